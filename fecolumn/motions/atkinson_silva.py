"""Fourier amplitude of ground acceleration in California after Atkinson and Silva (2000), and the
time it takes.

Product of source (two corners), path, site and near-surface loss, in the terms of Boore (2003).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

SHEAR_VELOCITY = 3.5  # beta, at the source [km/s]
_DENSITY = 2.8  # at the source [g/cm3]
RADIATION, FREE_SURFACE, PARTITION = 0.55, 2.0, 0.7071
KAPPA = 0.03  # [s]

# Boore and Joyner (1997), generic rock (620 m/s over the upper 30 m): frequency [Hz] and
# amplification, straight lines between, over the logarithm of the frequency; constant outside
GENERIC_ROCK = np.array(
    [
        (0.01, 1.00),
        (0.09, 1.10),
        (0.16, 1.18),
        (0.51, 1.42),
        (0.84, 1.58),
        (1.25, 1.74),
        (2.26, 2.06),
        (3.17, 2.25),
        (6.05, 2.58),
        (16.60, 3.13),
        (61.20, 4.00),
    ]
)


def corner_frequencies(magnitude: float) -> tuple[float, float, float]:
    """Lower and higher corner f_a, f_b [Hz] and the weight epsilon of the higher one (Atkinson and
    Silva 2000).
    """
    return (
        10 ** (2.181 - 0.496 * magnitude),
        10 ** (2.41 - 0.408 * magnitude),
        10 ** (0.605 - 0.255 * magnitude),
    )


def seismic_moment(magnitude: float) -> float:
    """M_0 [dyne cm] (Hanks and Kanamori 1979)."""
    return 10 ** (1.5 * (magnitude + 10.7))


def effective_distance(magnitude: float, distance: float) -> float:
    """R' = sqrt(R^2 + h^2) [km], with the pseudo-depth h = 10^(-0.05 + 0.15 M)."""
    return math.hypot(distance, 10 ** (-0.05 + 0.15 * magnitude))


def duration(magnitude: float, distance: float) -> float:
    """T = 1/(2 f_a) + 0.05 R of the motion [s]; R in km."""
    return 0.5 / corner_frequencies(magnitude)[0] + 0.05 * distance


def site_amplification(frequency: ArrayLike) -> NDArray[Any]:
    """Amplification of generic rock (Boore and Joyner 1997)."""
    frequency = np.maximum(np.asarray(frequency, dtype=np.float64), GENERIC_ROCK[0, 0])
    rock, gain = np.log(GENERIC_ROCK[:, 0]), GENERIC_ROCK[:, 1]
    result: NDArray[Any] = np.interp(np.log(frequency), rock, gain)
    return result


def fourier_amplitude(frequency: ArrayLike, magnitude: float, distance: float) -> NDArray[Any]:
    """Amplitude |A(f)| of the acceleration's Fourier transform int a exp(-2 pi i f t) dt.

    C (2 pi f)^2 M_0 [(1 - eps)/(1 + (f/f_a)^2) + eps/(1 + (f/f_b)^2)] exp(-pi f R'/(Q beta))
    exp(-pi kappa f) G(f) / R', Q = 180 f^0.45, C = 1e-20 * 0.55 * 0.7071 * 2/(4 pi rho beta^3), G
    the amplification of generic rock.

    Parameters
    ----------
    frequency
        (n,) not negative [Hz].
    magnitude
        moment magnitude M.
    distance
        from the fault, R [km]; within 40 km, where amplitudes fall as 1/R'.

    Returns
    -------
    (n,) [m/s]
    """
    frequency = np.asarray(frequency, dtype=np.float64)
    low, high, weight = corner_frequencies(magnitude)
    far = effective_distance(magnitude, distance)
    source = (1 - weight) / (1 + (frequency / low) ** 2) + weight / (1 + (frequency / high) ** 2)
    scale = (
        1e-20
        * RADIATION
        * PARTITION
        * FREE_SURFACE
        / (4 * math.pi * _DENSITY * SHEAR_VELOCITY**3)
        * seismic_moment(magnitude)
    )
    loss = np.exp(
        -math.pi * far / (180 * SHEAR_VELOCITY) * frequency**0.55 - math.pi * KAPPA * frequency
    )
    centimetres = (
        scale * (2 * math.pi * frequency) ** 2 * source / far * loss * site_amplification(frequency)
    )
    result: NDArray[Any] = 0.01 * centimetres
    return result
