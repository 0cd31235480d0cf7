"""A structure that is shaken, and what a program says of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.planar import theory
from benchmarks.planar.bodies import Structure

#: Between rows of the histories that are kept [s]
EVERY = 1e-3


@dataclass(frozen=True)
class Shaken:
    """A structure and how strongly it is shaken.

    Attributes
    ----------
    structure
        planar.
    uplift
        acceleration of the ground at which it begins to rock [m/s2].
    factor
        peak of a motion over that.
    motions
        their number.
    observed
        number of the body whose top is watched.
    closed
        the block of the same motion, if there is one.
    """

    structure: Structure
    uplift: float
    factor: float
    observed: int
    motions: int = 100
    closed: theory.Rocker | None = None


@dataclass(frozen=True)
class Response:
    """What a program says of a structure in a motion.

    Attributes
    ----------
    time
        (n,) [s], each EVERY.
    top
        (n,) [m] displacement of the observed body's top along x.
    tilt
        (n, nb) [rad] of the bodies, without sign.
    fallen
        whether it overturned.
    failed
        why the program stopped before the end, if it did.
    unsolved
        steps whose friction problem was not solved to the program's tolerance.
    """

    time: np.ndarray
    top: np.ndarray
    tilt: np.ndarray
    fallen: bool
    failed: str = ""
    unsolved: int = 0

    @property
    def peak(self) -> float:
        """Largest displacement of the top [m]."""
        return float(np.abs(self.top).max())
