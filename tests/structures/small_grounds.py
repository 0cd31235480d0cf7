"""Rigid blocks on grounds of all kinds, analysed with the rigid engine."""

import numpy as np
from small_structures import RIGID, STONE, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.toml_file import merge
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


def wave(folder):
    """A motion of one sine wave that begins and ends softly: its file, times [s], displacements
    [m].
    """
    times = 1e-3 * np.arange(401)
    w = 2 * np.pi / 0.4
    # displacement d (1 - cos w t)^2, at rest at both ends
    displacement = 2e-4 * (1 - np.cos(w * times)) ** 2
    acceleration = 2e-4 * 2 * w**2 * (np.cos(w * times) - np.cos(2 * w * times))
    file = folder / "wave.csv"
    rows = "\n".join(f"{t:.6f},{a:.15e},0.0" for t, a in zip(times, acceleration))
    file.write_text(f"t,ax,ay\n{rows}\n", encoding="utf-8")
    return file, times, displacement


def bridge(file, block, stiffness):
    """Tables of two piers that stick to their grounds, 0.5 m apart in height, one moved by -0.5
    times the motion of a file against the other, with springs between them.
    """
    motion = dict(source=str(file), units="m/s2", free_vibration_s=0.05)
    spring = dict(kind="spring", stiffness_n_m=stiffness)
    deck = dict(body="right", point_m=[0, 0, 0.05], to="left", to_point_m=[-4.0, 0, 0.05])
    anchor = dict(body="left", point_m=[0, 0, 0.1], to="hill", to_point_m=[3.0, 0, 0.1])
    return dict(
        bodies=dict(left=block, right=block | dict(at_m=[4.0, 0, 0.5])),
        joints=dict(left=dict(between=["left", "valley"]), right=dict(between=["right", "hill"])),
        grounds=dict(valley={}, hill=dict(level_m=0.5, motion=motion | dict(scale=-0.5))),
        links=dict(deck=spring | deck, anchor=spring | anchor),
        motion=motion,
        integration=dict(dt_s=1e-3, duration_s=0.0),
    )
