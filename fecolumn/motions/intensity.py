"""Intensity measures of a ground motion: single numbers that say how strong, how long and of what
period it is.

Measures over directions or of both components are those of the one component where the motion is
along x or y alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from fecolumn.motions.processing import arias_intensity, integrate
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.spectra import horizontal_spectrum, rotated_peaks

_HOUSNER_PERIODS = np.linspace(0.1, 2.5, 121)


def peak_values(motion: GroundMotion) -> tuple[float, float, float]:
    """PGA [m/s2], PGV [m/s] and PGD [m] of the horizontal motion: median over directions (RotD50;
    Boore 2010), or the one component's.

    Velocity and displacement are integrated from rest, without baseline correction.
    """
    velocity, displacement = integrate(motion)

    def peak(history: NDArray[Any]) -> float:
        if len(motion.horizontal_axes) == 1:
            return float(np.abs(history[:, motion.horizontal_axes[0]]).max())
        return float(np.median(rotated_peaks(history[:, :2])))

    return peak(motion.acceleration), peak(velocity), peak(displacement)


def total_arias_intensity(motion: GroundMotion) -> float:
    """Arias intensity of both horizontal components together [m/s]; the same whatever the axes
    (Arias 1970).
    """
    return float(arias_intensity(motion)[-1, :2].sum())


def significant_duration(motion: GroundMotion, start: float = 0.05, end: float = 0.95) -> float:
    """Time between two fractions of the Arias intensity of both horizontal components together [s]
    (Trifunac and Brady 1975).

    Straight lines join the samples of the intensity. 0 for a motion that is zero.
    """
    intensity = arias_intensity(motion)[:, :2].sum(axis=1)
    if intensity[-1] == 0:
        return 0.0
    first, last = np.interp(
        [start * intensity[-1], end * intensity[-1]],
        intensity,
        np.arange(len(intensity)) * motion.dt,
    )
    return float(last - first)


def cumulative_absolute_velocity(motion: GroundMotion) -> float:
    """Geometric mean over x and y of int |a| dt [m/s] (EPRI 1988), by the trapezoidal rule; of one
    component, its own.
    """
    magnitude = np.abs(motion.acceleration[:, :2])
    along = motion.dt * (magnitude.sum(axis=0) - 0.5 * (magnitude[0] + magnitude[-1]))
    if len(motion.horizontal_axes) == 1:
        return float(along[motion.horizontal_axes[0]])
    return float(np.sqrt(along[0] * along[1]))


def housner_intensity(motion: GroundMotion, damping: float = 0.05) -> float:
    """Integral of the pseudo-velocity, RotD50 or the one component's, over periods from 0.1 to 2.5
    s [m] (Housner 1952).
    """
    velocity = (
        horizontal_spectrum(motion, _HOUSNER_PERIODS, damping) * _HOUSNER_PERIODS / (2 * np.pi)
    )
    return float(trapezoid(velocity, _HOUSNER_PERIODS))


def intensity_measures(motion: GroundMotion) -> dict[str, float]:
    """All measures of this module by name with unit."""
    pga, pgv, pgd = peak_values(motion)
    return {
        "pga_m_s2": pga,
        "pgv_m_s": pgv,
        "pgd_m": pgd,
        "arias_m_s": total_arias_intensity(motion),
        "ds5_75_s": significant_duration(motion, 0.05, 0.75),
        "ds5_95_s": significant_duration(motion),
        "cav_m_s": cumulative_absolute_velocity(motion),
        "housner_m": housner_intensity(motion),
    }
