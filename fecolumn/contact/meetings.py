"""Contact that is found: for each step, pairs of convex bodies that are near, or a body and a plane
ground, and the places at which they may touch.

In a step::

    find_boxes(hulls, centers, rotations, margins, boxes)
    found = find_pairs(hulls, boxes, left_out, pairs)
    found = add_grounds(hulls, boxes, ground_places, ground_axes, pairs, found)
    # where found > len(pairs), or a row is missing: make room with `more_rows` and look again
    missing = keep_rows(meetings, pairs[:found])
    changed = find_places(
        hulls, centers, rotations, ground_places, ground_axes, reach, meetings, room
    )

A row of `Meetings` is a pair, and stays its row as long as the pair is near; a slot of a row is a
place, and stays its slot as long as the place is known again, by its name, or else by where it is
on the first body. So what a contact carries from step to step needs no search: contact points may
be numbered `row * slots + slot`, those without a name take no part.

A row is an interface of that step: `master`, `slave`, `origin` and `axes` are what an INTERFACE
has, fixed in the master's frame. Of two edges the first tangent is the edge of the master and the
normal changes as the slave turns. Where the axis is of another face or other edges than in the step
before, `exchanged` says so; frame_before then has the axes of the step before in the table frame,
to turn forces by, which change sign where another body is the master now, `master_before`.

While bodies have moved against each other by less than OTHER_AXIS / 4 since all axes were looked
at, theirs is still good enough: a pair that rests costs one axis, as one that is apart.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.convex import Hulls
from fecolumn.contact.manifold import (
    Places,
    facing,
    place_of_edges,
    places_for,
    places_on_face,
    places_on_ground,
)
from fecolumn.contact.record import record
from fecolumn.contact.separation import (
    FACE_OF_FIRST,
    FACE_OF_SECOND,
    NO_AXIS,
    Relation,
    choose_axis,
    least_along,
    relate,
    relation_for,
    separation_along,
)
from fecolumn.contact.tolerances import OTHER_AXIS, SAME_POINT_BY_PLACE
from fecolumn.foundation._compiled import interpreted, njit

#: Kind of axis of a body over a plane ground, beside those of `contact.separation`
GROUND_NORMAL = 4
#: First number of a row without a pair; that of ground g is -1 - g
NO_PAIR = -(2**62)

_BESIDE = ("convex.py", "manifold.py", "record.py", "separation.py", "tolerances.py")


#: A pair. pair: (2,) bodies, the first -1 - g of ground g, NO_PAIR of an unused row; kind of the
#: axis, feature: (2,) its face or edges, facing: face of the slave; separation along the axis [m].
#: master: -1 of a ground, slave. origin: (3,) [m], axes: (3, 3) in the master's frame, frame: (3,
#: 3) in the table frame; exchanged: whether the axis is another than before, frame_before and
#: master_before: of the step before. turn_then: (3, 3), shift_then: (3,) [m] how the bodies were to
#: each other when all axes were looked at; seen: own to `keep_rows`.
MEETING = record(
    ("pair", "i8", 2),
    ("kind", "i8"),
    ("feature", "i8", 2),
    ("facing", "i8"),
    ("separation", "f8"),
    ("master", "i8"),
    ("slave", "i8"),
    ("origin", "f8", 3),
    ("axes", "f8", (3, 3)),
    ("frame", "f8", (3, 3)),
    ("exchanged", "?"),
    ("frame_before", "f8", (3, 3)),
    ("master_before", "i8"),
    ("turn_then", "f8", (3, 3)),
    ("shift_then", "f8", 3),
    ("seen", "?"),
)

#: A place in a slot. name: 0 of an unused one; arm: (3,) from the slave's centre of mass in its
#: frame, seat: (3,) from the master's in its own [m], of a ground from its place in the table
#: frame; gap along the normal [m]; fresh: whether the slot was unused before.
PLACE_MET = record(
    ("name", "i8"), ("arm", "f8", 3), ("seat", "f8", 3), ("gap", "f8"), ("fresh", "?")
)


class Meetings(NamedTuple):
    """Pairs and their places: (P,) of MEETING and (P, S) of PLACE_MET; buckets: (2^n,) rows by
    their pair, own to `keep_rows`.
    """

    rows: np.ndarray
    places: np.ndarray
    buckets: np.ndarray


class Room(NamedTuple):
    """Room for the work of `find_places`: two relations, places, and a vector."""

    relation: Relation
    reverse: Relation
    places: Places
    normal: np.ndarray


def room_for(hulls: Hulls) -> Room:
    """Room for any pair of the bodies."""
    return Room(relation_for(hulls), relation_for(hulls), places_for(hulls), np.zeros(3))


def meetings_for(rows: int, slots: int = 8) -> Meetings:
    """Rows without a pair."""
    buckets = np.full(2 ** int(np.ceil(np.log2(2 * rows + 2))), -1)
    meetings = Meetings(np.zeros(rows, MEETING), np.zeros((rows, slots), PLACE_MET), buckets)
    for row, places in zip(meetings.rows, meetings.places):
        interpreted(_free)(row, places)
    return meetings


def more_rows(meetings: Meetings, rows: int) -> Meetings:
    """The same pairs with `rows` rows."""
    result = meetings_for(rows, meetings.places.shape[1])
    result.rows[: len(meetings.rows)] = meetings.rows
    result.places[: len(meetings.rows)] = meetings.places
    return result


@njit(alone=_BESIDE)
def add_grounds(hulls, boxes, ground_places, ground_axes, pairs, found):
    """Add to `found` pairs those of a body and a ground that are as near as boxes are grown; how
    many there are then.

    Parameters
    ----------
    ground_places, ground_axes
        (G, 3) a point of each plane in the table frame [m] and (G, 3, 3), whose columns are two
        tangents and the normal.
    """
    for g in range(len(ground_places)):
        n, place = ground_axes[g, :, 2], ground_places[g]
        for b in range(len(boxes.low)):
            if hulls.first[b + 1, 0] == hulls.first[b, 0]:
                continue
            over = 0.0
            for i in range(3):
                over += n[i] * (boxes.low[b, i] if n[i] > 0.0 else boxes.high[b, i])
                over -= n[i] * place[i]
            if over > 0.0:
                continue
            if found < len(pairs):
                pairs[found, 0], pairs[found, 1] = -1 - g, b
            found += 1
    return found


@njit(alone=_BESIDE)
def _bucket(meetings, first, second):
    """The bucket in which the row of a pair is or would be."""
    buckets, mask = meetings.buckets, len(meetings.buckets) - 1
    k = (first * 73856093 ^ second * 19349663) & mask
    while buckets[k] >= 0:
        pair = meetings.rows[buckets[k]].pair
        if pair[0] == first and pair[1] == second:
            break
        k = (k + 1) & mask
    return k


@njit(alone=_BESIDE)
def keep_rows(meetings, pairs):
    """Give each of pairs (k, 2) a row, the one it has where it has one, and free all others; how
    many pairs found no row.
    """
    buckets, rows, missing, free = meetings.buckets, meetings.rows, 0, 0
    for k in range(len(buckets)):
        buckets[k] = -1
    for r in range(len(rows)):
        rows[r].seen = False
        if rows[r].pair[0] != NO_PAIR:
            buckets[_bucket(meetings, rows[r].pair[0], rows[r].pair[1])] = r
    for k in range(len(pairs)):
        r = buckets[_bucket(meetings, pairs[k, 0], pairs[k, 1])]
        if r >= 0:
            rows[r].seen = True
    for r in range(len(rows)):
        if not rows[r].seen and rows[r].pair[0] != NO_PAIR:
            _free(rows[r], meetings.places[r])
    for k in range(len(pairs)):
        # a row freed above is in its bucket still, but has lost its pair
        bucket = _bucket(meetings, pairs[k, 0], pairs[k, 1])
        if buckets[bucket] >= 0:
            continue
        while free < len(rows) and rows[free].seen:
            free += 1
        if free == len(rows):
            missing += 1
            continue
        rows[free].pair[0], rows[free].pair[1], rows[free].seen = pairs[k, 0], pairs[k, 1], True
        buckets[bucket] = free
    return missing


@njit(alone=_BESIDE)
def _free(row, places):
    """Take the pair from a row."""
    row.pair[0] = row.pair[1] = NO_PAIR
    row.kind, row.separation, row.facing = NO_AXIS, np.inf, -1
    row.master = row.slave = row.master_before = row.feature[0] = row.feature[1] = -1
    row.exchanged, row.turn_then[0, 0] = False, np.inf
    for slot in range(len(places)):
        places[slot].name, places[slot].fresh = 0, False


@njit(alone=_BESIDE)
def find_places(hulls, centers, rotations, ground_places, ground_axes, reach, meetings, room):
    """Find the places of all rows at which bodies are less than `reach` [m] apart; whether others
    take part than before.

    Parameters
    ----------
    centers, rotations
        (N, 3) centres of mass [m] and (N, 3, 3) of all bodies.
    """
    changed = False
    for r in range(len(meetings.rows)):
        row, places = meetings.rows[r], meetings.places[r]
        if row.pair[0] == NO_PAIR:
            continue
        if row.pair[0] < 0:
            place, axes = ground_places[-1 - row.pair[0]], ground_axes[-1 - row.pair[0]]
            changed |= _meet_ground(
                hulls, centers, rotations, place, axes, reach, row, places, room.places
            )
        else:
            changed |= _meet(hulls, centers, rotations, reach, row, places, room)
    return changed


@njit(alone=_BESIDE)
def _meet_ground(hulls, centers, rotations, place, axes, reach, row, places, room):
    """`find_places` of a row of a body and a ground."""
    body = row.pair[1]
    count = places_on_ground(hulls, body, centers, rotations, place, axes, reach, room)
    row.separation, known = np.inf, row.kind == GROUND_NORMAL
    for q in range(count):
        row.separation = min(row.separation, room.found[q].gap)
    row.kind, row.master, row.slave, row.master_before = GROUND_NORMAL, -1, body, -1
    for i in range(3):
        row.origin[i] = 0.0
        for k in range(3):
            row.frame_before[i, k] = row.frame[i, k] if known else axes[i, k]
            row.frame[i, k] = row.axes[i, k] = axes[i, k]
    return _settle(row, places, room.found, count, hulls.thickness[body])


@njit(alone=_BESIDE)
def _meet(hulls, centers, rotations, reach, row, places, room):
    """`find_places` of a row of two bodies."""
    a, b, relation, was, count = row.pair[0], row.pair[1], room.relation, row.kind, 0
    first, second = row.feature[0], row.feature[1]
    relate(centers, rotations, a, b, relation)
    separation = -np.inf
    if was != NO_AXIS:
        separation = separation_along(hulls, a, b, relation, was, first, second)
    if separation > reach and _is_idle(places):
        row.separation, row.exchanged = separation, False
        return False
    kind, size = was, min(hulls.thickness[a], hulls.thickness[b])
    if separation <= reach and (
        separation == -np.inf or not _is_same(hulls, b, relation, row, OTHER_AXIS / 4 * size)
    ):
        separation, kind, first, second = choose_axis(
            hulls, a, b, relation, reach, was, first, second, separation
        )
        _remember(relation, row, separation <= reach)
    same = kind == was and first == row.feature[0] and second == row.feature[1]
    row.exchanged, row.master_before = not same and was != NO_AXIS, row.master
    row.separation, row.kind, row.feature[0], row.feature[1] = separation, kind, first, second
    row.master, row.slave = (b, a) if kind == FACE_OF_SECOND else (a, b)
    if separation <= reach:
        before = row.facing if same else -1
        if kind == FACE_OF_FIRST:
            count = _meet_face(hulls, a, first, b, relation, False, reach, row, before, room.places)
        elif kind == FACE_OF_SECOND:
            relate(centers, rotations, b, a, room.reverse)
            count = _meet_face(
                hulls, b, second, a, room.reverse, True, reach, row, before, room.places
            )
        else:
            crosses = place_of_edges(
                hulls, a, first, b, second, relation, reach, room.places, room.normal
            )
            count = 1 if crosses else 0
            _set_axes_of_edge(hulls, a, first, row, room.normal)
        _set_frame(row, rotations[row.master], was != NO_AXIS)
    return _settle(row, places, room.places.found, count, size)


@njit(alone=_BESIDE)
def _is_idle(places):
    for slot in range(len(places)):
        if places[slot].name != 0:
            return False
    return True


@njit(alone=_BESIDE)
def _is_same(hulls, b, relation, row, most):
    """Whether no place of body b has moved by `most` [m] as seen from the other body since all axes
    were looked at.
    """
    turned = moved = radius = 0.0
    for i in range(3):
        moved += (relation.shift[i] - row.shift_then[i]) ** 2
        radius += (abs(hulls.middle[b, i]) + hulls.half[b, i]) ** 2
        for k in range(3):
            turned += (relation.turn[i, k] - row.turn_then[i, k]) ** 2
    return np.sqrt(moved) + np.sqrt(turned * radius) < most


@njit(alone=_BESIDE)
def _remember(relation, row, near):
    """Keep how the bodies are to each other, where all axes were looked at."""
    for i in range(3):
        row.shift_then[i] = relation.shift[i]
        for k in range(3):
            row.turn_then[i, k] = relation.turn[i, k] if near else np.inf


@njit(alone=_BESIDE)
def _meet_face(hulls, master, face, slave, relation, exchanged, reach, row, before, places):
    """Find the places over a face of the master and set the axes of a row; how many they are."""
    f, T, first = hulls.first[master, 1] + face, relation.turn, hulls.first
    n = hulls.normals[f]
    x = T[0, 0] * n[0] + T[1, 0] * n[1] + T[2, 0] * n[2]
    y = T[0, 1] * n[0] + T[1, 1] * n[1] + T[2, 1] * n[2]
    z = T[0, 2] * n[0] + T[1, 2] * n[1] + T[2, 2] * n[2]
    least = least_along(hulls.corners, first[slave, 0], first[slave + 1, 0], x, y, z)[0]
    row.facing = facing(hulls, slave, x, y, z, least, before)
    for i in range(3):
        row.origin[i] = hulls.middles[f, i]
        for k in range(3):
            row.axes[i, k] = hulls.axes[f, i, k]
    return places_on_face(
        hulls, master, face, slave, row.facing, relation, exchanged, reach, places
    )


@njit(alone=_BESIDE)
def _set_axes_of_edge(hulls, a, edge, row, normal):
    """Axes of a row: an edge of body a, across it, and the normal (3,) in its frame."""
    d = hulls.ways[hulls.first[a, 2] + edge]
    start = hulls.corners[hulls.first[a, 0] + hulls.ends[hulls.first[a, 2] + edge, 0]]
    for i in range(3):
        one, two = (i + 1) % 3, (i + 2) % 3
        row.origin[i] = start[i]
        row.axes[i, 0], row.axes[i, 2] = d[i], normal[i]
        row.axes[i, 1] = normal[one] * d[two] - normal[two] * d[one]


@njit(alone=_BESIDE)
def _set_frame(row, rotation, known):
    """Turn a row's axes into the table frame."""
    for i in range(3):
        for k in range(3):
            before, along = row.frame[i, k], 0.0
            for c in range(3):
                along += rotation[i, c] * row.axes[c, k]
            row.frame[i, k] = along
            row.frame_before[i, k] = before if known else along


