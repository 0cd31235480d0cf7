"""Feet that touch with balls, in a step of the reduced engine: see `contact.ball`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.ball import from_center, roll_on
from fecolumn.contact.pose import SLAVE
from fecolumn.engines.reduced.elastic import END, START, find_elastic
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Structure
    from fecolumn.engines.reduced.motion import MotionState


@njit
def roll_balls(
    structure: Structure, k: int, work: Work, start: MotionState, end: MotionState
) -> None:
    """Place the points of interface k where their balls touch in the middle of the step; `end` gets
    the state of the foot.

    The poses of `work` are those of the start and of the middle; the points of a round rim have
    their places on it.
    """
    interface, points, now = structure.interfaces[k], work.points, work.poses[START, k].turned
    first, last, normal, moved, way = (
        np.empty(3),
        np.empty(3),
        np.empty(3),
        np.zeros(3),
        np.zeros(3),
    )
    placed = False
    for a in range(3):
        normal[a] = start.rims[k].normal[a]
        placed |= normal[a] != 0.0
    if not placed:
        for a in range(3):
            normal[a] = now[SLAVE, 2, a]
    from_center(interface, normal, first)
    for a in range(3):
        normal[a] = end.rims[k].normal[a] = work.poses[END, k].turned[SLAVE, 2, a]
    from_center(interface, normal, last)
    for i in range(len(points)):
        if points[i].interface != k:
            continue
        if interface.edge[0] > 0.0:
            _carry_dome(structure, work, i, start, first, -1.0, moved)
            _carry_dome(structure, work, i, start, last, 1.0, moved)
        for a in range(3):
            points[i].arm[a] = last[a]
        # of a dome the first carrier is the centre of the ball, the weights of the others are ways
        for q in range(1 if interface.edge[0] > 0.0 else points[i].count):
            for a in range(3):
                points[i].arm[a] += (
                    points[i].weights[q] * structure.bodies.arms[points[i].carriers[q], a]
                )
    for a in range(3):
        for c in range(3):
            way[a] += now[SLAVE, a, c] * (last[c] - first[c] + moved[c])
    roll_on(end.rims[k], k, way, start.contact, points, work.before)


@njit
def _carry_dome(
    structure: Structure,
    work: Work,
    i: int,
    start: MotionState,
    offset: Array,
    sign: float,
    moved: Array,
) -> None:
    """Let the foot's mean motion and its tilts carry the point i of a dome at `offset` (3,) [m]
    from the centre of the ball; adds its elastic displacement at the start to moved (3,).
    """
    point = work.points[i]
    point.count = 4
    point.carriers[0] = point.carriers[1] = point.node
    point.carriers[2], point.carriers[3] = point.node + 1, point.node + 2
    point.weights[0], point.weights[1], point.weights[2], point.weights[3] = (
        1.0,
        0.0,
        offset[0],
        offset[1],
    )
    find_elastic(structure, work.points, i, start, work.elastic, START)
    for a in range(3):
        moved[a] += sign * work.elastic.point[START, i, a]
