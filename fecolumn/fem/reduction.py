"""Reduction of a body's finite-element operators: rigid motion, elastic modes, exact flexibility of
the nodes that may touch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fecolumn.fem.effective import blocks, unit_loads
from fecolumn.fem.free_body import FreeBody
from fecolumn.fem.modes import elastic_modes
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body

# Unit forces solved for at once: bounds the memory, 3 n_nodes x BATCH numbers a block
BATCH = 120


class Reduction(NamedTuple):
    """What remains of a Body. inertia: (3, 3) [kg m2] about the centre of mass; frequencies: (m,)
    [rad/s] of the free body's elastic modes, fields: (m, n_owned, 3) [1/sqrt(kg)] their shapes;
    flexibility: (n, n, 3, 3) [m/N] of the nodes, by inertia relief.
    """

    body: Any
    inertia: Array
    frequencies: Array
    fields: Array
    flexibility: Array

    def at(self, nodes: Array) -> Array:
        """Shapes (k, 3, m) of the modes at nodes (k,)."""
        return np.ascontiguousarray(self.body.gather(nodes, self.fields.transpose(1, 2, 0)))


def reduced_at(body: Body, nodes: Array, n_modes: int) -> Reduction:
    """Reduce a Body to its `n_modes` lowest elastic modes and the flexibility of nodes (n,)."""
    frequencies, fields = elastic_modes(body, n_modes)
    free, n = FreeBody(body), len(nodes)
    flexibility = np.empty((3 * n, 3 * n))
    for first in range(0, n, BATCH // 3):
        batch = nodes[first : first + BATCH // 3]
        columns = free.response(unit_loads(body, batch))
        at_nodes = body.gather(nodes, columns.reshape(body.n_owned, 3, -1))
        flexibility[:, 3 * first : 3 * (first + len(batch))] = at_nodes.reshape(3 * n, -1)
    return Reduction(body, free.masses[3:, 3:], frequencies, fields, blocks(flexibility))
