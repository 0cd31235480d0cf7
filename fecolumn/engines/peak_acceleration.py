"""Peak acceleration of a body from its history, over a time that no step decides."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Half the time over which accelerations are taken [s]: an impact changes a velocity at once, so
#: that over a step it would be what the step says.
HALF_WINDOW_S = 5e-3


def window_s(time: NDArray[Any]) -> float | None:
    """Time [s] over which `peak_acceleration` takes its mean: 10 ms, as near as an even number of
    the steps of `time` (n,) [s] comes to it, two at least; None of a shorter history.
    """
    half, dt = _half_steps(time)
    return 2 * half * dt if half else None


def _half_steps(time: NDArray[Any]) -> tuple[int, float]:
    """Steps in half of the window, 0 of a history that is shorter than that, and a step [s]."""
    if len(time) < 3:
        return 0, 0.0
    dt = float(time[-1] - time[0]) / (len(time) - 1)
    half = max(1, round(HALF_WINDOW_S / dt))
    return (half if len(time) > 2 * half else 0), dt


def peak_acceleration(
    time: NDArray[Any], displacement: NDArray[Any], ground: NDArray[Any]
) -> float | None:
    """Largest horizontal acceleration [m/s2] in space of a point, its mean over `window_s` with the
    weights of a triangle: the second difference of its places half of that apart, and as much of
    the ground's. None of a history that is shorter than that.

    Parameters
    ----------
    time
        (n,) evenly spaced [s].
    displacement
        (n, 3) relative to the ground [m].
    ground
        (n, 3) acceleration of the ground [m/s2].
    """
    half, dt = _half_steps(time)
    if not half:
        return None
    moved, shaken = (np.asarray(each)[:, :2] for each in (displacement, ground))
    relative = (moved[2 * half :] - 2 * moved[half:-half] + moved[: -2 * half]) / (half * dt) ** 2
    weights = np.concatenate([np.arange(1, half + 1), np.arange(half - 1, 0, -1)]) / half**2
    # the ends of the triangle weigh nothing
    base = np.column_stack([np.convolve(shaken[1:-1, axis], weights, "valid") for axis in range(2)])
    return float(np.linalg.norm(relative + base, axis=1).max())
