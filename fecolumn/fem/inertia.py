"""How many eigenvalues of a symmetric matrix are negative: as many as in the factors L D L^T of it
(Sylvester's law of inertia).
"""

from __future__ import annotations

from petsc4py import PETSc

# Controls of MUMPS that are 1 so that it counts negative pivots, those of the last front, too
_COUNTS = (13, 24)
# Control of the room beyond MUMPS's estimate [%], and what is tried: pivots that are put off take
# more than a definite matrix does
_ROOM, _ROOMS = 14, (30, 100, 400)


def negative_eigenvalues(matrix: PETSc.Mat) -> int:
    """Number of negative eigenvalues of a symmetric matrix.

    Raises
    ------
    RuntimeError
        MUMPS cannot factor it.
    """
    for room in _ROOMS:
        solver = PETSc.PC().create(matrix.comm)
        try:
            solver.setOperators(matrix)
            solver.setType("cholesky")
            solver.setFactorSolverType("mumps")
            solver.setFactorSetUpSolverType()
            factor = solver.getFactorMatrix()
            for control in _COUNTS:
                factor.setMumpsIcntl(control, 1)
            factor.setMumpsIcntl(_ROOM, room)
            solver.setUp()
            # PETSc itself says nothing of a factorisation that failed
            failed = factor.getMumpsInfog(1)
            if failed >= 0:
                negative: int = factor.getInertia()[0]
                return negative
        finally:
            solver.destroy()
    raise RuntimeError(f"MUMPS cannot factor a matrix of {matrix.size[0]} rows: INFOG(1) {failed}")
