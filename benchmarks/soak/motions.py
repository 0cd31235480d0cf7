"""Ground motions of every family that the package makes, or finds without a download."""

from __future__ import annotations

import dataclasses
import functools
import warnings
from pathlib import Path

import numpy as np

from fecolumn.case.sections import Motion
from fecolumn.foundation.paths import LICK_PREFIX
from fecolumn.motions import fema_p695, lick
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import members, write_ensemble
from fecolumn.motions.load import read_motion
from fecolumn.motions.near_fault import near_fault_ensemble
from fecolumn.motions.pulses import SHAPES, Pulse, sample
from fecolumn.motions.record import UnusableRecord

_MAGNITUDES, _DISTANCES, _EACH = (6.0, 7.0), (5.0, 15.0), 5
_PERIODS = (0.1, 0.3, 1.0)  # of pulses [s]
_VERTICAL = 0.6  # of a second motion's first component


def write_motions(folder: Path) -> dict[str, list[str]]:
    """Sources by family, each as in motion.source; what has to be made is written into the
    folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    made = {"near-fault": _near_fault, "pulses": _pulses, "three components": _three_components}
    for name, maker in made.items():
        if not _file(folder, name).exists():
            write_ensemble(maker(), _file(folder, name))
    sources = {name: members(f"{_file(folder, name)}#*") for name in made}
    sources["lick"] = [f"{LICK_PREFIX}{number}" for number in range(1, lick.COUNT + 1)]
    try:
        sources["records"] = [entry.name for entry in fema_p695.available()]
    except UnusableRecord as error:
        warnings.warn(f"no records take part: {error}", stacklevel=2)
    return dict(sorted(sources.items()))


@functools.cache
def sampling_and_peak(source: str) -> tuple[float, float]:
    """Time step [s] and largest horizontal acceleration [m/s2] of a source."""
    motion = read_motion(Motion(source), "benchmarks.soak")
    return motion.dt, float(np.hypot(*motion.acceleration[:, :2].T).max())


def _file(folder: Path, name: str) -> Path:
    return (folder / f"{name.replace(' ', '-')}.h5").resolve()


def _near_fault() -> Ensemble:
    return near_fault_ensemble(_MAGNITUDES, _DISTANCES, _EACH, fault_parallel=True)


def _pulses() -> Ensemble:
    motions = tuple(
        sample(Pulse(shape, 1.0, period), 1e-3, lead=0.05, tail=1.0)
        for shape in SHAPES
        for period in _PERIODS
    )
    return Ensemble(
        "pulses", motions, {"period_s": np.tile(_PERIODS, len(SHAPES))}, {"model": "closed form"}
    )


def _three_components() -> Ensemble:
    """Near-fault motions with the next one's fault-normal component upright."""
    motions = _near_fault().motions
    length = min(len(motion.acceleration) for motion in motions)
    whole = tuple(
        dataclasses.replace(
            one,
            acceleration=np.column_stack(
                [one.acceleration[:length, :2], _VERTICAL * other.acceleration[:length, 0]]
            ),
        )
        for one, other in zip(motions, (*motions[1:], motions[0]))
    )
    return Ensemble("three components", whole, {}, {"model": "near-fault synthetics"})
