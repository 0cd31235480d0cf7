"""The error of the stick operator's first forces, predicted from the step before.

The operator of standing feet serves until they have turned by STICK_TURN. Its first forces in a
step therefore leave slips and gaps of 1e-4 of those at the beginning of the step. The ratio of the
two hardly changes from step to step. So the slips and gaps that are expected to be left are added
to those at the beginning, and the first forces meet the laws (a secant method of rank one, Broyden
1965). Whether they do is checked as always.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.tolerances import FULL_FRICTION
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


class Secant(NamedTuple):
    """begun: (P, 3) slips and gaps at the beginning of a step, left: those that the operator's
    forces for them would have left [m]; share: (1,) of `left` foreseen last; known: (1,) whether
    begun and left are of one step.
    """

    begun: Array
    left: Array
    share: Array
    known: Array


def no_secant(points: int) -> Secant:
    """Room for so many points, of which nothing is learnt."""
    return Secant(np.zeros((points, 3)), np.zeros((points, 3)), np.zeros(1), np.zeros(1, bool))


@njit
def predict_slips(secant: Secant, listed: Array, slack: Array) -> None:
    """Add to the slips and gaps (P, 3) of the listed points (k,) at the beginning of a step those
    that its first forces are expected to leave.
    """
    share = square = 0.0
    for i in listed:
        for a in range(3):
            share += slack[i, a] * secant.begun[i, a]
            square += secant.begun[i, a] ** 2
    secant.share[0] = share / square if secant.known[0] and square > 0.0 else 0.0
    # until what these forces leave is learnt
    secant.known[0] = False
    for i in listed:
        for a in range(3):
            secant.begun[i, a] = slack[i, a]
            slack[i, a] += secant.share[0] * secant.left[i, a]


@njit
def update_secant(
    secant: Secant, points: Array, listed: Array, slack: Array, contact: Array
) -> None:
    """Note what the first forces of the step, those of `contact` (P,) at the listed points (k,),
    have left; nothing where points slip or open, whose slips and gaps are no error.
    """
    secant.known[0] = True
    for i in listed:
        x, y, most = (
            contact[i].force[0],
            contact[i].force[1],
            (1 - FULL_FRICTION) * points[i].friction * contact[i].force[2],
        )
        secant.known[0] &= contact[i].force[2] > 0.0 and x * x + y * y < most * most
        for a in range(3):
            secant.left[i, a] = secant.share[0] * secant.left[i, a] + slack[i, a]
