"""Plane faces of a body's mesh, and which of them coincide with faces of another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fecolumn.contact.tolerances import LEVEL
from fecolumn.mesh.bricks import BrickMesh, outer_faces, outline_edges

#: Over the size of a body: faces within it lie in one plane, and faces of two bodies coincide. What
#: rounding of five digits leaves.
SAME_PLANE = 1e-5
# Sine of the angle between faces of one plane
_PARALLEL = 1e-6


@dataclass(frozen=True)
class Face:
    """All outer faces of elements of one part of a body in one plane.

    part: of the mesh. normal: (3,) out of the body; offset: of the plane along it [m]. cells: (n, 4
    or 3) point numbers of the element faces, counter-clockwise seen from outside; corners: (n, 4 or
    3, 3) their places [m] in the drawing of the body.
    """

    part: int
    normal: NDArray[Any]
    offset: float
    cells: NDArray[Any]
    corners: NDArray[Any]

    @cached_property
    def area(self) -> float:
        """Area [m2]."""
        return float(np.linalg.norm(_normals(self.corners), axis=1).sum() / 2)

    @cached_property
    def axes(self) -> NDArray[Any]:
        """Two tangents and the normal as columns (3, 3), right-handed; the first tangent is the x
        axis where the face is level.
        """
        along = (
            np.array([1.0, 0.0, 0.0]) if abs(self.normal[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
        )
        first = along - self.normal * (along @ self.normal)
        first /= np.linalg.norm(first)
        return np.stack([first, np.cross(self.normal, first), self.normal], axis=1)

    @cached_property
    def plane(self) -> NDArray[Any]:
        """Corners (n, 4 or 3, 2) [m] along the tangents, in the drawing of the body."""
        corners: NDArray[Any] = self.corners.reshape(-1, 3) @ self.axes[:, :2]
        return corners.reshape(*self.corners.shape[:2], 2)

    @cached_property
    def box(self) -> NDArray[Any]:
        """Least and largest (2, 2) [m] of the corners along the tangents."""
        return np.array([self.plane.min(axis=(0, 1)), self.plane.max(axis=(0, 1))])

    @property
    def is_level(self) -> bool:
        """Whether it looks straight up or down."""
        return bool(abs(self.normal[2]) > LEVEL)

    @property
    def outline(self) -> NDArray[Any]:
        """Ends (n, 2, 3) [m] of the sides of the face's outlines."""
        number, place = np.unique(self.cells, return_index=True)
        return self.corners.reshape(-1, 3)[place][
            np.searchsorted(number, outline_edges(self.cells))
        ]


def plane_faces(mesh: BrickMesh) -> list[Face]:
    """Every plane that outer faces of a mesh lie in, those of the largest area first."""
    size, found = np.ptp(mesh.points, axis=0).max(), []
    for part in sorted(set(mesh.part.tolist())):
        cells = outer_faces(mesh, part)
        corners = mesh.points[cells]
        normals = _normals(corners)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        offsets = np.einsum("ni,ni->n", normals, corners.mean(axis=1))
        flat = (
            np.abs(np.einsum("ni,nai->na", normals, corners) - offsets[:, None]).max(axis=1)
            < SAME_PLANE * size
        )
        for rows in _alike(np.column_stack([normals, offsets / size])[flat]):
            rows = np.flatnonzero(flat)[rows]
            normal = normals[rows].mean(axis=0)
            normal[np.abs(normal) < _PARALLEL] = 0.0
            found.append(
                Face(
                    part,
                    normal / np.linalg.norm(normal),
                    float(offsets[rows].mean()),
                    cells[rows],
                    corners[rows],
                )
            )
    return sorted(found, key=lambda face: -face.area)


def _normals(corners: NDArray[Any]) -> NDArray[Any]:
    """Normals (n, 3) of twice the area of faces (n, 4 or 3, 3)."""
    if corners.shape[1] == 3:
        one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    else:
        one, other = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normals: NDArray[Any] = np.cross(one, other)
    return normals


