"""Ground motions of the table and their intensity measures: near-fault ones, those of the Lick
ensemble at three time scales, pulses of closed form.
"""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.fragility.motions import drawn_motion
from fecolumn.case.sections import Motion
from fecolumn.foundation.paths import LICK_PREFIX
from fecolumn.foundation.version import __version__
from fecolumn.motions import lick
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import read_ensemble, write_ensemble
from fecolumn.motions.intensity import intensity_measures
from fecolumn.motions.load import read_motion
from fecolumn.motions.processing import scale_time
from fecolumn.motions.pulses import Pulse, sample
from fecolumn.motions.record import GroundMotion

FAMILIES = ("near fault", "lick", "pulse")
#: Seed of the near-fault motions: none of those of `benchmarks.fragility`.
SEED, TIME_SCALES = 2, (1.0, 2.0, 3.0)
SHAPES = ("one_sine", "one_cosine", "symmetric_ricker", "antisymmetric_ricker")
#: Intensity measures by the power of a factor on the accelerations that they go with.
POWERS = {
    "pga_m_s2": 1,
    "pgv_m_s": 1,
    "pgd_m": 1,
    "arias_m_s": 2,
    "ds5_75_s": 0,
    "ds5_95_s": 0,
    "cav_m_s": 1,
    "housner_m": 1,
}
_ALONG = "along x: "


def motions(near_fault: int) -> list[tuple[GroundMotion, int, float]]:
    """Motions with their place in FAMILIES and the period of their pulse [s], nan where there is
    none: so many near-fault ones, and as many of the others as make a third of them.
    """
    made = []
    for number in range(1, near_fault + 1):
        motion, drawn = drawn_motion(number, SEED)
        made.append((motion, 0, drawn["pulse_period_s"]))
    for time_scale in TIME_SCALES:
        for number in range(1, min(lick.COUNT, near_fault // 15 + 1) + 1):
            motion = read_motion(Motion(f"{LICK_PREFIX}{number}"), "benchmarks.outcomes")
            made.append((scale_time(motion, time_scale), 1, float("nan")))
    for shape in SHAPES:
        for period in np.geomspace(0.2, 3.0, near_fault // 40 + 1):
            made.append((sample(Pulse(shape, 1.0, period), 0.01, tail=1.0), 2, float(period)))
    return made


def motions_file(folder: Path, near_fault: int) -> Path:
    """File of the motions with their measures, made unless it is there."""
    file = (folder / "motions.h5").resolve()
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        made = motions(near_fault)
        columns = {
            "family": np.array([family for _, family, _ in made], float),
            "pulse_period_s": np.array([period for _, _, period in made]),
        }
        for prefix, motion_of in (("", lambda motion: motion), (_ALONG, along_x)):
            measured = [intensity_measures(motion_of(motion)) for motion, _, _ in made]
            columns |= {prefix + name: np.array([one[name] for one in measured]) for name in POWERS}
        write_ensemble(
            Ensemble(
                "motions of the table of outcomes",
                tuple(motion for motion, _, _ in made),
                columns,
                {"model": "near-fault synthetics, Lick, pulses", "version": __version__},
            ),
            file,
        )
    return file


def along_x(motion: GroundMotion) -> GroundMotion:
    """Its component along x alone."""
    return replace(motion, acceleration=motion.acceleration * [1.0, 0.0, 0.0])


@functools.lru_cache(maxsize=1)
def stored(file: Path) -> Ensemble:
    """The ensemble of a file."""
    return read_ensemble(file)


def measures(ensemble: Ensemble, place: int, scale: float, alone: bool) -> dict[str, float]:
    """Intensity measures of a motion times a factor; alone: of its component along x."""
    prefix = _ALONG if alone else ""
    return {
        name: float(ensemble.parameters[prefix + name][place]) * scale**power
        for name, power in POWERS.items()
    }
