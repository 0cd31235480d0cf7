"""Which of its two interfaces a point of a joint with two sides belongs to, and what takes a
corner.
"""

from __future__ import annotations

import numpy as np

from fecolumn.contact.moved_points import on_face
from fecolumn.contact.overlap import OTHER, OWN, beyond
from fecolumn.contact.tolerances import FLAT, ONE_CORNER, OUTLINE_BAND, SAME_CORNER, SAME_OUTLINE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

# What a slot was in the step before
NONE, FORWARD, REVERSE = range(3)


@njit
def choose_corners(
    slots: Array,
    interfaces: Array,
    k: int,
    r: int,
    out: Array,
    at: Array,
    contact: Array,
    slope: Array,
    shift: Array,
    other: Array,
    size: float,
    chosen: Array,
) -> None:
    """Give each corner of the region, at `other` (n, 2) [m] on the master's face, the slot that was
    nearest to it in the step before, or else that of the nearest corner of the slave's face, or a
    free one; none where a corner of the slave's face is still there. chosen: (slots,) corner of
    each.
    """
    taken = np.zeros(len(other), np.bool_)
    for s in range(len(slots)):
        if slots[s].corner and abs(out[s]) <= SAME_OUTLINE * size:
            v = _nearest(other, taken, at[s, 0], at[s, 1], ONE_CORNER * size)
            if v >= 0:
                taken[v] = True
    for s in range(len(slots)):
        if not (slots[s].free or slots[s].corner and out[s] > SAME_OUTLINE * size):
            continue
        found, x, y = _place_before(slots[s], interfaces, k, r, contact, slope, shift)
        v = _nearest(other, taken, x, y, SAME_CORNER * size) if found else -1
        if v >= 0:
            chosen[s], taken[v] = v, True
    for s in range(len(slots)):
        if chosen[s] < 0 and slots[s].corner and out[s] > SAME_OUTLINE * size:
            v = _nearest(other, taken, at[s, 0], at[s, 1], np.inf)
            if v >= 0:
                chosen[s], taken[v] = v, True
    for s in range(len(slots)):
        if chosen[s] < 0 and slots[s].free:
            v = _nearest(other, taken, 0.0, 0.0, np.inf)
            if v >= 0:
                chosen[s], taken[v] = v, True


@njit
def _place_before(
    slot: Record, interfaces: Array, k: int, r: int, contact: Array, slope: Array, shift: Array
) -> tuple[bool, float, float]:
    """Whether a slot took part in the step before, and the place x, y [m] on the master's face
    where it is now.
    """
    i, j = slot.forward, slot.reverse
    if contact[i].present:
        x, y = on_face(contact[i].arm, interfaces[r])
        return (
            True,
            slope[0, 0] * x + slope[0, 1] * y + shift[0],
            slope[1, 0] * x + slope[1, 1] * y + shift[1],
        )
    if j >= 0 and contact[j].present:
        x, y = on_face(contact[j].arm, interfaces[k])
        return True, x, y
    return False, 0.0, 0.0


@njit
def _nearest(places: Array, taken: Array, x: float, y: float, within: float) -> int:
    """Number of the nearest of places (n, 2) that is not taken, at most `within` [m] away, or
    -1.
    """
    found, least = -1, within
    for v in range(len(places)):
        away = np.hypot(places[v, 0] - x, places[v, 1] - y)
        if not taken[v] and (away < least or found < 0 and away <= least):
            found, least = v, away
    return found


@njit
def may_stay(slot: Record, points: Array, before: Array, arms: Array) -> bool:
    """Whether a slot is a node of the slave that takes part where it is and did so in the step
    before, so that it brings itself.
    """
    i, j = slot.forward, slot.reverse
    if (
        slot.free
        or points[i].count != 1
        or points[i].idle
        or j >= 0
        and not (points[j].idle and not before[j].located)
    ):
        return False
    for a in range(3):
        if not before[i].arm[a] == points[i].arm[a] == arms[points[i].node, a]:
            return False
    return True


