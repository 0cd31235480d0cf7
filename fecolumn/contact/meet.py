"""The places at which each pair of `contact.meetings` may touch in a step."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.best_axis import choose_axis
from fecolumn.contact.convex import TOGETHER, Hulls
from fecolumn.contact.manifold import (
    PlaceRoom,
    facing,
    place_of_edges,
    place_room_for,
    places_on_face,
    places_on_ground,
)
from fecolumn.contact.meetings import GROUND_NORMAL, NO_PAIR
from fecolumn.contact.separation import (
    FACE_OF_FIRST,
    FACE_OF_SECOND,
    NO_AXIS,
    Relation,
    least_along,
    relate,
    relation_for,
    separation_along,
)
from fecolumn.contact.slots import is_idle, settle_places
from fecolumn.contact.tolerances import OTHER_AXIS
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.meetings import Meetings


class Room(NamedTuple):
    """Room for the work of `find_meetings`: two relations, places, and a vector."""

    relation: Relation
    reverse: Relation
    places: PlaceRoom
    normal: Array


def room_for(hulls: Hulls) -> Room:
    """Room for any pair of the bodies."""
    return Room(relation_for(hulls), relation_for(hulls), place_room_for(hulls), np.zeros(3))


@njit(alone=TOGETHER)
def find_meetings(
    hulls: Hulls,
    centers: Array,
    rotations: Array,
    ground_places: Array,
    ground_axes: Array,
    reach: float,
    meetings: Meetings,
    room: Room,
) -> bool:
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


@njit(alone=TOGETHER)
def _meet_ground(
    hulls: Hulls,
    centers: Array,
    rotations: Array,
    place: Array,
    axes: Array,
    reach: float,
    row: Record,
    places: Array,
    room: PlaceRoom,
) -> bool:
    """`find_meetings` of a row of a body and a ground."""
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
    return settle_places(row, places, room.found, count, hulls.thickness[body])


@njit(alone=TOGETHER)
def _meet(
    hulls: Hulls,
    centers: Array,
    rotations: Array,
    reach: float,
    row: Record,
    places: Array,
    room: Room,
) -> bool:
    """`find_meetings` of a row of two bodies."""
    a, b, relation, was, count = row.pair[0], row.pair[1], room.relation, row.kind, 0
    first, second = row.feature[0], row.feature[1]
    relate(centers, rotations, a, b, relation)
    separation = -np.inf
    if was != NO_AXIS:
        separation = separation_along(hulls, a, b, relation, was, first, second)
    if separation > reach and is_idle(places):
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
    return settle_places(row, places, room.places.found, count, size)


@njit(alone=TOGETHER)
def _is_same(hulls: Hulls, b: int, relation: Relation, row: Record, most: float) -> bool:
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


@njit(alone=TOGETHER)
def _remember(relation: Relation, row: Record, near: bool) -> None:
    """Keep how the bodies are to each other, where all axes were looked at."""
    for i in range(3):
        row.shift_then[i] = relation.shift[i]
        for k in range(3):
            row.turn_then[i, k] = relation.turn[i, k] if near else np.inf


@njit(alone=TOGETHER)
def _meet_face(
    hulls: Hulls,
    master: int,
    face: int,
    slave: int,
    relation: Relation,
    exchanged: bool,
    reach: float,
    row: Record,
    before: int,
    places: PlaceRoom,
) -> int:
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


@njit(alone=TOGETHER)
def _set_axes_of_edge(hulls: Hulls, a: int, edge: int, row: Record, normal: Array) -> None:
    """Axes of a row: an edge of body a, across it, and the normal (3,) in its frame."""
    d = hulls.ways[hulls.first[a, 2] + edge]
    start = hulls.corners[hulls.first[a, 0] + hulls.ends[hulls.first[a, 2] + edge, 0]]
    for i in range(3):
        one, two = (i + 1) % 3, (i + 2) % 3
        row.origin[i] = start[i]
        row.axes[i, 0], row.axes[i, 2] = d[i], normal[i]
        row.axes[i, 1] = normal[one] * d[two] - normal[two] * d[one]


@njit(alone=TOGETHER)
def _set_frame(row: Record, rotation: Array, known: bool) -> None:
    """Turn a row's axes into the table frame."""
    for i in range(3):
        for k in range(3):
            before, along = row.frame[i, k], 0.0
            for c in range(3):
                along += rotation[i, c] * row.axes[c, k]
            row.frame[i, k] = along
            row.frame_before[i, k] = before if known else along
