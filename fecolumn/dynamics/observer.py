"""What an engineer watches: top displacement, tilt, twist, slide, contact resultant; and when the
column is lost.
"""

from __future__ import annotations

import numpy as np

from fecolumn.dynamics.overturning import STANDS, fallen, stance
from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.rotation import tilt_angle, twist_angle
from fecolumn.mesh.bricks import boundary_faces
from fecolumn.mesh.surface import face_points, nodal_areas


def top_of(column, specimen) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (k,) of the top's face and their shares (k,) in its mean."""
    mesh = specimen.body
    part = mesh.top_part
    height = mesh.points[:, 2].max()
    quads = boundary_faces(mesh, part, height, 1e-6 * height)
    found = column.find_nodes(face_points(mesh.points[quads], column.order).reshape(-1, 3), part)
    nodes, position = np.unique(found, return_inverse=True)
    areas = nodal_areas(
        mesh.points[quads], position.reshape(len(quads), -1), len(nodes), column.order
    )
    return nodes, areas / areas.sum()


class Observer:
    """Measures a state of a system.

    The top's displacement is the mean over its top face, which is that of the face's centre; it is
    relative to the base and to the unstrained upright position.
    """

    def __init__(self, system, specimen, cap: float):
        self.system, self.body, column = system, 0, system.body
        self._top, self._weights = top_of(column, specimen)
        foot = column.all_X[system.footprint.nodes] - column.center
        self.stance = stance(
            foot,
            rigid_fields(column)[2][3:, 3:],
            system.weight,
            system.laws["friction"],
            cap,
        )
        #: (3,) [m] of the top's centre from the centre of mass.
        self.top_arm = self._weights @ column.all_X[self._top] - column.center

    def measure(self, state) -> dict:
        """Measures of a state by the names of the history file, in SI units."""
        system = self.system
        column, foot, R = system.body, system.footprint, state.rotation[0]
        top = self._weights @ (column.gather(self._top, state.x) - column.all_X[self._top])
        share = foot.areas / foot.areas.sum()
        slid = share @ (column.gather(foot.nodes, state.x) - column.all_X[foot.nodes])
        return dict(
            time=state.time,
            u_top=top,
            tilt=tilt_angle(R),
            twist=twist_angle(R),
            slide=slid[:2],
            contact_force=state.forces.sum(axis=0),
            active_nodes=int((state.forces[:, 2] > 0).sum()),
            penetration=max(0.0, -float(state.relative[:, 2].min())),
            ground=state.ground[:3],
        )

    def fallen(self, state, measures: dict, steepest: float) -> int:
        """As `overturning.fallen`; on all ranks together."""
        top = float(np.hypot(*measures["u_top"][:2]))
        if top < self.stance.cap and measures["tilt"] <= self.stance.critical:
            return STANDS
        return fallen(
            self.stance,
            state.rotation[0].copy(),
            self._spin(state),
            measures["contact_force"],
            top,
            float(steepest),
        )

    def _spin(self, state) -> np.ndarray:
        """Angular velocity (3,) [rad/s] in the column's frame, of the rigid body with the angular
        momentum of the column.
        """
        column = self.system.body
        momentum = column.momentum(state.v)
        center = column.sum(column.node_mass @ state.x) / column.total_mass
        angular = column.sum(np.cross(state.x - center, momentum).sum(axis=0))
        return np.linalg.solve(self.stance.inertia, state.rotation[0].T @ angular)
