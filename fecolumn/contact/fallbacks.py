"""Ways to the forces of contact where Newton from a near guess does not find them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact import tolerances
from fecolumn.contact.coulomb import in_cone
from fecolumn.contact.coupling import (
    coupling_of,
    motion_by,
    part_of,
    slips_under,
    stiffnesses,
    whole_of,
)
from fecolumn.contact.frozen_slips import follow_slips, halve_way, solve_frozen
from fecolumn.contact.interior_point import approach, in_cones
from fecolumn.contact.newton import NewtonLimits, newton_steps
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.coupling import Coupling


@njit
def gauss_seidel(
    W: Array, q: Array, forces: Array, friction: Array, rho: Array, sweeps: int, tolerance: float
) -> int:
    """Projected nonlinear Gauss-Seidel (Jourdan, Alart, Jean 1998); changes `forces`, returns the
    sweeps made.
    """
    n, s = len(q), np.empty(3)
    for sweep in range(sweeps):
        change = 0.0
        for i in range(n):
            for a in range(3):
                s[a], row = q[i, a], W[3 * i + a]
                for j in range(n):
                    s[a] += (
                        row[3 * j] * forces[j, 0]
                        + row[3 * j + 1] * forces[j, 1]
                        + row[3 * j + 2] * forces[j, 2]
                    )
            normal = forces[i, 2] - s[2] / W[3 * i + 2, 3 * i + 2]
            t0, t1, normal = in_cone(
                forces[i, 0] - rho[i] * s[0], forces[i, 1] - rho[i] * s[1], normal, friction[i]
            )
            change = max(
                change, abs(t0 - forces[i, 0]), abs(t1 - forces[i, 1]), abs(normal - forces[i, 2])
            )
            forces[i, 0], forces[i, 1], forces[i, 2] = t0, t1, normal
        if change <= tolerance:
            return sweep + 1
    return sweeps


@njit
def by_frozen_slips(
    coupling: Coupling,
    q: Array,
    friction: Array,
    start: Array,
    tolerance: float,
    rho: Array,
    turns: int,
) -> tuple[Array, float, int, int]:
    """Forces by a fixed point on the sizes of the slips (Acary, Cadoux, Lemarechal and Malick 2011,
    ZAMM 91): best forces, residual, steps of Newton, iterations of an interior point.

    With these sizes frozen the problem is convex. By levers Newton finds its solution, at the cost
    of what the points are: many blocks of a wall that is shaken, whose head joints touch and hardly
    carry. By the whole matrix an interior point does, from no slips. Newton on the laws tries from
    each solution, `turns` times at most.
    """
    n, best, least, iterations, others, give = len(q), start, np.inf, 0, 0, 0.0
    slips, forces, slopes = np.zeros(n), np.empty((n, 3)), np.empty((n, 3, 3))
    by_levers, missed, motion = len(coupling.whole) == 0, np.inf, np.empty((0, 0))
    A, Q = np.empty((0, 0)), np.empty((0, 3))
    for i in range(n):
        give = max(give, tolerances.GIVE / rho[i])
    if by_levers:
        relative, motion = slips_under(coupling, q, start), motion_by(coupling, start)
        for i in range(n):
            slips[i] = friction[i] * np.hypot(relative[i, 0], relative[i, 1])
            if not coupling.own[i].min() > 0.0:
                return best, least, 0, 0
    else:
        A, Q = in_cones(coupling.whole, q, friction)
    steps, patience = tolerances.NEWTON_STALLED, 2
    if by_levers:
        steps, patience = tolerances.NEWTON_STEPS, tolerances.NEWTON_STALLED
    limits = NewtonLimits(tolerance, rho, rho, give, steps, patience)
    for turn in range(turns):
        if by_levers:
            before, exact = slips.copy(), tolerance
            if missed < np.inf:
                exact = max(tolerance, tolerances.FROZEN_SHARE * missed)
            made, missed = solve_frozen(coupling, q, friction, slips, motion, forces, slopes, exact)
            iterations += made
            if turn >= tolerances.FROZEN_HALVED:
                halve_way(before, slips)
            follow_slips(coupling, before, slips, motion, forces, slopes)
        else:
            forces, inside = approach(
                A, Q, friction, np.zeros((n, 3)), np.zeros((n, 3)), tolerances.FROZEN_INSIDE, slips
            )
            others += inside
            relative = slips_under(coupling, q, forces)
            for i in range(n):
                slips[i] = np.hypot(relative[i, 0], relative[i, 1]) if friction[i] > 0.0 else 0.0
        found, residual, made = newton_steps(coupling, q, friction, forces, limits)
        iterations += made
        if residual < least:
            best, least = found, residual
        if least <= tolerance:
            break
    return best, least, iterations, others


@njit
def find_some(
    coupling: Coupling,
    q: Array,
    friction: Array,
    forces: Array,
    start: Array,
    listed: Array,
    tolerance: float,
    sweeps: int,
    turns: int,
) -> tuple[int, int]:
    """Put forces that obey the laws on the listed points (k,), the others open, in place of
    `forces` (n, 3): iterations of Newton and others.
    """
    k = len(listed)
    slack, mu, guess, first = (
        np.empty((k, 3)),
        np.empty(k),
        np.empty((k, 3)),
        np.empty((k, 3)),
    )
    for u in range(k):
        i = listed[u]
        mu[u] = friction[i]
        for a in range(3):
            slack[u, a], guess[u, a], first[u, a] = q[i, a], forces[i, a], start[i, a]
    found, _, iterations, others = _with_fallbacks(
        part_of(coupling, listed), slack, mu, guess, first, tolerance, sweeps, turns
    )
    forces[:] = 0.0
    for u in range(k):
        for a in range(3):
            forces[listed[u], a] = found[u, a]
    return iterations, others


@njit
def _with_fallbacks(
    coupling: Coupling,
    q: Array,
    friction: Array,
    guess: Array,
    start: Array,
    tolerance: float,
    sweeps: int,
    turns: int,
) -> tuple[Array, float, int, int]:
    """Forces (n, 3) by one way after the other, residual, Newton iterations and others; guess,
    start: (n, 3) from which Newton is tried; turns: of `by_frozen_slips`, 0 to leave it.
    """
    n, stiffest, give = len(q), np.inf, 0.0
    if n == 0:
        return guess, 0.0, 0, 0
    rho, rho_t = stiffnesses(coupling, False), np.empty(n)
    for i in range(n):
        stiffest, give = min(stiffest, rho[i]), max(give, tolerances.GIVE / rho[i])
    others = 0
    best, least, iterations = newton_steps(
        coupling,
        q,
        friction,
        guess,
        NewtonLimits(tolerance, rho, rho, 0.0, tolerances.FAR_STEPS, tolerances.FAR_STALLED),
    )
    if least > tolerance:
        forces, residual, made = newton_steps(
            coupling,
            q,
            friction,
            start,
            NewtonLimits(
                tolerance,
                stiffnesses(coupling, True),
                rho,
                0.0,
                tolerances.NEWTON_STEPS,
                tolerances.NEWTON_STALLED,
            ),
        )
        iterations += made
        if residual < least:
            best, least = forces, residual
    if least > tolerance:
        # what follows does not use how the bodies move
        coupling = coupling_of(whole_of(coupling))
        W = coupling.whole
        for i in range(n):
            rho_t[i] = 1 / np.hypot(W[3 * i, 3 * i], W[3 * i + 1, 3 * i + 1])
        A, Q = in_cones(W, q, friction)
        R, U, inside, most = np.zeros((n, 3)), np.zeros((n, 3)), 0, tolerances.INSIDE_FIRST
        while inside < tolerances.INSIDE_MOST:
            forces, made = approach(A, Q, friction, R, U, most, np.empty(0))
            inside += made
            # from inside Newton needs a step or two when the active set is right, and costs a tenth
            forces, residual, newtons = newton_steps(
                coupling,
                q,
                friction,
                forces,
                NewtonLimits(tolerance, rho, rho, give, tolerances.NEWTON_STALLED, 2),
            )
            iterations += newtons
            if residual < least:
                best, least = forces, residual
            if least <= tolerance or made < most:
                break
            most = tolerances.INSIDE_TURN
        others += inside
    count = tolerances.SWEEPS_FIRST
    while least > tolerance and count <= sweeps:
        forces = best.copy()
        others += gauss_seidel(
            coupling.whole, q, forces, friction, rho_t, count, tolerance * stiffest
        )
        forces, residual, made = newton_steps(
            coupling,
            q,
            friction,
            forces,
            NewtonLimits(
                tolerance, rho, rho, give, tolerances.NEWTON_STEPS, tolerances.NEWTON_STALLED
            ),
        )
        iterations += made
        if residual < least:
            best, least = forces, residual
        count *= 4
    if least > tolerance:
        # many small steps, each held by a compliance against change: they end where the active sets
        # of all other ways cycle
        held = give * tolerances.HELD_GIVE / tolerances.GIVE
        forces, residual, made = newton_steps(
            coupling,
            q,
            friction,
            best,
            NewtonLimits(tolerance, rho, rho, held, tolerances.HELD_STEPS, tolerances.HELD_STALLED),
        )
        iterations += made
        if residual < least:
            best, least = forces, residual
    if least > tolerance and turns > 0 and n <= tolerances.FROZEN_POINTS:
        forces, residual, made, inside = by_frozen_slips(
            coupling, q, friction, best, tolerance, rho, turns
        )
        iterations += made
        others += inside
        if residual < least:
            best, least = forces, residual
    return best, least, iterations, others
