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
from fecolumn.foundation._compiled import njit

#: Kind of axis of a body over a plane ground, beside those of `contact.separation`
GROUND_NORMAL = 4
#: First number of a row without a pair; that of ground g is -1 - g
NO_PAIR = -(2**62)

_BESIDE = ("convex.py", "manifold.py", "separation.py", "tolerances.py")


class Meetings(NamedTuple):
    """Pairs in P rows and their places in S slots of each.

    pair: (P, 2) bodies, the first -1 - g of ground g, NO_PAIR of an unused row. kind: (P,) of the
    axis, feature: (P, 2) its face or edges, facing: (P,) face of the slave, separation: (P,) along
    the axis [m]. master: (P,), -1 of a ground, slave: (P,). origin: (P, 3) [m], axes: (P, 3, 3) in
    the master's frame, frame: (P, 3, 3) in the table frame; exchanged: (P,), and frame_before,
    master_before of the step before. turn_then: (P, 3, 3), shift_then: (P, 3) [m] how the bodies
    were to each other when all axes were looked at. names: (P, S), 0 of an unused slot, arms: (P,
    S, 3) from the slave's centre of mass in its frame, seats: (P, S, 3) from the master's in its
    own [m], of a ground from its place in the table frame; gaps: (P, S) [m]; fresh: (P, S) whether
    it was unused before. buckets: (2^n,) rows by their pair, seen: (P,), own to `keep_rows`.
    """

    pair: np.ndarray
    kind: np.ndarray
    feature: np.ndarray
    facing: np.ndarray
    separation: np.ndarray
    master: np.ndarray
    slave: np.ndarray
    origin: np.ndarray
    axes: np.ndarray
    frame: np.ndarray
    frame_before: np.ndarray
    exchanged: np.ndarray
    master_before: np.ndarray
    turn_then: np.ndarray
    shift_then: np.ndarray
    names: np.ndarray
    arms: np.ndarray
    seats: np.ndarray
    gaps: np.ndarray
    fresh: np.ndarray
    buckets: np.ndarray
    seen: np.ndarray


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
    whole, eye = np.int64, np.broadcast_to(np.eye(3), (rows, 3, 3))
    return Meetings(
        np.full((rows, 2), NO_PAIR),
        np.full(rows, NO_AXIS),
        np.full((rows, 2), -1),
        np.full(rows, -1),
        np.full(rows, np.inf),
        np.full(rows, -1),
        np.full(rows, -1),
        np.zeros((rows, 3)),
        eye.copy(),
        eye.copy(),
        eye.copy(),
        np.zeros(rows, bool),
        np.full(rows, -1),
        np.zeros((rows, 3, 3)),
        np.zeros((rows, 3)),
        np.zeros((rows, slots), whole),
        np.zeros((rows, slots, 3)),
        np.zeros((rows, slots, 3)),
        np.zeros((rows, slots)),
        np.zeros((rows, slots), bool),
        np.full(2 ** int(np.ceil(np.log2(2 * rows + 2))), -1),
        np.zeros(rows, bool),
    )


def more_rows(meetings: Meetings, rows: int) -> Meetings:
    """The same pairs with `rows` rows."""
    result = meetings_for(rows, meetings.names.shape[1])
    for name in Meetings._fields:
        if name not in ("buckets", "seen"):
            getattr(result, name)[: len(meetings.pair)] = getattr(meetings, name)
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
    mask = len(meetings.buckets) - 1
    k = (first * 73856093 ^ second * 19349663) & mask
    while meetings.buckets[k] >= 0:
        row = meetings.buckets[k]
        if meetings.pair[row, 0] == first and meetings.pair[row, 1] == second:
            break
        k = (k + 1) & mask
    return k


