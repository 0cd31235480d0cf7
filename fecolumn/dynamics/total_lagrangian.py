"""Total Lagrangian kinematics: St. Venant-Kirchhoff material, exact for any rotation."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc

from fecolumn import _dolfinx
from fecolumn.dynamics.corotated import mean_rotation
from fecolumn.material.elasticity import isotropic_stress
from fecolumn.material.kinematics import green_lagrange_strain


class TotalLagrangian:
    """Internal forces as the derivative of the St. Venant-Kirchhoff energy, its tangent by `ufl.derivative`."""

    name = "total_lagrangian"

    def __init__(self, body):
        self.body = body
        self.u = fem.Function(body.space)
        strain = green_lagrange_strain(self.u)
        stress = isotropic_stress(strain, body.material.youngs_modulus_pa, body.material.poissons_ratio)
        energy = 0.5 * ufl.inner(stress, strain) * ufl.dx
        residual = ufl.derivative(energy, self.u, ufl.TestFunction(body.space))
        self._energy, self._residual = fem.form(energy), fem.form(residual)
        self._tangent = ufl.derivative(residual, self.u, ufl.TrialFunction(body.space))

    def _set(self, x: np.ndarray) -> None:
        self.u.x.array[: 3 * self.body.n_owned] = (x - self.body.X).reshape(-1)
        self.u.x.scatter_forward()

    def rotation(self, x: np.ndarray) -> np.ndarray:
        return mean_rotation(self.body, x)

    def internal(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """Mean rotation (3, 3), internal forces (n_owned, 3) [N] and strain energy [J] at positions x."""
        self._set(x)
        vector = fem.petsc.assemble_vector(self._residual)
        vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        force = self.body.constraint.collect(vector.array.reshape(-1, 3).copy())
        vector.destroy()
        energy = self.body.comm.allreduce(fem.assemble_scalar(self._energy), MPI.SUM)
        return self.rotation(x), force, float(energy)

    def tangent(self, x: np.ndarray) -> PETSc.Mat:
        """Reduced tangent stiffness at positions x, in the table frame."""
        self._set(x)
        full = _dolfinx.assemble_matrix(self._tangent)
        reduced = self.body.constraint.reduce(full)
        full.destroy()
        return reduced

    def local_displacement(self, x: np.ndarray) -> np.ndarray:
        """Displacement (n_owned, 3) [m] seen in the body's frame, from which stresses are computed."""
        return x @ self.rotation(x) - self.body.X
