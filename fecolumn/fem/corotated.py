"""Corotated kinematics: one rotation for the whole body, small strains in its frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.fem.rotation import polar_rotation
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body


def mean_rotation(body: Body, x: Array) -> Array:
    """Mean rotation (3, 3) of a body from its node positions (n_owned, 3), weighted by the mass
    matrix.

    In its frame displacements d from the reference X have no moment, sum X x M d = 0, as those of
    elastic modes: the reduced engine's frame is the same to first order.
    """
    return polar_rotation(body.sum(x.T @ body.mass_arms))


class Corotated:
    """Internal forces f = R K (R^T x - X), R the body's mean rotation.

    The elastic energy is that of the co-rotated small strains. Its gradient has besides what takes
    away the moment of these forces, which is of second order in the strain: see
    `dynamics.stage.Stage.twist_corrections_at`.
    """

    name = "corotated"
    #: Whether `tangent` gives the stiffness at strained positions; else that of the reference
    #: serves, turned.
    has_tangent = False

    def __init__(self, body: Body) -> None:
        self.body = body

    def rotation(self, x: Array) -> Array:
        """Mean rotation (3, 3) of the body at positions x (n_owned, 3) [m]."""
        return mean_rotation(self.body, x)

    def internal(self, x: Array) -> tuple[Array, Array, float]:
        """Rotation (3, 3), internal forces (n_owned, 3) [N] and strain energy [J] at positions x
        (n_owned, 3).
        """
        rotation, deformation = self._deformed(x)
        force = self.body.apply(self.body.stiffness, deformation)
        return rotation, force @ rotation.T, 0.5 * self.body.dot(deformation, force)

    def internal_of_copies(self, places: list) -> list[tuple]:
        """`internal` of copies of the body at each of the positions, for which the stiffness is
        read once.
        """
        if len(places) == 1:
            return [self.internal(places[0])]
        rotations, deformations = zip(*map(self._deformed, places))
        forces = self.body.apply(self.body.stiffness, np.stack(deformations))
        return [
            (R, force @ R.T, 0.5 * self.body.dot(deformation, force))
            for R, deformation, force in zip(rotations, deformations, forces)
        ]

    def _deformed(self, x: Array) -> tuple[Array, Array]:
        rotation = self.rotation(x)
        deformation = x @ rotation - self.body.X
        # the stiffness does not see a translation, the rounding of the energy does
        return rotation, deformation - self.body.sum(
            self.body.node_mass @ deformation
        ) / self.body.total_mass

    def moved(self, x: Array, step: Array) -> Array:
        """Positions after an increment (n_owned, 3) [m] of an iteration; the stretch of its turn
        falls out with R.
        """
        return x + step

    def predicted(self, x: Array, step: Array) -> Array:
        """First guess after a time step's increment (n_owned, 3) [m]."""
        return x + step

    def local_displacement(self, x: Array) -> Array:
        """Displacement (n_owned, 3) [m] seen in the body's frame, from which stresses are
        computed.
        """
        return x @ self.rotation(x) - self.body.X
