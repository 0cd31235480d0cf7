"""The motions of the grounds of a structure."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.sections import Motion
from fecolumn.foundation.schema import InputError

if TYPE_CHECKING:
    from fecolumn.motions.record import GroundMotion

# Speed at which two grounds go on to move apart after their motions, over their largest one, that
# is told
_DRIFTS = 0.05


def motions_of(
    case: Case, first: GroundMotion | None, file: Path | str
) -> list[GroundMotion | None]:
    """Ground motion of each ground, `first` that of those which have none of their own; None of a
    ground at rest.
    """
    found = [
        _own_motion(f"grounds.{name}", ground.motion, float(case.integration.dt_s), file)
        if ground.motion
        else first
        for name, ground in case.grounds.items()
    ]
    names = list(case.grounds)
    for name, motion in zip(names[1:], found[1:]):
        if motion and found[0] and motion is not found[0]:
            _warn_of_drift(f"grounds.{name}", f"grounds.{names[0]}", motion, found[0], file)
    return found


def _own_motion(key: str, motion: Motion, dt: float, file: Path | str) -> GroundMotion:
    """The motion of one ground, whose table is at `key`."""
    from fecolumn.motions.load import load_motion

    try:
        return load_motion(motion, dt, file)
    except InputError as error:
        own = f"{key}.{error.key}" if error.key.startswith("motion.") else error.key
        raise InputError(error.file, own, error.value, error.allowed) from None


def accelerations(motions: Sequence[GroundMotion | None], steps: range) -> NDArray[Any]:
    """Accelerations (k, 3 G) of grounds at k successive steps [m/s2]."""
    found = np.zeros((len(steps), len(motions), 3))
    for number, motion in enumerate(motions):
        if motion is not None:
            recorded = motion.acceleration[steps.start : steps.stop]
            found[: len(recorded), number] = recorded
    return found.reshape(len(steps), -1)


def _warn_of_drift(
    name: str, other: str, motion: GroundMotion, first: GroundMotion, file: Path | str
) -> None:
    """Tell of a ground that goes on to move away from the first one when both motions are over."""
    steps = max(len(one.acceleration) for one in (motion, first))
    relative = np.zeros((steps, 3))
    for one, sign in ((motion, 1.0), (first, -1.0)):
        relative[: len(one.acceleration)] += sign * one.acceleration
    speed = np.zeros_like(relative)
    speed[1:] = np.cumsum((relative[1:] + relative[:-1]) / 2, axis=0) * motion.dt
    left, largest = np.linalg.norm(speed[-1]), np.linalg.norm(speed, axis=1).max()
    if left > _DRIFTS * largest:
        warnings.warn(
            f"{file}: {name} goes on to move away from {other} at {left:.3g} m/s when "
            "their motions "
            f"are over, {left / largest:.0%} of the largest relative speed: correct the baselines "
            "of the records, so that both end at rest",
            stacklevel=2,
        )
