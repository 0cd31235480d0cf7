"""Compliance of the contact points, and their static displacement, in compiled code."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit


@njit
def assemble(column, points, arms, active, rotation, rigid, nodal, W):
    """W (3 k, 3 k): rigid (1/m + arm J^-1 arm^T) + nodal (3 n, 3 n) of the active points, turned into the table frame.

    arms: (n, 3) of the points. rigid: factor of the rigid motion's mobility.
    """
    k, J = len(active), column.inverse
    lever, block, half = np.empty((k, 3, 3)), np.empty((3, 3)), np.empty((3, 3))
    W[:] = 0.0
    add_interpolated(nodal, points.carriers, points.weights, active, 1.0, W)
    for i in range(k):
        x, y, z = arms[active[i], 0], arms[active[i], 1], arms[active[i], 2]
        for a in range(3):
            # J^-1 [arm]
            lever[i, a, 0] = J[a, 1] * z - J[a, 2] * y
            lever[i, a, 1] = J[a, 2] * x - J[a, 0] * z
            lever[i, a, 2] = J[a, 0] * y - J[a, 1] * x
    for i in range(k):
        x, y, z = arms[active[i], 0], arms[active[i], 1], arms[active[i], 2]
        for j in range(i, k):
            for b in range(3):
                # [arm]^T = -[arm]
                l0, l1, l2 = lever[j, 0, b], lever[j, 1, b], lever[j, 2, b]
                block[0, b] = W[3 * i, 3 * j + b] + rigid * (z * l1 - y * l2)
                block[1, b] = W[3 * i + 1, 3 * j + b] + rigid * (x * l2 - z * l0)
                block[2, b] = W[3 * i + 2, 3 * j + b] + rigid * (y * l0 - x * l1)
                block[b, b] += rigid / column.mass
            turn_block(rotation, block, half)
            for a in range(3):
                for b in range(3):
                    W[3 * i + a, 3 * j + b] = block[a, b]
                    W[3 * j + b, 3 * i + a] = block[a, b]


@njit
def add_interpolated(compliance, nodes, weights, active, factor, W):
    """Add factor times the compliance (3 m, 3 m) of nodes to W (3 k, 3 k) of the active points, upper blocks only.

    nodes, weights: (n, 4) those of which each of the n points takes the displacement, and to which it gives its force.
    """
    k = len(active)
    # the few nodes concerned, beside each other in memory
    listed, places, m = np.empty(4 * k, np.int64), np.empty((k, 4), np.int64), 0
    for i in range(k):
        p = active[i]
        for c in range(4):
            if weights[p, c] != 0.0:
                places[i, c], m = enlist(nodes[p, c], listed, m)
    local, rows = np.empty((3 * m, 3 * m)), np.empty((3, 3 * m))
    for u in range(m):
        for v in range(m):
            first, second = 3 * listed[u], 3 * listed[v]
            for a in range(3):
                for b in range(3):
                    local[3 * u + a, 3 * v + b] = factor * compliance[first + a, second + b]
    for i in range(k):
        rows[:] = 0.0
        for c in range(4):
            w = weights[active[i], c]
            if w != 0.0:
                for a in range(3):
                    line = local[3 * places[i, c] + a]
                    for x in range(3 * m):
                        rows[a, x] += w * line[x]
        for j in range(i, k):
            for d in range(4):
                w = weights[active[j], d]
                if w != 0.0:
                    first = 3 * places[j, d]
                    for a in range(3):
                        for b in range(3):
                            W[3 * i + a, 3 * j + b] += w * rows[a, first + b]


@njit
def turn_block(rotation, block, half):
    """block = rotation block rotation^T; half: (3, 3) room."""
    for a in range(3):
        for b in range(3):
            half[a, b] = rotation[a, 0] * block[0, b] + rotation[a, 1] * block[1, b] + rotation[a, 2] * block[2, b]
    for a in range(3):
        for b in range(3):
            block[a, b] = half[a, 0] * rotation[b, 0] + half[a, 1] * rotation[b, 1] + half[a, 2] * rotation[b, 2]


@njit
def add_below(own, plate, footing, active, W, factor):
    """Add factor times the compliance of base, uneven rim and `own` (n, 3) of the points alone of the active points to W (3 k, 3 k)."""
    k = len(active)
    add_interpolated(plate.compliance, footing.slots, footing.weights, active, factor, W)
    for i in range(k):
        p = active[i]
        for a in range(3):
            W[3 * i + a, 3 * i + a] += factor * own[p, a]
            for b in range(3):
                W[3 * i + a, 3 * i + b] += factor * footing.even[p, a, b]
        for j in range(i + 1, k):
            for a in range(3):
                for b in range(3):
                    W[3 * j + b, 3 * i + a] = W[3 * i + a, 3 * j + b]


@njit
def even(column, points, plate, footing, rotation, i):
    """Find footing.even of point i, zero at a node: see Interface._evened."""
    target = footing.even[i]
    target[:] = 0.0
    if points.count[i] == 1:
        return
    first, second = 3 * points.carriers[i, 0], 3 * points.carriers[i, 1]
    share = points.weights[i, 0] * points.weights[i, 1]
    for a in range(3):
        for b in range(3):
            C = column.static
            target[a, b] = share * (C[first + a, first + b] + C[second + a, second + b] - C[first + a, second + b] - C[second + a, first + b])
    turn_block(rotation, target, np.empty((3, 3)))
    for c in range(4):
        row, u = 3 * footing.slots[i, c], footing.weights[i, c]
        for d in range(4):
            w = (u if c == d else 0.0) - u * footing.weights[i, d]
            first = 3 * footing.slots[i, d]
            for a in range(3):
                for b in range(3):
                    target[a, b] += w * plate.compliance[row + a, first + b]


@njit
def static_displacement(column, points, plate, footing, rotation, forces, near, given):
    """given (n, 3): displacement of the near points (mask) relative to the base that follows the forces at once; without what the points give alone."""
    n, loaded, told = len(forces), 0, 0
    given[:] = 0.0
    for i in range(n):
        loaded += forces[i, 2] > 0.0
        told += near[i]
    if loaded == 0:
        return
    # forces on the column's nodes and on the base's, points beside each other share them
    carriers, pulls, n_carriers = np.empty(4 * loaded, np.int64), np.zeros((4 * loaded, 3)), 0
    slots, shares, n_slots = np.empty(4 * loaded, np.int64), np.zeros((4 * loaded, 3)), 0
    for i in range(n):
        r0, r1, r2 = forces[i, 0], forces[i, 1], forces[i, 2]
        if r2 <= 0.0:
            continue
        for q in range(points.count[i]):
            place, n_carriers = enlist(points.carriers[i, q], carriers, n_carriers)
            for a in range(3):
                pulls[place, a] += points.weights[i, q] * (rotation[0, a] * r0 + rotation[1, a] * r1 + rotation[2, a] * r2)
        for q in range(4):
            place, n_slots = enlist(footing.slots[i, q], slots, n_slots)
            w = footing.weights[i, q]
            shares[place, 0] += w * r0
            shares[place, 1] += w * r1
            shares[place, 2] += w * r2
    # what they do at the nodes of the near points, each found once
    above, moved, n_above = np.empty(4 * told, np.int64), np.empty((4 * told, 3)), 0
    below, sunk, n_below = np.empty(4 * told, np.int64), np.empty((4 * told, 3)), 0
    for i in range(n):
        if not near[i]:
            continue
        u0 = u1 = u2 = 0.0
        for q in range(points.count[i]):
            known, w = n_above, points.weights[i, q]
            place, n_above = enlist(points.carriers[i, q], above, n_above)
            if place == known:
                _respond(column.static, above[place], pulls, carriers, n_carriers, moved[place])
            u0, u1, u2 = u0 + w * moved[place, 0], u1 + w * moved[place, 1], u2 + w * moved[place, 2]
        for a in range(3):
            given[i, a] = rotation[a, 0] * u0 + rotation[a, 1] * u1 + rotation[a, 2] * u2
        for q in range(4):
            if footing.slots[i, q] < 0 or footing.weights[i, q] == 0.0:
                continue
            known = n_below
            place, n_below = enlist(footing.slots[i, q], below, n_below)
            if place == known:
                _respond(plate.compliance, below[place], shares, slots, n_slots, sunk[place])
            for a in range(3):
                given[i, a] += footing.weights[i, q] * sunk[place, a]
        if forces[i, 2] > 0 and points.count[i] > 1:
            for a in range(3):
                given[i, a] += footing.even[i, a, 0] * forces[i, 0] + footing.even[i, a, 1] * forces[i, 1] + footing.even[i, a, 2] * forces[i, 2]


@njit
def enlist(item, items, count):
    """Place of an item among the first `count`, after which it is put where it is not there, and how many there are then."""
    for place in range(count - 1, -1, -1):
        if items[place] == item:
            return place, count
    items[count] = item
    return count, count + 1


@njit
def _respond(compliance, row, values, places, count, target):
    """target (3,): displacement at node `row` by values (count, 3) at `places`."""
    for a in range(3):
        line, total = compliance[3 * row + a], 0.0
        for j in range(count):
            place = 3 * places[j]
            total += line[place] * values[j, 0] + line[place + 1] * values[j, 1] + line[place + 2] * values[j, 2]
        target[a] = total
