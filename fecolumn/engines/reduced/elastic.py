"""Where the points of reduced bodies are: their elastic displacement, positions and velocities,
found where they are wanted.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fecolumn.contact.points import GROUND, OVER
from fecolumn.contact.pose import into_frame
from fecolumn.contact.projection import find_seat, side_of_outline, take_surface
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

# What is asked for at each point is put in place of its call: a call would hand on two hundred
# addresses of arrays, which takes as long as what is done there

# Rows of MotionState.modal: coordinate, rate, and the acceleration that HHT remembers, without
# contact
COORDINATE, RATE, ACCELERATION = range(3)


class Elastic(NamedTuple):
    """Elastic displacement at the START and at the END of a step, found where it is wanted. node:
    (2, N, 3) [m] of nodes, stamp: (2, N) with which they are up to date, now: (2,) the present
    stamps; point: (2, P, 3) of points, in their slaves' frames; seat: (2, P, 3) [m] places of
    points on moving masters, from their centres of mass in their frames.
    """

    node: Array
    stamp: Array
    now: Array
    point: Array
    seat: Array


START, END = range(2)


def no_elastic(nodes: int, points: int) -> Elastic:
    """Room for so many nodes and points, of which nothing is known."""
    return Elastic(
        np.zeros((2, nodes, 3)),
        np.zeros((2, nodes), np.int64),
        np.zeros(2, np.int64),
        np.zeros((2, points, 3)),
        np.zeros((2, points, 3)),
    )


@njit(fastmath={"reassoc", "contract"})
def modal_strain(squares: Array, coordinates: Array) -> float:
    """Strain energy [J] of modes by their squared frequencies (m,) and coordinates (m,)."""
    total = 0.0
    for k in range(len(coordinates)):
        total += squares[k] * coordinates[k] ** 2
    return total / 2


@njit(fastmath={"reassoc", "contract"})
def _node_displacement(pushes: Array, coordinates: Array, node: int, target: Array) -> None:
    """Target (3,): filtered displacement of a node by modal coordinates (m,)."""
    x = y = z = 0.0
    for k in range(len(coordinates)):
        x += pushes[node, 0, k] * coordinates[k]
        y += pushes[node, 1, k] * coordinates[k]
        z += pushes[node, 2, k] * coordinates[k]
    target[0], target[1], target[2] = x, y, z


@njit
def find_all_elastic(structure: Any, b: int, motion: Any, elastic: Elastic, when: int) -> None:
    """Find the elastic displacement of all nodes of body b, for a foot of which all points touch:
    one product.
    """
    first, count = structure.bodies.body[b].first, structure.bodies.body[b].count
    flat = structure.bodies.pushes.reshape(
        3 * len(structure.bodies.pushes), structure.bodies.pushes.shape[2]
    )
    moved = flat[3 * first : 3 * (first + count)] @ motion.modal[b, COORDINATE]
    for i in range(count):
        elastic.stamp[when, first + i] = elastic.now[when]
        for a in range(3):
            elastic.node[when, first + i, a] = moved[3 * i + a]


@njit(inline="always")
def _find_node(structure: Any, node: int, b: int, motion: Any, elastic: Elastic, when: int) -> None:
    """Find the elastic displacement of a node of body b unless it is known."""
    if elastic.stamp[when, node] != elastic.now[when]:
        elastic.stamp[when, node] = elastic.now[when]
        _node_displacement(
            structure.bodies.pushes, motion.modal[b, COORDINATE], node, elastic.node[when, node]
        )


@njit(inline="always")
def find_elastic(
    structure: Any, points: Array, i: int, motion: Any, elastic: Elastic, when: int
) -> None:
    """Find the elastic displacement of point i in a motion at START or END of a step."""
    b = points[i].slave
    x = y = z = 0.0
    for q in range(points[i].count):
        node, w = points[i].carriers[q], points[i].weights[q]
        if elastic.stamp[when, node] != elastic.now[when]:
            elastic.stamp[when, node] = elastic.now[when]
            _node_displacement(
                structure.bodies.pushes, motion.modal[b, COORDINATE], node, elastic.node[when, node]
            )
        x += w * elastic.node[when, node, 0]
        y += w * elastic.node[when, node, 1]
        z += w * elastic.node[when, node, 2]
    elastic.point[when, i, 0], elastic.point[when, i, 1], elastic.point[when, i, 2] = x, y, z


@njit
def find_places(
    structure: Any,
    points: Array,
    rim: Array,
    motion: Any,
    pose: Record,
    elastic: Elastic,
    wanted: Array,
    places: Array,
) -> None:
    """Places (N, 3): positions at the START of the wanted nodes (mask) of the points of a rim (n,)
    in the frame of its interface, without their static part.
    """
    x = np.empty(3)
    for i in rim:
        node, b = points[i].node, points[i].slave
        if not wanted[node]:
            continue
        _find_node(structure, node, b, motion, elastic, START)
        arms, moved = structure.bodies.arms, elastic.node[START]
        for a in range(3):
            x[a] = arms[node, a] + moved[node, a]
        _into_table(motion, b, x[0], x[1], x[2], places[node])
        into_frame(pose, places[node])


@njit
def _into_table(motion: Any, b: int, x: float, y: float, z: float, target: Array) -> None:
    """Target (3,): position of the place x, y, z of body b in its frame."""
    for a in range(3):
        target[a] = (
            motion.frames[b].center[a]
            + motion.rotation[b, a, 0] * x
            + motion.rotation[b, a, 1] * y
            + motion.rotation[b, a, 2] * z
        )


@njit(inline="always")
def find_position(
    points: Array, i: int, motion: Any, elastic: Elastic, when: int, target: Array
) -> None:
    """Target (3,): position of point i in the table frame without its static part, its elastic
    displacement being known; on a ground in the frame of that, which is all of it.
    """
    b, u = points[i].slave, elastic.point[when, i]
    x, y, z = points[i].arm[0] + u[0], points[i].arm[1] + u[1], points[i].arm[2] + u[2]
    for a in range(3):
        target[a] = (
            motion.frames[b].center[a]
            + motion.rotation[b, a, 0] * x
            + motion.rotation[b, a, 1] * y
            + motion.rotation[b, a, 2] * z
        )
    if points[i].master == GROUND:
        for a in range(3):
            target[a] -= motion.grounds[points[i].ground].place[a]
        target[2] += points[i].lift


@njit(inline="always")
def find_on_master(
    structure: Any,
    points: Array,
    i: int,
    motion: Any,
    poses: Array,
    elastic: Elastic,
    when: int,
    target: Array,
) -> None:
    """Position (3,) of point i in the table frame as its place relative to its moving master's
    surface, in the frame of its interface, in place.

    A point that is beyond the surface at the START of a step is put high above it: within a step
    none comes or goes over an outline.
    """
    b, interface = points[i].master, structure.interfaces[points[i].interface]
    answer = find_seat(structure.bodies, interface, points[i], poses[points[i].interface], target)
    for a in range(3):
        elastic.seat[when, i, a] = points[i].seat[a]
    if motion.modal.shape[2] > 0:
        for q in range(3):
            _find_node(structure, points[i].below[q], b, motion, elastic, when)
            take_surface(interface, points[i], q, elastic.node[when, points[i].below[q]], target)
    target[2] += points[i].lift
    if when == START:
        points[i].beyond = side_of_outline(answer, points[i].beyond, target[2], interface.width)
    if points[i].beyond != OVER:
        target[2] = interface.width


@njit
def locate_start(
    structure: Any,
    points: Array,
    i: int,
    start: Any,
    poses: Array,
    elastic: Elastic,
    before: Array,
    place: Array,
) -> None:
    """Elastic displacement at the START of a step of point i, which was open, and where it was,
    unless the step before located it; place: (3,) room.
    """
    find_elastic(structure, points, i, start, elastic, START)
    if points[i].master != GROUND:
        find_position(points, i, start, elastic, START, place)
        find_on_master(structure, points, i, start, poses, elastic, START, place)
        if before[i].located:
            return
    elif before[i].located:
        return
    else:
        find_position(points, i, start, elastic, START, place)
    for a in range(3):
        before[i].relative[a] = place[a]
        if a < 2:
            before[i].anchor[a] = place[a]
    before[i].located = True


@njit
def find_velocity(
    structure: Any,
    points: Array,
    i: int,
    motion: Any,
    poses: Array,
    elastic: Elastic,
    when: int,
    target: Array,
) -> None:
    """Target (3,): velocity of point i relative to its master in a motion, in the frame of its
    interface, its elastic displacement being known.
    """
    b, u = points[i].slave, elastic.point[when, i]
    R, w, moved = motion.rotation[b], motion.frames[b].spin, np.empty(3)
    v0 = v1 = v2 = 0.0
    for q in range(points[i].count):
        _node_displacement(
            structure.bodies.pushes, motion.modal[b, RATE], points[i].carriers[q], moved
        )
        v0 += points[i].weights[q] * moved[0]
        v1 += points[i].weights[q] * moved[1]
        v2 += points[i].weights[q] * moved[2]
    x, y, z = points[i].arm[0] + u[0], points[i].arm[1] + u[1], points[i].arm[2] + u[2]
    v0, v1, v2 = v0 + w[1] * z - w[2] * y, v1 + w[2] * x - w[0] * z, v2 + w[0] * y - w[1] * x
    for a in range(3):
        target[a] = motion.frames[b].velocity[a] + R[a, 0] * v0 + R[a, 1] * v1 + R[a, 2] * v2
    b = points[i].master
    if b == GROUND:
        for a in range(3):
            target[a] -= motion.grounds[points[i].ground].velocity[a]
        return
    R, w, seat, Q = (
        motion.rotation[b],
        motion.frames[b].spin,
        elastic.seat[when, i],
        poses[points[i].interface].frame,
    )
    v0 = v1 = v2 = 0.0
    if motion.modal.shape[2] > 0:
        for q in range(3):
            _node_displacement(
                structure.bodies.pushes, motion.modal[b, RATE], points[i].below[q], moved
            )
            v0 += points[i].shares[q] * moved[0]
            v1 += points[i].shares[q] * moved[1]
            v2 += points[i].shares[q] * moved[2]
    v0, v1, v2 = (
        v0 + w[1] * seat[2] - w[2] * seat[1],
        v1 + w[2] * seat[0] - w[0] * seat[2],
        v2 + w[0] * seat[1] - w[1] * seat[0],
    )
    for a in range(3):
        moved[a] = (
            target[a] - motion.frames[b].velocity[a] - R[a, 0] * v0 - R[a, 1] * v1 - R[a, 2] * v2
        )
    for a in range(3):
        target[a] = Q[0, a] * moved[0] + Q[1, a] * moved[1] + Q[2, a] * moved[2]
