"""The elastic building of n storeys above a rocking storey: shear frames whose first mode has a
given profile, damped after Rayleigh.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from fecolumn.foundation.arrays import Array

#: First mode over the height x = i/n of floor i of n, after Thermou, Pantazopoulou and Elnashai
#: (2012)
PROFILES: dict[str, Callable[[Array], Array]] = {
    "flexural": lambda x: 1 - np.cos(math.pi * x / 2),
    "shear": lambda x: np.sin(math.pi * x / 2),
    "triangular": lambda x: x,
}


@dataclass(frozen=True, slots=True, eq=False)
class ElasticBuilding:
    """An elastic building, fixed at its foot.

    Attributes
    ----------
    mass
        of each floor (n,) [kg].
    stiffness
        of each storey (n,) from below [N/m].
    omega
        of the modes (n,) rising [rad/s].
    damping
        ratio of each mode (n,).
    shapes
        modes (n, n) in columns, normalised to shapes^T M shapes = 1 [kg^-1/2].
    """

    mass: Array
    stiffness: Array
    omega: Array
    damping: Array
    shapes: Array

    @property
    def participation(self) -> Array:
        """Gamma (n,) = shapes^T M 1 [kg^1/2]; its squares are the effective modal masses and add up
        to the mass.
        """
        factors: Array = self.shapes.T @ self.mass
        return factors

    @property
    def effective_mass(self) -> Array:
        """Share of the mass in each mode (n,)."""
        shares: Array = self.participation**2 / self.mass.sum()
        return shares

    @property
    def storey_shears(self) -> Array:
        """(n, n): shear of each storey from below [N] for accelerations of the modal coordinates:
        sums of the floors' forces above.
        """
        shears: Array = np.cumsum((self.mass[:, None] * self.shapes)[::-1], axis=0)[::-1]
        return shears


def storeys(
    profile: str, n: int, floor_mass: float, period: float, damping: float = 0.05
) -> ElasticBuilding:
    """Building of n equal floors whose first mode has a profile.

    The stiffness of storey i of a shear frame, k_i = omega^2 sum_{j >= i} m phi_j / (phi_i -
    phi_{i-1}), makes phi its mode of circular frequency omega = 2 pi/period; a mode that grows from
    floor to floor has no node, and so it is the first. Rayleigh damping, C = a M + b K, has the
    ratio `damping` in modes 1 and 2 (in the one mode there is, a = 0, for n = 1).

    Parameters
    ----------
    profile
        of PROFILES.
    n
        floors, at least 1.
    floor_mass
        [kg].
    period
        of the first mode [s].

    Raises
    ------
    ValueError
        unknown profile, or a number out of range.
    """
    if profile not in PROFILES:
        raise ValueError(f"profile = {profile!r} must be one of {', '.join(PROFILES)}")
    if n < 1 or not floor_mass > 0 or not period > 0 or not 0 <= damping < 1:
        raise ValueError(
            f"n = {n}, floor_mass = {floor_mass:g} kg, period = {period:g} s and "
            f"damping = {damping:g} must be positive, damping below 1"
        )
    first, mass = PROFILES[profile](np.arange(1, n + 1) / n), np.full(n, float(floor_mass))
    above = np.cumsum((mass * first)[::-1])[::-1]
    stiffness = (2 * math.pi / period) ** 2 * above / np.diff(first, prepend=0.0)
    return shear_building(mass, stiffness, damping, (1, 2))


def shear_building(
    mass: Array, stiffness: Array, damping: float, rayleigh: tuple[int, ...] = ()
) -> ElasticBuilding:
    """Building of floors (n,) [kg] on storeys (n,) [N/m], from below.

    Parameters
    ----------
    damping
        ratio of all modes, or of two modes after Rayleigh.
    rayleigh
        numbers of these two from 1; of one floor alone all is from the stiffness.
    """
    k = (
        np.diag(stiffness + np.append(stiffness[1:], 0.0))
        - np.diag(stiffness[1:], 1)
        - np.diag(stiffness[1:], -1)
    )
    squares, shapes = eigh(k, np.diag(mass))
    omega, ratios = np.sqrt(squares), np.full(len(mass), float(damping))
    if rayleigh and len(mass) > 1:
        first, second = (omega[mode - 1] for mode in rayleigh)
        a, b = (2 * damping * first * second / (first + second), 2 * damping / (first + second))
        ratios = (a / omega + b * omega) / 2
    return ElasticBuilding(mass, stiffness, omega, ratios, shapes)
