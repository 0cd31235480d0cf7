"""How a point of a joint with two sides is carried by nodes, and what it takes along when it moves
or changes bodies.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.rim import on_circle
from fecolumn.contact.tolerances import SAME_CORNER
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.overlap import Overlaps


@njit
def on_face(arm: Array, interface: Record) -> tuple[float, float]:
    """Place x, y [m] of an arm (3,) on the face that is the master's surface of an interface."""
    x = y = 0.0
    for a in range(3):
        away = arm[a] - interface.origin[a]
        x, y = x + interface.axes[a, 0] * away, y + interface.axes[a, 1] * away
    return x, y


@njit
def _place_in_frame(
    interface: Record, frames: Array, pose: Record, arm: Array, place: Array
) -> None:
    """Place (3,) [m] of an arm of the slave, which does not give, in the frame of an interface."""
    center = frames[interface.slave].center
    for a in range(3):
        place[a] = 0.0
        for c in range(3):
            place[a] += pose.turned[0, a, c] * arm[c] + pose.frame[c, a] * (
                center[c] - pose.origin[c]
            )


@njit
def carry_by_node(point: Record, node: int, arms: Array) -> None:
    """Let a point be a node."""
    point.count = 1
    for q in range(4):
        point.carriers[q], point.weights[q] = node, 1.0 if q == 0 else 0.0
    for a in range(3):
        point.arm[a] = arms[node, a]


@njit
def carry_by_outline(
    overlaps: Overlaps,
    joint: Record,
    which: int,
    side: int,
    place: Array,
    interface: Record,
    other: Record,
    rim: Array,
    points: Array,
    i: int,
    arms: Array,
) -> None:
    """Place point i on the outline `which`, OWN or OTHER, at `place` (2,) [m]: find the nodes that
    carry it and their shares.

    side: of the outline that is near to the place; -1 where the outline is a circle. other: the
    interface in which the face with that outline is the master's surface.
    """
    point = points[i]
    if side >= 0:
        _carry_on_side(overlaps.sides[side], overlaps.nodes, place, point)
    else:
        x, y = place[0] - joint.center[which, 0], place[1] - joint.center[which, 1]
        angle = np.arctan2(
            other.axes[1, 0] * x + other.axes[1, 1] * y, other.axes[0, 0] * x + other.axes[0, 1] * y
        )
        offsets, n = np.empty(4, np.int64), interface.rim_count
        index = on_circle(angle, interface.rim_angle, interface.sector, n, offsets, point.weights)[
            0
        ]
        point.count = 4
        for q in range(4):
            point.carriers[q] = points[rim[interface.rim_first + (index + offsets[q]) % n]].node
    for a in range(3):
        point.arm[a] = 0.0
        for q in range(point.count):
            point.arm[a] += point.weights[q] * arms[point.carriers[q], a]


@njit
def _carry_on_side(side: Record, nodes: Array, place: Array, point: Record) -> None:
    """Let a point be carried by the two nodes of a side beside it, and where it is off the side, by
    the farthest one.
    """
    x, y = place[0] - side.start[0], place[1] - side.start[1]
    along, inwards = x * side.along[0] + y * side.along[1], -x * side.normal[0] - y * side.normal[1]
    far = inwards / side.far_place[1]
    if abs(far) < 1e-13:
        far = 0.0
    along = (along - far * side.far_place[0]) / (1 - far)
    q = side.first
    while q < side.first + side.count - 2 and nodes[q + 1].at < along:
        q += 1
    last = min(q + 1, side.first + side.count - 1)
    share = (along - nodes[q].at) / (nodes[last].at - nodes[q].at) if last > q else 0.0
    point.count = 2 if far == 0.0 else 3
    point.carriers[0], point.carriers[1], point.carriers[2] = (
        nodes[q].node,
        nodes[last].node,
        side.far,
    )
    point.carriers[3] = nodes[q].node
    point.weights[0], point.weights[1], point.weights[2] = (
        (1 - far) * (1 - share),
        (1 - far) * share,
        far,
    )
    point.weights[3] = 0.0


