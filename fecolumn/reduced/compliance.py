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
    for i in range(k):
        x, y, z = arms[active[i], 0], arms[active[i], 1], arms[active[i], 2]
        for a in range(3):
            # J^-1 [arm]
            lever[i, a, 0] = J[a, 1] * z - J[a, 2] * y
            lever[i, a, 1] = J[a, 2] * x - J[a, 0] * z
            lever[i, a, 2] = J[a, 0] * y - J[a, 1] * x
    for i in range(k):
        p = active[i]
        x, y, z = arms[p, 0], arms[p, 1], arms[p, 2]
        for j in range(i, k):
            q = active[j]
            for b in range(3):
                # [arm]^T = -[arm]
                l0, l1, l2 = lever[j, 0, b], lever[j, 1, b], lever[j, 2, b]
                block[0, b] = rigid * (z * l1 - y * l2)
                block[1, b] = rigid * (x * l2 - z * l0)
                block[2, b] = rigid * (y * l0 - x * l1)
                block[b, b] += rigid / column.mass
            for c in range(points.count[p]):
                row, u = 3 * points.carriers[p, c], points.weights[p, c]
                for d in range(points.count[q]):
                    first, w = 3 * points.carriers[q, d], u * points.weights[q, d]
                    for a in range(3):
                        for b in range(3):
                            block[a, b] += w * nodal[row + a, first + b]
            turn_block(rotation, block, half)
            for a in range(3):
                for b in range(3):
                    W[3 * i + a, 3 * j + b] = block[a, b]
                    W[3 * j + b, 3 * i + a] = block[a, b]


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
def add_below(column, plate, footing, active, W, factor):
    """Add factor times the compliance of base, contact law and uneven rim of the active points to W (3 k, 3 k)."""
    k = len(active)
    for i in range(k):
        p = active[i]
        for j in range(i, k):
            q = active[j]
            for c in range(4):
                row, u = 3 * footing.slots[p, c], footing.weights[p, c] * factor
                if u == 0.0:
                    continue
                for d in range(4):
                    w = u * footing.weights[q, d]
                    if w == 0.0:
                        continue
                    first = 3 * footing.slots[q, d]
                    for a in range(3):
                        for b in range(3):
                            value = w * plate.compliance[row + a, first + b]
                            W[3 * i + a, 3 * j + b] += value
                            if j > i:
                                W[3 * j + b, 3 * i + a] += value
        for a in range(3):
            W[3 * i + a, 3 * i + a] += factor * column.own[p, a]
            for b in range(3):
                W[3 * i + a, 3 * i + b] += factor * footing.even[p, a, b]


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
    """given (n, 3): displacement of the near points (mask) relative to the base that follows the forces at once; without the law's own."""
    n = len(forces)
    given[:] = 0.0
    on_nodes, at_node = np.zeros((n, 3)), np.empty((n, 3))
    pressed, done = np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    slots, shares, n_slots = np.empty(4 * n, np.int64), np.empty((4 * n, 3)), 0
    for i in range(n):
        r0, r1, r2 = forces[i, 0], forces[i, 1], forces[i, 2]
        if r2 <= 0.0:
            continue
        for q in range(points.count[i]):
            carrier, w = points.carriers[i, q], points.weights[i, q]
            pressed[carrier] |= w != 0.0
            for a in range(3):
                on_nodes[carrier, a] += w * (rotation[0, a] * r0 + rotation[1, a] * r1 + rotation[2, a] * r2)
        for q in range(4):
            slot, w = footing.slots[i, q], footing.weights[i, q]
            # points beside each other share nodes of the base
            place = n_slots
            for p in range(max(0, n_slots - 16), n_slots):
                if slots[p] == slot:
                    place = p
            if place == n_slots:
                slots[place] = slot
                shares[place] = 0.0
                n_slots += 1
            shares[place, 0] += w * r0
            shares[place, 1] += w * r1
            shares[place, 2] += w * r2
    nodes = np.flatnonzero(pressed)
    if len(nodes) == 0:
        return
    sunk = np.empty(3)
    for i in range(n):
        if not near[i]:
            continue
        u0 = u1 = u2 = 0.0
        for q in range(points.count[i]):
            carrier, w = points.carriers[i, q], points.weights[i, q]
            if w == 0.0:
                continue
            if not done[carrier]:
                done[carrier] = True
                _respond(column.static, carrier, on_nodes, nodes, at_node[carrier])
            u0, u1, u2 = u0 + w * at_node[carrier, 0], u1 + w * at_node[carrier, 1], u2 + w * at_node[carrier, 2]
        for a in range(3):
            given[i, a] = rotation[a, 0] * u0 + rotation[a, 1] * u1 + rotation[a, 2] * u2
        for q in range(4):
            slot, w = footing.slots[i, q], footing.weights[i, q]
            if slot < 0 or w == 0.0:
                continue
            _respond_rows(plate.compliance, slot, shares, slots, n_slots, sunk)
            for a in range(3):
                given[i, a] += w * sunk[a]
        if forces[i, 2] > 0 and points.count[i] > 1:
            for a in range(3):
                given[i, a] += footing.even[i, a, 0] * forces[i, 0] + footing.even[i, a, 1] * forces[i, 1] + footing.even[i, a, 2] * forces[i, 2]


@njit
def _respond(compliance, row, values, places, target):
    """target (3,): displacement at node `row` by values (n, 3) at `places`."""
    for a in range(3):
        line, total = compliance[3 * row + a], 0.0
        for place in places:
            total += line[3 * place] * values[place, 0] + line[3 * place + 1] * values[place, 1] + line[3 * place + 2] * values[place, 2]
        target[a] = total


@njit
def _respond_rows(compliance, row, values, places, count, target):
    """target (3,): displacement at node `row` by values (count, 3) at `places`."""
    for a in range(3):
        line, total = compliance[3 * row + a], 0.0
        for j in range(count):
            place = 3 * places[j]
            total += line[place] * values[j, 0] + line[place + 1] * values[j, 1] + line[place + 2] * values[j, 2]
        target[a] = total
