"""How the ground moves, from its acceleration in the history."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

# A ground that is still this fast [-] at the end, over its largest speed, runs away: the record has
# a baseline of its own, or is a piece of a longer one
_STILL = 0.1


@dataclass(frozen=True, slots=True)
class GroundPath:
    """Displacement of the first ground.

    Attributes
    ----------
    place
        (t, 3) [m] at each time.
    rests
        whether it ends at rest, so that the page shows it moving at first.
    """

    place: np.ndarray
    rests: bool

    @property
    def largest(self) -> float:
        """Largest displacement [m]."""
        return float(np.linalg.norm(self.place, axis=1).max())


def ground_of(history: dict[str, np.ndarray], times: np.ndarray) -> GroundPath:
    """Displacement at `times` (t,) [s] of a ground that was at rest at the first row, by the
    trapezoidal rule twice, no baseline corrected.
    """
    time, acceleration = history["time"], history["ground"][:, :3]
    velocity = cumulative_trapezoid(acceleration, time, axis=0, initial=0.0)
    place = cumulative_trapezoid(velocity, time, axis=0, initial=0.0)
    speed = np.linalg.norm(velocity, axis=1)
    return GroundPath(
        np.stack([np.interp(times, time, one) for one in place.T], axis=1),
        bool(speed[-1] <= _STILL * speed.max()),
    )
