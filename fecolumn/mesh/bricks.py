"""Meshes of 8-node bricks, or of tetrahedra, as plain arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fecolumn.mesh.winding import counterclockwise

LOWER, UPPER, CAP, BASE, FLANGE = 1, 2, 3, 4, 5
PART_NAMES = {
    LOWER: "lower column",
    UPPER: "upper column",
    CAP: "cap",
    BASE: "base",
    FLANGE: "flange",
}

# Faces of the VTK hexahedron and tetrahedron, seen from outside counter-clockwise.
FACES = np.array(
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)
TETRAHEDRON_FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


@dataclass(frozen=True, slots=True)
class BrickMesh:
    """Bricks of one or several parts; or the tetrahedra of a user's column.

    Attributes
    ----------
    points
        (n_points, 3) [m].
    cells
        (n_cells, 8) point numbers in VTK hexahedron order, or (n_cells, 4) of tetrahedra.
    part
        (n_cells,) part of each element: FLANGE, LOWER, UPPER, CAP or BASE.
    relative_density
        (n_cells,) density of each element over that of the body's material [-]; None: all alike.
    """

    points: np.ndarray
    cells: np.ndarray
    part: np.ndarray
    relative_density: np.ndarray | None = None

    @property
    def is_tetrahedral(self) -> bool:
        """Tetrahedra, not bricks."""
        return self.cells.shape[1] == 4

    @property
    def foot_part(self) -> int:
        """The lowest part of a body."""
        return next(part for part in (FLANGE, LOWER, UPPER) if self.has_part(part))

    @property
    def top_part(self) -> int:
        """The highest part of a body."""
        return next(part for part in (CAP, UPPER, LOWER) if self.has_part(part))

    def shifted(self, z: float) -> BrickMesh:
        """The mesh moved up by `z` [m]."""
        return replace(self, points=self.points + [0.0, 0.0, z])

    def only(self, kept: np.ndarray) -> BrickMesh:
        """The elements (n_cells,) that are kept, with all points."""
        shares = self.relative_density
        return replace(
            self,
            cells=self.cells[kept],
            part=self.part[kept],
            relative_density=None if shares is None else shares[kept],
        )

    def has_part(self, part: int) -> bool:
        """Whether any brick belongs to `part`."""
        return bool(np.any(self.part == part))

    def part_nodes(self, part: int) -> np.ndarray:
        """(n,) sorted point numbers of the bricks of `part`."""
        return np.unique(self.cells[self.part == part])


def brick_mesh(points: np.ndarray, cells: np.ndarray, part: int) -> BrickMesh:
    """Mesh of one part, its elements turned to positive volume.

    Parameters
    ----------
    points
        (n_points, 3) [m].
    cells
        (n_cells, 8) point numbers; bottom and top face may be exchanged. Or (n_cells, 4) of
        tetrahedra.
    part
        part of all elements.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    cells = np.array(cells, dtype=np.int64, order="C")
    # Opposite faces give the Jacobian at the brick's centre; its sign is the node order's.
    corners = points[cells]
    if cells.shape[1] == 4:
        inverted = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
        cells[inverted] = cells[inverted][:, [0, 2, 1, 3]]
        return BrickMesh(points, cells, np.full(len(cells), part, dtype=np.int8))
    edges = np.stack(
        [
            corners[:, face].sum(axis=1) - corners[:, opposite].sum(axis=1)
            for face, opposite in ((FACES[3], FACES[5]), (FACES[4], FACES[2]), (FACES[1], FACES[0]))
        ],
        axis=1,
    )
    inverted = np.linalg.det(edges) < 0
    cells[inverted] = cells[inverted][:, [4, 5, 6, 7, 0, 1, 2, 3]]
    return BrickMesh(points, cells, np.full(len(cells), part, dtype=np.int8))


def merged_mesh(meshes: Sequence[BrickMesh]) -> BrickMesh:
    """One mesh of several; coincident points stay apart, so the parts stay disconnected."""
    meshes = list(meshes)
    offsets = np.cumsum([0] + [len(m.points) for m in meshes[:-1]])
    shares = None
    if any(m.relative_density is not None for m in meshes):
        shares = np.concatenate(
            [
                np.ones(len(m.cells)) if m.relative_density is None else m.relative_density
                for m in meshes
            ]
        )
    return BrickMesh(
        np.concatenate([m.points for m in meshes]),
        np.concatenate([m.cells + offset for m, offset in zip(meshes, offsets)]),
        np.concatenate([m.part for m in meshes]),
        shares,
    )


def outer_faces(mesh: BrickMesh, part: int) -> np.ndarray:
    """(n_faces, 4) faces of `part` that no two of its elements share, counter-clockwise seen from
    outside; (n_faces, 3) of tetrahedra.
    """
    of_cell = TETRAHEDRON_FACES if mesh.is_tetrahedral else FACES
    faces = mesh.cells[mesh.part == part][:, of_cell].reshape(-1, of_cell.shape[1])
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    return faces[np.sort(first[count == 1])]


def boundary_faces(mesh: BrickMesh, part: int, z: float, tolerance: float) -> np.ndarray:
    """Outer faces of `part` that lie in a horizontal plane.

    Parameters
    ----------
    mesh
        bricks or tetrahedra.
    part
        the part whose faces are sought.
    z
        height of the plane [m].
    tolerance
        largest distance of a corner from the plane [m].

    Returns
    -------
    (n_faces, 4 or 3) point numbers, counter-clockwise in plan (seen from +z).
    """
    faces = outer_faces(mesh, part)
    faces = faces[np.all(np.abs(mesh.points[faces, 2] - z) <= tolerance, axis=1)]
    return counterclockwise(mesh.points[:, :2], faces)


def outline_edges(faces: np.ndarray) -> np.ndarray:
    """(n, 2) point numbers of the edges that no two of the faces (n_faces, 4 or 3) share: the
    outlines of the surface that they make.
    """
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    return edges[np.sort(first[count == 1])]
