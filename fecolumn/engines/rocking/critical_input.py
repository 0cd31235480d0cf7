"""The worst input for a rocking block: impulses of the ground's velocity at every impact, each
driving it on (after Casapulla, Jossa and Maione 2010).

An impulse changes the ground's velocity by dV at once, and the tilt velocity of a block upright by
k dV, k = p^2 cos(alpha)/g. Given at each impact, in the sense of the motion, tilt velocities follow
w_1 = k dV, w_(n+1) = e w_n + k dV; upright a block overturns with w >= p sqrt(2 (1 - cos alpha)).
So the least impulse that overturns with the n-th of equal ones is

    dV = p sqrt(2 (1 - cos alpha)) (1 - e) / (k (1 - e^n)),

and below its limit for many no sequence of such impulses overturns: energy lost in an impact then
outweighs what an impulse gives.
"""

from __future__ import annotations

import math

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.overturning import critical_tilt_rate
from fecolumn.engines.rocking.swing import rock_one
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.foundation.arrays import Array
from fecolumn.motions.record import GroundMotion


def least_impulse(
    slenderness: float, p: float, restitution: float, impulses: float = math.inf
) -> float:
    """Least change of the ground's velocity [m/s] that overturns with the last of equal ones at
    each impact; inf of them: the least of all.

    Parameters
    ----------
    slenderness
        alpha [rad].
    p
        [rad/s].
    restitution
        of the angular velocity, below 1.
    impulses
        their number, at least 1.
    """
    given = p * p * math.cos(slenderness) / GRAVITY
    least: float = (
        p
        * critical_tilt_rate(slenderness)
        * (1 - restitution)
        / (given * (1 - restitution**impulses))
    )
    return least


def tilt_velocities(
    slenderness: float, p: float, restitution: float, impulse: float, impulses: int
) -> Array:
    """Tilt velocities (n,) after each of equal impulses [m/s] at the impacts, from rest [rad/s];
    magnitudes, as if none overturned.
    """
    given = p * p * math.cos(slenderness) / GRAVITY * impulse
    return given * (1 - restitution ** np.arange(1, impulses + 1)) / (1 - restitution)


def critical_motion(
    slenderness: float, p: float, restitution: float, impulse: float, impulses: int, dt: float
) -> GroundMotion:
    """Ground motion along x of impulses [m/s], the first at rest and each next at the impact that
    follows; ended where the block overturns before.

    An impulse lasts two steps `dt` [s], a triangle: the shorter, the closer to the closed form.
    """
    row, places = row_of_block(slenderness, p, restitution), [1]
    while len(places) < impulses:
        _, impacts, _ = rock_one(_samples(places, impulse, dt)[:, [0, 2]], dt, row, free_s=40 / p)
        if len(impacts) < len(places):
            break
        # wholly after the impact: what comes before it would lose its share there
        places.append(math.ceil(impacts[len(places) - 1] / dt) + 1)
    return GroundMotion(
        _samples(places, impulse, dt),
        dt,
        f"{len(places)} impulses of {impulse:g} m/s",
        "after Casapulla, Jossa and Maione (2010)",
    )


def _samples(places: list[int], impulse: float, dt: float) -> Array:
    """Accelerations (n, 3) of impulses at sample numbers, turn about; a positive one tilts the
    block to the negative side.
    """
    samples = np.zeros((places[-1] + 3, 3))
    samples[places, 0] = impulse / dt * (-1.0) ** np.arange(len(places))
    return samples
