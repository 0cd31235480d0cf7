"""Fields of a structure in full order: displacement, stress and contact pressure of all bodies in
one mesh that tells them apart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.dynamics.checkpoint import gather_all
from fecolumn.engines.scene.fields import StressField, vertex_nodes
from fecolumn.engines.scene.scene import Scene
from fecolumn.engines.scene.state_fields import node_forces, seats_of

if TYPE_CHECKING:
    from fecolumn.fem.composite import Composite
    from fecolumn.structures.model import StructureModel


class StructureFields:
    """Fields on the points of a scene from positions and contact forces, as
    `engines.scene.fields.FieldWriter` takes them.

    Parameters
    ----------
    bodies
        `fem.composite.Composite`.
    structure
        StructureModel, as it stands upright.
    points
        (P,) of POINT.
    """

    def __init__(
        self,
        scene: Scene,
        bodies: Composite,
        structure: StructureModel,
        points: NDArray[Any],
    ) -> None:
        self.comm, self._bodies, self._points, self.scene = bodies.comm, bodies, points, scene
        self.meshes, self.of_cells, self.grounds = scene.meshes, scene.of_cells, scene.plates()
        self._nodes = bodies.of_each(lambda body, _: vertex_nodes(body))
        self._stress = bodies.of_each(lambda body, _: StressField(body))
        self._seats = seats_of(structure, scene)

    def values(
        self,
        x: NDArray[Any],
        local: NDArray[Any],
        positions: NDArray[Any] | None,
        forces: NDArray[Any],
    ) -> dict[str, NDArray[Any]] | None:
        """Displacement (n_points, 3) [m] from where the bodies stand upright, von Mises stress
        (n_cells,) [Pa], and pressure (n_points,) [Pa] on the faces of slaves; on rank 0.

        Called on every rank.

        Parameters
        ----------
        x
            (n_owned, 3) positions [m]
        local
            displacements in the frames of the bodies [m].
        positions
            (P, 3) [m] of the contact points, asked for where a ground is an elastic plate.
        forces
            (P, 3) [N] on them in the frames of their joints.
        """
        bodies, scene = self._bodies, self.scene
        gathered = [
            gather_all(part, (x - bodies.placed)[rows])
            for part, rows in zip(bodies.parts, bodies.rows)
        ]
        stresses = [own.values(local[rows]) for own, rows in zip(self._stress, bodies.rows)]
        if bodies.comm.rank:
            return None
        # None on other ranks alone
        moved = [
            values[nodes] for values, nodes in zip(gathered, self._nodes) if values is not None
        ]
        stress = [values for values in stresses if values is not None]
        of = self._points["interface"]
        for plate, ground in self.grounds:
            assert positions is not None
            on = [number for number, one in enumerate(scene.contacts) if one.stands_on(ground)]
            own = np.isin(of, on)
            for found, values in zip((moved, stress), plate.sunk(positions[own], forces[own])):
                found.append(values)
        pressure = np.zeros(len(scene.points))
        for number, (contact, seat) in enumerate(zip(scene.contacts, self._seats)):
            own = self._points[of == number]
            force = node_forces(seat, own["carriers"], own["weights"], forces[of == number, 2])
            shared = np.divide(force, seat.areas, out=np.zeros(len(force)), where=seat.areas > 0)
            pressure[contact.points] += seat.shown(shared)
        return {
            "displacement": np.vstack(moved),
            "von_mises": np.concatenate(stress),
            "pressure": pressure,
        }
