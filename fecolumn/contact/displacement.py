"""Static displacement of contact points by the forces on them: what bodies and base give at
once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.coupling import are_stiff
from fecolumn.contact.gathered import gather
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import turns
from fecolumn.contact.tolerances import FEW_SIDES
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.projection import GroundTops


@njit
def static_displacement(
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    poses: Array,
    contact: Array,
    listed: Array,
    target: Array,
) -> None:
    """Target (n, 3): displacement [m] of the listed points (k,), slave relative to master, that
    follows their forces in `contact` at once; without what the points give alone.
    """
    loaded = 0
    for i in listed:
        loaded += contact[i].force[2] > 0.0
        for a in range(3):
            target[i, a] = 0.0
    if loaded == 0:
        return
    if are_stiff(bodies, base, points, listed):
        # each point gives alone
        pass
    elif len(listed) > FEW_SIDES:
        _displace_many(bodies, base, points, turns(poses), contact, listed, target)
    else:
        _displace_few(bodies, base, points, turns(poses), contact, listed, target)
    for i in listed:
        if contact[i].force[2] > 0:
            for a in range(3):
                for c in range(3):
                    target[i, a] += points[i].uneven[a, c] * contact[i].force[c]


@njit
def _displace_few(
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    turned: Array,
    contact: Array,
    listed: Array,
    target: Array,
) -> None:
    """`static_displacement` without `uneven`, of few points: by the compliance of each two of
    them.
    """
    force, way = np.empty(3), np.empty(3)
    for i in listed:
        for side in range(2):
            b, k = points[i].master if side else points[i].slave, points[i].interface
            compliance, first = (
                (base.compliance, 0) if b == GROUND else (bodies.static, bodies.body[b].first)
            )
            for a in range(3):
                way[a] = 0.0
            for j in listed:
                if not contact[j].force[2] > 0.0:
                    continue
                for other in range(2):
                    if (points[j].master if other else points[j].slave) != b:
                        continue
                    l, f = points[j].interface, contact[j].force
                    for a in range(3):
                        force[a] = (
                            f[a]
                            if b == GROUND
                            else turned[l, other, 0, a] * f[0]
                            + turned[l, other, 1, a] * f[1]
                            + turned[l, other, 2, a] * f[2]
                        )
                    for q in range(4 if side else points[i].count):
                        w, node = (
                            -points[i].shares[q] if side else points[i].weights[q],
                            points[i].below[q] if side else points[i].carriers[q],
                        )
                        for r in range(4 if other else points[j].count):
                            x, under = (
                                -points[j].shares[r] if other else points[j].weights[r],
                                points[j].below[r] if other else points[j].carriers[r],
                            )
                            if w * x == 0.0:
                                continue
                            column = 3 * (under - first)
                            for a in range(3):
                                line = compliance[3 * node + a]
                                way[a] += (
                                    w
                                    * x
                                    * (
                                        line[column] * force[0]
                                        + line[column + 1] * force[1]
                                        + line[column + 2] * force[2]
                                    )
                                )
            for a in range(3):
                target[i, a] += (
                    way[a]
                    if b == GROUND
                    else turned[k, side, a, 0] * way[0]
                    + turned[k, side, a, 1] * way[1]
                    + turned[k, side, a, 2] * way[2]
                )


@njit
def _displace_many(
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    turned: Array,
    contact: Array,
    listed: Array,
    target: Array,
) -> None:
    """`static_displacement` without `uneven`, of many points: by forces on nodes, which they
    share.
    """
    gather(base, points, listed)
    # nodes of all bodies, then those gathered of the base; those of each that are pushed are listed
    # from its first one on
    own, own_count = len(bodies.arms), len(bodies.body)
    count = own + base.gathered.number[0]
    pushes, moved, pushed, number = (
        np.zeros((count, 3)),
        np.empty((count, 3)),
        np.empty(count, np.int64),
        np.zeros(own_count + 1, np.int64),
    )
    is_pushed, is_moved, push, way = (
        np.zeros(count, np.bool_),
        np.zeros(count, np.bool_),
        np.empty(3),
        np.empty(3),
    )
    for i in listed:
        if not contact[i].force[2] > 0.0:
            continue
        k = points[i].interface
        for side in range(2):
            b, f = points[i].master if side else points[i].slave, contact[i].force
            first = own if b == GROUND else bodies.body[b].first
            for a in range(3):
                push[a] = (
                    f[a]
                    if b == GROUND
                    else turned[k, side, 0, a] * f[0]
                    + turned[k, side, 1, a] * f[1]
                    + turned[k, side, 2, a] * f[2]
                )
            for q in range(4 if side else points[i].count):
                w, node = _share(base, points[i], side, q, own)
                if w == 0.0:
                    continue
                if not is_pushed[node]:
                    is_pushed[node] = True
                    # the base is the last of all
                    pushed[first + number[b]] = node
                    number[b] += 1
                for a in range(3):
                    pushes[node, a] += w * push[a]
    for i in listed:
        k = points[i].interface
        for side in range(2):
            b = points[i].master if side else points[i].slave
            if number[b] == 0:
                continue
            first, nodes = (
                (own, count - own) if b == GROUND else (bodies.body[b].first, bodies.body[b].count)
            )
            for a in range(3):
                way[a] = 0.0
            for q in range(4 if side else points[i].count):
                w, node = _share(base, points[i], side, q, own)
                if w == 0.0:
                    continue
                if not is_moved[node]:
                    is_moved[node] = True
                    compliance, row = (
                        (base.gathered.matrix, 3 * (node - own))
                        if b == GROUND
                        else (bodies.static, 3 * node)
                    )
                    if 3 * number[b] > nodes:
                        _move(compliance, row, pushes[first : first + nodes], moved[node])
                    else:
                        _move_by_few(
                            compliance,
                            row,
                            first,
                            pushed[first : first + number[b]],
                            pushes,
                            moved[node],
                        )
                for a in range(3):
                    way[a] += w * moved[node, a]
            for a in range(3):
                target[i, a] += (
                    way[a]
                    if b == GROUND
                    else turned[k, side, a, 0] * way[0]
                    + turned[k, side, a, 1] * way[1]
                    + turned[k, side, a, 2] * way[2]
                )


@njit
def _share(base: GroundTops, point: Record, side: int, q: int, own: int) -> tuple[float, int]:
    """Share of the force of a point that node q of its slave (side 0) or of its master (side 1,
    negative) takes, and the number of the node: nodes of the base follow the `own` nodes of bodies.
    """
    w, node = (
        -point.shares[q] if side else point.weights[q],
        point.below[q] if side else point.carriers[q],
    )
    if side and point.master == GROUND and w != 0.0:
        node = own + base.gathered.place[node]
    return w, node


@njit(fastmath={"reassoc", "contract"})
def _move(compliance: Array, row: int, pushes: Array, target: Array) -> None:
    """Target (3,): displacement in three rows of a compliance by the pushes (n, 3) on all nodes of
    its columns.
    """
    flat = pushes.reshape(3 * len(pushes))
    for a in range(3):
        line, total = compliance[row + a], 0.0
        for j in range(len(flat)):
            total += line[j] * flat[j]
        target[a] = total


@njit
def _move_by_few(
    compliance: Array, row: int, first: int, pushed: Array, pushes: Array, target: Array
) -> None:
    """As `_move`, by the pushes (N, 3) on the nodes `pushed` (k,); first: node of the first
    column.
    """
    for a in range(3):
        line, total = compliance[row + a], 0.0
        for j in pushed:
            column = 3 * (j - first)
            total += (
                line[column] * pushes[j, 0]
                + line[column + 1] * pushes[j, 1]
                + line[column + 2] * pushes[j, 2]
            )
        target[a] = total
