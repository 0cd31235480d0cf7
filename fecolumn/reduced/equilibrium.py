"""Contact forces and motion at the end of a step: laws of contact on the moved points, laws of motion under the forces."""

from __future__ import annotations

import numba
import numpy as np

from fecolumn.contact.friction import iterate
from fecolumn.contact.interface import NEAR, SOLVED
from fecolumn.dynamics.stage import CONTACT_TOLERANCE, PENETRATION
from fecolumn.reduced.compliance import add_below, assemble, even, static_displacement
from fecolumn.reduced.motion import STATIC, follow, point_positions
from fecolumn.reduced.plate import ON, UNKNOWN, project

# Ways a step can end; FAR_BASE asks for more of the base's compliance, OVERTURNED ends the analysis
OK, FAR_BASE, OFF_BASE, CONTACT, ITERATIONS, IMPACT, OVERTURNED = range(7)
# Points nearer than so many times NEAR are told their static displacement
CLOSE = 10.0
# Residual of the contact laws on the moved points at which a step has converged, over that of a contact problem
CONVERGED = 0.1
# Places in a record of counts
N_ITERATIONS, N_CONTACT, N_IMPACTS, N_CUTS, N_FAST, N_ASSEMBLED = range(6)


@numba.njit(cache=True)
def law_residual(column, points, relative, forces, active, rho):
    """Largest violation of the contact laws [m] among the active points; see `friction.natural_residual`."""
    worst, mu = 0.0, column.friction
    for k in range(len(active)):
        i = active[k]
        r0, r1, r2 = forces[i, 0], forces[i, 1], forces[i, 2]
        s0 = relative[i, 0] + column.own[i, 0] * r0 - points.anchors[i, 0]
        s1 = relative[i, 1] + column.own[i, 1] * r1 - points.anchors[i, 1]
        s2 = relative[i, 2] + column.own[i, 2] * r2
        normal = max(0.0, r2 - rho[k] * s2)
        t0, t1 = r0 - rho[k] * s0, r1 - rho[k] * s1
        length = np.sqrt(t0 * t0 + t1 * t1)
        if length > mu * normal:
            t0 *= mu * normal / length
            t1 *= mu * normal / length
        worst = max(worst, ((r0 - t0) ** 2 + (r1 - t1) ** 2 + (r2 - normal) ** 2) / rho[k] ** 2)
    return np.sqrt(worst)


@numba.njit(cache=True)
def equilibrate(column, plate, scheme, points, footing, start, free_center, free_modal, advance, end, sway, record):
    """Find forces and motion at the end of a step.

    Newton about the present forces: the motion is evaluated exactly for them, the contact problem is solved with the compliance W that
    the column has in that place. It is done when the laws hold for the exact positions.

    Args:
        start: Motion at the start; points bring the first guess of the forces and the anchors.
        free_center, free_modal, advance: see `motion.follow`.
        end: gets center, rotation, modal, elastic, forces, relative, static energy.
    Returns: a way to end.
    """
    n = len(points.forces)
    positions, given, relative = np.empty((n, 3)), np.empty((n, 3)), end.relative
    close, mark, active = np.empty(n, np.bool_), np.zeros(n, np.bool_), np.empty(0, np.int64)
    W, rho, assembled = np.empty((0, 0)), np.empty(0), False
    forces = end.forces
    forces[:] = points.forces
    end.elastic[:] = start.elastic
    sway.turn[:] = advance
    last = np.inf
    for _ in range(25):
        record[N_ITERATIONS] += 1
        follow(column, scheme, points, start, free_center, free_modal, advance, forces, end, sway)
        point_positions(points, end, positions)
        for i in range(n):
            close[i] = positions[i, 2] < CLOSE * NEAR * column.width or forces[i, 2] > 0 or points.forces[i, 2] > 0
        answer = project(plate, positions, close, footing)
        if answer != ON:
            return FAR_BASE if answer == UNKNOWN else OFF_BASE
        for i in range(n):
            if close[i] and points.count[i] > 1:
                even(column, points, plate, footing, end.rotation, i)
        static_displacement(column, points, plate, footing, end.rotation, forces, close, given)
        changed = not assembled
        k = 0
        for i in range(n):
            for a in range(3):
                relative[i, a] = positions[i, a] + given[i, a]
            new = positions[i, 2] < NEAR * column.width or forces[i, 2] > 0 or relative[i, 2] < -PENETRATION * column.width
            changed |= new != mark[i]
            mark[i] = new
            k += new
        if changed:
            active = np.flatnonzero(mark)
            arms = points.arms + start.elastic
            W, rho, assembled = np.empty((3 * k, 3 * k)), np.empty(k), True
            assemble(column, points, arms, active, end.rotation, scheme.half, scheme.elastic, W)
            add_below(column, plate, footing, active, W, 1.0)
            record[N_ASSEMBLED] += 1
            for j in range(k):
                rho[j] = 3 / (W[3 * j, 3 * j] + W[3 * j + 1, 3 * j + 1] + W[3 * j + 2, 3 * j + 2])
        residual = law_residual(column, points, relative, forces, active, rho)
        if residual <= CONVERGED * SOLVED * column.width or (residual <= SOLVED * column.width and residual >= 0.5 * last):
            energy = 0.0
            for i in range(n):
                for a in range(3):
                    energy += forces[i, a] * (given[i, a] + column.own[i, a] * forces[i, a])
            end.scalars[STATIC] = energy / 2
            return OK
        last = residual
        q, old = np.empty((k, 3)), np.empty((k, 3))
        for j in range(k):
            i = active[j]
            for a in range(3):
                old[j, a] = forces[i, a]
                q[j, a] = relative[i, a] + column.own[i, a] * forces[i, a] - (points.anchors[i, a] if a < 2 else 0.0)
        q -= (W @ old.ravel()).reshape(k, 3)
        new_forces, residual, newtons, sweeps = iterate(W, q, column.friction, old, CONVERGED * SOLVED * column.width)
        record[N_CONTACT] += newtons + sweeps
        if not residual <= CONTACT_TOLERANCE * column.width:
            return CONTACT
        for j in range(k):
            for a in range(3):
                forces[active[j], a] = new_forces[j, a]
    return ITERATIONS