@njit
def move_inwards(
    interface: Record,
    rim: Array,
    q: int,
    points: Array,
    point: Record,
    share: float,
    arms: Array,
    way: Array,
) -> None:
    """Move a point of a rim towards the middle by a share of the diameter: way (3,) [m] by which it
    goes.
    """
    n = interface.rim_count
    far = points[rim[interface.rim_first + (q + n // 2) % n]].node
    if point.count == 1:
        point.count, point.carriers[1], point.weights[1] = 2, far, 0.0
        first, last = 1, 1
    else:
        # the last two are at the other side
        first, last = 2, 3
    for c in range(4):
        point.weights[c] *= 1 - share
    for c in range(first, last + 1):
        point.weights[c] += share / (last - first + 1)
    for a in range(3):
        before = point.arm[a]
        point.arm[a] = 0.0
        for c in range(point.count):
            point.arm[a] += point.weights[c] * arms[point.carriers[c], a]
        way[a] = point.arm[a] - before


@njit
def deactivate_point(i: int, points: Array, before: Array) -> bool:
    """Let point i take no part; whether it did in the step before."""
    changed, contact = not points[i].idle, before[i]
    points[i].idle = True
    for a in range(3):
        contact.force[a] = 0.0
    contact.raised = 0.0
    contact.located = contact.beyond = contact.present = False
    return changed


@njit
def bring(
    i: int,
    gone: int,
    interfaces: Array,
    frames: Array,
    poses: Array,
    contact: Array,
    points: Array,
    before: Array,
    size: float,
    lay: bool,
) -> None:
    """Bring to point i, which is in its place, what it carried in the step before.

    If it took no part then, it takes over from point `gone`, which was in this place in the
    interface with the roles exchanged. If that carried nothing, the point begins afresh: the edges
    may cross elsewhere now, where the gap is another. lay: the points are laid for the first time.
    """
    point, now, jump = points[i], before[i], 0.0
    turned = poses[point.interface].turned[0]
    for a in range(3):
        jump = max(jump, abs(point.arm[a] - now.arm[a]))
    if now.present and jump <= SAME_CORNER * size:
        for a in range(3):
            way = 0.0
            for c in range(3):
                way += turned[a, c] * (point.arm[c] - now.arm[c])
            now.relative[a] += way
            if a < 2:
                now.anchor[a] += way
    elif gone >= 0 and contact[gone].present and contact[gone].force[2] > 0.0:
        _exchange(i, gone, interfaces, frames, poses, contact, points, before)
    elif not lay or point.count > 1:
        activate_point(now)
        now.beyond = not lay
    now.present = True
    for a in range(3):
        now.arm[a] = point.arm[a]


@njit
def _exchange(
    i: int,
    gone: int,
    interfaces: Array,
    frames: Array,
    poses: Array,
    contact: Array,
    points: Array,
    before: Array,
) -> None:
    """Let point i take over force, slip and gap of a point `gone` of the interface with the roles
    exchanged.
    """
    new, old, was, now = (
        poses[points[i].interface],
        poses[points[gone].interface],
        contact[gone],
        before[i],
    )
    place, place_before = np.empty(3), np.empty(3)
    _place_in_frame(interfaces[points[i].interface], frames, new, points[i].arm, place)
    _place_in_frame(interfaces[points[gone].interface], frames, old, was.arm, place_before)
    for a in range(3):
        force = moved = slip = 0.0
        for c in range(3):
            turn = (
                new.frame[0, a] * old.frame[0, c]
                + new.frame[1, a] * old.frame[1, c]
                + new.frame[2, a] * old.frame[2, c]
            )
            force -= turn * was.force[c]
            # what bodies give, over their rigid motion
            moved -= turn * (was.relative[c] - place_before[c])
            slip -= turn * (was.relative[c] - was.anchor[c]) if c < 2 else 0.0
        now.force[a], now.relative[a] = force, place[a] + moved
        if a < 2:
            now.anchor[a] = now.relative[a] - slip
    now.relative[2], now.raised = was.relative[2], was.raised
    now.located, now.beyond = True, was.beyond
    if not now.force[2] > 0.0:
        for a in range(3):
            now.force[a] = 0.0


@njit
def activate_point(now: Record) -> None:
    """Let a point, of CONTACT, take part that did not before: it must be above the surface to
    carry.
    """
    for a in range(3):
        now.force[a] = 0.0
    now.located, now.beyond, now.raised = False, True, 0.0
