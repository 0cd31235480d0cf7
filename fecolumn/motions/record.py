"""A ground motion as analyses use it, and a recording as files state it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY

# Samples of a motion [-], its step [s] and acceleration [m/s2]: beyond them a file is damaged or
# its unit is wrong
MOST_SAMPLES, STEPS_S, _LARGEST = 10_000_000, (1e-6, 10.0), 1e3
METRES_PER_S2 = {
    "g": GRAVITY,
    "%g": GRAVITY / 100,
    "mg": GRAVITY / 1000,
    "m/s2": 1.0,
    "cm/s2": 1e-2,
    "mm/s2": 1e-3,
    "ft/s2": 0.3048,
    "in/s2": 0.0254,
}


class UnusableRecord(ValueError):
    """A file or record name cannot be used; the message says where in it and why."""


@dataclass(frozen=True, slots=True, eq=False)
class GroundMotion:
    """Acceleration of the ground, sampled evenly from t = 0.

    Attributes
    ----------
    acceleration
        (n, 3) along x, y and z (up), n of at least 2, read-only [m/s2]; also `acceleration_m_s2`.
    dt
        sampling step, above 0 [s]; also `dt_s`.
    name
        short name for figures and tables.
    source
        where the motion comes from, to be cited.

    Raises
    ------
    ValueError
        an acceleration of another shape, or a step that is not above 0.
    """

    acceleration: NDArray[Any]
    dt: float
    name: str
    source: str

    def __post_init__(self) -> None:
        acceleration = np.array(self.acceleration, dtype=np.float64, order="C")
        if acceleration.ndim != 2 or acceleration.shape[1] != 3 or len(acceleration) < 2:
            raise ValueError(f"acceleration must be (n_steps >= 2, 3), not {acceleration.shape}")
        if not self.dt > 0:
            raise ValueError(f"dt must be positive, not {self.dt}")
        acceleration.flags.writeable = False
        object.__setattr__(self, "acceleration", acceleration)

    @property
    def acceleration_m_s2(self) -> NDArray[Any]:
        """Acceleration (n_steps, 3) along x, y and z (up), read-only [m/s2]."""
        return self.acceleration

    @property
    def dt_s(self) -> float:
        """Sampling step [s]."""
        return self.dt

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample [s]."""
        return self.duration

    @property
    def peak_m_s2(self) -> NDArray[Any]:
        """Peak absolute acceleration (3,) along x, y and z [m/s2]."""
        return self.pga

    @property
    def duration(self) -> float:
        """Older name of `duration_s`."""
        return (len(self.acceleration) - 1) * self.dt

    @property
    def horizontal_axes(self) -> tuple[int, ...]:
        """Horizontal axes along which the ground moves: 0 for x, 1 for y."""
        return tuple(axis for axis in (0, 1) if self.acceleration[:, axis].any())

    @property
    def pga(self) -> NDArray[Any]:
        """Older name of `peak_m_s2`."""
        result: NDArray[Any] = np.abs(self.acceleration).max(axis=0)
        return result


def sound(motion: GroundMotion) -> GroundMotion:
    """The motion itself.

    Raises
    ------
    UnusableRecord
        its step or an acceleration is none that a ground motion has.
    """
    if not STEPS_S[0] <= motion.dt <= STEPS_S[1]:
        raise UnusableRecord(
            f"is sampled at {motion.dt:g} s; must be in [{STEPS_S[0]:g}, {STEPS_S[1]:g}] s"
        )
    if not motion.pga.max() <= _LARGEST:  # not so for nan
        raise UnusableRecord(
            f"holds an acceleration of {motion.pga.max():g} m/s2; must be finite and at "
            f"most {_LARGEST:g}, about 100 g: its unit may be another"
        )
    return motion


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """What one file says.

    Attributes
    ----------
    values
        (n_steps, n_components) [units].
    axes
        axis of each component, "x", "y" or "z"; "" where the file does not say.
    dt
        sampling step [s], None where the file does not say.
    units
        a key of METRES_PER_S2, "" where the file does not say.
    name
        short name.
    source
        what the file says about its origin.
    format
        of the file, in words.
    """

    values: NDArray[Any]
    axes: tuple[str, ...]
    dt: float | None
    units: str
    name: str
    source: str
    format: str = ""