@njit(alone=_BESIDE)
def _apart(one, other):
    x, y, z = one[0] - other[0], one[1] - other[1], one[2] - other[2]
    return np.sqrt(x * x + y * y + z * z)


@njit(alone=_BESIDE)
def _keep_spanning(places, found, count, size):
    """Mark the places found, as many as there are slots, that stand for all: the lowest, and each
    further one the farthest from those; one of the step before is preferred by OTHER_AXIS.
    """
    slots, chosen, least, preferred = len(places), 0, np.inf, OTHER_AXIS * size
    for q in range(count):
        found[q].kept, found[q].slot, found[q].away = count <= slots, -1, np.inf
        for slot in range(slots):
            if places[slot].name == found[q].name:
                found[q].slot = slot
                break
        gap = found[q].gap - (preferred if found[q].slot >= 0 else 0.0)
        if gap < least:
            least, chosen = gap, q
    if count <= slots:
        return
    for left in range(slots - 1, -1, -1):
        found[chosen].kept = True
        last, most = chosen, -np.inf
        for q in range(count if left > 0 else 0):
            if found[q].kept:
                continue
            found[q].away = min(found[q].away, _apart(found[last].seat, found[q].seat))
            away = found[q].away + (preferred if found[q].slot >= 0 else 0.0)
            if away > most:
                chosen, most = q, away


