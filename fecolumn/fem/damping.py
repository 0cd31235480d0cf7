"""Modal damping of a body in full order: forces on its elastic modes, none on its rigid motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.fem.modes import elastic_modes
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body
    from fecolumn.fem.effective import Factor


class ModalDamping:
    """Viscous forces of the elastic modes of a body, which may be turned.

    f = R sum M phi 2 zeta w (M phi . R^T v), with the body's rotation R, its velocities v and its
    elastic modes phi of unit modal mass. The modes are M-orthogonal to every rigid motion, so that
    translation, rotation and their impacts lose nothing. They diagonalise the effective matrix,
    too, so that its factor serves with a correction in each mode.

    Parameters
    ----------
    body
        Body.
    count
        elastic modes that are damped, the lowest.
    ratio
        zeta, of each.
    """

    def __init__(self, body: Body, count: int, ratio: float) -> None:
        self.body, self.ratio = body, ratio
        self.frequencies, self.shapes = elastic_modes(body, count)
        self._momenta = np.array([body.apply(body.mass, shape) for shape in self.shapes]).reshape(
            self.shapes.shape
        )
        self._rates = 2 * ratio * self.frequencies

    def _modal(self, velocity: Array, rotation: Array) -> Array:
        """Damping force (m,) on each mode at velocities (n_owned, 3) [m/s]."""
        return self._rates * self.body.sum(np.tensordot(self._momenta, velocity @ rotation, axes=2))

    def force(self, velocity: Array, rotation: Array) -> Array:
        """Nodal forces (n_owned, 3) [N] that velocities (n_owned, 3) [m/s] need, in the sense of
        internal forces.
        """
        return np.tensordot(self._modal(velocity, rotation), self._momenta, axes=1) @ rotation.T

    def acceleration(self, velocity: Array, rotation: Array) -> Array:
        """M^-1 of `force`."""
        return np.tensordot(self._modal(velocity, rotation), self.shapes, axes=1) @ rotation.T

    def damped(
        self, factor: Factor, mass_factor: float, stiffness_factor: float, rate_factor: float
    ) -> DampedFactor:
        """Factor of mass_factor M + stiffness_factor (K + rate_factor C) from that of mass_factor M
        + stiffness_factor K.
        """
        own = mass_factor + stiffness_factor * self.frequencies**2
        return DampedFactor(
            factor, self.shapes, 1 / (own + stiffness_factor * rate_factor * self._rates) - 1 / own
        )


class DampedFactor:
    """A `fem.effective.Factor` and what damping changes of its inverse: `change` (m,) times phi
    phi^T of each mode.
    """

    def __init__(self, factor: Factor, shapes: Array, change: Array) -> None:
        self._factor, self._change = factor, change
        self._flat = shapes.reshape(len(shapes), -1)

    def _correction(self, forces: Array) -> Array:
        return self._flat.T @ (self._change[:, None] * self._factor.body.sum(self._flat @ forces))

    def solve(self, forces: Array) -> Array:
        """`Factor.solve` with damping."""
        copies = forces.reshape(-1, self._flat.shape[1])
        return self._factor.solve(forces) + self._correction(copies.T).T.reshape(forces.shape)

    def solve_many(self, forces: Array) -> Array:
        """`Factor.solve_many` with damping."""
        return self._factor.solve_many(forces) + self._correction(forces)

    def destroy(self) -> None:
        """Free the factor."""
        self._factor.destroy()
