"""For how long an analysis follows its motion, and where it is at rest."""

from __future__ import annotations

import numpy as np

from fecolumn.case.sections import UNTIL_REST, Motion
from fecolumn.foundation.arrays import Array
from fecolumn.motions.record import GroundMotion


def followed_s(motion: GroundMotion | None, keys: Motion | None, stated_s: float) -> float:
    """Time that is followed at most [s].

    Parameters
    ----------
    motion, keys
        the motion as it is loaded, and the table [motion]; None for a ground at rest.
    stated_s
        integration.duration_s; 0: until the motion, a step after its last sample and the longest
        free vibration are over.
    """
    if stated_s:
        return stated_s
    assert motion and keys  # `check_duration` asks for one of the two
    return len(motion.acceleration) * motion.dt + keys.longest_free_vibration_s


def ends_at_rest(keys: Motion | None, stated_s: float) -> bool:
    """Whether the analysis ends when the structure is at rest; arguments as of `followed_s`."""
    return keys is not None and keys.free_vibration_s == UNTIL_REST and not stated_s


def until(motion: GroundMotion | None, steps: int, dt_s: float) -> tuple[GroundMotion, float]:
    """What of a motion, None for a ground at rest, falls in so many steps [s], and the time [s]
    that is left after it.
    """
    samples = np.zeros((2, 3)) if motion is None else motion.acceleration[: steps + 1]
    name, source = (motion.name, motion.source) if motion else ("at rest", "")
    found = GroundMotion(samples, dt_s, name, source)
    return found, max(0.0, steps * dt_s - found.duration)


def first_still(energy: Array, still_j: float, after: int) -> int | None:
    """The first row from `after` on with no more than `still_j` of energy (n,) [J], or None."""
    rows = np.flatnonzero((energy <= still_j) & (np.arange(len(energy)) >= after))
    return int(rows[0]) if len(rows) else None
