"""Convex bodies in their places, and a step in which their contact is found."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from fecolumn.contact.convex import Hulls, hull_of, hulls_of
from fecolumn.contact.meet import Room, find_meetings, room_for
from fecolumn.contact.meetings import NO_PAIR, Meetings, add_grounds, keep_rows, meetings_for
from fecolumn.contact.nearby import Boxes, boxes_for, find_boxes, find_pairs


def box(x, y, z):
    """Corners of a box about its middle."""
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    return signs * [x / 2, y / 2, z / 2]


def frustum(sides, below, above, height):
    """Corners of a tapered drum about the mean of its corners."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides)])
    corners = np.vstack([below * ring, above * ring + [0, 0, height]])
    return corners - corners.mean(axis=0)


def prism(rng, sides, height):
    """Corners of a prism over corners on an ellipse about their mean."""
    angle = np.sort(rng.uniform(0, 2 * np.pi, sides))
    plane = np.column_stack([np.cos(angle), rng.uniform(0.4, 1) * np.sin(angle)])
    corners = np.vstack([np.column_stack([plane, np.full(sides, z)]) for z in (0, height)])
    return corners - corners.mean(axis=0)


def turned(*vector):
    """Rotation (3, 3) by a vector [rad]."""
    return Rotation.from_rotvec(vector).as_matrix()


class World(NamedTuple):
    hulls: Hulls
    boxes: Boxes
    meetings: Meetings
    room: Room
    ground_places: np.ndarray
    ground_axes: np.ndarray


def world(*bodies, ground=None, slots=8):
    """Bodies given by their corners, and a ground at a height or none."""
    hulls = hulls_of([hull_of(body) for body in bodies])
    places = np.zeros((0, 3)) if ground is None else np.array([[0.0, 0.0, ground]])
    axes = np.tile(np.eye(3), (len(places), 1, 1))
    rows = len(bodies) * (len(bodies) + 1) // 2
    count = len(bodies)
    return World(hulls, boxes_for(count), meetings_for(rows, slots), room_for(hulls), places, axes)


def step(w, centers, rotations, reach=0.01):
    """Find contact as a step does; whether others take part than before."""
    pairs, no_pairs = np.zeros((len(w.meetings.rows), 2), np.int64), np.zeros(0, np.int64)
    find_boxes(w.hulls, centers, rotations, np.full(len(centers), reach), w.boxes)
    found = find_pairs(w.hulls, w.boxes, no_pairs, pairs)
    found = add_grounds(w.hulls, w.boxes, w.ground_places, w.ground_axes, pairs, found)
    assert keep_rows(w.meetings, pairs[:found]) == 0
    return find_meetings(
        w.hulls,
        centers,
        rotations,
        w.ground_places,
        w.ground_axes,
        reach,
        w.meetings,
        w.room,
    )


def row_of(w, first, second):
    """Row and used places of a pair."""
    for row, places in zip(w.meetings.rows, w.meetings.places):
        if tuple(row.pair) == (first, second):
            return row, places[places["name"] != 0]
    return None


def on_bodies(row, places, centers, rotations):
    """Places (n, 3) [m] on the slave and on the master, in the table frame."""
    own = centers[row.slave] + places["arm"] @ rotations[row.slave].T
    if row.master < 0:
        return own, places["seat"]
    return own, centers[row.master] + places["seat"] @ rotations[row.master].T


def used_rows(w):
    """Numbers of the rows that have a pair."""
    return [r for r, row in enumerate(w.meetings.rows) if row.pair[0] != NO_PAIR]