def _alike(planes: NDArray[Any]) -> list[NDArray[Any]]:
    """Rows of planes (n, 4), normals and offsets over the size, that are the same within
    SAME_PLANE.
    """
    if not len(planes):
        return []
    rounded, group = np.unique(np.round(planes / (0.1 * SAME_PLANE)), axis=0, return_inverse=True)
    pairs = cKDTree(rounded).query_pairs(10.0, output_type="ndarray")
    links = coo_array((np.ones(len(pairs), np.int8), pairs.T), shape=(len(rounded),) * 2)
    label = connected_components(links, directed=False)[1][group.ravel()]
    return [np.flatnonzero(label == one) for one in range(label.max() + 1)]


def over(points: NDArray[Any], triangles: NDArray[Any], tolerance: float) -> NDArray[Any]:
    """Which points (n, 2) lie in any of the triangles (t, 3, 2) of a plane, or within `tolerance`
    [m] of one.
    """
    return np.concatenate([np.zeros(0, bool), *_over_by_parts(points, triangles, tolerance)])


def any_over(points: NDArray[Any], triangles: NDArray[Any], tolerance: float) -> bool:
    """Whether any of the points lies there, as of `over`: sooner known than which."""
    return any(part.any() for part in _over_by_parts(points, triangles, tolerance))


def _over_by_parts(
    points: NDArray[Any], triangles: NDArray[Any], tolerance: float
) -> Iterator[NDArray[Any]]:
    """`over` of some hundred points after the other."""
    a, ab, ac = (
        triangles[:, 0],
        triangles[:, 1] - triangles[:, 0],
        triangles[:, 2] - triangles[:, 0],
    )
    double = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    # shares of the corners may be negative by the tolerance over the smallest height of the
    # triangle
    longest = np.linalg.norm(np.stack([ab, ac, ac - ab]), axis=2).max(axis=0)
    slack = tolerance * longest / np.abs(double)
    for first in range(0, len(points), 256):
        offset = points[first : first + 256, None] - a
        s = (offset[..., 0] * ac[:, 1] - offset[..., 1] * ac[:, 0]) / double
        t = (offset[..., 1] * ab[:, 0] - offset[..., 0] * ab[:, 1]) / double
        yield ((s >= -slack) & (t >= -slack) & (s + t <= 1 + slack)).any(axis=1)


def apart(points: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """Distances (...) [m] of points (..., 2) from the sides (..., 2, 2) between two ends each,
    which broadcast.
    """
    start, along = sides[..., 0, :], sides[..., 1, :] - sides[..., 0, :]
    offset, square = points - start, (along**2).sum(axis=-1)
    share = np.clip((offset * along).sum(axis=-1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    distances: NDArray[Any] = np.linalg.norm(offset - share[..., None] * along, axis=-1)
    return distances


def apart_from_side(triangles: NDArray[Any], side: NDArray[Any]) -> NDArray[Any]:
    """Distances (t,) [m] of triangles (t, 3, 2) from the side (2, 2) between two ends, 0 of those
    that it meets.
    """
    around = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
    found: NDArray[Any] = np.minimum(
        apart(triangles, side).min(axis=1), apart(side[:, None, None], around).min(axis=(0, 2))
    )

    def left(
        ends: NDArray[Any], point: NDArray[Any]
    ) -> NDArray[Any]:  # of the way between two ends
        way, offset = ends[..., 1, :] - ends[..., 0, :], point - ends[..., 0, :]
        turned: NDArray[Any] = way[..., 0] * offset[..., 1] - way[..., 1] * offset[..., 0]
        return turned

    first, last = left(around, side[0]), left(around, side[1])
    crossed = (first * last < 0) & (left(side, around[:, :, 0]) * left(side, around[:, :, 1]) < 0)
    found[(first >= 0).all(axis=1) | (first <= 0).all(axis=1) | crossed.any(axis=1)] = 0.0
    return found


def triangles_of(quads: NDArray[Any]) -> NDArray[Any]:
    """Triangles (t, 3, 2) of faces (n, 4 or 3, 2)."""
    return (
        quads if quads.shape[1] == 3 else np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    )
