# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # An exhibit from a scan
#
# A figure was scanned. Does it rock on its pedestal in a given earthquake, and do wires help? We
# read the surface, check its mass, run it once as it stands, and once with wires.

# %%
from pathlib import Path

import numpy as np
import pyvista

import fecolumn

folder = Path("results/exhibit")
folder.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## The scan
#
# Yours is a file: a closed surface (`.stl`, `.obj`, `.ply`). Here a figure of 0.6 m is made by
# revolution, in millimetres, as scanners write them.

# %%
heights = np.linspace(0, 600, 21)
radius = np.interp(heights, [0, 40, 320, 450, 520, 560, 600], [60, 55, 75, 80, 40, 45, 15])
outline = np.c_[np.r_[0, radius, 0], np.zeros(23), np.r_[0, heights, 600]]
surface = pyvista.lines_from_points(outline).extrude_rotate(resolution=20, capping=True)
surface.triangulate().clean().save(folder / "scan.stl")

# %% [markdown]
# ## The case
#
# Parts of a case are classes. Their keys end in their unit, and `help(fecolumn.MeshBody)` tells
# what each means. The bodies, joints and links get names, by which they refer to one another.

# %%
bodies = {
    "pedestal": fecolumn.Block(length_m=0.35, width_m=0.35, height_m=0.9, mass_kg=120, rigid=True),
    "figure": fecolumn.MeshBody(
        mesh_file=str(folder / "scan.stl"),
        mesh_unit="mm",
        at_m=(0, 0, 0.9),  # the middle of its foot
        density_kg_m3=8700,
        rigid=True,
    ),
}
joints = {
    "floor": fecolumn.Joint(between=("pedestal", "ground"), friction_coefficient=0.6),
    "foot": fecolumn.Joint(between=("figure", "pedestal"), friction_coefficient=0.4),
}
plain = fecolumn.Case(
    title="Figure on its pedestal",
    bodies=bodies,
    joints=joints,
    motion=fecolumn.Motion("lick:12", scale=1.5, strong_part=(0.05, 0.95)),
    integration=fecolumn.Integration(engine="rigid", dt_s=0.002),
)
plain

# %% [markdown]
# ## As it stands
#
# A wrong key, a wrong unit or a joint of bodies that do not touch is told in one line when the case
# is made or run.

# %%
fecolumn.run(plain, folder / "plain")
stands = fecolumn.load(folder / "plain")
stands

# %% [markdown]
# The history is an `xarray.Dataset` with units; figures are those of matplotlib.

# %%
tilt = stands.data["tilt"]
print(f"largest tilt {float(tilt.max()):.4f} {tilt.attrs['units']}")
stands.plot.top()

# %% [markdown]
# ## With four wires
#
# From the figure's shoulder to the pedestal's corners. Points are measured from the middle of the
# figure's foot. A tendon only pulls.

# %%
corners = {"ne": (0.15, 0.15), "nw": (-0.15, 0.15), "sw": (-0.15, -0.15), "se": (0.15, -0.15)}
wires = {
    name: fecolumn.Tendon(
        body="figure",
        point_m=(0.03 * np.sign(x), 0.03 * np.sign(y), 0.45),
        to="pedestal",
        to_point_m=(x, y, 0.0),
        stiffness_n_m=1e5,
        prestress_n=20.0,
    )
    for name, (x, y) in corners.items()
}
held = fecolumn.Case(
    title="Figure with four wires",
    bodies=bodies,
    joints=joints,
    links=wires,
    motion=plain.motion,
    integration=plain.integration,
)
fecolumn.run(held, folder / "held")
wired = fecolumn.load(folder / "held")
wired.plot.links()

# %%
for name, wire in wired.summary["links"].items():
    print(f"wire {name}: at most {wire['tension_max_n']:.0f} N")
for result in (stands, wired):
    foot = result.summary["interfaces"]["foot: figure on pedestal"]
    print(f"{result.case.title}: slides by {1e3 * foot['slide_max_m']:.1f} mm at most")
