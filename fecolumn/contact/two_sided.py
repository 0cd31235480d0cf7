"""Contact points of joints with two sides: on the outline of the region where both faces overlap,
at every moment.

Within a step a point is a place of one body, as any contact point is. At the start of each step the
points are laid anew on the corners and edges of the region (`contact.overlap`). Where an edge of
the master bounds it, the points are places of the master that touch the face of the slave: they
belong to the interface with the roles exchanged, so that the normal of contact is that of the face
that slides over the edge. A point that moves, or that changes from one interface to the other,
takes along its force and where it sticks (`contact.moved_points`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.moved_points import (
    activate_point,
    bring,
    carry_by_node,
    carry_by_outline,
    deactivate_point,
    move_inwards,
    on_face,
)
from fecolumn.contact.overlap import (
    OTHER,
    OWN,
    beyond,
    find_corners,
    height_over,
    lies_within,
    map_between,
)
from fecolumn.contact.roles import (
    FORWARD,
    NONE,
    REVERSE,
    choose_corners,
    is_near_any,
    is_near_inner_node,
    may_stay,
    role_of_corner,
    role_of_node,
)
from fecolumn.contact.tolerances import APART, OUTLINE_BAND, SAME_OUTLINE, SAME_POINT
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.overlap import Overlaps


@njit
def mark_unused(
    overlaps: Overlaps, interfaces: Array, frames: Array, poses: Array, rims: Array
) -> None:
    """Mark the reverse interfaces that no point of needs, as the slave's face lies within the
    master's: `unused` in rims (ni,) of RIM at the end of the step.
    """
    slope, shift = np.empty((3, 2)), np.empty(3)
    for j in range(len(overlaps.joints)):
        joint = overlaps.joints[j]
        if rims[joint.forward].apart and not rims[joint.forward].plain:
            # `place_overlaps` asks for it where they come near
            rims[joint.reverse].unused = joint.within = False
            continue
        map_between(
            interfaces[joint.forward],
            interfaces[joint.reverse],
            frames,
            poses[joint.forward],
            slope,
            shift,
        )
        joint.within = lies_within(joint, overlaps.sides, slope, shift)
        unused = rims[joint.forward].plain and joint.within
        rims[joint.reverse].unused = unused
        if unused:
            rims[joint.reverse].angle = np.nan


@njit
def place_overlaps(
    overlaps: Overlaps,
    interfaces: Array,
    rim: Array,
    arms: Array,
    ways: Array,
    frames: Array,
    poses: Array,
    contact: Array,
    rims: Array,
    points: Array,
    before: Array,
) -> bool:
    """Lay the points of all joints with two sides, none where the faces are apart; whether other
    points take part than in the step before.

    Parameters
    ----------
    rim
        points on the circles of all interfaces.
    arms
        (N, 3) of the nodes [m].
    ways
        (nb, 2) way of the centre of mass [m] and turn [rad] of each body in a step.
    frames
        (nb,) with the centres of mass, poses: (ni,) of POSE and contact: (P,) of CONTACT at the
        start of the step.
    rims
        (ni,) of RIM at its end.
    points
        (P,) of POINT and before: (P,) of CONTACT, changed; before has what `contact`, or a rim that
        rolled, brings.
    """
    changed = False
    for j in range(len(overlaps.joints)):
        joint = overlaps.joints[j]
        if rims[joint.reverse].unused and joint.plain:
            continue
        was_apart = rims[joint.forward].apart and rims[joint.forward].placed
        apart = _is_apart(overlaps, joint, interfaces, ways, frames, poses)
        rims[joint.forward].apart = rims[joint.reverse].apart = apart
        if apart and was_apart and joint.left:
            # nothing has changed: its points brought nothing, and none takes part
            joint.plain = rims[joint.forward].plain = False
            continue
        joint.left = apart
        if apart:
            joint.plain = rims[joint.forward].plain = False
            rims[joint.forward].placed = True
            for k in (joint.forward, joint.reverse):
                changed |= _leave_rim(interfaces[k], rim, points, before)
            for slot in overlaps.slots[joint.slot : joint.slot + joint.slots]:
                changed |= deactivate_point(slot.forward, points, before)
                if slot.reverse >= 0:
                    changed |= deactivate_point(slot.reverse, points, before)
            continue
        changed |= _place(
            overlaps,
            joint,
            interfaces,
            rim,
            arms,
            frames,
            poses,
            contact,
            rims,
            points,
            before,
            was_apart,
        )
        rims[joint.forward].placed = True
    return changed


@njit
def _is_apart(
    overlaps: Overlaps, joint: Record, interfaces: Array, ways: Array, frames: Array, poses: Array
) -> bool:
    """Whether no point of a joint can touch in a step, as its faces are too far from each other."""
    k, r = joint.forward, joint.reverse
    slope, shift, way = np.empty((3, 2)), np.empty(3), 0.0
    for side in range(2):
        b = interfaces[r if side else k].slave
        way += ways[b, 0] + ways[b, 1] * joint.arm[side]
    map_between(interfaces[k], interfaces[r], frames, poses[k], slope, shift)
    return height_over(joint, overlaps.sides, slope, shift) > APART * joint.size + 2 * way


@njit
def _leave_rim(interface: Record, rim: Array, points: Array, before: Array) -> bool:
    """Let the points of a round rim take no part; whether any did in the step before."""
    changed = False
    for q in range(interface.rim_count):
        changed |= deactivate_point(rim[interface.rim_first + q], points, before)
    return changed


@njit
def _place(
    overlaps: Overlaps,
    joint: Record,
    interfaces: Array,
    rim: Array,
    arms: Array,
    frames: Array,
    poses: Array,
    contact: Array,
    rims: Array,
    points: Array,
    before: Array,
    was_apart: bool,
) -> bool:
    """`place_overlaps` of one joint; was_apart: whether its faces were in the step before."""
    k, r, sides, size = joint.forward, joint.reverse, overlaps.sides, joint.size
    most = 2 * (joint.count[OWN] + joint.count[OTHER]) + joint.count[OTHER] + 3
    own, other, on = np.empty((most, 2)), np.empty((most, 2)), np.empty((most, 2), np.int64)
    slope, shift, back, back_shift = np.empty((3, 2)), np.empty(3), np.empty((3, 2)), np.empty(3)
    map_between(interfaces[k], interfaces[r], frames, poses[k], slope, shift)
    map_between(interfaces[r], interfaces[k], frames, poses[r], back, back_shift)
    if was_apart:
        joint.within = lies_within(joint, sides, slope, shift)
    count = find_corners(joint, sides, slope, shift, back, back_shift, own, other, on)
    slots, axes = overlaps.slots[joint.slot : joint.slot + joint.slots], interfaces[r].axes
    # where the slave's face inclines, in the plane of the master's
    turned, x_down, y_down = poses[k].turned[0], 0.0, 0.0
    for c in range(3):
        x_down -= turned[0, c] * axes[c, 2]
        y_down -= turned[1, c] * axes[c, 2]
    out, at = np.empty(len(slots)), np.empty((len(slots), 2))
    chosen, nearest = np.full(len(slots), -1, np.int64), np.empty(len(slots), np.int64)
    for s in range(len(slots)):
        at[s, 0] = slope[0, 0] * slots[s].place[0] + slope[0, 1] * slots[s].place[1] + shift[0]
        at[s, 1] = slope[1, 0] * slots[s].place[0] + slope[1, 1] * slots[s].place[1] + shift[1]
        out[s], nearest[s] = beyond(joint, sides, OTHER, at[s, 0], at[s, 1])
    choose_corners(
        slots, interfaces, k, r, out, at, contact, slope, shift, other[:count], size, chosen
    )
    changed, plain, lay = False, count == 0, not rims[k].placed
    own_place, other_place = np.empty(2), np.empty(2)
    for s in range(len(slots)):
        slot = slots[s]
        was = FORWARD if contact[slot.forward].present else NONE
        if slot.reverse >= 0 and contact[slot.reverse].present:
            was = REVERSE
        role, own_side, other_side, v = NONE, slot.side, nearest[s], chosen[s]
        if (
            v < 0
            and slot.free
            and was == NONE
            and points[slot.forward].idle
            and points[slot.reverse].idle
        ):
            continue
        if (
            v < 0
            and was == FORWARD
            and out[s] <= SAME_OUTLINE * size
            and may_stay(slot, points, before, arms)
            and (slot.corner or not is_near_any(other[:count], at[s], SAME_POINT * size))
        ):
            continue
        if v >= 0:
            own_side, other_side = on[v, OWN], on[v, OTHER]
            for a in range(2):
                own_place[a], other_place[a] = own[v, a], other[v, a]
            in_band = not slot.free and out[s] <= OUTLINE_BAND * size
            role = (
                was
                if in_band and was != NONE
                else FORWARD
                if in_band
                else role_of_corner(
                    joint,
                    sides,
                    own_side,
                    other_side,
                    own_place,
                    other_place,
                    slope,
                    x_down,
                    y_down,
                    was,
                )
            )
        elif not slot.free and not (slot.corner and out[s] > SAME_OUTLINE * size):
            for a in range(2):
                own_place[a], other_place[a] = slot.place[a], at[s, a]
            role = role_of_node(
                joint,
                sides,
                slot,
                out[s],
                other_side,
                other_place,
                back,
                back_shift,
                own_place,
                was,
            )
            if (
                role != NONE
                and not slot.corner
                and (
                    is_near_any(other[:count], other_place, SAME_POINT * size)
                    or role == REVERSE
                    and is_near_inner_node(slots, at, other_place, SAME_POINT * size)
                )
            ):
                role = NONE
        if role == REVERSE and slot.reverse < 0:
            role = NONE
        plain &= (
            role == FORWARD
            and own_place[0] == slot.place[0]
            and own_place[1] == slot.place[1]
            or slot.free
        )
        if role != FORWARD:
            changed |= deactivate_point(slot.forward, points, before)
        if role != REVERSE and slot.reverse >= 0:
            changed |= deactivate_point(slot.reverse, points, before)
        if role == NONE:
            continue
        i, gone = (slot.forward, slot.reverse) if role == FORWARD else (slot.reverse, slot.forward)
        changed |= points[i].idle
        points[i].idle = False
        if (
            role == FORWARD
            and not slot.free
            and own_place[0] == slot.place[0]
            and own_place[1] == slot.place[1]
        ):
            carry_by_node(points[i], points[i].node, arms)
        elif role == FORWARD:
            carry_by_outline(
                overlaps,
                joint,
                OWN,
                own_side,
                own_place,
                interfaces[k],
                interfaces[r],
                rim,
                points,
                i,
                arms,
            )
        else:
            carry_by_outline(
                overlaps,
                joint,
                OTHER,
                other_side,
                other_place,
                interfaces[r],
                interfaces[k],
                rim,
                points,
                i,
                arms,
            )
        bring(i, gone, interfaces, frames, poses, contact, points, before, size, lay)
    if joint.radius[OWN] > 0.0:
        changed |= _place_rim(
            joint,
            sides,
            OTHER,
            k,
            interfaces,
            rim,
            slope,
            shift,
            poses[k].turned[0],
            arms,
            points,
            before,
            other[:count],
            lay,
        )
    if joint.radius[OTHER] > 0.0:
        changed |= _place_rim(
            joint,
            sides,
            OWN,
            r,
            interfaces,
            rim,
            back,
            back_shift,
            poses[r].turned[0],
            arms,
            points,
            before,
            own[:count],
            lay,
        )
    joint.plain = rims[k].plain = plain and joint.within
    return changed


@njit
def _place_rim(
    joint: Record,
    sides: Array,
    limit: int,
    k: int,
    interfaces: Array,
    rim: Array,
    slope: Array,
    shift: Array,
    turned: Array,
    arms: Array,
    points: Array,
    before: Array,
    corners: Array,
    lay: bool,
) -> bool:
    """Points of the round rim of interface k: those beyond the outline `limit` are moved to it if
    they are hardly beyond, else they take no part; of the master's rim those take part that are
    within the slave's outline.
    """
    interface, face, changed, way = (
        interfaces[k],
        interfaces[joint.reverse if limit == OTHER else joint.forward],
        False,
        np.empty(3),
    )
    place, band = np.empty(2), OUTLINE_BAND * joint.size
    for q in range(interface.rim_count):
        i = rim[interface.rim_first + q]
        point, now = points[i], before[i]
        x, y = on_face(point.arm, face)
        place[0] = slope[0, 0] * x + slope[0, 1] * y + shift[0]
        place[1] = slope[1, 0] * x + slope[1, 1] * y + shift[1]
        out, side = beyond(joint, sides, limit, place[0], place[1])
        takes = out <= band if limit == OTHER else out < -band
        takes = takes and not is_near_any(corners, place, SAME_POINT * joint.size)
        if not takes:
            changed |= deactivate_point(i, points, before)
            continue
        changed |= point.idle
        point.idle = False
        for a in range(3):
            way[a] = 0.0
        if out > SAME_OUTLINE * joint.size:
            move_inwards(interface, rim, q, points, point, out / (2 * interface.radius), arms, way)
        if now.present or lay:
            for a in range(3):
                moved = 0.0
                for c in range(3):
                    moved += turned[a, c] * (way[c] - now.arm[c])
                now.relative[a] += moved
                if a < 2:
                    now.anchor[a] += moved
        else:
            activate_point(now)
        now.present = True
        for a in range(3):
            now.arm[a] = way[a]
    return changed
