"""What is drawn of a specimen: its surfaces, the faces of its foot, the points of the history and
its mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.mesh.bricks import FACES, TETRAHEDRON_FACES, BrickMesh, boundary_faces
from fecolumn.mesh.quality import MassProperties, mass_properties
from fecolumn.mesh.specimen import SpecimenMesh, specimen_mesh
from fecolumn.short_form import ShortForm

# Heights that are one [-]: of the body's, as where the mesh is tied
_FLAT = 1e-6


@dataclass(frozen=True, slots=True)
class Surface:
    """The outside of a mesh.

    Attributes
    ----------
    points
        (n, 3) [m] at rest.
    nodes
        (n,) their numbers in the mesh.
    faces
        (n_faces, 4 or 3) of these points, counter-clockwise seen from outside.
    cells
        (n_faces,) the element that each belongs to.
    part
        (n_faces,) its part.
    """

    points: np.ndarray
    nodes: np.ndarray
    faces: np.ndarray
    cells: np.ndarray
    part: np.ndarray


@dataclass(frozen=True, slots=True)
class Solid:
    """A specimen as it is drawn, in its reference position.

    Attributes
    ----------
    mesh
        of column and base.
    column
        Surface
    base
        Surface, None of a base without bricks.
    foot_faces
        (n_faces, 4 or 3) point numbers of the column on the base.
    foot, top
        (3,) [m] centres of the foot and of the top's face, whose displacements the history has.
    mass
        MassProperties of the column.
    """

    mesh: SpecimenMesh
    column: Surface
    base: Surface | None
    foot_faces: np.ndarray
    foot: np.ndarray
    top: np.ndarray
    mass: MassProperties

    @property
    def height(self) -> float:
        """Of column and cap [m]."""
        return float(np.ptp(self.mesh.body.points[:, 2]))

    @property
    def foot_width(self) -> float:
        """Larger side of the foot [m]."""
        return float(np.ptp(self.mesh.body.points[np.unique(self.foot_faces)][:, :2], axis=0).max())


def solid_of(case: ShortForm) -> Solid:
    """The specimen of a finished case, meshed anew.

    Raises
    ------
    InputError
        the mesh file that the case names is gone, or does not fit it any more.
    """
    mesh = specimen_mesh(case)
    body = mesh.body
    height = float(body.points[:, 2].max())
    foot = boundary_faces(body, body.foot_part, 0.0, _FLAT * height)
    top = boundary_faces(body, body.top_part, height, _FLAT * height)
    return Solid(
        mesh,
        _surface(body),
        _surface(mesh.base) if len(mesh.base.cells) else None,
        foot,
        _centre(body.points[foot]),
        _centre(body.points[top]),
        mass_properties(body, case.material.density_kg_m3),
    )


def _surface(mesh: BrickMesh) -> Surface:
    """Faces that no two elements share, each with the element that it belongs to; parts share no
    points.
    """
    of_cell = TETRAHEDRON_FACES if mesh.is_tetrahedral else FACES
    faces = mesh.cells[:, of_cell].reshape(-1, of_cell.shape[1])
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = np.sort(first[count == 1])
    nodes, corners = np.unique(faces[outer], return_inverse=True)
    cells = outer // len(of_cell)
    return Surface(
        mesh.points[nodes], nodes, corners.reshape(len(outer), -1), cells, mesh.part[cells]
    )


def _centre(faces: np.ndarray) -> np.ndarray:
    """Middle (3,) of the area of plane faces with corners (n_faces, k, 3)."""
    first, areas, middles = faces[:, :1], [], []
    for a in range(1, faces.shape[1] - 1):
        triangle = np.concatenate([first, faces[:, a : a + 2]], axis=1)
        areas.append(
            np.linalg.norm(
                np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]), axis=1
            )
        )
        middles.append(triangle.mean(axis=1))
    return np.average(np.concatenate(middles), axis=0, weights=np.concatenate(areas))
