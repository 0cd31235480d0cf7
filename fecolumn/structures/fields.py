"""Fields of a structure in full order: displacement, stress and contact pressure of all bodies in
one mesh that tells them apart.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.dynamics.checkpoint import gather_all
from fecolumn.mesh.bricks import outer_faces
from fecolumn.post.fields import StressField, vertex_nodes
from fecolumn.structures.faces import SAME_PLANE


class StructureFields:
    """Fields of bodies from positions and contact forces, body by body in the order of their
    meshes; `body` numbers them from 1, as the case does.

    Parameters
    ----------
    column
        `fem.composite.Composite`.
    meshed
        `elements.Meshed` of each part.
    structure
        StructureModel, as it stands upright.
    points
        (P,) of POINT.
    """

    def __init__(self, column, meshed: list, structure, points: np.ndarray):
        self.comm, self._column, self._points = column.comm, column, points
        self.meshes = [
            replace(
                one.shape.mesh,
                points=part.center + (one.shape.mesh.points - part.model.center) @ part.rotation.T,
            )
            for one, part in zip(meshed, structure.parts)
        ]
        self.of_cells = {
            "part": np.concatenate([mesh.part for mesh in self.meshes]),
            "body": np.repeat(
                np.arange(1, len(meshed) + 1), [len(mesh.cells) for mesh in self.meshes]
            ),
        }
        self._nodes = column.of_each(lambda body, _: vertex_nodes(body))
        self._stress = column.of_each(lambda body, _: StressField(body))
        self._first = np.cumsum([0] + [len(mesh.points) for mesh in self.meshes])
        self._seats = [self._seat(meshed[joint.slave], joint) for joint in structure.joints]

    def _seat(self, one, joint):
        """Of a joint: first point of the slave's mesh, those on the slave's face, the contact point
        nearest to each, and the contact points' areas.
        """
        patch, mesh = one.patches[joint.slave_surface], one.shape.mesh
        faces = outer_faces(mesh, patch.part)
        away = np.abs((mesh.points[faces] - patch.origin) @ patch.axes[:, 2]).max(axis=1)
        corners = np.unique(faces[away < SAME_PLANE * np.ptp(mesh.points, axis=0).max()])
        return (
            self._first[joint.slave],
            corners,
            cKDTree(patch.positions).query(mesh.points[corners])[1],
            patch.areas,
        )

    def values(self, x, local, positions, forces, at_nodes) -> dict[str, np.ndarray] | None:
        """As of `post.fields.SpecimenFields.values`: displacement (n_points, 3) [m] from where the
        bodies stand upright, von Mises stress (n_cells,) [Pa], and pressure (n_points,) [Pa] on the
        faces of slaves; on rank 0.

        Parameters
        ----------
        x
            (n_owned, 3) positions [m]
        local
            displacements in the frames of the bodies [m].
        forces
            (P, 3) of the contact points [N].
        """
        column = self._column
        moved = [
            gather_all(part, (x - column.placed)[rows])
            for part, rows in zip(column.parts, column.rows)
        ]
        stress = [own.values(local[rows]) for own, rows in zip(self._stress, column.rows)]
        if column.comm.rank:
            return None
        pressure = np.zeros(self._first[-1])
        for number, (first, corners, nearest, areas) in enumerate(self._seats):
            push = forces[self._points["interface"] == number, 2]
            pressure[first + corners] += np.divide(
                push, areas, out=np.zeros(len(push)), where=areas > 0
            )[nearest]
        return {
            "displacement": np.vstack([values[nodes] for values, nodes in zip(moved, self._nodes)]),
            "von_mises": np.concatenate(stress),
            "pressure": pressure,
        }
