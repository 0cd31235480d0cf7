"""Compliance of contact points relative to one another: of their bodies, of the base, and of each
point alone (Delassus 1917).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.gathered import gather
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import MASTER, SLAVE, turns
from fecolumn.contact.tolerances import FEW_SIDES
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.projection import GroundTops


@njit
def assemble(
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    arms: Array,
    active: Array,
    poses: Array,
    rigid: float,
    nodal: Array,
    factor: float,
    own: Array,
    W: Array,
) -> None:
    """W (3 k, 3 k): displacement of the active points, slave relative to master, per force [m/N],
    or velocity per impulse, each in the frame of its interface.

    W_pq = sum over the bodies that p and q share of s_p s_q T_p [rigid (1/m + [a_p] J^-1 [a_q]^T) +
    nodal_pq] T_q^T, s = 1 on the slave, -1 on the master; then `factor` times the compliance of the
    base and `uneven` + `own` on the diagonal.

    Parameters
    ----------
    arms
        (n, 3) of the points on their slaves.
    active
        (k,).
    poses
        (ni,) of POSE, which has the turns T.
    rigid
        factor of rigid motion's mobility.
    nodal
        (3 N, 3 n) as of Bodies.
    own
        (n, 3) of the points alone.
    """
    k, m = len(active), 2 * len(active)
    rows, signs, nodes, shares, sides = (
        np.empty(m, np.int64),
        np.empty(m),
        np.empty((m, 4), np.int64),
        np.empty((m, 4)),
        np.empty((m, 3)),
    )
    turned, faces, concerned = (
        turns(poses),
        np.empty((m, 2), np.int64),
        np.zeros(len(bodies.body), np.bool_),
    )
    W[:] = 0.0
    for i in active:
        concerned[points[i].slave] = True
        if points[i].master != GROUND:
            concerned[points[i].master] = True
    for b in range(len(bodies.body)):
        count = 0
        if not concerned[b]:
            continue
        for j in range(k):
            i = active[j]
            for side in range(2):
                if (points[i].master if side else points[i].slave) != b:
                    continue
                rows[count], signs[count] = j, -1.0 if side else 1.0
                for q in range(4):
                    nodes[count, q] = points[i].below[q] if side else points[i].carriers[q]
                    shares[count, q] = points[i].shares[q] if side else points[i].weights[q]
                for a in range(3):
                    sides[count, a] = points[i].seat[a] if side else arms[i, a]
                faces[count, 0], faces[count, 1] = points[i].interface, MASTER if side else SLAVE
                count += 1
        _add_body(
            bodies, b, rows, signs, nodes, shares, sides, faces, turned, count, rigid, nodal, W
        )
    if factor != 0.0:
        count = 0
        gather(base, points, active)
        for j in range(k):
            i = active[j]
            if points[i].master == GROUND:
                rows[count] = j
                for q in range(4):
                    shares[count, q] = points[i].shares[q]
                    if shares[count, q] != 0.0:
                        nodes[count, q] = base.gathered.place[points[i].below[q]]
                count += 1
        _add_interpolated(
            base.gathered.matrix, 0, base.gathered.number[0], rows, nodes, shares, count, factor, W
        )
        for j in range(k):
            for a in range(3):
                W[3 * j + a, 3 * j + a] += factor * own[active[j], a]
                for b in range(3):
                    W[3 * j + a, 3 * j + b] += factor * points[active[j]].uneven[a, b]
    for i in range(3 * k):
        for j in range(i + 1, 3 * k):
            W[j, i] = W[i, j]


@njit
def _add_body(
    bodies: Bodies,
    b: int,
    rows: Array,
    signs: Array,
    nodes: Array,
    shares: Array,
    arms: Array,
    faces: Array,
    turned: Array,
    count: int,
    rigid: float,
    nodal: Array,
    W: Array,
) -> None:
    """Add to the upper blocks of W what one body gives: `count` sides of points on it, for each row
    in W, sign, nodes, shares, arm, and its interface and side, whose turns (ni, 2, 3, 3) lead from
    the body to the frame of the interface.
    """
    B, block, half, lever, places = (
        np.zeros((3 * count, 3 * count)),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty((count, 3, 3)),
        np.arange(count),
    )
    _add_interpolated(
        nodal, bodies.body[b].first, bodies.body[b].count, places, nodes, shares, count, 1.0, B
    )
    mobile = rigid * bodies.body[b].inverse_mass
    floats = mobile != 0.0
    if floats:
        J = bodies.body[b].inverse_inertia
        for i in range(count):
            x, y, z = arms[i, 0], arms[i, 1], arms[i, 2]
            for a in range(3):
                # J^-1 [arm]
                lever[i, a, 0] = J[a, 1] * z - J[a, 2] * y
                lever[i, a, 1] = J[a, 2] * x - J[a, 0] * z
                lever[i, a, 2] = J[a, 0] * y - J[a, 1] * x
    for i in range(count):
        x, y, z = arms[i, 0], arms[i, 1], arms[i, 2]
        for j in range(i, count):
            for c in range(3):
                block[0, c], block[1, c], block[2, c] = (
                    B[3 * i, 3 * j + c],
                    B[3 * i + 1, 3 * j + c],
                    B[3 * i + 2, 3 * j + c],
                )
                if floats:
                    # [arm]^T = -[arm]
                    l0, l1, l2 = lever[j, 0, c], lever[j, 1, c], lever[j, 2, c]
                    block[0, c] += rigid * (z * l1 - y * l2)
                    block[1, c] += rigid * (x * l2 - z * l0)
                    block[2, c] += rigid * (y * l0 - x * l1)
                    block[c, c] += mobile
            sign, k, s, l, t = (
                signs[i] * signs[j],
                faces[i, 0],
                faces[i, 1],
                faces[j, 0],
                faces[j, 1],
            )
            for a in range(3):
                for c in range(3):
                    half[a, c] = (
                        turned[k, s, a, 0] * block[0, c]
                        + turned[k, s, a, 1] * block[1, c]
                        + turned[k, s, a, 2] * block[2, c]
                    )
            for a in range(3):
                for c in range(3):
                    value = sign * (
                        half[a, 0] * turned[l, t, c, 0]
                        + half[a, 1] * turned[l, t, c, 1]
                        + half[a, 2] * turned[l, t, c, 2]
                    )
                    W[3 * rows[i] + a, 3 * rows[j] + c] += value
                    if rows[i] == rows[j] and i != j:
                        # both sides of one point on one body
                        W[3 * rows[i] + c, 3 * rows[j] + a] += value


@njit
def _add_interpolated(
    compliance: Array,
    first: int,
    number: int,
    rows: Array,
    nodes: Array,
    shares: Array,
    count: int,
    factor: float,
    W: Array,
) -> None:
    """Add factor times the compliance of nodes, interpolated, to the upper blocks of W (3 k, 3 k)
    at the rows (count,) of the sides.

    compliance: rows 3 node + a, columns 3 (node - first) + a of `number` nodes. nodes, shares: (m,
    4) those of which each side takes the displacement and to which it gives its force.
    """
    if count <= FEW_SIDES:
        for i in range(count):
            for j in range(i, count):
                top, left = 3 * rows[i], 3 * rows[j]
                for q in range(4):
                    for r in range(4):
                        w = factor * shares[i, q] * shares[j, r]
                        if w != 0.0:
                            row, column = 3 * nodes[i, q], 3 * (nodes[j, r] - first)
                            for a in range(3):
                                for b in range(3):
                                    W[top + a, left + b] += w * compliance[row + a, column + b]
        return
    # whole lines, which are beside each other in memory
    width = 3 * number
    line = np.empty((3, width))
    for i in range(count):
        line[:] = 0.0
        for q in range(4):
            w = factor * shares[i, q]
            if w != 0.0:
                for a in range(3):
                    source, target = compliance[3 * nodes[i, q] + a], line[a]
                    for x in range(width):
                        target[x] += w * source[x]
        top = 3 * rows[i]
        for j in range(i, count):
            left = 3 * rows[j]
            for q in range(4):
                w, column = shares[j, q], 3 * (nodes[j, q] - first)
                if w != 0.0:
                    for a in range(3):
                        for b in range(3):
                            W[top + a, left + b] += w * line[a, column + b]


@njit
def even_out(bodies: Bodies, base: GroundTops, points: Array, i: int, poses: Array) -> None:
    """Correct the compliance of point i for its place between nodes: find its `uneven` (3, 3)
    [m/N].

    Several nodes share a force between them, so that it meets less compliance than a force at a
    node. `uneven` is the difference, zero at a node; of bodies that do not deform it is the
    compliance of the point itself. Without it a rolling rim would store energy at each node and
    release it between nodes.
    """
    target, b, gives = points[i].uneven, points[i].slave, bodies.body[points[i].slave].gives
    if points[i].master != GROUND:
        gives += bodies.body[points[i].master].gives
    for a in range(3):
        for c in range(3):
            target[a, c] = gives if a == c else 0.0
    if points[i].count == 1:
        return
    block, C, pose = np.empty((3, 3)), bodies.static, poses[points[i].interface]
    first, second, start = (
        3 * points[i].carriers[0],
        3 * points[i].carriers[1],
        3 * bodies.body[b].first,
    )
    share = points[i].weights[0] * points[i].weights[1]
    for a in range(3):
        for c in range(3):
            block[a, c] = share * (
                C[first + a, first - start + c]
                + C[second + a, second - start + c]
                - C[first + a, second - start + c]
                - C[second + a, first - start + c]
            )
    _add_turned(block, pose.turned[SLAVE], target)
    if points[i].count < 4:
        # laid on an edge, which may bring it to a node, where it has none of the master's
        return
    block[:] = 0.0
    for q in range(4):
        row, u = 3 * points[i].below[q], points[i].shares[q]
        for r in range(4):
            w = (u if q == r else 0.0) - u * points[i].shares[r]
            column = 3 * points[i].below[r]
            if points[i].master == GROUND:
                for a in range(3):
                    for c in range(3):
                        target[a, c] += w * base.compliance[row + a, column + c]
            elif w != 0.0:
                column -= 3 * bodies.body[points[i].master].first
                for a in range(3):
                    for c in range(3):
                        block[a, c] += w * C[row + a, column + c]
    if points[i].master != GROUND:
        _add_turned(block, pose.turned[MASTER], target)


@njit
def _add_turned(block: Array, turn: Array, target: Array) -> None:
    """Add turn block turn^T, all (3, 3)."""
    half = np.empty((3, 3))
    for a in range(3):
        for c in range(3):
            half[a, c] = (
                turn[a, 0] * block[0, c] + turn[a, 1] * block[1, c] + turn[a, 2] * block[2, c]
            )
    for a in range(3):
        for c in range(3):
            target[a, c] += (
                half[a, 0] * turn[c, 0] + half[a, 1] * turn[c, 1] + half[a, 2] * turn[c, 2]
            )
