# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # A temple's columns
#
# Two columns of drums carry an architrave. In which motions does a drum lose its place? One file of
# a case is made by a few lines of Python, as there are many equal bodies.

# %%
from pathlib import Path

import fecolumn

folder = Path("results/temple")

# %% [markdown]
# ## Drums, capitals, architrave
#
# `copies_m` are the places of equal bodies: one name stands for both columns' drums of one course.

# %%
marble = fecolumn.Material(youngs_modulus_pa=50e9, poissons_ratio=0.25, density_kg_m3=2700)
bodies: dict = {}
joints = {"base": fecolumn.Joint(between=("drum1", "ground"))}
spacing, height, courses = 2.4, 1.2, 3
for course in range(1, courses + 1):
    level = (course - 1) * height
    bodies[f"drum{course}"] = fecolumn.Cylinder(
        outer_diameter_m=0.9,
        height_m=height,
        element_size_m=0.2,  # some 14 contact points around a drum: quick
        material="marble",
        copies_m=((-spacing / 2, 0, level), (spacing / 2, 0, level)),
    )
    if course > 1:
        joints[f"bed{course}"] = fecolumn.Joint(between=(f"drum{course}", f"drum{course - 1}"))
bodies["architrave"] = fecolumn.Block(
    length_m=3.6, width_m=0.9, height_m=0.7, material="marble", at_m=(0, 0, courses * height)
)
joints["top"] = fecolumn.Joint(between=("architrave", f"drum{courses}"))
temple = fecolumn.Case(
    title="Two columns and an architrave",
    bodies=bodies,
    joints=joints,
    materials={"marble": marble},
    contact=fecolumn.Contact(friction_coefficient=0.7, interior_points=9),
    motion=fecolumn.Motion("lick:12", scale=2.0, strong_part=(0.1, 0.6)),
    integration=fecolumn.Integration(engine="rigid", dt_s=0.002),
)
temple

# %% [markdown]
# The same case as a file, for the command line or for others:

# %%
folder.mkdir(parents=True, exist_ok=True)
(folder / "temple.toml").write_text(temple.to_toml())
print(temple.to_toml()[:400], "...")

# %% [markdown]
# ## One motion

# %%
fecolumn.run(temple, folder / "one")
one = fecolumn.load(folder / "one")
one

# %%
one.plot.joints()

# %% [markdown]
# Which joint slid the most?

# %%
slides = {name: each["slide_max_m"] for name, each in one.summary["interfaces"].items()}
for name in sorted(slides, key=slides.get, reverse=True)[:3]:
    print(f"{name}: {1e3 * slides[name]:.1f} mm")

# %% [markdown]
# ## Three strengths
#
# A study runs a case along axes, each with each; the runs are a `pandas.DataFrame`.

# %%
study = fecolumn.run_study(
    temple,
    folder / "strengths",
    axes={"motion.scale": [1.0, 3.0, 4.0]},
)
study.data[["motion.scale", "outcome", "u_max_m"]]

# %%
study.analyses({"motion.scale": 4.0})[0].plot.top()
