"""The column's foot as the time integration sees it: a dynamic part filtered to the step, and a
static rest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.fem.effective import blocks, unit_loads
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body
    from fecolumn.fem.effective import Factor


class FilteredFoot:
    """Contact of the foot's nodes with what a time step resolves, the rest treated statically.

    The elastic modes of single foot nodes are a thousand times faster than a step. Left to an
    implicit method they keep the contact force in their acceleration memory and ring at the Nyquist
    frequency. With theta the substep of the effective matrix, S = M + theta^2 K, a contact force r
    is therefore split,

        r acts on the body as        U r,  U = M Y,  Y = 2 Y1 - Y2,  Y1 = S^-1 B^T,  Y2 = S^-1 M Y1,
        the foot's position is       U^T d + C r,  d the displacement in the body's frame,
        with the static remainder    C = theta^2 (B Y1 + Y1^T M Y1 - 3 Y1^T M Y2 + Y2^T M Y2),

    B picking the foot's nodes. In a mode of frequency w, with s = 1/(1 + (w theta)^2), force and
    position carry the factor F = 2 s - s^2 and C is (1 - F^2)/w^2 >= 0: nothing for rigid motion,
    fourth order in dt for what is resolved, the whole static compliance for what is not. U^T K^-1 U
    + C = B K^-1 B^T for any dt, so that the contact always sees the exact finite-element compliance
    in statics. Force and position are conjugate, so the work of contact is exact, and C has no
    memory. This is the residual flexibility of component mode synthesis (Rubin 1975; Craig and
    Chang 1977) with powers of the effective matrix in place of a modal cut.

    Arrays are in the body's frame, rows those of this rank: `jump` = Y (3 n_owned, 3 n), U is M
    times it; `static` = C and `mobility` = U^T Y (n, n, 3, 3) on every rank.
    """

    filtered = True

    def __init__(
        self, body: Body, nodes: Array, factor: Factor, mass_factor: float, stiffness_factor: float
    ) -> None:
        self.body, self.nodes = body, nodes
        once = mass_factor * factor.solve_many(unit_loads(body, nodes))
        momentum = body.apply_many(body.mass, once)
        twice = mass_factor * factor.solve_many(momentum)
        last = body.apply_many(body.mass, twice)
        self.jump = 2 * once - twice
        s1 = body.gather(nodes, once.reshape(body.n_owned, 3, -1)).reshape(3 * len(nodes), -1)
        s2, s3 = body.sum(momentum.T @ once), body.sum(momentum.T @ twice)
        s4 = body.sum(twice.T @ last)
        self.mobility = blocks(body.sum((2 * momentum - last).T @ self.jump))
        self.static = blocks(stiffness_factor / mass_factor * (s1 + s2 - 3 * s3 + s4))

    def position(self, displacement: Array) -> Array:
        """Filtered displacement or velocity (..., n, 3) of the foot from fields (..., n_owned, 3)
        of as many copies, both in the body's frame.
        """
        return self.body.sum(as_row(self.body.momentum(displacement)) @ self.jump).reshape(
            *displacement.shape[:-2], -1, 3
        )

    def load(self, forces: Array) -> Array:
        """Nodal forces (..., n_owned, 3) of contact forces (..., n, 3) on as many copies, both in
        the body's frame: the mass times their `acceleration`.
        """
        return self.body.momentum(self.acceleration(forces))

    def unit_push(self) -> Array:
        """U (3 n_owned, 3 n), as large as Y and not kept: nodal forces of unit forces on
        the nodes.
        """
        return self.body.apply_many(self.body.mass, self.jump)

    def acceleration(self, forces: Array) -> Array:
        """M^-1 of `load`: acceleration of contact forces, or velocity jump of contact impulses."""
        return _combine(self.jump, forces)


class PlainFoot:
    """Contact of the foot's nodes without filter: forces and positions are those of the nodes."""

    filtered = False

    def __init__(self, body: Body, nodes: Array) -> None:
        self.body, self.nodes = body, nodes
        self.static = np.zeros((len(nodes), len(nodes), 3, 3))

    def position(self, displacement: Array) -> Array:
        """As of FilteredFoot."""
        return (
            self.body.gather(self.nodes, displacement)
            if displacement.ndim == 2
            else np.stack([self.position(one) for one in displacement])
        )

    def load(self, forces: Array) -> Array:
        """As of FilteredFoot."""
        return (
            self.body.spread(self.nodes, forces)
            if forces.ndim == 2
            else np.stack([self.load(one) for one in forces])
        )

    def unit_push(self) -> Array:
        """As of FilteredFoot."""
        return unit_loads(self.body, self.nodes)


class Response:
    """Positions that contact forces cause within one implicit stage, x = A^-1 U r.

    Parameters
    ----------
    foot
        FilteredFoot or PlainFoot.
    factor
        of the stage's effective matrix.
    """

    def __init__(self, foot: FilteredFoot | PlainFoot, factor: Factor) -> None:
        push = foot.unit_push()
        self._columns = factor.solve_many(push)
        self.compliance = blocks(foot.body.sum(push.T @ self._columns))

    def displacement(self, forces: Array) -> Array:
        """Displacements (..., n_owned, 3) of contact forces (..., n, 3) on as many copies, both in
        the frame of the factored matrix.
        """
        return _combine(self._columns, forces)


def as_row(values: Array) -> Array:
    """Vectors (..., n, 3) as numbers (..., 3 n)."""
    return values.reshape(*values.shape[:-2], -1)


def _combine(columns: Array, forces: Array) -> Array:
    """Sums (..., n_owned, 3) of columns times forces (..., n, 3), over what any of them loads only:
    few while rocking.
    """
    row = as_row(forces)
    loaded = np.flatnonzero(row if row.ndim == 1 else row.any(axis=tuple(range(row.ndim - 1))))
    sums = (
        row @ columns.T
        if 2 * len(loaded) > columns.shape[1]
        else row[..., loaded] @ columns.T[loaded]
    )
    return sums.reshape(*forces.shape[:-2], -1, 3)