@njit(alone=_BESIDE)
def keep_rows(meetings, pairs):
    """Give each of pairs (k, 2) a row, the one it has where it has one, and free all others; how
    many pairs found no row.
    """
    buckets, seen, missing = meetings.buckets, meetings.seen, 0
    for k in range(len(buckets)):
        buckets[k] = -1
    for row in range(len(seen)):
        seen[row] = False
        if meetings.pair[row, 0] != NO_PAIR:
            buckets[_bucket(meetings, meetings.pair[row, 0], meetings.pair[row, 1])] = row
    for k in range(len(pairs)):
        row = buckets[_bucket(meetings, pairs[k, 0], pairs[k, 1])]
        if row >= 0:
            seen[row] = True
    for row in range(len(seen)):
        if not seen[row]:
            _free(meetings, row)
    free = 0
    for k in range(len(pairs)):
        # a row freed above is in its bucket still, but has lost its pair
        bucket = _bucket(meetings, pairs[k, 0], pairs[k, 1])
        if buckets[bucket] >= 0:
            continue
        while free < len(seen) and seen[free]:
            free += 1
        if free == len(seen):
            missing += 1
            continue
        meetings.pair[free, 0], meetings.pair[free, 1] = pairs[k, 0], pairs[k, 1]
        seen[free] = True
        buckets[bucket] = free
    return missing


@njit(alone=_BESIDE)
def _free(meetings, row):
    meetings.pair[row, 0] = meetings.pair[row, 1] = NO_PAIR
    meetings.kind[row], meetings.separation[row], meetings.facing[row] = NO_AXIS, np.inf, -1
    meetings.turn_then[row, 0, 0] = np.inf
    meetings.master[row] = meetings.slave[row] = -1
    meetings.exchanged[row] = False
    for slot in range(meetings.names.shape[1]):
        meetings.names[row, slot] = 0
        meetings.fresh[row, slot] = False


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
    for row in range(len(meetings.pair)):
        if meetings.pair[row, 0] == NO_PAIR:
            continue
        if meetings.pair[row, 0] < 0:
            changed |= _meet_ground(
                hulls, centers, rotations, ground_places, ground_axes, reach, meetings, row, room
            )
        else:
            changed |= _meet(hulls, centers, rotations, reach, meetings, row, room)
    return changed


@njit(alone=_BESIDE)
def _meet_ground(hulls, centers, rotations, ground_places, ground_axes, reach, meetings, row, room):
    """`find_places` of a row of a body and a ground."""
    body, ground = meetings.pair[row, 1], -1 - meetings.pair[row, 0]
    axes, place = ground_axes[ground], ground_places[ground]
    count = places_on_ground(hulls, body, centers, rotations, place, axes, reach, room.places)
    meetings.separation[row] = np.inf
    for q in range(count):
        meetings.separation[row] = min(meetings.separation[row], room.places.gaps[q])
    known = meetings.kind[row] == GROUND_NORMAL
    meetings.kind[row], meetings.master[row], meetings.slave[row] = GROUND_NORMAL, -1, body
    for i in range(3):
        meetings.origin[row, i] = 0.0
        for k in range(3):
            meetings.frame_before[row, i, k] = meetings.frame[row, i, k] if known else axes[i, k]
            meetings.frame[row, i, k] = meetings.axes[row, i, k] = axes[i, k]
    return _settle(meetings, row, -1, count, hulls.thickness[body], room.places)


