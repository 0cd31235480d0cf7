"""Effective matrices of implicit time integration, factored once, and responses to many loads at
once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from petsc4py import PETSc

from fecolumn.foundation import _dolfinx
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body

#: Solves with one load in less than half the time of MUMPS, but on a single rank alone
_OF_ONE_RANK = "cholmod" if PETSc.Sys.hasExternalPackage("suitesparse") else "mumps"
#: Codes of PETSc's errors of a matrix that is singular or not definite: zero pivots of LU and of
#: Cholesky, what a package says
FACTORIZATION_FAILED = (71, 81, 76)
# Messages of CHOLMOD
_SAYS = "mat_cholmod_print"


class Factor:
    """Factor of a symmetric matrix of a body, which is taken over: Cholesky by CHOLMOD, on several
    ranks by MUMPS.

    Parameters
    ----------
    definite
        whether the matrix is positive definite beyond doubt. That of a strained body need not be,
        where an iteration is far from its answer: it is factored as L D L^T by MUMPS where Cholesky
        fails, and at once on several ranks.
    """

    def __init__(self, body: Body, matrix: PETSc.Mat, definite: bool = True) -> None:
        self.body, self._matrix = body, body.constraint.pinned(matrix)
        alone = body.comm.size == 1
        try:
            try:
                self._solver = _solver(
                    self._matrix, _OF_ONE_RANK if alone else "mumps", definite or alone
                )
            except PETSc.Error:
                if definite:
                    raise
                self._solver = _solver(self._matrix, "mumps", False)
        except PETSc.Error:
            self._matrix.destroy()
            raise
        self._release = _dolfinx.release_with(self, self._solver, self._matrix)

    def solve(self, forces: Array) -> Array:
        """Displacements (n_owned, 3) of all nodes from reduced forces (n_owned, 3); (k, n_owned, 3)
        of k copies at once, for which the factor is read once.
        """
        if forces.ndim == 3:
            return self.solve_many(forces.reshape(len(forces), -1).T).T.reshape(forces.shape)
        source, target = self.body.work
        source.array[:] = forces.reshape(-1)
        self._solver.solve(source, target)
        return self.body.constraint.expand(target.array.reshape(-1, 3).copy())

    def solve_many(self, forces: Array) -> Array:
        """Displacements (3 n_owned, m) of all nodes from m columns of reduced forces (3 n_owned,
        m).
        """
        sizes = (3 * self.body.n_owned, None), (None, forces.shape[1])
        source = PETSc.Mat().createDense(
            sizes, array=np.asfortranarray(forces), comm=self.body.comm
        )
        target = PETSc.Mat().createDense(sizes, comm=self.body.comm)
        for matrix in (source, target):
            matrix.setUp()
            matrix.assemble()
        self._solver.getPC().getFactorMatrix().matSolve(source, target)
        projection = self.body.constraint.projection
        expanded = target if projection is None else projection.matMult(target)
        result = expanded.getDenseArray().copy(order="F")
        for matrix in (source, target) if projection is None else (source, target, expanded):
            matrix.destroy()
        return result

    def destroy(self) -> None:
        """Free the factor and the matrix."""
        self._release()


def _solver(matrix: PETSc.Mat, package: str, definite: bool) -> PETSc.KSP:
    """Direct solver with a symmetric matrix, factored."""
    matrix.setOption(PETSc.Mat.Option.SPD, definite)
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setType("preonly")
    preconditioner = solver.getPC()
    preconditioner.setType("cholesky")
    preconditioner.setFactorSolverType(package)
    # else MUMPS says nothing where it fails, and the solution is not finite
    solver.setErrorIfNotConverged(True)
    options = PETSc.Options()
    # that a matrix is not definite is raised; it need not be printed besides
    options.setValue(_SAYS, 0)
    try:
        solver.setUp()
    except PETSc.Error:
        solver.destroy()
        raise
    finally:
        # one that is left and was not read is reported at the end
        options.delValue(_SAYS)
    return solver


def effective_factor(
    body: Body, mass_factor: float, stiffness_factor: float, stiffness: PETSc.Mat | None = None
) -> Factor:
    """Factor of mass_factor M + stiffness_factor K, with the body's reference stiffness unless
    another is given.
    """
    matrix = (stiffness or body.stiffness).copy()
    matrix.scale(stiffness_factor)
    if mass_factor:
        matrix.axpy(mass_factor, body.mass, structure=PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
    return Factor(body, matrix, definite=stiffness is None)


def unit_loads(body: Body, nodes: Array) -> Array:
    """Reduced forces of unit forces in x, y, z at `nodes`, as columns (3 n_owned, 3 len(nodes))."""
    loads = np.zeros((3 * body.n_owned, 3 * len(nodes)), order="F")
    here, local = body.owned(nodes)
    for axis in range(3):
        loads[3 * local + axis, 3 * here + axis] = 1.0
    if body.constraint.holds(nodes):
        for place in range(loads.shape[1]):
            one = body.constraint.collect(loads[:, place].reshape(-1, 3))
            loads[:, place] = one.reshape(-1)
    return loads


def blocks(matrix: Array) -> Array:
    """Symmetric (3 n, 3 n) matrix as node blocks (n, n, 3, 3)."""
    n = len(matrix) // 3
    return np.ascontiguousarray(((matrix + matrix.T) / 2).reshape(n, 3, n, 3).transpose(0, 2, 1, 3))
