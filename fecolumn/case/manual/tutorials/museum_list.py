# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # A museum's list
#
# A museum measured its objects. Which of them is in danger, how wide would the base of the worst
# have to be, and how often does it fall?

# %%
from pathlib import Path

import pandas

import fecolumn

folder = Path("results/museum")

# %% [markdown]
# ## The list
#
# A table: a CSV file, or a `DataFrame`. Units stand in the names of the columns.

# %%
objects = pandas.DataFrame(
    {
        "name": ["amphora", "bronze statuette", "marble bust", "showcase"],
        "width_cm": [18, 10, 35, 60],
        "depth_cm": [18, 8, 35, 60],
        "height_cm": [75, 55, 160, 190],
        "mass_kg": [9, 14, 310, 120],
        "friction": [0.6, 0.5, 0.6, 0.4],
    }
)
objects

# %% [markdown]
# ## Which is in danger?
#
# Each object is a rigid block that only rocks, in 36 motions of the Lick ensemble. Their time is
# that of a specimen: a factor of 2 on time brings them to full scale. This is a first look, which
# takes seconds; `engine="rigid"` lets the objects slide and turn, too, and takes some minutes.

# %%
ranking = fecolumn.screen(
    objects,
    folder / "screen",
    motions="lick:1-36",
    scale=(1.0, 2.0),
    event="overturn",
    engine="housner",
)
ranking

# %% [markdown]
# ## How wide must the base of the statuette be?
#
# The least width with which it overturns in less than one of ten motions, and the interval of that
# width that 36 motions leave.

# %%
statuette = fecolumn.case_from_tables(
    {
        "title": "Statuette",
        "block": {"width_m": 0.08, "height_m": 0.55},
        "motion": {"source": "lick:1", "time_scale": 2.0},
        "integration": {"dt_s": 0.005},
    }
)
width = fecolumn.design(
    statuette,
    folder / "width",
    vary=("block.width_m", 0.06, 0.3),
    motions="lick:1-36",
    limit="P(overturn) < 0.1",
    steps=12,
)
width

# %% [markdown]
# ## How often does it fall?
#
# The same motions at other strengths make a fragility; with a hazard curve of the site it gives the
# chance in 50 years.

# %%
study = fecolumn.run_study(
    statuette,
    folder / "strengths",
    axes={"motion.scale": [0.5, 1.0, 2.0], "motion.source": ["lick:1-12"]},
)
study.data.groupby("motion.scale")["lost"].mean()

# %%
study.plot.cdf()

# %%
hazard = folder / "hazard.csv"
hazard.write_text(
    "pga_g,annual_frequency\n0.02,0.08\n0.05,0.02\n0.1,0.006\n0.2,0.0014\n"
    "0.4,0.00025\n0.8,3e-5\n1.6,2.5e-6\n3.2,1.2e-7\n"
)
often = fecolumn.risk(folder / "strengths", folder / "risk", hazard=hazard)
often
