"""Contact points of a step: the foot's nodes, but for those of a round rim, which roll along it (`dynamics.rolling`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.rim import on_circle
from fecolumn.dynamics.rolling import FLAT, REACH, ROLL
from fecolumn.reduced.motion import RIM_ANGLE, RIM_LIFT, turn_by


class Points(NamedTuple):
    """Contact points of a step in their slots, and what they bring from the step before.

    carriers, weights: (n, 4) foot nodes that carry each point, the first `count` (n,) of them; arms: (n, 3) of the points;
    lift: (n,) height given to points of the rim; forces, anchors, relative, indent: those of the start, rolled along.
    angle: (1,) place of the rim's lowest contact point; rim_lift: (5,) of it and its neighbours.
    """

    carriers: np.ndarray
    weights: np.ndarray
    count: np.ndarray
    arms: np.ndarray
    lift: np.ndarray
    forces: np.ndarray
    anchors: np.ndarray
    relative: np.ndarray
    indent: np.ndarray
    angle: np.ndarray
    rim_lift: np.ndarray


def node_points(arms: np.ndarray) -> Points:
    """Points on the foot's nodes."""
    n = len(arms)
    carriers, weights = np.repeat(np.arange(n)[:, None], 4, axis=1), np.zeros((n, 4))
    weights[:, 0] = 1.0
    return Points(carriers, weights, np.ones(n, np.int64), arms.copy(), np.zeros(n), np.zeros((n, 3)), np.zeros((n, 2)), np.zeros((n, 3)), np.zeros((n, 3)),
                  np.array([np.nan]), np.zeros(2 * REACH + 1))


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
    index, _, offsets, weights = on_circle(angle, column.rim_first, column.rim_sector, n)
    arms, interpolated = np.empty((2 * n, 3)), np.empty((n, 3))
    for k in range(n):
        for a in range(3):
            arms[k, a] = arms[n + k, a] = column.arms[column.rim[k], a]
    _interpolate(arms, offsets, weights, interpolated)
    for k in range(n):
        i = column.rim[k]
        points.count[i] = 4
        points.lift[i] = 0.0
        for q in range(4):
            points.carriers[i, q], points.weights[i, q] = column.rim[_around(k + offsets[q], n)], weights[q]
        for a in range(3):
            points.arms[i, a] = interpolated[k, a]
    return index


@njit
def roll(column, motion, dt, rolls, points):
    """Place the points of the step `dt` that begins, and bring forces, anchors, relative positions and indentations to them; see `rolled`.

    Returns: whether they rolled.
    """
    points.forces[:] = motion.forces
    points.anchors[:] = motion.anchors
    points.relative[:] = motion.relative
    points.indent[:] = motion.indent
    n, sector = len(column.rim), column.rim_sector
    before = motion.scalars[RIM_ANGLE]
    points.rim_lift[:] = motion.scalars[RIM_LIFT:]
    if n == 0:
        return False
    rotation = np.empty((3, 3))
    turn_by(motion.rotation, dt / 2 * motion.spin, rotation)
    angle, tilt = lowest(rotation)
    old_index, old_phase, old_offsets, old_weights = on_circle(column.rim_first if np.isnan(before) else before, column.rim_first, sector, n)
    new_index, new_phase, new_offsets, new_weights = on_circle(angle, column.rim_first, sector, n)
    turned = _sectors(new_index + new_phase - old_index - old_phase, n)
    leaps = np.isnan(before) or abs(turned) * sector > ROLL
    loaded, carries, strongest, most = False, False, 0, 0.0
    for k in range(n):
        force = motion.forces[column.rim[k], 2]
        if force > 0:
            loaded = True
            past = k + old_phase - (new_index + new_phase if leaps else old_index + old_phase)
            if abs(_sectors(past, n)) <= REACH:
                carries = True
                if force > most:
                    strongest, most = k, force
    if tilt < FLAT:
        points.rim_lift[:] = np.maximum(points.rim_lift, 0.0)
    if tilt < FLAT or not rolls or leaps and loaded and not carries:
        _stay(column, points, before, old_index)
        return False
    if leaps:
        turned -= np.rint(turned)

    passed = int(np.rint(turned - new_phase + old_phase))
    places, old, now = np.empty((2 * n, 3)), np.empty((n, 3)), np.empty((n, 3))
    for k in range(n):
        i = column.rim[k]
        x, y, z = column.arms[i, 0] + motion.elastic[i, 0], column.arms[i, 1] + motion.elastic[i, 1], column.arms[i, 2] + motion.elastic[i, 2]
        for a in range(3):
            value = motion.center[a] + motion.rotation[a, 0] * x + motion.rotation[a, 1] * y + motion.rotation[a, 2] * z
            places[k, a] = places[n + k, a] = value
    like_index, _, like_offsets, like_weights = on_circle(lowest(motion.rotation)[0], column.rim_first, sector, n)
    place(column, points, angle)
    _interpolate(places, old_offsets, old_weights, old)
    _interpolate(places, new_offsets, new_weights, now)
    # heights that the lowest point's like and its neighbours have now
    like = np.zeros(2 * REACH + 1)
    for off in range(-REACH, REACH + 1):
        for q in range(4):
            like[REACH + off] += like_weights[q] * places[(like_index + off + like_offsets[q]) % n, 2]
    # what the rule leaves of the third order stays in the lift while the rim carries
    held = 0.0
    if carries:
        taken = strongest if leaps else (new_index - passed) % n
        held = old[taken, 2] - like[REACH]
        held += 0.0 if leaps else points.rim_lift[REACH]
    for k in range(n):
        number = _around(k - passed, n)
        i, taken = column.rim[k], column.rim[number]
        for a in range(3):
            points.forces[i, a] = motion.forces[taken, a]
            points.indent[i, a] = motion.indent[taken, a]
            points.relative[i, a] = motion.relative[taken, a] + now[k, a] - old[number, a]
        for a in range(2):
            points.anchors[i, a] = motion.anchors[taken, a] + now[k, a] - old[number, a]
    for off in range(-REACH, REACH + 1):
        k = (new_index + off) % n
        i, number = column.rim[k], (k - passed) % n
        points.lift[i] = points.rim_lift[REACH + off] = like[REACH + off] - now[(new_index - off) % n, 2] + held
        up = like[REACH + off] - old[number, 2] if leaps else 0.0
        points.relative[i, 2] = motion.relative[column.rim[number], 2] + up
    return True


@njit
def _sectors(number, n):
    """Distance along the rim, -n/2 to n/2."""
    return (number + n / 2) % n - n / 2


@njit
def _interpolate(values, offsets, weights, target):
    """target (n, 3): values at the rim's points from those at its nodes, (2 n, 3) since they are needed once around and again."""
    n = len(target)
    target[:] = 0.0
    flat = target.ravel()
    for q in range(4):
        first = 3 * _around(offsets[q], n)
        line, weight = values.ravel()[first:first + 3 * n], weights[q]
        for x in range(3 * n):
            flat[x] += weight * line[x]


@njit
def _around(number, n):
    """number, -n to 2 n, modulo n; a division takes longer than all else here."""
    if number < 0:
        return number + n
    return number - n if number >= n else number


@njit
def _stay(column, points, before, index):
    """Leave the rim's points where they are, at the heights that they have there."""
    n = len(column.rim)
    if not (before == points.angle[0] or np.isnan(before) and np.isnan(points.angle[0])):
        place(column, points, before)
    for i in column.rim:
        points.lift[i] = 0.0
    for off in range(-REACH, REACH + 1):
        points.lift[column.rim[(index + off) % n]] = points.rim_lift[REACH + off]
