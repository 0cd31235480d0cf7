"""The axis along which two convex bodies are farthest apart.

Two convex bodies are apart exactly if they are along one of these axes: the normals of the faces of
either, and the common perpendicular of an edge of each (the separating axis theorem). Of edges only
those pairs count that make a face of the bodies' difference, where the arcs of both edges between
the normals of their faces cross on the unit sphere (D. Gregorius, The separating axis test between
convex polyhedra, Game Developers Conference 2013); of these only edges along whose arc the nearest
corner of the other body is farther than along the best face.

The least way by which bodies that are in each other come apart is along that axis.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.convex import TOGETHER
from fecolumn.contact.separation import (
    FACE_OF_FIRST,
    FACE_OF_SECOND,
    TWO_EDGES,
    along_vector,
    over_first,
    over_second,
    perpendicular,
)
from fecolumn.contact.tolerances import NEARLY_PARALLEL, OTHER_AXIS
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.convex import Hulls
    from fecolumn.contact.separation import Relation


@njit(alone=TOGETHER)
def _over_faces(
    hulls: Hulls, a: int, b: int, relation: Relation, enough: float, band: float
) -> tuple[float, int, int]:
    """Largest gap between one body and the plane of a face of the other [m], over the faces of
    both.

    The search ends at a face whose gap is above `enough`. `relation.corner` gets the corners that
    are nearest to the best faces of a and b. A face is passed over where the corner nearest to an
    earlier face tells that its gap is smaller.

    Returns: the gap, the face of a, and the face of b, -1 where its gap is not larger than that of
    a by `band` [m].
    """
    T, s, corner = relation.turn, relation.shift, relation.corner
    most, face_a, face_b = -np.inf, -1, -1
    # any place of a body will do to begin with: its centre of mass
    for k in range(3):
        corner[0, k], corner[1, k] = 0.0, s[k]
    for f in range(hulls.first[a + 1, 1] - hulls.first[a, 1]):
        row, bound = hulls.first[a, 1] + f, 0.0
        for k in range(3):
            bound += hulls.normals[row, k] * corner[1, k]
        if bound - hulls.offsets[row] <= most:
            continue
        over, where = over_first(hulls, a, b, relation, f)
        if over > most:
            most, face_a = over, f
            if over > enough:
                return most, face_a, -1
            for k in range(3):
                corner[1, k] = s[k]
                for c in range(3):
                    corner[1, k] += T[k, c] * hulls.corners[where, c]
    # of body a, a corner of its face
    row = hulls.loop_first[hulls.first[a, 1] + face_a]
    for k in range(3):
        corner[0, k] = hulls.corners[hulls.first[a, 0] + hulls.loop[row], k]
    most += band
    for f in range(hulls.first[b + 1, 1] - hulls.first[b, 1]):
        row, bound = hulls.first[b, 1] + f, 0.0
        for k in range(3):
            at = 0.0
            for c in range(3):
                at += T[c, k] * (corner[0, c] - s[c])
            bound += hulls.normals[row, k] * at
        if bound - hulls.offsets[row] <= most:
            continue
        over, where = over_second(hulls, a, b, relation, f)
        if over > most:
            most, face_b = over, f
            if over > enough:
                break
            for k in range(3):
                corner[0, k] = hulls.corners[where, k]
    if face_b < 0:
        return most - band, face_a, face_b
    row = hulls.loop_first[hulls.first[b, 1] + face_b]
    for k in range(3):
        corner[1, k] = s[k]
        for c in range(3):
            corner[1, k] += T[k, c] * hulls.corners[hulls.first[b, 0] + hulls.loop[row], c]
    return most, face_a, face_b


@njit(alone=TOGETHER)
def _lay_out(hulls: Hulls, b: int, relation: Relation) -> None:
    """Put corners and normals of body b into the frame of the first body."""
    T, s = relation.turn, relation.shift
    for v in range(hulls.first[b + 1, 0] - hulls.first[b, 0]):
        p = hulls.corners[hulls.first[b, 0] + v]
        for k in range(3):
            relation.corners[v, k] = T[k, 0] * p[0] + T[k, 1] * p[1] + T[k, 2] * p[2] + s[k]
    for f in range(hulls.first[b + 1, 1] - hulls.first[b, 1]):
        p = hulls.normals[hulls.first[b, 1] + f]
        for k in range(3):
            relation.normals[f, k] = T[k, 0] * p[0] + T[k, 1] * p[1] + T[k, 2] * p[2]


@njit(alone=TOGETHER)
def _most_over(
    x: float, y: float, z: float, corners: Array, start: int, normals: Array, left: int, right: int
) -> float:
    """How far [m] a place is at most over an edge from corner `start`, along any direction between
    the normals `left` and `right` of its faces.
    """
    x, y, z = x - corners[start, 0], y - corners[start, 1], z - corners[start, 2]
    u, v, w = normals[left, 0], normals[left, 1], normals[left, 2]
    p, q, r = normals[right, 0], normals[right, 1], normals[right, 2]
    over_left, over_right = u * x + v * y + w * z, p * x + q * y + r * z
    cosine = u * p + v * q + w * r
    share_left, share_right = over_left - cosine * over_right, over_right - cosine * over_left
    if share_left <= 0.0 or share_right <= 0.0:
        return max(over_left, over_right)
    sine = 1.0 - cosine * cosine
    # the place is between both normals, which may be too near each other to say where
    return (
        np.sqrt((share_left * over_left + share_right * over_right) / sine)
        if sine > 1e-8
        else np.inf
    )


@njit(alone=TOGETHER)
def _over_edges(
    hulls: Hulls, a: int, b: int, relation: Relation, enough: float
) -> tuple[float, int, int]:
    """Largest separation above `enough` along perpendiculars of two edges [m], and the edges; -1
    where there is none. The corners of `_over_faces` are in relation.
    """
    _lay_out(hulls, b, relation)
    most, edge_a, edge_b, count = enough, -1, -1, 0
    faces, start = hulls.first[b + 1, 1] - hulls.first[b, 1], hulls.first[a, 0]
    ways, normals, along, near = relation.ways, relation.normals, relation.along, relation.near
    corner = relation.corner
    for j in range(hulls.first[b + 1, 2] - hulls.first[b, 2]):
        other = hulls.first[b, 2] + j
        over = _most_over(
            corner[0, 0],
            corner[0, 1],
            corner[0, 2],
            relation.corners,
            hulls.ends[other, 0],
            normals,
            hulls.sides[other, 0],
            hulls.sides[other, 1],
        )
        if over > enough:
            near[count] = j
            for k in range(3):
                ways[count, k] = (
                    relation.turn[k, 0] * hulls.ways[other, 0]
                    + relation.turn[k, 1] * hulls.ways[other, 1]
                    + relation.turn[k, 2] * hulls.ways[other, 2]
                )
            count += 1
    for i in range(hulls.first[a + 1, 2] - hulls.first[a, 2] if count > 0 else 0):
        row = hulls.first[a, 2] + i
        left_row, right_row = (
            hulls.first[a, 1] + hulls.sides[row, 0],
            hulls.first[a, 1] + hulls.sides[row, 1],
        )
        over = _most_over(
            corner[1, 0],
            corner[1, 1],
            corner[1, 2],
            hulls.corners,
            start + hulls.ends[row, 0],
            hulls.normals,
            left_row,
            right_row,
        )
        if over <= most:
            continue
        e, p = hulls.ways[row], hulls.corners[start + hulls.ends[row, 0]]
        left, right = hulls.normals[left_row], hulls.normals[right_row]
        for f in range(faces):
            along[f] = e[0] * normals[f, 0] + e[1] * normals[f, 1] + e[2] * normals[f, 2]
        for c in range(count):
            j = near[c]
            other = hulls.first[b, 2] + j
            # the arcs between the normals cross, those of b turned round
            right_b = along[hulls.sides[other, 1]]
            if along[hulls.sides[other, 0]] * right_b >= 0.0:
                continue
            w0, w1, w2 = ways[c, 0], ways[c, 1], ways[c, 2]
            left_a = left[0] * w0 + left[1] * w1 + left[2] * w2
            if right_b * left_a >= 0.0:
                continue
            if left_a * (right[0] * w0 + right[1] * w1 + right[2] * w2) >= 0.0:
                continue
            x, y, z, sine = perpendicular(hulls, a, b, relation, i, j)
            if sine == 0.0:
                continue
            if sine < NEARLY_PARALLEL:
                over = along_vector(hulls, a, b, relation, x, y, z)
            else:
                q = relation.corners[hulls.ends[other, 0]]
                over = x * (q[0] - p[0]) + y * (q[1] - p[1]) + z * (q[2] - p[2])
            if over > most:
                most, edge_a, edge_b = over, i, j
    return most, edge_a, edge_b


@njit(alone=TOGETHER)
def _gap_of_edges(
    hulls: Hulls, a: int, b: int, relation: Relation, first: int, second: int
) -> float:
    """Distance [m] of an edge of body a and one of body b along their perpendicular: the separation
    along it where no other corner reaches farther. The edges of a prism that are parallel to one
    of the two have the same perpendicular.
    """
    x, y, z, _ = perpendicular(hulls, a, b, relation, first, second)
    T, s = relation.turn, relation.shift
    p = hulls.corners[hulls.first[a, 0] + hulls.ends[hulls.first[a, 2] + first, 0]]
    q = hulls.corners[hulls.first[b, 0] + hulls.ends[hulls.first[b, 2] + second, 0]]
    return (
        x * (T[0, 0] * q[0] + T[0, 1] * q[1] + T[0, 2] * q[2] + s[0] - p[0])
        + y * (T[1, 0] * q[0] + T[1, 1] * q[1] + T[1, 2] * q[2] + s[1] - p[1])
        + z * (T[2, 0] * q[0] + T[2, 1] * q[1] + T[2, 2] * q[2] + s[2] - p[2])
    )


@njit(alone=TOGETHER)
def largest_separation(
    hulls: Hulls, a: int, b: int, relation: Relation
) -> tuple[float, int, int, int]:
    """Largest separation of bodies a and b [m], the kind of its axis and its face or edges, -1
    where there is none; relation: of `relate`.
    """
    faces, face_a, face_b = _over_faces(hulls, a, b, relation, np.inf, 0.0)
    most, edge_a, edge_b = _over_edges(hulls, a, b, relation, faces)
    if edge_a >= 0:
        return most, TWO_EDGES, edge_a, edge_b
    if face_b >= 0:
        return faces, FACE_OF_SECOND, -1, face_b
    return faces, FACE_OF_FIRST, face_a, -1


@njit(alone=TOGETHER)
def choose_axis(
    hulls: Hulls,
    a: int,
    b: int,
    relation: Relation,
    enough: float,
    kind: int,
    first: int,
    second: int,
    before: float,
) -> tuple[float, int, int, int]:
    """Axis of contact of bodies a and b: separation along it [m], its kind and its face or edges.

    It is that of the largest separation, with a preference of OTHER_AXIS for the one of the step
    before and for faces over two edges, so that bodies at rest keep theirs. A face over which they
    are farther apart than `enough` [m] is taken at once.

    Parameters
    ----------
    kind, first, second, before
        axis of the step before and the separation along it now; NO_AXIS where there is none.
    """
    band = OTHER_AXIS * min(hulls.thickness[a], hulls.thickness[b])
    most, face_a, face_b = _over_faces(hulls, a, b, relation, enough, band)
    if most <= enough:
        edges, edge_a, edge_b = _over_edges(hulls, a, b, relation, most + band)
        # one pair of edges stays until a face is nearly as good, or others along them are nearer
        if (
            kind == TWO_EDGES
            and before > most + band / 2
            and (edge_a < 0 or before > edges - band)
            and _gap_of_edges(hulls, a, b, relation, first, second) < before + band
        ):
            return before, kind, first, second
        if edge_a >= 0:
            return edges, TWO_EDGES, edge_a, edge_b
        if (kind == FACE_OF_FIRST or kind == FACE_OF_SECOND) and before > most - band:
            return before, kind, first, second
    if face_b >= 0:
        return most, FACE_OF_SECOND, -1, face_b
    return most, FACE_OF_FIRST, face_a, -1
