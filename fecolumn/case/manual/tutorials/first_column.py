# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # From a mesh to a distribution
#
# A marble drum stands on the ground. It is shaken by one motion, then by ten, and what comes out is
# a distribution of how far its top moves. Everything is in SI units. The file is a notebook in
# text: open it with Jupyter and jupytext, or run it with Python.

# %%
from pathlib import Path

import fecolumn

folder = Path("results/first_column")

# %% [markdown]
# ## The column
#
# A case is a table of keys, as in a TOML file; `fecolumn keys` prints them all. What is left open,
# such as the sizes of the bricks, follows the column.

# %%
drum = fecolumn.case_from_tables(
    {
        "title": "Marble drum",
        "column": {"shape": "solid", "outer_diameter_m": 0.4, "height_m": 1.8},
        "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700.0},
        "contact": {"friction_coefficient": 0.7},
        "motion": {"source": "lick:1", "scale": 1.5},
        "integration": {"engine": "reduced"},
    },
    "first_column",
)
print(drum.mesh)

# %% [markdown]
# ## One motion
#
# The first analysis of a column makes its reduced model, some seconds; it is kept for all others.

# %%
fecolumn.run(drum, folder / "one")
one = fecolumn.load(folder / "one")
one

# %%
one.plot.top()

# %% [markdown]
# Arrays have the names of the history, and units.

# %%
print(
    f"largest tilt {one['tilt'].max():.4f} {one.units['tilt']}, energy not accounted "
    f"for {abs(one.energy['closure']).max():.1e} J"
)

# %% [markdown]
# ## A motion of one's own
#
# Any array of accelerations is a motion: here three cycles of a sine.

# %%
import numpy as np

time = np.arange(0, 2.4, 0.01)
sine = fecolumn.motion_file(folder / "sine.csv", 3.0 * np.sin(2 * np.pi * time / 0.8), 0.01)
fecolumn.run(drum.replace(motion={"source": sine, "scale": 1.0}), folder / "sine")
print(fecolumn.load(folder / "sine"))

# %% [markdown]
# ## Ten motions
#
# One rocking analysis is chaotic and says little. A study is a file, so that it can be stopped,
# gone on with, and shown to others.

# %%
study = folder / "drum-study.toml"
study.write_text("""
title = "Marble drum, ten motions"

[case]
column = {shape = "solid", outer_diameter_m = 0.4, height_m = 1.8}
material = {youngs_modulus_pa = 50e9, density_kg_m3 = 2700}
contact.friction_coefficient = 0.7
integration.engine = "reduced"
motion = {source = "lick:1", scale = 1.5}

[axes]
"motion.source" = ["lick:1-10"]
""")
ten = fecolumn.run_study(study, folder / "ten")
ten

# %%
ten.plot.cdf()

# %%
distribution = ten.ecdf()
print(f"overturned: {distribution.lost} of {distribution.n}")
