"""Case files, and files they extend."""

from __future__ import annotations

import numpy as np

from benchmarks.fuzz.damage import toml
from fecolumn.case.case import load_case
from fecolumn.motions.load import load_motion

_SPECIMEN = """title = "tube"
[column]
outer_diameter_m = 0.0761
wall_m = 0.005
height_m = 1.5
[cap]
length_m = 0.15
width_m = 0.15
thickness_m = 0.01
[base]
length_m = 0.3
width_m = 0.3
thickness_m = 0.02
[mesh]
fine_size_m = 0.005
coarse_size_m = 0.015
[contact]
friction_coefficient = 0.3
[integration]
dt_s = 1e-3
alpha_hht = -0.2
"""
_CASE = """extends = "specimen.toml"
[integration]
engine = "rigid"
max_iterations = 20
[motion]
source = "motion.csv"
scale = 0.5
time_scale = 0.5
rotation_deg = 30.0
strong_part = [0.001, 0.999]
delay_s = 0.1
vertical = false
free_vibration_s = 1.0
[initial]
tilt_rad = 0.0
[output]
fields_every_s = 0.0
history_every_s = 0.005
"""


def prepare(folder) -> None:
    """A case that extends another, and its motion."""
    (folder / "specimen.toml").write_text(_SPECIMEN)
    (folder / "case.toml").write_text(_CASE)
    time = np.arange(0, 2, 0.01)
    (folder / "motion.csv").write_text(
        "time [s],ax [g],ay [g]\n"
        + "".join(f"{t:.2f},{np.sin(9 * t):.5f},{np.cos(7 * t):.5f}\n" for t in time)
    )


def sound(folder):
    """The case as it is."""
    return folder / "case.toml"


def mutate(rng, folder):
    """Either file changed."""
    name = str(rng.choice(["case.toml", "case.toml", "specimen.toml"]))
    path = folder / name
    path.write_bytes(toml(rng, path.read_text()))
    if rng.random() < 0.05:
        (folder / "specimen.toml").write_text('extends = "case.toml"\n' + _SPECIMEN)
    return folder / "case.toml"


def use(path) -> None:
    """What every command does first."""
    case = load_case(path)
    assert len(case.id) == 12
    if case.motion:
        ground = load_motion(case.motion, case.integration.dt_s, path)
        assert np.isfinite(ground.acceleration).all()
