"""Impulses of an impact, or forces of a step, by convex problems, one after the other: in each the
slips are those that the one before left (Acary, Cadoux, Lemarechal and Malick 2011, ZAMM 91).

With W = give + V V^T and the slips g = mu |s_t| frozen, the motion x = V^T r that impulses r give
the bodies is the least of |x|^2 / 2 + sum give |r(x)|^2 / 2. There r(x) is, of each point alone,
what lies in Coulomb's cone nearest to -(V x + q + g n) / give. The function is strictly convex with
a continuous gradient, so that Newton with a search along its steps finds its least from anywhere
(Castro, Permenter and Han 2023, IEEE Transactions on Robotics 39). A point may give otherwise along
its face than across it: with r_t and mu times the root of that ratio, it gives evenly.

Whatever the frozen slips are, each solution is an impact that physics allows: impulses lie in
Coulomb's cone, momentum is exact, and r.s = -g r_n takes energy. Slips that are not yet their own
only let points part or close by what they miss.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.arrays import largest
from fecolumn.contact.blocks import eliminate
from fecolumn.contact.coupling import motion_by, moved_by, slips_under
from fecolumn.contact.curvature import curvature, motion_of_rows, rows_of_motion
from fecolumn.contact.tolerances import (
    FROZEN_FARTHEST,
    FROZEN_MORE,
    FROZEN_ROUNDS,
    FROZEN_SEARCHES,
    FROZEN_SHARE,
    FROZEN_SLOPE,
    FROZEN_STEPS,
    MANY_POINTS,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.coupling import Coupling


@njit
def find_impulses(
    coupling: Coupling,
    q: Array,
    friction: Array,
    start: Array,
    near: bool,
    exact: float,
    allowed: float,
    usable: float,
) -> tuple[Array, float, int]:
    """Impulses (n, 3) [N s] of points, how far they miss Coulomb's law [m/s], Newton steps made.

    Parameters
    ----------
    coupling
        by levers, of points that give alone [1/kg], as much along both tangents.
    q
        (n, 3) velocities without the impulses [m/s].
    start
        (n, 3) first guess.
    near
        whether it is a good one, from whose slips to begin; else from none.
    exact, allowed, usable
        velocities [m/s] to which a convex problem is solved at most, by which the law may be
        missed, and by which after FROZEN_ROUNDS.
    """
    n, made, missed, tolerance = len(q), 0, largest(q), exact
    slips, impulses, slopes = np.zeros(n), np.empty((n, 3)), np.empty((n, 3, 3))
    motion, change = motion_by(coupling, start), np.zeros(n)
    if near:
        relative = slips_under(coupling, q, start)
        for i in range(n):
            slips[i] = friction[i] * np.hypot(relative[i, 0], relative[i, 1])
    for turn in range(FROZEN_ROUNDS + (FROZEN_MORE if n > MANY_POINTS else 0)):
        before, tolerance = slips.copy(), max(exact, FROZEN_SHARE * missed)
        more, missed = solve_frozen(
            coupling, q, friction, slips, motion, impulses, slopes, tolerance
        )
        made += more
        if max(missed, tolerance) <= (allowed if turn + 1 < FROZEN_ROUNDS else usable):
            break
        if turn >= FROZEN_ROUNDS:
            halve_way(before, slips)
        elif turn > 0 and turn % 2 == 0:
            extrapolate(before, change, slips)
        else:
            for i in range(n):
                change[i] = slips[i] - before[i]
        follow_slips(coupling, before, slips, motion, impulses, slopes)
    return impulses, max(missed, tolerance), made


@njit
def solve_frozen(
    coupling: Coupling,
    q: Array,
    friction: Array,
    slips: Array,
    motion: Array,
    impulses: Array,
    slopes: Array,
    tolerance: float,
) -> tuple[int, float]:
    """Solve the convex problem of frozen slips (n,), which become those that it leaves: Newton
    steps made, and how far these are from the ones before, or points from the surface.

    motion: (nb, w), the first guess; impulses: (n, 3), which are put; slopes: (n, 3, 3) room;
    tolerance: of what moves the points, as q.
    """
    made = _least(coupling, q, friction, slips, motion, impulses, slopes, tolerance)
    relative, missed = moved_by(coupling, motion), 0.0
    for i in range(len(q)):
        for a in range(3):
            relative[i, a] += q[i, a] + coupling.own[i, a] * impulses[i, a]
        slip = friction[i] * np.hypot(relative[i, 0], relative[i, 1])
        wrong = abs(slip - slips[i]) if impulses[i, 2] > 0 else -relative[i, 2]
        missed, slips[i] = max(missed, wrong), slip
    return made, missed


@njit
def follow_slips(
    coupling: Coupling, before: Array, slips: Array, motion: Array, impulses: Array, slopes: Array
) -> None:
    """Let the motion (nb, w) of a solution for slips `before` (n,) follow other slips, while the
    same points carry, stick and slide (Fiacco 1983, Introduction to Sensitivity and Stability
    Analysis in Nonlinear Programming, chapter 3); impulses, slopes: of the solution.

    Points give so little that Newton, from the motion as it was, would first find others to carry.
    """
    pushes = np.zeros((len(slips), 3))
    for i in range(len(slips)):
        if impulses[i, 2] > 0:
            for a in range(3):
                pushes[i, a] = slopes[i, a, 2] * (slips[i] - before[i])
    solved, step = _newton_step(coupling, motion_by(coupling, pushes), impulses, slopes)
    if solved:
        for b in range(len(motion)):
            for c in range(motion.shape[1]):
                motion[b, c] += step[b, c]


@njit
def extrapolate(before: Array, change: Array, slips: Array) -> None:
    """Let slips (n,) go on along their way from those before to where it would end, were it
    shortened in each round as in the last one, whose `change` (n,) led to those before (Irons and
    Tuck 1969, International Journal for Numerical Methods in Engineering 1, after Aitken).

    Where that is farther than FROZEN_FARTHEST times the way, or nearer than one part of so many,
    they stay.
    """
    along = square = 0.0
    for i in range(len(slips)):
        bends = slips[i] - before[i] - change[i]
        along -= change[i] * bends
        square += bends * bends
    if not square / FROZEN_FARTHEST < along < square * FROZEN_FARTHEST:
        return
    for i in range(len(slips)):
        slips[i] = max(before[i] + along / square * (slips[i] - before[i]), 0.0)


@njit
def halve_way(before: Array, slips: Array) -> None:
    """Let slips (n,) go half the way only from those before: where many stones hand on what they
    slip, they else go to and fro.
    """
    for i in range(len(slips)):
        slips[i] = (before[i] + slips[i]) / 2


@njit
def _least(
    coupling: Coupling,
    q: Array,
    friction: Array,
    slips: Array,
    motion: Array,
    impulses: Array,
    slopes: Array,
    tolerance: float,
) -> int:
    """Put the solution for frozen slips (n,) into motion (nb, w) and impulses (n, 3): Newton steps
    made. slopes: (n, 3, 3) room.
    """
    made, rest = 0, _gradient(coupling, q, friction, slips, motion, impulses, slopes)
    while made < FROZEN_STEPS and largest(moved_by(coupling, rest)) > tolerance:
        solved, step = _newton_step(coupling, rest, impulses, slopes)
        if not solved:
            break
        made += 1
        rest, descends = _search(coupling, q, friction, slips, motion, rest, step, impulses, slopes)
        if not descends:
            break
    return made


@njit
def _newton_step(
    coupling: Coupling, rest: Array, impulses: Array, slopes: Array
) -> tuple[bool, Array]:
    """Whether Newton's equations at a gradient `rest` (nb, w) are regular, and its step (nb, w)."""
    matrix, right = (
        curvature(coupling, impulses[:, 2] > 0, slopes),
        rows_of_motion(coupling, -rest),
    )
    solved = eliminate(matrix, right, coupling.blocks.first, coupling.blocks.coupled)
    return solved, motion_of_rows(coupling, right)


