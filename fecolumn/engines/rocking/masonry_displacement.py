"""Displacement-based assessment of masonry walls out of plane: force over displacement, and the
displacement that an earthquake demands.

A rigid wall has its largest force at rest and loses it linearly up to the displacement Delta_u at
which it falls; a real one begins with a finite stiffness, keeps a plateau and joins the rigid
wall's line (Doherty et al. 2002). As an oscillator of one degree of freedom (mass M*, displacement
at its centre) it is compared with a response spectrum, by its secant period or where capacity and
demand meet.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import SupportsFloat

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.foundation.arrays import Array
from fecolumn.foundation.gravity import GRAVITY
from fecolumn.motions.record import GroundMotion

#: Delta_1/Delta_u and Delta_2/Delta_u by the state of the mortar joints, of Doherty, Griffith, Lam
#: and Wilson (2002)
JOINTS = {"new": (0.06, 0.28), "moderate": (0.13, 0.40), "severe": (0.20, 0.50)}
#: Limit states of the largest tilt over alpha: the first rocks at all, the second limited to it,
#: the third overturns
INCIPIENT, LIMITED, COLLAPSE = 0.0, (0.2, 0.4), 1.0
#: Share of the ultimate displacement up to which the secant is taken where a code asks for one
SECANT_SHARE = 0.4


@dataclass(frozen=True, slots=True)
class Capacity:
    """Force of a wall over its displacement, as accelerations: straight lines.

    Attributes
    ----------
    displacement
        (n,) rising from 0 [m].
    acceleration
        (n,) force over the oscillator's mass [m/s2], 0 at the last.
    """

    displacement: Array
    acceleration: Array

    @property
    def ultimate(self) -> float:
        """Displacement at which it falls [m]."""
        return float(self.displacement[-1])

    def at(self, displacement: float | Array) -> Array:
        """Acceleration [m/s2] at a displacement >= 0 [m], 0 beyond the ultimate one."""
        found: Array = np.interp(displacement, self.displacement, self.acceleration)
        return found

    def secant_stiffness(self, displacement: float) -> float:
        """Force over mass and displacement [1/s2]."""
        return float(self.at(displacement)) / displacement

    def secant_period(self, displacement: float) -> float:
        """2 pi sqrt(displacement / acceleration) [s]."""
        return 2 * math.pi / math.sqrt(self.secant_stiffness(displacement))

    def softened(self, share: float = 0.75) -> float:
        """Displacement [m] beyond the peak at which the force has fallen to a share of it: where
        ductile systems take their secant (0.7 to 0.8).
        """
        if not 0 < share < 1:
            raise ValueError(f"share = {share:g} must lie in (0, 1)")
        peak = self.acceleration.max()
        last = int(np.flatnonzero(self.acceleration >= share * peak)[-1])
        a0, a1 = self.acceleration[last : last + 2]
        d0, d1 = self.displacement[last : last + 2]
        return float(d0 + (a0 - share * peak) / (a0 - a1) * (d1 - d0))


def bilinear(multiplier: float, ultimate: float, gravity: float = GRAVITY) -> Capacity:
    """Rigid wall: a = multiplier g (1 - Delta/Delta_u)."""
    return Capacity(np.array([0.0, ultimate]), np.array([multiplier * gravity, 0.0]))


def trilinear(
    multiplier: float,
    ultimate: float,
    ratios: tuple[float, float] = JOINTS["moderate"],
    gravity: float = GRAVITY,
) -> Capacity:
    """Wall of imperfect joints: up to Delta_1 elastic, level up to Delta_2, then along the rigid
    wall's line.

    Parameters
    ----------
    multiplier
        of the rigid wall.
    ultimate
        Delta_u [m].
    ratios
        Delta_1/Delta_u < Delta_2/Delta_u, of JOINTS or one's own.
    """
    first, second = ratios
    if not 0 < first < second < 1:
        raise ValueError(f"ratios = ({first:g}, {second:g}) must rise between 0 and 1")
    level = multiplier * gravity * (1 - second)
    return Capacity(
        ultimate * np.array([0, first, second, 1.0]), np.array([0.0, level, level, 0.0])
    )


def rigid_wall_curve(
    thickness: float, height: float, points: int = 200, gravity: float = GRAVITY
) -> Capacity:
    """Exact curve of a free wall in large rotations: a = g tan(alpha - theta) over the displacement
    R (sin alpha - sin(alpha - theta)) of its centre.
    """
    alpha, radius = math.atan2(thickness, height), math.hypot(thickness, height) / 2
    tilt = np.linspace(0, alpha, points)
    return Capacity(
        radius * (math.sin(alpha) - np.sin(alpha - tilt)), gravity * np.tan(alpha - tilt)
    )


@dataclass(frozen=True, slots=True)
class Oscillator:
    """One degree of freedom that stands for a mechanism.

    Attributes
    ----------
    mass
        M* = (sum W d)^2 / (g sum W d^2) [kg].
    share
        of the whole mass.
    displacement
        sum W d^2 / sum W d, of it where d is 1 [-].
    """

    mass: float
    share: float
    displacement: float


def oscillator(weights: ArrayLike, shape: ArrayLike, gravity: float = GRAVITY) -> Oscillator:
    """Oscillator of a mechanism by its virtual displacements, such that mass, force and kinetic
    energy are those of the mechanism.

    A uniform wall that turns about its foot, d rising linearly, has 3/4 of its mass at 2/3 of its
    top's displacement.

    Parameters
    ----------
    weights
        (n,) [N].
    shape
        (n,) horizontal virtual displacements d of their centres, any scale.
    """
    weights, shape = np.asarray(weights, float), np.asarray(shape, float)
    first, second = weights @ shape, weights @ shape**2
    return Oscillator(
        float(first**2 / second / gravity),
        float(first**2 / second / weights.sum()),
        float(second / first),
    )


def secant_demand(
    capacity: Capacity,
    spectral_displacement: Callable[[float], SupportsFloat],
    share: float = SECANT_SHARE,
) -> tuple[float, float]:
    """Secant period [s] at a share of the ultimate displacement, and the displacement [m] that a
    spectrum demands there.

    Parameters
    ----------
    spectral_displacement
        function of a period [s] that gives S_d [m], such as that of `motion_spectrum`.
    """
    period = capacity.secant_period(share * capacity.ultimate)
    return period, float(spectral_displacement(period))


def performance_point(
    capacity: Capacity, spectral_displacement: Callable[[float], SupportsFloat], points: int = 2000
) -> float:
    """Least displacement [m] at which the capacity's secant period demands no more than it:
    S_d(T(Delta)) <= Delta; inf where it falls before.
    """
    trial = capacity.ultimate * np.linspace(0, 1, points + 2)[1:-1]
    demand = np.array([float(spectral_displacement(capacity.secant_period(one))) for one in trial])
    enough = np.flatnonzero(demand <= trial)
    if not enough.size:
        return math.inf
    number = int(enough[0])
    if not number:
        return float(trial[0])
    before, after = demand[number - 1] - trial[number - 1], demand[number] - trial[number]
    return float(
        trial[number - 1] + before / (before - after) * (trial[number] - trial[number - 1])
    )


def motion_spectrum(
    motion: GroundMotion, damping: float = 0.05, longest: float = 10.0
) -> Callable[[float], SupportsFloat]:
    """Spectral displacement [m] over a period [s] of a motion's horizontal components (median over
    directions), for `secant_demand`.
    """
    from fecolumn.motions.spectra import horizontal_spectrum

    periods = np.geomspace(0.02, longest, 120)
    displacement = horizontal_spectrum(motion, periods, damping) * (periods / (2 * math.pi)) ** 2
    return lambda period: np.interp(period, periods, displacement)


def limit_state(tilt_over_alpha: float, limited: float = LIMITED[1]) -> str:
    """Of a largest tilt over alpha: "at rest", "limited rocking" up to `limited` (0.2 to 0.4),
    "rocking" below 1, "collapse" from 1 on.
    """
    if not LIMITED[0] <= limited <= LIMITED[1]:
        raise ValueError(f"limited = {limited:g} must lie in [{LIMITED[0]:g}, {LIMITED[1]:g}]")
    if tilt_over_alpha < 0 or math.isnan(tilt_over_alpha):
        raise ValueError(f"tilt_over_alpha = {tilt_over_alpha:g} must not be negative")
    if tilt_over_alpha <= INCIPIENT:
        return "at rest"
    if tilt_over_alpha <= limited:
        return "limited rocking"
    return "rocking" if tilt_over_alpha < COLLAPSE else "collapse"
