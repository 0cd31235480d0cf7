"""Compliance of contact points relative to one another: of their bodies, of the base, and of each point alone (Delassus 1917)."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.points import BASE
from fecolumn.contact.pose import MASTER, SLAVE, turns


@njit
def assemble(bodies, base, points, arms, active, poses, rigid, nodal, factor, own, W):
    """W (3 k, 3 k): displacement of the active points, slave relative to master, per force [m/N], or velocity per impulse,
    each in the frame of its interface.

    W_pq = sum over the bodies that p and q share of s_p s_q T_p [rigid (1/m + [a_p] J^-1 [a_q]^T) + nodal_pq] T_q^T, s = 1 on the slave, -1 on the master;
    then `factor` times the compliance of the base and `uneven` + `own` on the diagonal.

    Args:
        arms: (n, 3) of the points on their slaves. active: (k,). poses: (ni,) of POSE, which has the turns T. rigid: factor of rigid motion's mobility.
        nodal: (3 N, 3 n) as of Bodies. own: (n, 3) of the points alone.
    """
    k, m = len(active), 2 * len(active)
    rows, signs, nodes, shares, sides = np.empty(m, np.int64), np.empty(m), np.empty((m, 4), np.int64), np.empty((m, 4)), np.empty((m, 3))
    turned, faces = turns(poses), np.empty((m, 2), np.int64)
    W[:] = 0.0
    for b in range(len(bodies.body)):
        count = 0
        for j in range(k):
            i = active[j]
            if points[i].slave == b:
                rows[count], signs[count] = j, 1.0
                for q in range(4):
                    nodes[count, q], shares[count, q] = points[i].carriers[q], points[i].weights[q]
                for a in range(3):
                    sides[count, a] = arms[i, a]
                faces[count, 0], faces[count, 1] = points[i].interface, SLAVE
                count += 1
            if points[i].master == b:
                rows[count], signs[count] = j, -1.0
                for q in range(4):
                    nodes[count, q], shares[count, q] = points[i].below[q], points[i].shares[q]
                for a in range(3):
                    sides[count, a] = points[i].seat[a]
                faces[count, 0], faces[count, 1] = points[i].interface, MASTER
                count += 1
        _add_body(bodies, b, rows, signs, nodes, shares, sides, faces, turned, count, rigid, nodal, W)
    if factor != 0.0:
        count = 0
        for j in range(k):
            i = active[j]
            if points[i].master == BASE:
                rows[count] = j
                for q in range(4):
                    nodes[count, q], shares[count, q] = points[i].below[q], points[i].shares[q]
                count += 1
        _add_interpolated(base.compliance, 0, rows, signs, nodes, shares, count, False, factor, W)
        for j in range(k):
            for a in range(3):
                W[3 * j + a, 3 * j + a] += factor * own[active[j], a]
                for b in range(3):
                    W[3 * j + a, 3 * j + b] += factor * points[active[j]].uneven[a, b]
    for i in range(3 * k):
        for j in range(i + 1, 3 * k):
            W[j, i] = W[i, j]


@njit
def _add_body(bodies, b, rows, signs, nodes, shares, arms, faces, turned, count, rigid, nodal, W):
    """Add to the upper blocks of W what one body gives: `count` sides of points on it, for each row in W, sign, nodes, shares, arm, and its
    interface and side, whose turns (ni, 2, 3, 3) lead from the body to the frame of the interface."""
    if count == 0:
        return
    B, block, half, lever = np.zeros((3 * count, 3 * count)), np.empty((3, 3)), np.empty((3, 3)), np.empty((count, 3, 3))
    _add_interpolated(nodal, bodies.body[b].first, rows, signs, nodes, shares, count, True, 1.0, B)
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
                block[0, c], block[1, c], block[2, c] = B[3 * i, 3 * j + c], B[3 * i + 1, 3 * j + c], B[3 * i + 2, 3 * j + c]
                if floats:
                    # [arm]^T = -[arm]
                    l0, l1, l2 = lever[j, 0, c], lever[j, 1, c], lever[j, 2, c]
                    block[0, c] += rigid * (z * l1 - y * l2)
                    block[1, c] += rigid * (x * l2 - z * l0)
                    block[2, c] += rigid * (y * l0 - x * l1)
                    block[c, c] += mobile
            sign, k, s, l, t = signs[i] * signs[j], faces[i, 0], faces[i, 1], faces[j, 0], faces[j, 1]
            for a in range(3):
                for c in range(3):
                    half[a, c] = turned[k, s, a, 0] * block[0, c] + turned[k, s, a, 1] * block[1, c] + turned[k, s, a, 2] * block[2, c]
            for a in range(3):
                for c in range(3):
                    value = sign * (half[a, 0] * turned[l, t, c, 0] + half[a, 1] * turned[l, t, c, 1] + half[a, 2] * turned[l, t, c, 2])
                    W[3 * rows[i] + a, 3 * rows[j] + c] += value
                    if rows[i] == rows[j] and i != j:
                        # both sides of one point on one body
                        W[3 * rows[i] + c, 3 * rows[j] + a] += value


@njit
def _add_interpolated(compliance, first, rows, signs, nodes, shares, count, local, factor, W):
    """Add factor times the compliance of nodes, interpolated, to the upper blocks of W: at i, j of the sides if `local`, else at their rows.

    compliance: rows 3 node + a, columns 3 (node - first) + a. nodes, shares: (m, 4) those of which each side takes the displacement and to which
    it gives its force.
    """
    # the few nodes concerned, beside each other in memory
    listed, places, m = np.empty(4 * count, np.int64), np.empty((count, 4), np.int64), 0
    for i in range(count):
        for q in range(4):
            if shares[i, q] != 0.0:
                places[i, q], m = place_of(nodes[i, q], listed, m)
    gathered, line = np.empty((3 * m, 3 * m)), np.empty((3, 3 * m))
    for u in range(m):
        for v in range(m):
            row, column = 3 * listed[u], 3 * (listed[v] - first)
            for a in range(3):
                for b in range(3):
                    gathered[3 * u + a, 3 * v + b] = factor * compliance[row + a, column + b]
    for i in range(count):
        line[:] = 0.0
        for q in range(4):
            w = shares[i, q]
            if w != 0.0:
                for a in range(3):
                    for x in range(3 * m):
                        line[a, x] += w * gathered[3 * places[i, q] + a, x]
        top = 3 * (i if local else rows[i])
        for j in range(i, count):
            left = 3 * (j if local else rows[j])
            for q in range(4):
                w = shares[j, q]
                if w != 0.0:
                    for a in range(3):
                        for b in range(3):
                            W[top + a, left + b] += w * line[a, 3 * places[j, q] + b]


@njit
def place_of(item, items, count):
    """Place of an item among the first `count`, after which it is put where it is not there, and how many there are then."""
    for place in range(count - 1, -1, -1):
        if items[place] == item:
            return place, count
    items[count] = item
    return count, count + 1


@njit
def even_out(bodies, base, points, i, poses):
    """Find `uneven` of point i: the compliance by which forces at a point between nodes of slave and base meet less than at a node.

    Given back so that the indentation of a rolling rim is even: it would otherwise store and return energy at each node. Zero at a node.
    """
    target, b = points[i].uneven, points[i].slave
    for a in range(3):
        for c in range(3):
            target[a, c] = 0.0
    if points[i].count == 1:
        return
    block, C, pose = np.empty((3, 3)), bodies.static, poses[points[i].interface]
    first, second, start = 3 * points[i].carriers[0], 3 * points[i].carriers[1], 3 * bodies.body[b].first
    share = points[i].weights[0] * points[i].weights[1]
    for a in range(3):
        for c in range(3):
            block[a, c] = share * (C[first + a, first - start + c] + C[second + a, second - start + c]
                                   - C[first + a, second - start + c] - C[second + a, first - start + c])
    _add_turned(block, pose.turned[SLAVE], target)
    block[:] = 0.0
    for q in range(4):
        row, u = 3 * points[i].below[q], points[i].shares[q]
        for r in range(4):
            w = (u if q == r else 0.0) - u * points[i].shares[r]
            column = 3 * points[i].below[r]
            if points[i].master == BASE:
                for a in range(3):
                    for c in range(3):
                        target[a, c] += w * base.compliance[row + a, column + c]
            elif w != 0.0:
                column -= 3 * bodies.body[points[i].master].first
                for a in range(3):
                    for c in range(3):
                        block[a, c] += w * C[row + a, column + c]
    if points[i].master != BASE:
        _add_turned(block, pose.turned[MASTER], target)


@njit
def _add_turned(block, turn, target):
    """Add turn block turn^T, all (3, 3)."""
    half = np.empty((3, 3))
    for a in range(3):
        for c in range(3):
            half[a, c] = turn[a, 0] * block[0, c] + turn[a, 1] * block[1, c] + turn[a, 2] * block[2, c]
    for a in range(3):
        for c in range(3):
            target[a, c] += half[a, 0] * turn[c, 0] + half[a, 1] * turn[c, 1] + half[a, 2] * turn[c, 2]


@njit
def static_displacement(bodies, base, points, poses, contact, listed, target):
    """target (n, 3): displacement [m] of the listed points (k,), slave relative to master, that follows their forces in `contact` at once; without what
    the points give alone."""
    loaded = 0
    for i in listed:
        loaded += contact[i].force[2] > 0.0
        for a in range(3):
            target[i, a] = 0.0
    if loaded == 0:
        return
    room, far, turned = 8 * loaded, 8 * len(listed), turns(poses)
    pushed, pushes, reached, moved = np.empty(room, np.int64), np.empty((room, 3)), np.empty(far, np.int64), np.empty((far, 3))
    for b in range(-1, len(bodies.body)):
        _displace(bodies, base, points, b, turned, contact, listed, pushed, pushes, reached, moved, target)
    for i in listed:
        if contact[i].force[2] > 0 and points[i].count > 1:
            for a in range(3):
                for c in range(3):
                    target[i, a] += points[i].uneven[a, c] * contact[i].force[c]


@njit
def _displace(bodies, base, points, b, turned, contact, listed, pushed, pushes, reached, moved, target):
    """What `static_displacement` finds of one body, or the base; the four arrays before the last are room to work in."""
    n_pushed, first = 0, 0 if b == BASE else bodies.body[b].first
    compliance = base.compliance if b == BASE else bodies.static
    # forces on its nodes: points beside each other share them
    for i in listed:
        if not contact[i].force[2] > 0.0:
            continue
        r0, r1, r2 = contact[i].force[0], contact[i].force[1], contact[i].force[2]
        for side in range(2):
            if (points[i].master if side else points[i].slave) != b:
                continue
            for q in range(4 if side else points[i].count):
                w = -points[i].shares[q] if side else points[i].weights[q]
                before = n_pushed
                place, n_pushed = place_of(points[i].below[q] if side else points[i].carriers[q], pushed, n_pushed)
                if place == before:
                    pushes[place, 0] = pushes[place, 1] = pushes[place, 2] = 0.0
                if b == BASE:
                    pushes[place, 0] += w * r0
                    pushes[place, 1] += w * r1
                    pushes[place, 2] += w * r2
                else:
                    k = points[i].interface
                    for a in range(3):
                        pushes[place, a] += w * (turned[k, side, 0, a] * r0 + turned[k, side, 1, a] * r1 + turned[k, side, 2, a] * r2)
    if n_pushed == 0:
        return
    # what they do at the nodes of the near points, each found once
    n_reached = 0
    for i in listed:
        for side in range(2):
            if (points[i].master if side else points[i].slave) != b:
                continue
            u0 = u1 = u2 = 0.0
            for q in range(4 if side else points[i].count):
                w, node = -points[i].shares[q] if side else points[i].weights[q], points[i].below[q] if side else points[i].carriers[q]
                if w == 0.0 or node < 0:
                    continue
                before = n_reached
                place, n_reached = place_of(node, reached, n_reached)
                if place == before:
                    for a in range(3):
                        total = 0.0
                        for j in range(n_pushed):
                            column = 3 * (pushed[j] - first)
                            total += (compliance[3 * node + a, column] * pushes[j, 0] + compliance[3 * node + a, column + 1] * pushes[j, 1]
                                      + compliance[3 * node + a, column + 2] * pushes[j, 2])
                        moved[place, a] = total
                u0, u1, u2 = u0 + w * moved[place, 0], u1 + w * moved[place, 1], u2 + w * moved[place, 2]
            if b == BASE:
                target[i, 0] += u0
                target[i, 1] += u1
                target[i, 2] += u2
            else:
                k = points[i].interface
                for a in range(3):
                    target[i, a] += turned[k, side, a, 0] * u0 + turned[k, side, a, 1] * u1 + turned[k, side, a, 2] * u2
