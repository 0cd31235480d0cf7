"""Contact points of a step: the foot's nodes, but for those of a round rim, which roll along it (`dynamics.rolling`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.rim import on_circle
from fecolumn.dynamics.rolling import FLAT, REACH
from fecolumn.reduced.motion import RIM_ANGLE, turn_by


class Points(NamedTuple):
    """Contact points of a step in their slots, and what they bring from the step before.

    carriers, weights: (n, 4) foot nodes that carry each point, the first `count` (n,) of them; arms: (n, 3) of the points;
    lift: (n,) height given to points of the rim; forces, anchors, relative: those of the start, rolled along.
    angle: (1,) place of the rim's contact point.
    """

    carriers: np.ndarray
    weights: np.ndarray
    count: np.ndarray
    arms: np.ndarray
    lift: np.ndarray
    forces: np.ndarray
    anchors: np.ndarray
    relative: np.ndarray
    angle: np.ndarray


def node_points(arms: np.ndarray) -> Points:
    """Points on the foot's nodes."""
    n = len(arms)
    carriers, weights = np.repeat(np.arange(n)[:, None], 4, axis=1), np.zeros((n, 4))
    weights[:, 0] = 1.0
    return Points(carriers, weights, np.ones(n, np.int64), arms.copy(), np.zeros(n), np.zeros((n, 3)), np.zeros((n, 2)), np.zeros((n, 3)),
                  np.array([np.nan]))


@njit
def lowest(rotation):
    """As Rim.lowest."""
    return np.arctan2(-rotation[2, 1], -rotation[2, 0]), np.hypot(rotation[2, 0], rotation[2, 1])


@njit
def place(column, points, angle):
    """Put the rim's points on the circle with one at `angle`, without lift; nan: on the nodes. Returns index of that point."""
    n = len(column.rim)
    points.angle[0] = angle
    if np.isnan(angle):
        for i in column.rim:
            points.count[i] = 1
            points.carriers[i], points.weights[i] = i, 0.0
            points.weights[i, 0] = 1.0
            points.arms[i] = column.arms[i]
            points.lift[i] = 0.0
        return 0
    index, offsets, weights = on_circle(angle, column.rim_first, column.rim_sector, n)
    for k in range(n):
        i = column.rim[k]
        points.count[i] = 4
        points.lift[i] = 0.0
        points.arms[i] = 0.0
        for q in range(4):
            carrier = column.rim[(k + offsets[q]) % n]
            points.carriers[i, q], points.weights[i, q] = carrier, weights[q]
            for a in range(3):
                points.arms[i, a] += weights[q] * column.arms[carrier, a]
    return index


@njit
def roll(column, motion, dt, points):
    """Place the points of the step `dt` that begins, and bring forces, anchors and relative positions to them; see `rolled`."""
    points.forces[:] = motion.forces
    points.anchors[:] = motion.anchors
    points.relative[:] = motion.relative
    n = len(column.rim)
    before = motion.scalars[RIM_ANGLE]
    if n == 0:
        return
    rotation = np.empty((3, 3))
    turn_by(motion.rotation, dt / 2 * motion.spin, rotation)
    angle, tilt = lowest(rotation)
    last = column.rim_first if np.isnan(before) else before
    if tilt < FLAT:
        if not (before == points.angle[0] or np.isnan(before) and np.isnan(points.angle[0])) or points.lift.any():
            place(column, points, before)
        return

    sector = column.rim_sector
    turn = (angle - last + np.pi) % (2 * np.pi) - np.pi
    carrying, beside = False, np.inf
    for k in range(n):
        if motion.forces[column.rim[k], 2] > 0:
            carrying = True
            off = (column.rim_first + k * sector - angle) / sector
            beside = min(beside, abs((off + n / 2) % n - n / 2))
    leaps = abs(turn) > REACH * sector
    if leaps and carrying and not beside <= REACH:
        place(column, points, last)
        # as long as the old part of the rim carries, the angle is not taken over
        points.angle[0] = before
        return
    if leaps:
        turn = (turn / sector + 0.5) % 1 * sector - sector / 2

    places = np.empty((n, 3))
    for k in range(n):
        i = column.rim[k]
        for a in range(3):
            places[k, a] = motion.center[a]
            for b in range(3):
                places[k, a] += motion.rotation[a, b] * (column.arms[i, b] + motion.elastic[i, b])
    old_index, old_offsets, old_weights = on_circle(last, column.rim_first, sector, n)
    new_index = place(column, points, last + turn)
    _, new_offsets, new_weights = on_circle(last + turn, column.rim_first, sector, n)
    like_index, like_offsets, like_weights = on_circle(last + turn + lowest(motion.rotation)[0] - angle, column.rim_first, sector, n)
    old, now = np.empty(3), np.empty(3)
    for k in range(n):
        i = column.rim[k]
        number = (k - new_index + old_index) % n
        taken = column.rim[number]
        old[:] = 0.0
        now[:] = 0.0
        for q in range(4):
            for a in range(3):
                old[a] += old_weights[q] * places[(number + old_offsets[q]) % n, a]
                now[a] += new_weights[q] * places[(k + new_offsets[q]) % n, a]
        near = abs((k - new_index + n // 2) % n - n // 2) <= REACH
        lift = 0.0
        if near:
            height = 0.0
            for q in range(4):
                height += like_weights[q] * places[((k - new_index + like_index) % n + like_offsets[q]) % n, 2]
            lift = height - now[2]
        points.lift[i] = lift
        up = 0.0 if near and not leaps else now[2] - old[2] + lift
        for a in range(3):
            points.forces[i, a] = motion.forces[taken, a]
        for a in range(2):
            points.anchors[i, a] = motion.anchors[taken, a] + now[a] - old[a]
            points.relative[i, a] = motion.relative[taken, a] + now[a] - old[a]
        points.relative[i, 2] = motion.relative[taken, 2] + up