@njit(alone=_BESIDE)
def _is_taken(found, count, slot):
    for q in range(count):
        if found[q].kept and found[q].slot == slot:
            return True
    return False


@njit(alone=_BESIDE)
def _settle(row, places, found, count, size):
    """Put the places found into the slots of a row: each into its own, where its name is known, or
    else into that of the nearest place that has gone; whether others take part than before.

    size: thickness of the thinner body [m].
    """
    if count == 0 and _is_idle(places):
        return False
    changed = False
    _keep_spanning(places, found, count, size)
    # places on the first body; on the other one, where the first is a ground
    first = row.pair[0]
    was, now = first >= 0 and row.master_before == first, first >= 0 and row.master == first
    for q in range(count):
        if not found[q].kept or found[q].slot >= 0:
            continue
        nearest = SAME_POINT_BY_PLACE * size
        for slot in range(len(places)):
            if places[slot].name == 0 or _is_taken(found, count, slot):
                continue
            away = _apart(
                found[q].seat if now else found[q].arm,
                places[slot].seat if was else places[slot].arm,
            )
            if away < nearest:
                nearest, found[q].slot = away, slot
    for q in range(count):
        if not found[q].kept or found[q].slot >= 0:
            continue
        for slot in range(len(places)):
            # a slot of one that has gone is as good as an unused one
            if not _is_taken(found, count, slot):
                found[q].slot, places[slot].name, changed = slot, 0, True
                break
    for slot in range(len(places)):
        if not _is_taken(found, count, slot):
            changed |= places[slot].name != 0
            places[slot].name, places[slot].fresh = 0, False
    for q in range(count):
        if not found[q].kept:
            continue
        place = places[found[q].slot]
        place.fresh = place.name == 0
        place.name, place.gap = found[q].name, found[q].gap
        for i in range(3):
            place.arm[i], place.seat[i] = found[q].arm[i], found[q].seat[i]
    return changed
