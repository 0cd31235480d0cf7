"""How far two convex bodies are apart along an axis.

Axes are normals of faces of either body and perpendiculars of an edge of each; which one is best is
found in `contact.best_axis`. The largest separation of bodies that are in each other is the depth,
exactly: the least way by which they come apart. Of bodies apart it is their distance where a face
meets a corner or two edges cross; else, as between two corners, it is less than the distance, but
above 0.

Axes point from the first body to the second. Faces and edges are numbers in their own body.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.convex import TOGETHER, Hulls
from fecolumn.contact.tolerances import PARALLEL
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

#: What an axis is: none, the normal of a face of the first body or of the second, which then points
#: against the axis, or the perpendicular of an edge of each
NO_AXIS, FACE_OF_FIRST, FACE_OF_SECOND, TWO_EDGES = range(4)


class Relation(NamedTuple):
    """Where the second body is, seen from the frame of the first: turn (3, 3) and shift (3,) [m];
    room for its corners (V, 3) and normals (F, 3) there, for edges near the first body, ways (E,
    3) and near (E,), for numbers of its faces (F,) and for a corner of each body (2, 3).
    """

    turn: Array
    shift: Array
    corners: Array
    normals: Array
    ways: Array
    along: Array
    near: Array
    corner: Array


def relation_for(hulls: Hulls) -> Relation:
    """A relation with room for each of the bodies."""
    corners, faces, edges = (max(int(n), 1) for n in np.diff(hulls.first, axis=0).max(axis=0))
    return Relation(
        np.eye(3),
        np.zeros(3),
        np.zeros((corners, 3)),
        np.zeros((faces, 3)),
        np.zeros((edges, 3)),
        np.zeros(faces),
        np.zeros(edges, np.int64),
        np.zeros((2, 3)),
    )


@njit(alone=TOGETHER)
def relate(centers: Array, rotations: Array, a: int, b: int, relation: Relation) -> None:
    """Find where body b is seen from body a; centers: (N, 3) [m], rotations: (N, 3, 3)."""
    A, B = rotations[a], rotations[b]
    for i in range(3):
        relation.shift[i] = 0.0
        for k in range(3):
            relation.shift[i] += A[k, i] * (centers[b, k] - centers[a, k])
            relation.turn[i, k] = A[0, i] * B[0, k] + A[1, i] * B[1, k] + A[2, i] * B[2, k]


@njit(alone=TOGETHER)
def least_along(
    corners: Array, first: int, last: int, x: float, y: float, z: float
) -> tuple[float, int]:
    """Least product [m] of a vector with corners `first` to before `last`, and the row of it."""
    least, where = np.inf, -1
    for v in range(first, last):
        product = x * corners[v, 0] + y * corners[v, 1] + z * corners[v, 2]
        if product < least:
            least, where = product, v
    return least, where


@njit(alone=TOGETHER)
def over_first(hulls: Hulls, a: int, b: int, relation: Relation, face: int) -> tuple[float, int]:
    """How far [m] body b is over a face of body a, and its row of corners that is nearest."""
    f, T, s = hulls.first[a, 1] + face, relation.turn, relation.shift
    x, y, z = hulls.normals[f, 0], hulls.normals[f, 1], hulls.normals[f, 2]
    least, where = least_along(
        hulls.corners,
        hulls.first[b, 0],
        hulls.first[b + 1, 0],
        T[0, 0] * x + T[1, 0] * y + T[2, 0] * z,
        T[0, 1] * x + T[1, 1] * y + T[2, 1] * z,
        T[0, 2] * x + T[1, 2] * y + T[2, 2] * z,
    )
    return least + x * s[0] + y * s[1] + z * s[2] - hulls.offsets[f], where


@njit(alone=TOGETHER)
def over_second(hulls: Hulls, a: int, b: int, relation: Relation, face: int) -> tuple[float, int]:
    """How far [m] body a is over a face of body b, and its row of corners that is nearest."""
    f, T, s = hulls.first[b, 1] + face, relation.turn, relation.shift
    n = hulls.normals[f]
    x = T[0, 0] * n[0] + T[0, 1] * n[1] + T[0, 2] * n[2]
    y = T[1, 0] * n[0] + T[1, 1] * n[1] + T[1, 2] * n[2]
    z = T[2, 0] * n[0] + T[2, 1] * n[1] + T[2, 2] * n[2]
    least, where = least_along(hulls.corners, hulls.first[a, 0], hulls.first[a + 1, 0], x, y, z)
    return least - x * s[0] - y * s[1] - z * s[2] - hulls.offsets[f], where


@njit(alone=TOGETHER)
def perpendicular(
    hulls: Hulls, a: int, b: int, relation: Relation, first: int, second: int
) -> tuple[float, float, float, float]:
    """Unit vector x, y, z in the frame of body a along the perpendicular of an edge of each, out of
    body a, and the sine of the angle between the edges; 0 of parallel ones.
    """
    i, T = hulls.first[a, 2] + first, relation.turn
    e, w = hulls.ways[i], hulls.ways[hulls.first[b, 2] + second]
    u = T[0, 0] * w[0] + T[0, 1] * w[1] + T[0, 2] * w[2]
    v = T[1, 0] * w[0] + T[1, 1] * w[1] + T[1, 2] * w[2]
    t = T[2, 0] * w[0] + T[2, 1] * w[1] + T[2, 2] * w[2]
    x, y, z = e[1] * t - e[2] * v, e[2] * u - e[0] * t, e[0] * v - e[1] * u
    sine = np.sqrt(x * x + y * y + z * z)
    if sine < PARALLEL:
        return 0.0, 0.0, 0.0, 0.0
    left, right = hulls.first[a, 1] + hulls.sides[i, 0], hulls.first[a, 1] + hulls.sides[i, 1]
    out = (
        x * (hulls.normals[left, 0] + hulls.normals[right, 0])
        + y * (hulls.normals[left, 1] + hulls.normals[right, 1])
        + z * (hulls.normals[left, 2] + hulls.normals[right, 2])
    )
    over = 1 / sine if out > 0 else -1 / sine
    return x * over, y * over, z * over, sine


@njit(alone=TOGETHER)
def along_vector(
    hulls: Hulls, a: int, b: int, relation: Relation, x: float, y: float, z: float
) -> float:
    """Separation [m] along a unit vector in the frame of body a."""
    T, s = relation.turn, relation.shift
    least = least_along(
        hulls.corners,
        hulls.first[b, 0],
        hulls.first[b + 1, 0],
        T[0, 0] * x + T[1, 0] * y + T[2, 0] * z,
        T[0, 1] * x + T[1, 1] * y + T[2, 1] * z,
        T[0, 2] * x + T[1, 2] * y + T[2, 2] * z,
    )[0]
    return (
        least
        + x * s[0]
        + y * s[1]
        + z * s[2]
        + least_along(hulls.corners, hulls.first[a, 0], hulls.first[a + 1, 0], -x, -y, -z)[0]
    )


@njit(alone=TOGETHER)
def separation_along(
    hulls: Hulls, a: int, b: int, relation: Relation, kind: int, first: int, second: int
) -> float:
    """Separation [m] of bodies a and b along an axis of a kind: below 0 where they overlap.

    Bodies are at least as far apart, whether or not the axis is still one of the bodies'
    difference.
    """
    if kind == FACE_OF_FIRST:
        return over_first(hulls, a, b, relation, first)[0]
    if kind == FACE_OF_SECOND:
        return over_second(hulls, a, b, relation, second)[0]
    x, y, z, sine = perpendicular(hulls, a, b, relation, first, second)
    return along_vector(hulls, a, b, relation, x, y, z) if sine > 0.0 else -np.inf
