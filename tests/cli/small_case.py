"""Case files for the command line: a thick short tube with cap and base, a few hundred bricks,
shaken by two tones, results in seconds.
"""

import os

import numpy as np

SPECIMEN = os.path.abspath("meshes/stout.toml")
MESH = """
[column]
wall_m = 0.02
height_m = 0.5
fine_height_m = 0.02
[base]
length_m = 0.3
width_m = 0.3
slide_allowance_m = 0.01
[mesh]
fine_size_m = 0.02
coarse_size_m = 0.03
cap_size_m = 0.05
base_size_m = 0.05
"""


def write_motion(path, seconds=0.5, scale=0.4):
    """Two horizontal components [g] every 2 ms, strong enough to rock the column."""
    time = np.arange(0, seconds, 0.002)
    x, y = np.sin(2 * np.pi * 4 * time), 0.7 * np.sin(2 * np.pi * 5.3 * time)
    rows = "".join(f"{t:.3f},{scale * a:.6f},{scale * b:.6f}\n" for t, a, b in zip(time, x, y))
    path.write_text("time [s],ax [g],ay [g]\n" + rows)
    return path


def write_case(folder, duration=0.2, extra=""):
    """Path of a case file in `folder` with its motion beside it."""
    write_motion(folder / "motion.csv", min(duration, 0.5))
    path = folder / "case.toml"
    engine = "" if "engine" in extra else 'engine = "full"\n'
    path.write_text(
        f'extends = "{SPECIMEN}"\n{MESH}\n[motion]\nsource = "motion.csv"\n'
        f"[integration]\nduration_s = {duration}\ndt_s = 2e-3\nalpha_hht = -0.05\n{engine}{extra}"
    )
    return path
