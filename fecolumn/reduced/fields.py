"""Fields of a reduced analysis: displacements of the whole mesh expanded from modes and contact forces."""

from __future__ import annotations

import numpy as np

from fecolumn.dynamics.assembly import foot_of
from fecolumn.fem.free_body import FreeBody
from fecolumn.post.fields import FieldWriter
from fecolumn.reduced.cache import make_bodies
from fecolumn.reduced.elastic import COORDINATE


class ReducedFields:
    """Writes the frames of a reduced analysis as the full-order engine does.

    In the column's frame the displacement is that of the modes, and the static response to the contact forces beyond what has gone
    into the modes already: with f the modal forces of the contact, sum phi (q - F f / w^2) + K^+ B^T r.

    Args:
        folder: for the frames. case: of the analysis. model: ColumnModel; model_folder: its place in the cache.
    """

    def __init__(self, folder, case, model, model_folder):
        column, plate, specimen = make_bodies(case)
        foot = foot_of(case, specimen, column)
        if not np.allclose(column.all_X[foot.nodes], model.reference):
            raise RuntimeError(f"the cached model has another mesh than the one made now: delete {model_folder}")
        self._body, self._free, self._model, self._foot = column, FreeBody(column), model, foot.nodes
        self._shapes = np.load(model_folder / "fields.npy", mmap_mode="r")[:len(model.frequencies)]
        self._writer = FieldWriter(folder, column, plate, foot, specimen)

    def write(self, engine) -> None:
        """Add the frame of the engine's motion."""
        motion, points, body = engine.motion, engine.work.points, self._body
        at_nodes = np.zeros_like(motion.forces)
        np.add.at(at_nodes, points["carriers"], points["weights"][:, :, None] * motion.forces[:, None])
        moved = np.einsum("iam,m->ia", engine.structure.pushes, motion.modal[0, COORDINATE])
        arms = points["arm"] + np.einsum("pq,pqa->pa", points["weights"], moved[points["carriers"]])
        center, rotation = motion.frames["center"][0], motion.rotation[0]
        positions = center + arms @ rotation.T
        positions[:, 2] += points["lift"]
        local = self.displacement(engine, at_nodes)
        x = center + (body.X - self._model.center + local) @ rotation.T
        self._writer.write(motion.time, x, local, positions, motion.forces, at_nodes)

    def displacement(self, engine, at_nodes) -> np.ndarray:
        """Displacement (n_nodes, 3) [m] in the column's frame; at_nodes: (n, 3) contact forces on the foot's nodes [N]."""
        motion, structure = engine.motion, engine.structure
        forces = at_nodes @ motion.rotation[0]
        given = np.einsum("iam,ia->m", structure.pushes, forces) / structure.squares[0]
        load = self._body.spread(self._foot, forces).reshape(-1, 1)
        return np.tensordot(motion.modal[0, COORDINATE] - given, self._shapes, 1) + self._free.response(load).reshape(-1, 3)