@njit
def _search(
    coupling: Coupling,
    q: Array,
    friction: Array,
    slips: Array,
    motion: Array,
    rest: Array,
    step: Array,
    impulses: Array,
    slopes: Array,
) -> tuple[Array, bool]:
    """Move the motion along a step to where the slope is a small share of what it was at its
    start: the gradient there, and whether the step descends at all.
    """
    first = _product(rest, step)
    low, low_slope, high, high_slope, way = 0.0, first, np.inf, 0.0, 1.0
    moved = motion.copy()
    for _ in range(FROZEN_SEARCHES):
        for b in range(len(motion)):
            for c in range(motion.shape[1]):
                moved[b, c] = motion[b, c] + way * step[b, c]
        rest = _gradient(coupling, q, friction, slips, moved, impulses, slopes)
        slope = _product(rest, step)
        if way == 1.0 and slope <= 0.0 or abs(slope) <= FROZEN_SLOPE * abs(first):
            break
        if slope > 0.0:
            high, high_slope = way, slope
        else:
            low, low_slope = way, slope
        # the chord's zero, not too near to either end
        way = low - (high - low) * low_slope / (high_slope - low_slope)
        margin = (high - low) / 20
        way = min(max(way, low + margin), high - margin)
    motion[:] = moved
    return rest, first < 0.0


