"""Convex bodies: the corners, plane faces and straight edges of the hull of a body's mesh.

Contact that no joint declares is found between such bodies: pairs that are near in
`contact.nearby`, the axis along which two of them are farthest apart in `contact.separation`, the
places at which they may touch in `contact.manifold`, and all of it for each step, with what was
found in the step before, in `contact.meetings`. A body that is not convex is larger in its hull
than it is: its `share` says so, and the caller refuses it or cuts it into convex parts.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from fecolumn.contact.tolerances import SAME_FACE, SAME_HULL
from fecolumn.foundation.arrays import Array

#: Files beside each other from which the compiled functions of any of them take code
TOGETHER = (
    "best_axis.py",
    "convex.py",
    "manifold.py",
    "meet.py",
    "meetings.py",
    "nearby.py",
    "record.py",
    "separation.py",
    "slots.py",
    "through.py",
    "tolerances.py",
)


class OpenFacesError(ValueError):
    """Faces of which one has an edge that no other face has."""


class Hulls(NamedTuple):
    """Convex bodies, each in its own frame, whose origin is its centre of mass.

    first: (N + 1, 3) rows of each body among all corners, faces and edges: those of body b begin at
    first[b] and end before first[b + 1], none of a body without a hull. corners: (V, 3) [m].
    normals: (F, 3) out of the body, offsets: (F,) of the faces' planes along them [m], middles: (F,
    3) of the faces [m], axes: (F, 3, 3), whose columns are two tangents and the normal.
    loop_first: (F + 1,) rows of each face in loop: (L,) its corners, counter-clockwise seen from
    outside, and loop_edge: (L,) the edge from each to the next one. ends: (E, 2) corners of an
    edge, sides: (E, 2) the faces to its left and right seen from outside along ways: (E, 3), its
    unit vector. All numbers of corners, faces and edges count from the first of their body.
    middle: (N, 3), half: (N, 3) of the box of each body along the axes of its frame [m]; thickness:
    (N,) least distance between a face and a plane parallel to it behind the body [m], to which
    tolerances of length are related; share: (N,) volume of the body over that of its hull, 1 of a
    convex one.
    """

    first: Array
    corners: Array
    normals: Array
    offsets: Array
    middles: Array
    axes: Array
    loop_first: Array
    loop: Array
    loop_edge: Array
    ends: Array
    sides: Array
    ways: Array
    middle: Array
    half: Array
    thickness: Array
    share: Array


def hull_of(points: Array, volume: float | None = None) -> Hulls:
    """Hull of one body with points (n, 3) from its centre of mass [m]; volume: of the body [m3],
    None of one that is known to be convex.
    """
    points = np.asarray(points, float)
    try:
        found = ConvexHull(points)
    except QhullError as error:
        raise ValueError("a convex body has four points that do not lie in one plane") from error
    on, outward = _planes(points, found)
    # a node inside an edge lies on two planes, one inside a face on one
    at_corner = on.sum(axis=0) >= 3
    corners = points[found.vertices[at_corner]]
    loops = [_loop(corners, row[at_corner], normal) for row, normal in zip(on, outward)]
    share = 1.0 if volume is None else volume / found.volume
    try:
        return _assemble(corners, loops, share)
    except OpenFacesError:
        # planes of a slender body that are almost one: its triangles close in any case
        return _assemble(points[found.vertices], _triangles(points, found), share)


def no_hull() -> Hulls:
    """A body without a hull, which meets nothing."""
    return _assemble(np.zeros((0, 3)), [], 1.0)


def hulls_of(bodies: list[Hulls]) -> Hulls:
    """Hulls of several bodies in one, in their order."""
    firsts = [body.first[1:] for body in bodies]
    loops = np.cumsum([0, *(len(body.loop) for body in bodies)])
    whole = {
        name: np.concatenate([getattr(body, name) for body in bodies]) for name in Hulls._fields
    }
    whole["first"] = np.cumsum(np.concatenate([np.zeros((1, 3), np.int64), *firsts]), axis=0)
    whole["loop_first"] = np.concatenate(
        [[0], *(body.loop_first[1:] + start for body, start in zip(bodies, loops))]
    ).astype(np.int64)
    return Hulls(**whole)


def is_convex_body(hulls: Hulls) -> Array:
    """Mask (N,) of the bodies that fill their hulls."""
    return hulls.share > 1 - SAME_HULL


def _planes(points: Array, found: Any) -> tuple[Array, Array]:
    """Which of the hull's vertices (V,) lie on each of its planes: mask (F, V), and outward normals
    (F, 3); found: the ConvexHull of points (n, 3).
    """
    size, vertices, planes, normals = np.ptp(points, axis=0).max(), found.vertices, [], []
    sides = points[found.simplices[:, 1:]] - points[found.simplices[:, :1]]
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    row = np.zeros(len(points), np.int64)
    row[vertices] = np.arange(len(vertices))
    triangles, done = row[found.simplices], np.zeros(len(areas), bool)
    # the largest triangle tells best where the plane of a face is
    for k in np.argsort(-areas, kind="stable"):
        if done[k]:
            continue
        normal, offset = found.equations[k, :3], found.equations[k, 3]
        on = np.abs(points[vertices] @ normal + offset) < SAME_FACE * size
        done |= on[triangles].all(axis=1)
        planes.append(on)
        normals.append(normal)
    return np.array(planes), np.array(normals)


def _triangles(points: Array, found: Any) -> list[Array]:
    """The triangles of a ConvexHull of points (n, 3) as loops of rows among its vertices."""
    row = np.zeros(len(points), np.int64)
    row[found.vertices] = np.arange(len(found.vertices))
    loops = []
    for simplex, normal in zip(found.simplices, found.equations[:, :3]):
        a, b, c = points[simplex]
        outward = np.cross(b - a, c - a) @ normal > 0
        loops.append(row[simplex if outward else simplex[::-1]])
    return loops


def _loop(corners: Array, on: Array, normal: Array) -> Array:
    """Rows of the corners (V, 3) on a face, of a mask (V,), counter-clockwise seen from outside."""
    rows = np.flatnonzero(on)
    away = corners[rows] - corners[rows].mean(axis=0)
    first = away[0] - (away[0] @ normal) * normal
    angle = np.arctan2(away @ np.cross(normal, first), away @ first)
    return rows[np.argsort(angle, kind="stable")]


def _assemble(corners: Array, loops: list[Array], share: float) -> Hulls:
    """Hulls of one body with corners (V, 3) [m] and the loops of its faces."""
    found: list[list[Any]] = []
    sides: list[list[Any]] = []
    edges: dict[tuple[Any, Any], int] = {}
    loop_edge = []
    for f, loop in enumerate(loops):
        for start, end in zip(loop, np.roll(loop, -1)):
            if (end, start) in edges:
                sides[edges[end, start]][1] = f
                loop_edge.append(edges.pop((end, start)))
            else:
                edges[start, end] = len(found)
                loop_edge.append(len(found))
                found.append([start, end])
                sides.append([f, -1])
    if edges or loops and len(corners) - len(found) + len(loops) != 2:
        raise OpenFacesError("the faces of the hull do not close: its points are too inexact")
    normals, axes = np.zeros((len(loops), 3)), np.zeros((len(loops), 3, 3))
    middles = np.zeros((len(loops), 3))
    for f, loop in enumerate(loops):
        middles[f] = corners[loop].mean(axis=0)
        away = corners[loop] - middles[f]
        area = np.cross(away, np.roll(away, -1, axis=0)).sum(axis=0)
        normals[f] = area / np.linalg.norm(area)
        side = away[1] - away[0]
        side -= (side @ normals[f]) * normals[f]
        side /= np.linalg.norm(side)
        axes[f] = np.column_stack([side, np.cross(normals[f], side), normals[f]])
    offsets = np.einsum("fa,fa->f", normals, middles)
    ends = np.array(found, np.int64).reshape(-1, 2)
    ways = corners[ends[:, 1]] - corners[ends[:, 0]]
    behind = (offsets[:, None] - normals @ corners.T).max(axis=1, initial=0.0)
    low, high = (corners.min(axis=0), corners.max(axis=0)) if loops else (np.zeros(3), np.zeros(3))
    return Hulls(
        np.array([[0, 0, 0], [len(corners), len(loops), len(ends)]]),
        corners,
        normals,
        offsets,
        middles,
        axes,
        np.cumsum([0, *(len(loop) for loop in loops)]).astype(np.int64),
        np.concatenate(loops).astype(np.int64) if loops else np.zeros(0, np.int64),
        np.array(loop_edge, np.int64),
        ends,
        np.array(sides, np.int64).reshape(-1, 2),
        ways / np.linalg.norm(ways, axis=1)[:, None],
        (low + high)[None] / 2,
        (high - low)[None] / 2,
        np.array([behind.min() if loops else 0.0]),
        np.array([share]),
    )