@njit
def is_near_any(places: Array, place: Array, within: float) -> bool:
    """Whether any of places (n, 2) is nearer than `within` [m]."""
    for v in range(len(places)):
        x, y = abs(places[v, 0] - place[0]), abs(places[v, 1] - place[1])
        if x < within and y < within and np.hypot(x, y) < within:
            return True
    return False


@njit
def is_near_inner_node(slots: Array, at: Array, place: Array, within: float) -> bool:
    """Whether a node inside the slave's face is nearer than `within` [m] to a place (2,) on the
    master's; at: (slots, 2) where the slots' nodes are there.
    """
    for s in range(len(slots)):
        if slots[s].side < 0 and not slots[s].free and is_near_any(at[s : s + 1], place, within):
            return True
    return False


@njit
def role_of_corner(
    joint: Record,
    sides: Array,
    own_side: int,
    other_side: int,
    own_place: Array,
    other_place: Array,
    slope: Array,
    x_down: float,
    y_down: float,
    was: int,
) -> int:
    """Whether a corner of the region is a point of the slave or of the master: of the body over
    whose edge the slave leans.
    """
    if beyond(joint, sides, OWN, own_place[0], own_place[1])[0] < -OUTLINE_BAND * joint.size:
        return REVERSE
    tilt = np.hypot(x_down, y_down)
    if tilt < FLAT:
        return was if was != NONE else FORWARD
    u, v = _normal(joint, sides, OWN, own_side, own_place)
    over_own = x_down * (slope[0, 0] * u + slope[0, 1] * v) + y_down * (
        slope[1, 0] * u + slope[1, 1] * v
    )
    u, v = _normal(joint, sides, OTHER, other_side, other_place)
    over_other = x_down * u + y_down * v
    if abs(over_own - over_other) < 1e-3 * tilt and was != NONE:
        return was
    return REVERSE if over_other > over_own else FORWARD


@njit
def _normal(
    joint: Record, sides: Array, which: int, side: int, place: Array
) -> tuple[float, float]:
    """Outward normal of an outline in a place on it."""
    if side >= 0:
        return sides[side].normal[0], sides[side].normal[1]
    x, y = place[0] - joint.center[which, 0], place[1] - joint.center[which, 1]
    length = max(np.hypot(x, y), 1e-300)
    return x / length, y / length


@njit
def role_of_node(
    joint: Record,
    sides: Array,
    slot: Record,
    out: float,
    side: int,
    place: Array,
    back: Array,
    back_shift: Array,
    own_place: Array,
    was: int,
) -> int:
    """Role of a node of the slave's face that is `out` [m] beyond the master's outline; one that is
    beyond it is moved to the edge there, in `place` on the master's face and `own_place` on the
    slave's.
    """
    band = OUTLINE_BAND * joint.size
    if slot.side < 0:
        return FORWARD if out <= band else NONE
    if out <= SAME_OUTLINE * joint.size:
        return REVERSE if was == REVERSE and out > -band else FORWARD
    if out > band and slot.reverse < 0:
        return NONE
    if side >= 0:
        for a in range(2):
            place[a] -= out * sides[side].normal[a]
        way = (place[0] - sides[side].start[0]) * sides[side].along[0] + (
            place[1] - sides[side].start[1]
        ) * sides[side].along[1]
        if way < 0.0 or way > sides[side].length:
            return NONE
    else:
        u, v = _normal(joint, sides, OTHER, -1, place)
        place[0], place[1] = place[0] - out * u, place[1] - out * v
    own_place[0] = back[0, 0] * place[0] + back[0, 1] * place[1] + back_shift[0]
    own_place[1] = back[1, 0] * place[0] + back[1, 1] * place[1] + back_shift[1]
    if beyond(joint, sides, OWN, own_place[0], own_place[1])[0] > band:
        return NONE
    if out > band:
        return REVERSE
    return was if was != NONE else FORWARD
