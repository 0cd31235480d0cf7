"""Fields of a reduced analysis: displacements of the whole mesh expanded from modes and contact
forces.
"""

from __future__ import annotations

import numpy as np

from fecolumn.dynamics.assembly import foot_of
from fecolumn.fem.free_body import FreeBody
from fecolumn.post.fields import SpecimenFields
from fecolumn.reduced.cache import make_bodies
from fecolumn.reduced.states import State


class StateFields:
    """Expands states of a reduced analysis to fields as the full-order engine has them.

    In the column's frame the displacement is that of the modes, and the static response to the
    contact forces beyond what has gone into the modes already: with f the modal forces of the
    contact, sum phi (q - F f / w^2) + K^+ B^T r.

    Parameters
    ----------
    case
        of the analysis.
    model
        ColumnModel
    model_folder
        its place in the cache.
    """

    def __init__(self, case, model, model_folder):
        column, plate, specimen = make_bodies(case)
        foot = foot_of(case, specimen, column)
        if not np.allclose(column.all_X[foot.nodes], model.reference):
            raise RuntimeError(
                f"the cached model has another mesh than the one made now: delete {model_folder}"
            )
        self._body, self._free, self._model, self._foot = (
            column,
            FreeBody(column),
            model,
            foot.nodes,
        )
        self._shapes = np.load(model_folder / "fields.npy", mmap_mode="r")[: len(model.frequencies)]
        #: SpecimenFields.
        self.specimen = SpecimenFields(column, plate, foot, specimen)

    def values(self, state: State) -> dict[str, np.ndarray]:
        """Fields by the names of `SpecimenFields.values`."""
        local, at_nodes = self.displacement(state), state.at_nodes(len(self._foot))
        x = state.center[0] + (self._body.X - self._model.center + local) @ state.rotation[0].T
        return self.specimen.values(x, local, state.position, state.force, at_nodes)

    def displacement(self, state: State) -> np.ndarray:
        """Displacement (n_nodes, 3) [m] in the column's frame."""
        load = self._body.spread(
            self._foot, state.at_nodes(len(self._foot)) @ state.rotation[0]
        ).reshape(-1, 1)
        return np.tensordot(state.modal[0], self._shapes, 1) + self._free.response(load).reshape(
            -1, 3
        )
