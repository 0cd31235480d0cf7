"""Places at which two convex bodies touch or nearly do, for an axis of `contact.separation`.

Along the normal of a face, the body of the face is the master. Of the other body, the slave, that
face which faces it most among those at its nearest corner is clipped to the prism over the master's
face (Sutherland and Hodgman 1974): each corner of what is left is a place of contact. Of two edges
it is the place where they cross, and the first body is the master. Of a body over a plane ground
all its corners are.

A place has a name, by which it is known again in the next step, whichever body is the master then:
a corner of the first body, one of the second, or an edge of each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.convex import TOGETHER, Hulls
from fecolumn.contact.record import record
from fecolumn.contact.separation import perpendicular
from fecolumn.contact.tolerances import SAME_OUTLINE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.separation import Relation

#: Kinds of names: see `name_of`; 0 is that of no place
CORNER_OF_FIRST, CORNER_OF_SECOND, CROSSING = 1, 2, 3


#: A place. arm: (3,) from the slave's centre of mass in its frame, seat: (3,) from the master's in
#: its own [m], of a ground from its place in the table frame; gap along the normal [m]; name. slot,
#: kept, away [m]: for `contact.slots`.
PLACE_FOUND = record(
    ("arm", "f8", 3),
    ("seat", "f8", 3),
    ("gap", "f8"),
    ("name", "i8"),
    ("slot", "i8"),
    ("kept", "?"),
    ("away", "f8"),
)

#: A corner of what is left of a face. at: (3,) along the tangents and the normal of the master's
#: face [m]; name; source: what the edge from it to the next one is: an edge of the slave, or -1 - k
#: where it lies over side k of the master's face.
CLIPPED = record(("at", "f8", 3), ("name", "i8"), ("source", "i8"))


class PlaceRoom(NamedTuple):
    """Room for places: (M,) of PLACE_FOUND, and (2, M) of CLIPPED."""

    found: Array
    clipped: Array


def place_room_for(hulls: Hulls) -> PlaceRoom:
    """Room for the places of any pair."""
    longest = int(np.diff(hulls.loop_first).max(initial=1))
    most = max(2 * longest + 2, int(np.diff(hulls.first[:, 0]).max(initial=1)))
    return PlaceRoom(np.zeros(most, PLACE_FOUND), np.zeros((2, most), CLIPPED))


@njit(alone=TOGETHER)
def name_of(kind: int, first: int, second: int) -> int:
    """Name of a place: of its kind, and of the corner, or of an edge of the first body and one of
    the second.
    """
    return (kind << 48) + (first << 24) + second


@njit(alone=TOGETHER)
def _crossing(exchanged: bool, of_slave: int, of_master: int) -> int:
    return (
        name_of(CROSSING, of_slave, of_master)
        if exchanged
        else name_of(CROSSING, of_master, of_slave)
    )


@njit(alone=TOGETHER)
def facing(
    hulls: Hulls, slave: int, x: float, y: float, z: float, least: float, before: int
) -> int:
    """The slave's face that is most against a normal x, y, z, in the slave's frame.

    Only faces at the slave's nearest corner count, which is at `least` [m] along the normal. Where
    the face of the step before is as much against it, it is that one.
    """
    chosen, most, within = -1, np.inf, 1e-9 * hulls.thickness[slave]
    for f in range(hulls.first[slave, 1], hulls.first[slave + 1, 1]):
        n = hulls.normals[f]
        along = n[0] * x + n[1] * y + n[2] * z
        face = f - hulls.first[slave, 1]
        if face == before:
            along -= 1e-6
        if along >= most:
            continue
        for k in range(hulls.loop_first[f], hulls.loop_first[f + 1]):
            p = hulls.corners[hulls.first[slave, 0] + hulls.loop[k]]
            if p[0] * x + p[1] * y + p[2] * z <= least + within:
                chosen, most = face, along
                break
    return chosen


@njit(alone=TOGETHER)
def _lay_face(
    hulls: Hulls,
    slave: int,
    face: int,
    f: int,
    relation: Relation,
    exchanged: bool,
    places: PlaceRoom,
) -> int:
    """Put a face of the slave into the frame of face f of the master; how many corners it has."""
    T, s, axes, middle = relation.turn, relation.shift, hulls.axes[f], hulls.middles[f]
    row = hulls.first[slave, 1] + face
    start, kind = hulls.loop_first[row], CORNER_OF_FIRST if exchanged else CORNER_OF_SECOND
    count = hulls.loop_first[row + 1] - start
    for k in range(count):
        corner = hulls.loop[start + k]
        p = hulls.corners[hulls.first[slave, 0] + corner]
        u = v = w = 0.0
        for i in range(3):
            away = T[i, 0] * p[0] + T[i, 1] * p[1] + T[i, 2] * p[2] + s[i] - middle[i]
            u, v, w = u + axes[i, 0] * away, v + axes[i, 1] * away, w + axes[i, 2] * away
        corner_left = places.clipped[0, k]
        corner_left.at[0], corner_left.at[1], corner_left.at[2] = u, v, w
        corner_left.name = name_of(kind, corner, 0)
        corner_left.source = hulls.loop_edge[start + k]
    return count


@njit(alone=TOGETHER)
def _name_at_side(hulls: Hulls, f: int, k: int, source: int, exchanged: bool) -> int:
    """Name of the place where an edge of what is left comes to side k of face f of the master."""
    start = hulls.loop_first[f]
    if source >= 0:
        return _crossing(exchanged, source, hulls.loop_edge[start + k])
    # both sides meet in a corner of the master, but where the next sides cut it off
    last = -1 - source
    corner = hulls.loop[start + k]
    if last == (k + 1) % (hulls.loop_first[f + 1] - start):
        corner = hulls.loop[start + last]
    return name_of(CORNER_OF_SECOND if exchanged else CORNER_OF_FIRST, corner, 0)


@njit(alone=TOGETHER)
def _clip(
    hulls: Hulls, master: int, f: int, slave: int, count: int, exchanged: bool, places: PlaceRoom
) -> tuple[int, int]:
    """Clip to face f of the master; how many corners are left, and in which half of the room.

    A corner on the outline, or beyond it by no more than rounding, belongs to the face: of two
    equal faces the corners are the slave's.
    """
    now, start = 0, hulls.loop_first[f]
    sides = hulls.loop_first[f + 1] - start
    slack = SAME_OUTLINE * (hulls.thickness[master] + hulls.thickness[slave])
    axes, middle = hulls.axes[f], hulls.middles[f]
    for k in range(sides):
        p = hulls.corners[hulls.first[master, 0] + hulls.loop[start + k]]
        q = hulls.corners[hulls.first[master, 0] + hulls.loop[start + (k + 1) % sides]]
        u = v = du = dv = 0.0
        for i in range(3):
            u, v = u + axes[i, 0] * (p[i] - middle[i]), v + axes[i, 1] * (p[i] - middle[i])
            du, dv = du + axes[i, 0] * (q[i] - p[i]), dv + axes[i, 1] * (q[i] - p[i])
        length = np.hypot(du, dv)
        du, dv = du / length, dv / length
        old, new, left, beyond = places.clipped[now], places.clipped[1 - now], 0, False
        for c in range(count):
            beyond |= (old[c].at[0] - u) * dv - (old[c].at[1] - v) * du > slack
        if not beyond:
            continue
        for c in range(count):
            one, other = old[c], old[c + 1 if c + 1 < count else 0]
            # how far both ends of an edge are beyond the side
            here = (one.at[0] - u) * dv - (one.at[1] - v) * du
            there = (other.at[0] - u) * dv - (other.at[1] - v) * du
            if here <= slack:
                new[left] = one
                left += 1
            if (here <= slack) == (there <= slack):
                continue
            # the end that is on the side is the corner itself
            if here <= slack and here >= -slack:
                new[left - 1].source = -1 - k
            elif not (there <= slack and there >= -slack):
                share = here / (here - there)
                for i in range(3):
                    new[left].at[i] = one.at[i] + share * (other.at[i] - one.at[i])
                new[left].name = _name_at_side(hulls, f, k, one.source, exchanged)
                new[left].source = -1 - k if here <= slack else one.source
                left += 1
        now, count = 1 - now, left
        if count == 0:
            break
    return count, now


@njit(alone=TOGETHER)
def places_on_face(
    hulls: Hulls,
    master: int,
    face: int,
    slave: int,
    facing_face: int,
    relation: Relation,
    exchanged: bool,
    reach: float,
    places: PlaceRoom,
) -> int:
    """Find the places at which the slave's face is less than `reach` [m] over a face of the master;
    how many they are.

    Parameters
    ----------
    relation
        of the slave as seen from the master.
    exchanged
        whether the master is the second body of the pair.
    """
    f, T, s = hulls.first[master, 1] + face, relation.turn, relation.shift
    count = _lay_face(hulls, slave, facing_face, f, relation, exchanged, places)
    count, now = _clip(hulls, master, f, slave, count, exchanged, places)
    axes, middle, found = hulls.axes[f], hulls.middles[f], 0
    for c in range(count):
        corner, place = places.clipped[now, c], places.found[found]
        p = corner.at
        if p[2] > reach:
            continue
        for i in range(3):
            place.seat[i] = middle[i] + axes[i, 0] * p[0] + axes[i, 1] * p[1]
        for i in range(3):
            place.arm[i] = 0.0
            for k in range(3):
                place.arm[i] += T[k, i] * (place.seat[k] + axes[k, 2] * p[2] - s[k])
        place.gap, place.name = p[2], corner.name
        found += 1
    return found


@njit(alone=TOGETHER)
def place_of_edges(
    hulls: Hulls,
    a: int,
    first: int,
    b: int,
    second: int,
    relation: Relation,
    reach: float,
    places: PlaceRoom,
    normal: Array,
) -> bool:
    """Find the place where an edge of body a and one of body b cross, if they do and are less than
    `reach` [m] apart; whether there is one. normal: (3,) is put, in the frame of body a.
    """
    T, s = relation.turn, relation.shift
    i, j = hulls.first[a, 2] + first, hulls.first[b, 2] + second
    p = hulls.corners[hulls.first[a, 0] + hulls.ends[i, 0]]
    p_end = hulls.corners[hulls.first[a, 0] + hulls.ends[i, 1]]
    q = hulls.corners[hulls.first[b, 0] + hulls.ends[j, 0]]
    q_end = hulls.corners[hulls.first[b, 0] + hulls.ends[j, 1]]
    normal[0], normal[1], normal[2], sine = perpendicular(hulls, a, b, relation, first, second)
    if sine == 0.0:
        return False
    d, e, w = hulls.ways[i], hulls.ways[j], np.empty(3)
    gap = cosine = on_d = on_w = length = other = 0.0
    for k in range(3):
        w[k] = T[k, 0] * e[0] + T[k, 1] * e[1] + T[k, 2] * e[2]
        away = T[k, 0] * q[0] + T[k, 1] * q[1] + T[k, 2] * q[2] + s[k] - p[k]
        gap, cosine = gap + normal[k] * away, cosine + d[k] * w[k]
        on_d, on_w = on_d + d[k] * away, on_w + w[k] * away
        length, other = length + d[k] * (p_end[k] - p[k]), other + e[k] * (q_end[k] - q[k])
    at = (on_d - cosine * on_w) / (sine * sine)
    there = (cosine * on_d - on_w) / (sine * sine)
    slack = 1e-9 * (length + other)
    if gap > reach or not (-slack <= at <= length + slack and -slack <= there <= other + slack):
        return False
    place = places.found[0]
    for k in range(3):
        place.seat[k], place.arm[k] = p[k] + at * d[k], q[k] + there * e[k]
    place.gap, place.name = gap, name_of(CROSSING, first, second)
    return True


@njit(alone=TOGETHER)
def places_on_ground(
    hulls: Hulls,
    body: int,
    centers: Array,
    rotations: Array,
    place: Array,
    axes: Array,
    reach: float,
    places: PlaceRoom,
) -> int:
    """Find the corners of a body that are less than `reach` [m] over a plane ground; how many they
    are.

    Parameters
    ----------
    place, axes
        (3,) a point of the ground's plane in the table frame [m] and (3, 3), whose columns are two
        tangents and the normal.
    """
    R, found, start = rotations[body], 0, hulls.first[body, 0]
    for v in range(hulls.first[body + 1, 0] - start):
        p, on_ground, gap = hulls.corners[start + v], places.found[found], 0.0
        for i in range(3):
            at = centers[body, i] + R[i, 0] * p[0] + R[i, 1] * p[1] + R[i, 2] * p[2] - place[i]
            gap += axes[i, 2] * at
            on_ground.seat[i] = at
        if gap > reach:
            continue
        for i in range(3):
            on_ground.arm[i] = p[i]
            on_ground.seat[i] -= gap * axes[i, 2]
        on_ground.gap, on_ground.name = gap, name_of(CORNER_OF_SECOND, v, 0)
        found += 1
    return found
