"""Reduction of a column's finite-element operators: rigid motion, elastic modes, exact flexibility
of the foot.
"""

from __future__ import annotations

import numpy as np

from fecolumn.fem.effective import blocks, unit_loads
from fecolumn.fem.free_body import FreeBody
from fecolumn.fem.modes import elastic_modes
from fecolumn.reduced.model import ColumnModel

# Unit forces solved for at once: bounds the memory, 3 n_nodes x BATCH numbers a block
BATCH = 120


def column_model(
    body, foot_nodes, areas, top_nodes, top_weights, n_modes: int
) -> tuple[ColumnModel, np.ndarray]:
    """Reduce a column; also the shapes (n_modes, n_owned, 3) of the modes all over it.

    Parameters
    ----------
    body
        Body of column and cap.
    foot_nodes
        (n,) nodes that may touch
    areas
        (n,) tributary to them [m2].
    top_nodes, top_weights
        (k,) nodes of the top's face and their shares in its mean.
    n_modes
        elastic modes to keep.
    """
    frequencies, fields = elastic_modes(body, n_modes)
    free, n = FreeBody(body), len(foot_nodes)
    flexibility = np.empty((3 * n, 3 * n))
    for first in range(0, n, BATCH // 3):
        batch = foot_nodes[first : first + BATCH // 3]
        columns = free.response(unit_loads(body, batch))
        at_foot = body.gather(foot_nodes, columns.reshape(body.n_owned, 3, -1))
        flexibility[:, 3 * first : 3 * (first + len(batch))] = at_foot.reshape(3 * n, -1)

    def at(nodes):
        return np.ascontiguousarray(body.gather(nodes, fields.transpose(1, 2, 0)))

    model = ColumnModel(
        mass=float(body.total_mass),
        inertia=free.masses[3:, 3:],
        center=body.center,
        frequencies=frequencies,
        shapes=at(foot_nodes),
        flexibility=blocks(flexibility),
        arms=body.all_X[foot_nodes] - body.center,
        areas=np.asarray(areas),
        top_arm=top_weights @ body.all_X[top_nodes] - body.center,
        top_shape=np.einsum("i,iam->am", top_weights, at(top_nodes)),
        dofs=3 * body.n_nodes,
    )
    return model, fields
