"""The elastic base plate: static compliance of its top, extended to where the column travels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.base_top import BaseTop
from fecolumn.contact.unbounded_base import shear_frequency
from fecolumn.fem.effective import effective_factor, unit_loads
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.summed import summed_at

if TYPE_CHECKING:
    from fecolumn.fem.body import Body


class BasePlate:
    """Base plate held at its bottom, responding statically to contact forces.

    Its lowest mode (a quarter wave of shear through the thickness: 39 kHz for 20 mm of steel) is
    far above what any time step of a rocking analysis resolves, so its inertia is left out;
    `frequency` tells, and a case whose step would resolve it is warned of. Its own weight and
    inertia would move the top by rho a t^2 / 2E, 1e-10 m for that plate.

    Parameters
    ----------
    body
        the base's Body, its bottom held.
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        top = body.all_X[:, 2].max()
        thickness = np.ptp(body.all_X[:, 2])
        self.nodes = np.flatnonzero(body.all_X[:, 2] > top - 1e-9 * thickness)
        self.grid = BaseTop(body.all_X[self.nodes])
        #: Lowest shear mode through the thickness [Hz].
        self.frequency = shear_frequency(body.material, thickness)
        self.dofs = 3 * body.n_nodes
        self._factor = effective_factor(body, 0.0, 1.0)
        self.slot = np.full(len(self.nodes), -1, np.int64)
        self.compliance = np.zeros((0, 0, 3, 3))
        self.known = np.zeros(0, np.int64)

    def adopt(self, known: Array, compliance: Array) -> None:
        """Take over the compliance (k, k, 3, 3) of the top nodes `known` (k,) found before."""
        self.known, self.compliance = known, compliance
        self.slot[:] = -1
        self.slot[known] = np.arange(len(known))

    def need(self, wanted: Array) -> None:
        """Make sure that the compliance holds the top nodes `wanted` (positions in `nodes`)."""
        new = np.unique(wanted[self.slot[wanted] < 0])
        if not len(new):
            return
        known, old, n = np.concatenate([self.known, new]), len(self.known), len(new)
        response = self._factor.solve_many(unit_loads(self.body, self.nodes[new]))
        columns = self.body.gather(self.nodes[known], response.reshape(self.body.n_owned, 3, 3 * n))
        fresh = columns.reshape(len(known), 3, n, 3).transpose(0, 2, 1, 3)
        compliance = np.empty((len(known), len(known), 3, 3))
        compliance[:old, :old] = self.compliance
        compliance[:, old:] = fresh
        compliance[old:, :old] = fresh[:old].transpose(1, 0, 3, 2)
        corner = compliance[old:, old:]
        compliance[old:, old:] = (corner + corner.transpose(1, 0, 3, 2)) / 2
        self.compliance, self.known = compliance, known
        self.slot[new] = np.arange(old, len(known))

    def displacement(self, nodes: Array, weights: Array, forces: Array) -> Array:
        """Displacement (n_owned, 3) [m] of the whole plate under forces (n, 3) [N] spread over top
        `nodes` (n, 4).
        """
        share = summed_at(nodes, weights[:, :, None] * forces[:, None], len(self.nodes))
        return self._factor.solve(self.body.spread(self.nodes, share))
