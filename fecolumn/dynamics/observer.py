"""What an engineer watches: top displacement, tilt, twist, slide, contact resultant; and when the column is lost."""

from __future__ import annotations

import math

import numpy as np

from fecolumn.dynamics.rotation import tilt_angle, twist_angle
from fecolumn.mesh.bricks import boundary_faces
from fecolumn.mesh.surface import face_points, nodal_areas

#: Tilt beyond the critical one, as a factor, at which a column that is still falling counts as lost.
LOST = 1.5


def top_of(column, specimen) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (k,) of the top's face and their shares (k,) in its mean."""
    mesh = specimen.body
    part = mesh.top_part
    height = mesh.points[:, 2].max()
    quads = boundary_faces(mesh, part, height, 1e-6 * height)
    found = column.find_nodes(face_points(mesh.points[quads], column.order).reshape(-1, 3), part)
    nodes, position = np.unique(found, return_inverse=True)
    areas = nodal_areas(mesh.points[quads], position.reshape(len(quads), -1), len(nodes), column.order)
    return nodes, areas / areas.sum()


class Observer:
    """Measures a state of a system.

    The top's displacement is the mean over its top face, which is that of the face's centre; it is relative to the base
    and to the unstrained upright position.
    """

    def __init__(self, system, specimen, overturn_displacement: float):
        self.system, self.limit = system, overturn_displacement
        column = system.column
        self._top, self._weights = top_of(column, specimen)
        radius = np.linalg.norm(column.all_X[system.foot_nodes, :2] - column.center[:2], axis=1).max()
        #: Tilt (slenderness) at which the centre of mass stands over the rim [rad].
        self.critical_tilt = math.atan2(radius, column.center[2])
        self.last_tilt = 0.0

    def measure(self, state) -> dict:
        """Measures of a state by the names of the history file, in SI units."""
        system = self.system
        column = system.column
        top = self._weights @ (column.gather(self._top, state.x) - column.all_X[self._top])
        area = system.areas / system.areas.sum()
        foot = area @ (column.gather(system.foot_nodes, state.x) - column.all_X[system.foot_nodes])
        return dict(
            time=state.time, u_top=top, tilt=tilt_angle(state.rotation), twist=twist_angle(state.rotation),
            slide=foot[:2], contact_force=state.forces.sum(axis=0), active_nodes=int((state.forces[:, 2] > 0).sum()),
            penetration=max(0.0, -float(state.relative[:, 2].min())), ground=state.ground)

    def overturned(self, measures: dict) -> bool:
        """The top met the overturn displacement, or the tilt is past the point of no return and still grows."""
        growing = measures["tilt"] > self.last_tilt
        self.last_tilt = measures["tilt"]
        return bool(np.hypot(*measures["u_top"][:2]) >= self.limit
                    or (measures["tilt"] > LOST * self.critical_tilt and growing))