@njit
def _product(one: Array, other: Array) -> float:
    """Sum of the products of two arrays (nb, w)."""
    total = 0.0
    for b in range(len(one)):
        for c in range(one.shape[1]):
            total += one[b, c] * other[b, c]
    return total


@njit
def _gradient(
    coupling: Coupling,
    q: Array,
    friction: Array,
    slips: Array,
    motion: Array,
    impulses: Array,
    slopes: Array,
) -> Array:
    """Gradient (nb, w) at a motion (nb, w); puts impulses (n, 3) and minus what they change by
    with the velocities of their points (n, 3, 3).
    """
    velocity = moved_by(coupling, motion)
    for i in range(len(q)):
        give = coupling.own[i, 2]
        even = np.sqrt(2 * give / (coupling.own[i, 0] + coupling.own[i, 1]))
        x, y = (
            -even * (velocity[i, 0] + q[i, 0]) / give,
            -even * (velocity[i, 1] + q[i, 1]) / give,
        )
        z = -(velocity[i, 2] + q[i, 2] + slips[i]) / give
        _nearest(x, y, z, friction[i] / even, give, impulses[i], slopes[i])
        if even != 1.0:
            for a in range(2):
                impulses[i, a] *= even
                for b in range(3):
                    slopes[i, a, b] *= even
                    slopes[i, b, a] *= even
    given = motion_by(coupling, impulses)
    rest = np.empty_like(motion)
    for b in range(len(motion)):
        for c in range(motion.shape[1]):
            rest[b, c] = motion[b, c] - given[b, c]
    return rest


@njit
def _nearest(
    x: float, y: float, z: float, mu: float, give: float, impulse: Array, slope: Array
) -> None:
    """Put the impulse (3,) of Coulomb's cone nearest to x, y, z, and its slope (3, 3) over give."""
    for a in range(3):
        impulse[a] = 0.0
        for b in range(3):
            slope[a, b] = 0.0
    length = np.sqrt(x * x + y * y)
    if length <= mu * z:
        impulse[0], impulse[1], impulse[2] = x, y, z
        for a in range(3):
            slope[a, a] = 1 / give
        return
    if mu * length <= -z:
        return
    size = 1 + mu * mu
    normal = (z + mu * length) / size
    impulse[2] = normal
    if mu == 0.0:
        slope[2, 2] = 1 / give
        return
    u, v = x / length, y / length
    impulse[0], impulse[1] = mu * normal * u, mu * normal * v
    across = mu * normal / length
    slope[0, 0] = (mu * mu * u * u / size + across * v * v) / give
    slope[1, 1] = (mu * mu * v * v / size + across * u * u) / give
    slope[0, 1] = slope[1, 0] = (mu * mu / size - across) * u * v / give
    slope[0, 2] = slope[2, 0] = mu * u / size / give
    slope[1, 2] = slope[2, 1] = mu * v / size / give
    slope[2, 2] = 1 / size / give
