"""Rigid blocks on grounds of all kinds, analysed with the rigid engine."""

import numpy as np
from small_structures import RIGID, STONE, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import merge
from fecolumn.simulation import run

SIDE, HEIGHT, SUBGRADE = 0.6, 0.9, 2e7
MASS = 2700.0 * SIDE**2 * HEIGHT
WEIGHT = MASS * GRAVITY
# of a block on the pad: angular frequency of its vertical vibration [rad/s] and settlement [m]
VERTICAL = np.sqrt(SUBGRADE * SIDE**2 / MASS)
SETTLED = WEIGHT / (SUBGRADE * SIDE**2)
BLOCK = dict(kind="block", length_m=SIDE, width_m=SIDE, height_m=HEIGHT, element_size_m=0.1) | (
    STONE | RIGID
)


def analysed(folder, **tables):
    """Summary and history of a structure in the rigid engine."""
    settings = dict(
        integration=dict(engine="rigid", alpha_hht=0.0, dt_s=5e-4),
        contact=dict(friction_coefficient=5.0, interior_points=200),
    )
    summary = run(structure(**merge(settings, tables)), folder, quiet=True)
    return summary, read_history(folder / "history.h5")


def on_pad(folder, soil=None, **tables):
    """The same of a block on soil springs."""
    stands = dict(
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "soil"])),
        grounds=dict(soil=dict(kind="pad", stiffness_n_m3=SUBGRADE) | (soil or {})),
    )
    return analysed(folder, **merge(stands, tables))


def frequency(times, values):
    """Mean angular frequency [rad/s] by the zeros of a vibration about its mean."""
    values = values - (values.max() + values.min()) / 2
    rising = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    zeros = times[rising] - values[rising] * np.diff(times)[rising] / np.diff(values)[rising]
    return 2 * np.pi * (len(zeros) - 1) / (zeros[-1] - zeros[0])
