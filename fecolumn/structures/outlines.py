"""Outlines of plane faces as sides of polygons, and the corners of the region where two overlap."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from fecolumn.mesh.bricks import outline_edges
from fecolumn.structures.faces import SAME_PLANE, Face, apart

# Angle [rad] between two sides of an outline that are one edge
_STRAIGHT = 1e-3


def outline_of(face: Face) -> NDArray[Any]:
    """Ends (n, 2, 3) [m] of the sides of the outer outlines of a face, counter-clockwise seen from
    outside, straight on no corner; holes are left out.
    """
    hull = convex_outline(face)
    if hull is not None:
        return np.stack([hull, np.roll(hull, -1, axis=0)], axis=1)
    return np.concatenate([loop for loop in _loops(face) if _area(loop @ face.axes[:, :2]) > 0])


def convex_outline(face: Face) -> NDArray[Any] | None:
    """Corners (n, 3) [m] of the outer outline of a face, counter-clockwise seen from outside; None
    where it is not convex.
    """
    axes, sides = face.axes, face.outline
    plane = sides @ axes[:, :2]
    size = np.ptp(plane, axis=(0, 1)).max()
    hull = plane.reshape(-1, 2)[ConvexHull(plane.reshape(-1, 2)).vertices]
    before, after = hull - np.roll(hull, 1, axis=0), np.roll(hull, -1, axis=0) - hull
    turn = (
        (before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        / np.linalg.norm(before, axis=1)
        / np.linalg.norm(after, axis=1)
    )
    hull = hull[turn > _STRAIGHT]
    around = np.stack([hull, np.roll(hull, -1, axis=0)], axis=1)
    ends = np.stack([plane[:, 0], plane.mean(axis=1), plane[:, 1]], axis=1)
    on = (apart(ends[:, :, None], around[None, None]).min(axis=2) < SAME_PLANE * size).all(axis=1)
    covered = np.linalg.norm(plane[on, 1] - plane[on, 0], axis=1).sum()
    if abs(covered - np.linalg.norm(around[:, 1] - around[:, 0], axis=1).sum()) > 1e-3 * size:
        return None
    corners: NDArray[Any] = hull @ axes[:, :2].T + face.offset * face.normal
    return corners


def inwards(points: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """How far (n,) [m] points (n, 2) are within the outline of sides (m, 2, 2), below 0 beyond
    it.
    """
    start, end, points = sides[:, 0], sides[:, 1], points[:, None]
    crosses = (start[:, 1] > points[..., 1]) != (end[:, 1] > points[..., 1])
    rise = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    where = start[:, 0] + (points[..., 1] - start[:, 1]) / rise * (end[:, 0] - start[:, 0])
    inside = (crosses & (points[..., 0] < where)).sum(axis=1) % 2 == 1
    away = apart(points, sides).min(axis=1)
    return np.where(inside, away, -away)


def crossings(first: NDArray[Any], second: NDArray[Any]) -> NDArray[Any]:
    """Places (n, 2) [m] where sides (m, 2, 2) of two outlines cross or meet."""
    own, other = first[:, 0], second[:, 0]
    along, across = (first[:, 1] - own)[:, None], second[:, 1] - other
    offset, turn = other - own[:, None], cross_product(along, across)
    lengths = np.linalg.norm(along, axis=2) * np.linalg.norm(across, axis=1)
    parallel = np.abs(turn) <= 1e-12 * lengths
    turn = np.where(parallel, 1.0, turn)
    at, there = cross_product(offset, across) / turn, cross_product(offset, along) / turn
    met = ~parallel & (at >= 0) & (at <= 1) & (there >= 0) & (there <= 1)
    places: NDArray[Any] = (own[:, None] + at[..., None] * along)[met]
    return places


def corners_of_overlap(first: NDArray[Any], second: NDArray[Any], slack: float) -> NDArray[Any]:
    """Corners (n, 2) [m] of the region where two outlines, of sides (m, 2, 2), overlap: those of
    one within the other, or beyond it by less than `slack` [m], and where sides cross.
    """
    own, other = first[:, 0], second[:, 0]
    return np.concatenate(
        [
            own[inwards(own, second) >= -slack],
            other[inwards(other, first) >= -slack],
            crossings(first, second),
        ]
    )


def cross_product(one: NDArray[Any], other: NDArray[Any]) -> NDArray[Any]:
    """The cross products (...) of vectors (..., 2)."""
    products: NDArray[Any] = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
    return products


def _loops(face: Face) -> list[NDArray[Any]]:
    """Ends (n, 2, 3) [m] of the sides of each outline of a face, one after the other along it, the
    face on the left.
    """
    number, place = np.unique(face.cells, return_index=True)
    edges, points = outline_edges(face.cells), face.corners.reshape(-1, 3)[place]
    starts: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        starts.setdefault(start, []).append(end)
    found = []
    while starts:
        loop = [next(iter(starts))]
        while (ends := starts.get(loop[-1])) is not None:
            after = ends.pop()
            if not ends:
                del starts[loop[-1]]
            loop.append(after)
        corners = points[np.searchsorted(number, loop[:-1])]
        along = np.roll(corners, -1, axis=0) - corners
        along /= np.linalg.norm(along, axis=1)[:, None]
        straight = np.einsum("na,na->n", along, np.roll(along, 1, axis=0)) > math.cos(_STRAIGHT)
        corners = corners[~straight]
        found.append(np.stack([corners, np.roll(corners, -1, axis=0)], axis=1))
    return found


def _area(sides: NDArray[Any]) -> float:
    """Area [m2] within an outline of sides (n, 2, 2), below 0 clockwise."""
    return float(cross_product(sides[:, 0], sides[:, 1]).sum() / 2)
