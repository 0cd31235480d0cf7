"""Feet that are not flat: a dome, which is a part of one ball, and a rounded edge, which is a ball
of small radius about each contact point.

A ball of radius r about a centre c of a body touches a plane with the normal n, seen from the body,
at c - r n. The place moves over the body as it turns, and the body rolls.

For a step it is that of the rotation halfway, R_h. The material point there moves by that of the
centre less r (R_1 - R_0) n_h, which is level: its gap changes as that of the ball does, its slip is
that of the ball, and the contact force does the work of rolling and no other (a discrete gradient,
Gonzalez 1996). What the forecast of R_h leaves of it, r dt^2 w^2 / 8 at an angular velocity w, and
what the edge of a dome leaves, is held as a height of the points while the foot carries, so that it
makes no energy.
"""

from __future__ import annotations

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record


@njit
def from_center(interface: Record, normal: Array, offset: Array) -> None:
    """Offset (3,) [m]: from a ball's centre to where it touches a plane with the unit normal (3,),
    both in the frame of the body that carries it.

    A dome ends at its edge, a circle or the sides of a rectangle: beyond them it touches with the
    lowest point of its edge.
    """
    r, x, y = interface.ball, interface.edge[0], interface.edge[1]
    for a in range(3):
        offset[a] = -r * normal[a]
    side = -1.0 if normal[2] > 0 else 1.0
    if x <= 0.0:
        return
    if y <= 0.0:
        out = np.hypot(offset[0], offset[1])
        if out > x:
            offset[0], offset[1], offset[2] = (
                offset[0] * x / out,
                offset[1] * x / out,
                side * np.sqrt(max(r * r - x * x, 0.0)),
            )
        return
    beyond_x, beyond_y = abs(offset[0]) > x, abs(offset[1]) > y
    if not (beyond_x or beyond_y):
        return
    end_x, end_y = x if offset[0] > 0 else -x, y if offset[1] > 0 else -y
    if beyond_x:
        # the arc in which a side cuts the ball
        arc = np.sqrt(r * r - x * x) / np.hypot(normal[1], normal[2])
        if abs(arc * normal[1]) <= y:
            offset[0], offset[1], offset[2] = end_x, -arc * normal[1], -arc * normal[2]
            return
    if beyond_y:
        arc = np.sqrt(r * r - y * y) / np.hypot(normal[0], normal[2])
        if abs(arc * normal[0]) <= x:
            offset[0], offset[1], offset[2] = -arc * normal[0], end_y, -arc * normal[2]
            return
    offset[0], offset[1], offset[2] = end_x, end_y, side * np.sqrt(r * r - x * x - y * y)


@njit
def remove_lift(points: Array, number: int) -> None:
    """Take from the points of an interface the heights of the last step."""
    for i in range(len(points)):
        if points[i].interface == number:
            points[i].lift = 0.0


@njit
def roll_on(
    rim_state: Record, number: int, way: Array, contact: Array, points: Array, before: Array
) -> None:
    """Bring what the points of an interface carry to their places of this step, which lie `way`
    (3,) [m] from those of the last one.

    A point that sticks goes on sticking. While the foot carries, its gaps stay as they are: the
    height by which they would change is kept in `raised`. Once nothing carries, `raised` is given
    back to the gaps.

    Parameters
    ----------
    rim_state
        of RIM at the start of the step; changed.
    number
        of the interface.
    contact
        (P,) of CONTACT at the start
    before
        what it brings to the points of the step.
    """
    carries, up = False, way[2]
    for i in range(len(points)):
        carries |= points[i].interface == number and contact[i].force[2] > 0
    if carries:
        rim_state.raised -= up
        up = 0.0
    else:
        up -= rim_state.raised
        rim_state.raised = 0.0
    for i in range(len(points)):
        if points[i].interface != number:
            continue
        points[i].lift += rim_state.raised
        if before[i].located:
            before[i].relative[2] += up
            for a in range(2):
                before[i].relative[a] += way[a]
                before[i].anchor[a] += way[a]
