"""Contact forces and motion at the end of a step: laws of contact on the moved points, laws of motion under the forces."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.friction import iterate
from fecolumn.contact.interface import SOLVED
from fecolumn.contact.pad import indent
from fecolumn.dynamics.rolling import FLAT
from fecolumn.dynamics.stage import CONTACT_TOLERANCE, PENETRATION
from fecolumn.reduced import bed as beds
from fecolumn.reduced.compliance import add_below, assemble, even, static_displacement
from fecolumn.reduced.bed import SOFT_TURN, TURN, WAY
from fecolumn.reduced.motion import STATIC, follow, point_positions
from fecolumn.reduced.plate import ON, UNKNOWN, project

# Ways a step can end; FAR_BASE asks for more of the base's compliance, ENDED ends the analysis
OK, FAR_BASE, OFF_BASE, CONTACT, ITERATIONS, IMPACT, ENDED = range(7)
# Gap, over the foot's width, below which a point takes part in the contact problem: tighter than in the full-order engine, since all that
# a point costs here grows with it, and one that is missed shows below the base and is taken in; up to CLOSE it is told its static displacement
NEAR, CLOSE = 2e-5, 4e-5
# Iterations of a step
MOST = 25
# Residual to which a contact problem is solved, over the one at which the laws hold on the moved points
SHARP = 0.1
# Places in a record of counts
N_ITERATIONS, N_CONTACT, N_IMPACTS, N_CUTS, N_FAST, N_ASSEMBLED = range(6)


@njit
def law_residual(column, scheme, points, relative, forces, active, rho, slack):
    """Largest violation of the contact laws [m] among the active points (mask); see `friction.natural_residual`.

    slack: (n, 3) gets slips and gaps [m], with the give of contact law and pad.
    """
    worst, mu, kept = 0.0, column.friction, scheme.kept
    for i in range(len(active)):
        r0, r1, r2 = forces[i, 0], forces[i, 1], forces[i, 2]
        s0 = relative[i, 0] + scheme.own[i, 0] * r0 + kept * points.indent[i, 0] - points.anchors[i, 0]
        s1 = relative[i, 1] + scheme.own[i, 1] * r1 + kept * points.indent[i, 1] - points.anchors[i, 1]
        s2 = relative[i, 2] + scheme.own[i, 2] * r2 + kept * points.indent[i, 2]
        slack[i, 0], slack[i, 1], slack[i, 2] = s0, s1, s2
        if not active[i]:
            continue
        normal = max(0.0, r2 - rho[i] * s2)
        t0, t1 = r0 - rho[i] * s0, r1 - rho[i] * s1
        length = np.sqrt(t0 * t0 + t1 * t1)
        if length > mu * normal:
            t0 *= mu * normal / length
            t1 *= mu * normal / length
        worst = max(worst, ((r0 - t0) ** 2 + (r1 - t1) ** 2 + (r2 - normal) ** 2) / rho[i] ** 2)
    return np.sqrt(worst)


@njit
def settled(column, points, start, free_center, advance):
    """Whether the foot stays in its place long enough to make a bed for it."""
    way, turn = 0.0, 0.0
    for a in range(3):
        turn = max(turn, abs(advance[a]))
        if a < 2:
            way = max(way, abs(free_center[a] - start.center[a]))
    if column.soft:
        return turn < SOFT_TURN / 5
    flat = np.hypot(start.rotation[2, 0], start.rotation[2, 1]) < FLAT
    return flat and turn < TURN / 5 and way < WAY * column.width / 5


@njit
def equilibrate(column, plate, scheme, points, footing, bed, start, free_center, free_modal, advance, end, sway, record):
    """Find forces and motion at the end of a step.

    Newton about the present forces: the motion is evaluated exactly for them, the contact problem is solved with the compliance W that
    the column has in that place. It is done when the laws hold for the exact positions.

    Args:
        start: Motion at the start; points bring the first guess of the forces and the anchors.
        free_center, free_modal, advance: see `motion.follow`.
        end: gets center, rotation, modal, elastic, forces, relative, indent, static energy.
    Returns: a way to end.
    """
    n, mu, tight = len(points.forces), column.friction, SHARP * SOLVED * column.width
    positions, given, slack, relative = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3)), end.relative
    close, active, evened = np.ones(n, np.bool_), np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    W, rho, listed, assembled = np.empty((0, 0)), np.empty(n), np.empty(0, np.int64), False
    forces = end.forces
    forces[:] = points.forces
    end.elastic[:] = start.elastic
    sway.turn[:] = advance
    in_bed = beds.fits(bed, column, points, scheme.half, start.center, start.rotation)
    may_bed = not in_bed and settled(column, points, start, free_center, advance)
    for iteration in range(MOST):
        record[N_ITERATIONS] += 1
        follow(column, scheme, points, start, free_center, free_modal, advance, forces, end, sway)
        point_positions(points, end, positions)
        if iteration == 0 or not in_bed:
            for i in range(n):
                close[i] = in_bed or positions[i, 2] < CLOSE * column.width or forces[i, 2] > 0 or points.forces[i, 2] > 0
            answer = project(plate, positions, close, footing)
            if answer != ON:
                return FAR_BASE if answer == UNKNOWN else OFF_BASE
            for i in range(n):
                # the foot turns too little in an iteration to change it
                if not in_bed and forces[i, 2] > 0 and not evened[i]:
                    even(column, points, plate, footing, end.rotation, i)
                    evened[i] = True
        if may_bed and 2 * np.sum(close) > n:
            may_bed = False
            if close.all():
                for i in range(n):
                    even(column, points, plate, footing, end.rotation, i)
                beds.make(bed, column, plate, scheme, points, footing, end.center, end.rotation)
                record[N_ASSEMBLED] += 1
                in_bed = True
        if in_bed:
            given[:] = (bed.static @ forces.ravel()).reshape(n, 3)
        else:
            static_displacement(column, points, plate, footing, end.rotation, forces, close, given)
        changed, count = not assembled, 0
        for i in range(n):
            for a in range(3):
                relative[i, a] = positions[i, a] + given[i, a]
            new = positions[i, 2] < NEAR * column.width or forces[i, 2] > 0 or relative[i, 2] < -PENETRATION * column.width
            changed |= new != active[i]
            active[i] = new
            count += new
        if in_bed:
            rho[:] = bed.rho
        elif changed:
            listed, assembled = np.flatnonzero(active), True
            W = np.empty((3 * count, 3 * count))
            for i in listed:
                if not evened[i]:
                    even(column, points, plate, footing, end.rotation, i)
                    evened[i] = True
            assemble(column, points, points.arms, listed, end.rotation, scheme.half, scheme.elastic, W)
            add_below(scheme.own, plate, footing, listed, W, 1.0)
            record[N_ASSEMBLED] += 1
            for j in range(count):
                rho[listed[j]] = 3 / (W[3 * j, 3 * j] + W[3 * j + 1, 3 * j + 1] + W[3 * j + 2, 3 * j + 2])
        residual = law_residual(column, scheme, points, relative, forces, active, rho, slack)
        if residual <= SOLVED * column.width:
            energy = 0.0
            if column.soft:
                indent(scheme.give, scheme.kept, forces, points.indent, end.indent)
            for i in range(n):
                for a in range(3):
                    energy += forces[i, a] * (given[i, a] + column.own[i, a] * forces[i, a])
                    energy += column.springs[i, a] * end.indent[i, a] ** 2
            end.scalars[STATIC] = energy / 2
            return OK
        if in_bed:
            residual, newtons = beds.solve(bed, mu, slack, active, forces, tight, CONTACT_TOLERANCE * column.width)
            record[N_CONTACT] += newtons
            if residual <= CONTACT_TOLERANCE * column.width:
                continue
            listed = np.flatnonzero(active)
            W = np.empty((3 * count, 3 * count))
            for i in range(count):
                for j in range(count):
                    W[3 * i:3 * i + 3, 3 * j:3 * j + 3] = bed.W[3 * listed[i]:3 * listed[i] + 3, 3 * listed[j]:3 * listed[j] + 3]
        q, old = np.empty((count, 3)), np.empty((count, 3))
        for j in range(count):
            for a in range(3):
                old[j, a] = forces[listed[j], a]
                q[j, a] = slack[listed[j], a]
        q -= (W @ old.ravel()).reshape(count, 3)
        new_forces, residual, newtons, sweeps = iterate(W, q, mu, old, tight)
        record[N_CONTACT] += newtons + sweeps
        if not residual <= CONTACT_TOLERANCE * column.width:
            return CONTACT
        for j in range(count):
            for a in range(3):
                forces[listed[j], a] = new_forces[j, a]
    return ITERATIONS