@njit(alone=_BESIDE)
def _meet(hulls, centers, rotations, reach, meetings, row, room):
    """`find_places` of a row of two bodies."""
    a, b = meetings.pair[row, 0], meetings.pair[row, 1]
    relation, reverse, places = room.relation, room.reverse, room.places
    relate(centers, rotations, a, b, relation)
    was, first_was, second_was = (
        meetings.kind[row],
        meetings.feature[row, 0],
        meetings.feature[row, 1],
    )
    separation, kind, first, second = -np.inf, was, first_was, second_was
    rests = was != NO_AXIS and _is_same(hulls, a, b, relation, meetings, row)
    if rests:
        separation = separation_along(hulls, a, b, relation, kind, first, second)
    if not rests or separation == -np.inf:
        separation, kind, first, second = choose_axis(
            hulls, a, b, relation, reach, was, first_was, second_was
        )
        if separation <= reach:
            _remember(relation, meetings, row)
        else:
            meetings.turn_then[row, 0, 0] = np.inf
    same = kind == was and first == first_was and second == second_was
    master_was = meetings.master_before[row] = meetings.master[row]
    meetings.separation[row], meetings.kind[row] = separation, kind
    meetings.feature[row, 0], meetings.feature[row, 1] = first, second
    size, count = min(hulls.thickness[a], hulls.thickness[b]), 0
    master, slave = (b, a) if kind == FACE_OF_SECOND else (a, b)
    meetings.master[row], meetings.slave[row] = master, slave
    meetings.exchanged[row] = not same and was != NO_AXIS
    if separation <= reach:
        if kind == FACE_OF_FIRST:
            count = _meet_face(
                hulls, a, first, b, relation, False, reach, meetings, row, same, places
            )
        elif kind == FACE_OF_SECOND:
            relate(centers, rotations, b, a, reverse)
            count = _meet_face(
                hulls, b, second, a, reverse, True, reach, meetings, row, same, places
            )
        else:
            crosses = place_of_edges(
                hulls, a, first, b, second, relation, reach, places, room.normal
            )
            count = 1 if crosses else 0
            _set_axes_of_edge(hulls, a, first, meetings, row, room.normal)
        _set_frame(meetings, row, rotations[master], was != NO_AXIS)
    return _settle(meetings, row, master_was, count, size, places)


@njit(alone=_BESIDE)
def _is_same(hulls, a, b, relation, meetings, row):
    """Whether no place of body b has moved much as seen from body a since all axes were looked
    at.
    """
    turned = moved = reach = 0.0
    for i in range(3):
        moved += (relation.shift[i] - meetings.shift_then[row, i]) ** 2
        reach += (abs(hulls.middle[b, i]) + hulls.half[b, i]) ** 2
        for k in range(3):
            turned += (relation.turn[i, k] - meetings.turn_then[row, i, k]) ** 2
    most = OTHER_AXIS / 4 * min(hulls.thickness[a], hulls.thickness[b])
    return np.sqrt(moved) + np.sqrt(turned * reach) < most


@njit(alone=_BESIDE)
def _remember(relation, meetings, row):
    for i in range(3):
        meetings.shift_then[row, i] = relation.shift[i]
        for k in range(3):
            meetings.turn_then[row, i, k] = relation.turn[i, k]


@njit(alone=_BESIDE)
def _meet_face(hulls, master, face, slave, relation, exchanged, reach, meetings, row, same, places):
    """Find the places over a face of the master and set the axes of a row; how many they are."""
    f, T = hulls.first[master, 1] + face, relation.turn
    n = hulls.normals[f]
    x = T[0, 0] * n[0] + T[1, 0] * n[1] + T[2, 0] * n[2]
    y = T[0, 1] * n[0] + T[1, 1] * n[1] + T[2, 1] * n[2]
    z = T[0, 2] * n[0] + T[1, 2] * n[1] + T[2, 2] * n[2]
    least = least_along(hulls, slave, x, y, z)[0]
    before = meetings.facing[row] if same else -1
    meetings.facing[row] = facing(hulls, slave, x, y, z, least, before)
    for i in range(3):
        meetings.origin[row, i] = hulls.middles[f, i]
        for k in range(3):
            meetings.axes[row, i, k] = hulls.axes[f, i, k]
    return places_on_face(
        hulls, master, face, slave, meetings.facing[row], relation, exchanged, reach, places
    )


@njit(alone=_BESIDE)
def _set_axes_of_edge(hulls, a, edge, meetings, row, normal):
    """Axes of a row: an edge of body a, across it, and the normal (3,) in its frame."""
    d = hulls.ways[hulls.first[a, 2] + edge]
    start = hulls.corners[hulls.first[a, 0] + hulls.ends[hulls.first[a, 2] + edge, 0]]
    for i in range(3):
        one, two = (i + 1) % 3, (i + 2) % 3
        meetings.origin[row, i] = start[i]
        meetings.axes[row, i, 0], meetings.axes[row, i, 2] = d[i], normal[i]
        meetings.axes[row, i, 1] = normal[one] * d[two] - normal[two] * d[one]


