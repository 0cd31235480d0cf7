"""Frictional unilateral contact of a few points: find forces r with s = W r + q, r in Coulomb's
cone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact import tolerances
from fecolumn.contact.arrays import marked
from fecolumn.contact.coulomb import law_error, violation
from fecolumn.contact.coupling import coupling_of, slips_under, stiffnesses, stiffnesses_by_whole
from fecolumn.contact.fallbacks import by_frozen_slips, find_some
from fecolumn.contact.newton import NewtonLimits, newton_steps, solve_in_place
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.coupling import Coupling


@dataclass(frozen=True, slots=True)
class ContactSolution:
    """Forces (n, 3) [N], residual of the contact laws [m], Newton iterations, and interior point
    iterations and Gauss-Seidel sweeps used.
    """

    forces: Array
    residual: float
    iterations: int
    sweeps: int


@njit
def frictionless(coupling: Coupling, q: Array, start: Array) -> Array:
    """Forces (n, 3) without friction by primal-dual active sets, or the last ones before they
    cycle: a guess of the points that press.
    """
    if len(coupling.whole) == 0:
        rho = stiffnesses(coupling, False)
        forces, _, _ = newton_steps(
            coupling,
            q,
            np.zeros(len(q)),
            start,
            NewtonLimits(0.0, rho, rho, 0.0, tolerances.ACTIVE_SETS, 5),
        )
        for i in range(len(q)):
            forces[i, 0] = forces[i, 1] = 0.0
            forces[i, 2] = max(forces[i, 2], 0.0)
        return forces
    W = coupling.whole
    n = len(q)
    forces, pressed = np.zeros((n, 3)), np.empty(n, np.bool_)
    for i in range(n):
        pressed[i] = start[i, 2] > 0
    for _ in range(tolerances.ACTIVE_SETS):
        listed = marked(pressed)
        k = len(listed)
        matrix, normal = np.empty((k, k)), np.empty(k)
        for i in range(k):
            normal[i] = -q[listed[i], 2]
            for j in range(k):
                matrix[i, j] = W[3 * listed[i] + 2, 3 * listed[j] + 2]
        if k and not solve_in_place(matrix, normal):
            break
        for i in range(n):
            forces[i, 2] = 0.0
        for i in range(k):
            forces[listed[i], 2] = normal[i]
        changed = False
        for i in range(n):
            gap = q[i, 2]
            for j in range(k):
                gap += W[3 * i + 2, 3 * listed[j] + 2] * normal[j]
            new = forces[i, 2] > 0 if pressed[i] else gap < 0
            changed |= new != pressed[i]
            pressed[i] = new
        if not changed:
            break
    for i in range(n):
        forces[i, 2] = max(forces[i, 2], 0.0)
    return forces


@njit
def iterate(
    coupling: Coupling,
    q: Array,
    friction: Array,
    start: Array,
    tolerance: float,
    near: bool,
    sweeps: int,
) -> tuple[Array, float, int, int]:
    """As `solve_contact`, for compiled code: forces (n, 3), residual, Newton iterations and others.

    coupling: of `contact.coupling`. near: whether `start` is a good guess, from which Newton is
    tried first.
    """
    n, best, least, iterations, others = len(q), start.copy(), np.inf, 0, 0
    if n == 0:
        return best, 0.0, 0, 0
    by_levers, W = len(coupling.whole) == 0, coupling.whole
    rho = stiffnesses(coupling, False) if by_levers else stiffnesses_by_whole(W, False)
    if near:
        together = stiffnesses(coupling, True) if by_levers else stiffnesses_by_whole(W, True)
        softest = 1 / rho.min()
        for give in (0.0, tolerances.NEAR_GIVE * softest):
            if least > tolerance:
                forces, residual, made = newton_steps(
                    coupling,
                    q,
                    friction,
                    start,
                    NewtonLimits(
                        tolerance,
                        together,
                        rho,
                        give,
                        tolerances.NEWTON_STEPS,
                        tolerances.NEWTON_STALLED,
                    ),
                )
                iterations += made
                if residual < least:
                    best, least = forces, residual
        if least <= tolerance:
            return best, least, iterations, others
    many = by_levers and n > tolerances.MANY_POINTS
    # cheap by levers: many small steps, each held by a compliance against change
    held = NewtonLimits(
        tolerance,
        rho,
        rho,
        tolerances.HELD_GIVE / rho.min(),
        tolerances.HELD_STEPS,
        tolerances.HELD_STALLED,
    )
    if many and least > tolerance:
        forces, residual, made, _ = by_frozen_slips(
            coupling,
            q,
            friction,
            best,
            tolerance,
            rho,
            tolerances.FROZEN_ROUNDS + tolerances.FROZEN_MORE,
        )
        iterations += made
        if residual < least:
            best, least = forces, residual
    # of few points the whole matrix follows
    if by_levers and least > tolerance:
        forces, residual, made = newton_steps(coupling, q, friction, best, held)
        iterations += made
        if residual < least:
            best, least = forces, residual
    if least <= tolerance or many:
        return best, least, iterations, others
    # few of many points carry: first those that would carry without friction, then also those that
    # sink into the surface under the forces of these
    forces, taken, grown, pressed = (
        frictionless(coupling, q, start),
        np.empty(n, np.bool_),
        True,
        0,
    )
    for i in range(n):
        pressed += forces[i, 2] > 0
    for i in range(n):
        taken[i] = n <= tolerances.FEW_POINTS or 2 * pressed > n or forces[i, 2] > 0
    while grown and least > tolerance:
        made, more = find_some(
            coupling,
            q,
            friction,
            forces,
            start,
            marked(taken),
            tolerance,
            sweeps,
            tolerances.FROZEN_TURNS,
        )
        iterations += made
        others += more
        relative = slips_under(coupling, q, forces)
        residual, grown = violation(relative, forces, friction, rho), False
        if residual < least:
            best, least = forces.copy(), residual
        for i in range(n):
            if (
                not taken[i]
                and law_error(
                    0.0,
                    0.0,
                    0.0,
                    relative[i, 0],
                    relative[i, 1],
                    relative[i, 2],
                    rho[i],
                    friction[i],
                )
                > tolerance
            ):
                taken[i] = grown = True
    if least > tolerance and n > tolerances.FEW_POINTS:
        forces, residual, made, more = _incremental_active_set(
            coupling, q, friction, rho, tolerance, sweeps
        )
        iterations += made
        others += more
        if residual < least:
            best, least = forces, residual
    return best, least, iterations, others


@njit
def _incremental_active_set(
    coupling: Coupling, q: Array, friction: Array, rho: Array, tolerance: float, sweeps: int
) -> tuple[Array, float, int, int]:
    """As `iterate`, from no forces at all: the point that violates the laws most is
    added to the active set, one at a time; one that then carries nothing is removed once. Each
    solution is the first guess of the next problem.
    """
    n, least, iterations, others = len(q), np.inf, 0, 0
    forces, best, taken, gone = (
        np.zeros((n, 3)),
        np.zeros((n, 3)),
        np.zeros(n, np.bool_),
        np.zeros(n, np.int64),
    )
    for _ in range(tolerances.ONE_BY_ONE):
        relative, residual, farthest, most = slips_under(coupling, q, forces), 0.0, -1, tolerance
        for i in range(n):
            error = law_error(
                forces[i, 0],
                forces[i, 1],
                forces[i, 2],
                relative[i, 0],
                relative[i, 1],
                relative[i, 2],
                rho[i],
                friction[i],
            )
            residual = max(residual, error)
            if not taken[i] and error > most:
                farthest, most = i, error
        if residual < least:
            best, least = forces.copy(), residual
        if least <= tolerance or farthest < 0:
            break
        taken[farthest] = True
        made, more = find_some(
            coupling, q, friction, forces, forces, marked(taken), tolerance, sweeps, 0
        )
        iterations += made
        others += more
        for i in range(n):
            if taken[i] and forces[i, 2] <= 0 and gone[i] < tolerances.LET_GO:
                taken[i] = False
                gone[i] += 1
    return best, least, iterations, others


def solve_contact(
    W: Array,
    q: Array,
    mu: Array | float,
    start: Array,
    tolerance: float = 1e-12,
    sweeps: int = tolerances.SWEEPS_MOST,
) -> ContactSolution:
    """Solve the frictional contact problem of n points.

    Parameters
    ----------
    W
        (3 n, 3 n) compliance [m/N], symmetric positive definite; per point x, y (tangential), z
        (normal).
    q
        (n, 3) [m] slip (x, y) and gap (z) without contact forces; gap > 0 is open.
    mu
        Coulomb friction coefficient, of all points or (n,) of each.
    start
        (n, 3) [N] first guess.
    tolerance
        residual at convergence [m].

    Semismooth Newton, stick and slip judged by the stiffness of all points together, again with a
    little give where W proves singular. Where its active set cycles, the points that press without
    friction, and those that sink where these carry, are a smaller problem: Newton from there, an
    interior point and, should they fail, Gauss-Seidel sweeps and slower ways; at last the points
    are taken in one by one. The residual returned is the true one: the caller decides what to do
    with a solution that has not converged.
    """
    W, q, start = (np.ascontiguousarray(array, float) for array in (W, q, start))
    # a copy: of one point it would be an array that is only read, for which all is compiled again
    friction = np.broadcast_to(np.asarray(mu, float), len(q)).copy()
    return ContactSolution(*iterate(coupling_of(W), q, friction, start, tolerance, True, sweeps))
