"""Total Lagrangian kinematics: St. Venant-Kirchhoff material, exact for any rotation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc

from fecolumn.fem.corotated import mean_rotation
from fecolumn.fem.material.elasticity import isotropic_stress
from fecolumn.fem.material.kinematics import green_lagrange_strain
from fecolumn.foundation import _dolfinx
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body


class TotalLagrangian:
    """Internal forces as the derivative of St. Venant and Kirchhoff's energy, their tangent by
    `ufl.derivative`.
    """

    name = "total_lagrangian"
    #: Whether `tangent` gives the stiffness at strained positions; else that of the reference
    #: serves, turned.
    has_tangent = True

    def __init__(self, body: Body) -> None:
        self.body = body
        self.u = fem.Function(body.space)
        strain = green_lagrange_strain(self.u)
        stress = isotropic_stress(
            strain, body.material.youngs_modulus_pa, body.material.poissons_ratio
        )
        energy = 0.5 * ufl.inner(stress, strain) * ufl.dx
        residual = ufl.derivative(energy, self.u, ufl.TestFunction(body.space))
        self._energy, self._residual = fem.form(energy), fem.form(residual)
        self._tangent = ufl.derivative(residual, self.u, ufl.TrialFunction(body.space))

    def _set(self, x: Array) -> None:
        self.u.x.array[: 3 * self.body.n_owned] = (x - self.body.X).reshape(-1)
        self.u.x.scatter_forward()

    def rotation(self, x: Array) -> Array:
        """Mean rotation (3, 3) of the body at positions x (n_owned, 3) [m]."""
        return mean_rotation(self.body, x)

    def internal(self, x: Array) -> tuple[Array, Array, float]:
        """Mean rotation (3, 3), internal forces (n_owned, 3) [N] and strain energy [J] at positions
        x.
        """
        self._set(x)
        vector = fem.petsc.assemble_vector(self._residual)
        vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        force = self.body.constraint.collect(vector.array.reshape(-1, 3).copy())
        vector.destroy()
        energy = self.body.comm.allreduce(fem.assemble_scalar(self._energy), MPI.SUM)
        return self.rotation(x), force, float(energy)

    def internal_of_copies(self, places: list) -> list[tuple]:
        """`internal` of copies of the body at each of the positions."""
        return [self.internal(x) for x in places]

    def tangent(self, x: Array) -> PETSc.Mat:
        """Reduced tangent stiffness at positions x, in the table frame."""
        self._set(x)
        full = _dolfinx.assemble_matrix(self._tangent)
        reduced = self.body.constraint.reduce(full)
        full.destroy()
        return reduced

    def moved(self, x: Array, step: Array) -> Array:
        """Positions after an increment (n_owned, 3) [m] of an iteration, its rigid part made a
        rotation.

        A turn by w taken straight would stretch the body by w^2 / 2: at dt = 0.02 s that is a
        thousand times its strains.
        """
        rigid, linear = self._rigid_parts(x, step)
        return rigid + step - linear

    def predicted(self, x: Array, step: Array) -> Array:
        """First guess after a time step's increment (n_owned, 3) [m]: only its rigid part.

        Elastic velocities that the step does not resolve would carry the guess far outside small
        strains.
        """
        return self._rigid_parts(x, step)[0]

    def _rigid_parts(self, x: Array, step: Array) -> tuple[Array, Array]:
        """Positions moved by the rigid part of an increment, and that part taken straight."""
        body = self.body
        mass = body.node_mass[:, None]
        centre, shift = (
            body.sum((mass * x).sum(axis=0)) / body.total_mass,
            body.sum((mass * step).sum(axis=0)) / body.total_mass,
        )
        turn = self.rotation(x + step) @ self.rotation(x).T
        # the straight increment whose rotation is `turn`: of length tan(w) about the same axis
        skew = (turn - turn.T) / (np.trace(turn) - 1)
        arm = x - centre
        return centre + shift + arm @ turn.T, shift + arm @ skew.T

    def local_displacement(self, x: Array) -> Array:
        """Displacement (n_owned, 3) [m] seen in the body's frame, from which stresses are
        computed.
        """
        return x @ self.rotation(x) - self.body.X