@njit(alone=_BESIDE)
def _set_frame(meetings, row, rotation, known):
    for i in range(3):
        for k in range(3):
            before, axes = meetings.frame[row, i, k], meetings.axes[row]
            meetings.frame[row, i, k] = (
                rotation[i, 0] * axes[0, k]
                + rotation[i, 1] * axes[1, k]
                + rotation[i, 2] * axes[2, k]
            )
            meetings.frame_before[row, i, k] = before if known else meetings.frame[row, i, k]


@njit(alone=_BESIDE)
def _has(meetings, row, name):
    """Slot of a row that has a name, -1 of none."""
    for slot in range(meetings.names.shape[1]):
        if meetings.names[row, slot] == name:
            return slot
    return -1


@njit(alone=_BESIDE)
def _apart(one, other):
    x, y, z = one[0] - other[0], one[1] - other[1], one[2] - other[2]
    return np.sqrt(x * x + y * y + z * z)


@njit(alone=_BESIDE)
def _keep_spanning(meetings, row, count, size, places):
    """Mark the places, as many as there are slots, that stand for all: the lowest, and each further
    one the farthest from those; one of the step before is preferred by OTHER_AXIS.
    """
    slots, lowest, least = meetings.names.shape[1], 0, np.inf
    for q in range(count):
        places.kept[q] = count <= slots
        places.slot[q] = _has(meetings, row, places.names[q])
        gap = places.gaps[q] - (OTHER_AXIS * size if places.slot[q] >= 0 else 0.0)
        if gap < least:
            least, lowest = gap, q
    if count <= slots:
        return
    places.kept[lowest] = True
    for _ in range(slots - 1):
        chosen, most = -1, -np.inf
        for q in range(count):
            if places.kept[q]:
                continue
            away = np.inf
            for p in range(count):
                if places.kept[p]:
                    away = min(away, _apart(places.seats[p], places.seats[q]))
            if places.slot[q] >= 0:
                away += OTHER_AXIS * size
            if away > most:
                chosen, most = q, away
        places.kept[chosen] = True


@njit(alone=_BESIDE)
def _settle(meetings, row, master_was, count, size, places):
    """Put places into the slots of a row: each into its own, where its name is known, or else into
    that of the nearest place that has gone; whether others take part than before.

    Parameters
    ----------
    master_was
        the row's master in the step before, -1 of a ground or none
    size
        thickness of the thinner body [m].
    """
    names, slots, changed = meetings.names, meetings.names.shape[1], False
    _keep_spanning(meetings, row, count, size, places)
    first = meetings.pair[row, 0]
    # on the body, where the first one is a ground
    was, now = first >= 0 and master_was == first, first >= 0 and meetings.master[row] == first
    for q in range(count):
        if not places.kept[q] or places.slot[q] >= 0:
            continue
        nearest = SAME_POINT_BY_PLACE * size
        here = places.seats[q] if now else places.arms[q]
        for slot in range(slots):
            if names[row, slot] == 0 or _is_taken(places, count, slot):
                continue
            there = meetings.seats[row, slot] if was else meetings.arms[row, slot]
            away = _apart(here, there)
            if away < nearest:
                nearest, places.slot[q] = away, slot
    for q in range(count):
        if not places.kept[q] or places.slot[q] >= 0:
            continue
        for slot in range(slots):
            # a slot of one that has gone is as good as an unused one
            if not _is_taken(places, count, slot):
                places.slot[q] = slot
                changed = True
                names[row, slot] = 0
                break
    for slot in range(slots):
        if not _is_taken(places, count, slot):
            changed |= names[row, slot] != 0
            names[row, slot], meetings.fresh[row, slot] = 0, False
    for q in range(count):
        if not places.kept[q]:
            continue
        slot = places.slot[q]
        meetings.fresh[row, slot] = names[row, slot] == 0
        names[row, slot], meetings.gaps[row, slot] = places.names[q], places.gaps[q]
        for i in range(3):
            meetings.arms[row, slot, i] = places.arms[q, i]
            meetings.seats[row, slot, i] = places.seats[q, i]
    return changed


@njit(alone=_BESIDE)
def _is_taken(places, count, slot):
    for q in range(count):
        if places.kept[q] and places.slot[q] == slot:
            return True
    return False
