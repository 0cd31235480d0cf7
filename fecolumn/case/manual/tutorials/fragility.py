# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # A column of one's own under records of one's own, to a fragility curve
#
# A museum's glass case stands on a steel pedestal. Its records are text files with one row a
# sample. How likely is it to overturn, at which peak ground velocity?

# %%
from pathlib import Path

import numpy as np

import fecolumn

folder = Path("results/fragility")

# %% [markdown]
# ## Records
#
# Here they are made: modulated noise of a fixed seed. Yours are files as they come, `.AT2`, `.csv`
# or text.

# %%
rng, dt = np.random.default_rng(1), 0.01
time = np.arange(0, 6, dt)
for number in range(1, 7):
    noise = np.convolve(
        rng.normal(size=len(time)), np.exp(-np.arange(0, 0.5, dt) / 0.08), mode="same"
    )
    acceleration = noise / abs(noise).max() * 2.5 * np.exp(-(((time - 2.5) / 1.2) ** 2))
    fecolumn.motion_file(folder / f"record-{number}.csv", acceleration, dt)

# %% [markdown]
# ## The study
#
# Each record at six scales: an incremental dynamic analysis.

# %%
study = folder / "pedestal.toml"
study.write_text("""
title = "Pedestal, own records"

[case]
column = {outer_diameter_m = 0.2, wall_m = 0.008, height_m = 1.2}
cap = {length_m = 0.3, width_m = 0.3, thickness_m = 0.02}
contact.friction_coefficient = 0.5
integration.engine = "rigid"
motion = {source = "record-1.csv"}

[axes]
"motion.source" = [
    "record-1.csv", "record-2.csv", "record-3.csv", "record-4.csv", "record-5.csv", "record-6.csv",
]
"motion.scale" = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0]
""")
pedestal = fecolumn.run_study(study, folder / "study")
pedestal

# %%
pedestal.plot.cdf()

# %% [markdown]
# ## The fragility
#
# `fecolumn report` fits it over the intensity of the motions, with intervals, and draws the IDA
# curves.

# %%
print(pedestal.report())

# %% [markdown]
# The same by hand: the share that is lost at each scale.

# %%
for scale in pedestal.axes["motion.scale"]:
    distribution = pedestal.ecdf({"motion.scale": scale})
    print(f"scale {scale:g}: {distribution.lost} of {distribution.n} lost")
