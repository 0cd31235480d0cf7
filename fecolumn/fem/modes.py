"""Free vibration modes of a body: what the tied mesh does when nothing holds it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from fecolumn.fem.rayleigh import spectral_shift

# Shift of the spectrum over the bound of the first elastic frequency's square: K + s M can be factored, and 1 / (w^2 + s) still
# tells the rigid modes from the first elastic ones
_SHARE = 0.01


@dataclass(frozen=True, slots=True)
class Modes:
    """Frequencies (m,) [Hz], rising, and shapes (m, n_owned, 3) with unit modal mass [1/sqrt(kg)].

    A frequency below zero is one whose eigenvalue came out negative by rounding: -sqrt(|w^2|) / 2 pi.
    """

    frequencies: np.ndarray
    shapes: np.ndarray


def free_modes(body, count: int, tolerance: float = 1e-10) -> Modes:
    """The `count` lowest modes of K x = w^2 M x, rigid ones included, ties as in the body.

    Krylov-Schur with shift-invert (SLEPc), the shifted matrix factored by MUMPS. Constrained nodes carry neither mass nor
    stiffness in the reduced matrices; they are pinned far above the wanted frequencies.

    Raises:
        RuntimeError: fewer modes converged than asked for.
    """
    from slepc4py import SLEPc

    stiffness = body.constraint.pinned(body.stiffness.copy())
    solver = SLEPc.EPS().create(body.comm)
    solver.setOperators(stiffness, body.mass)
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTarget(-spectral_shift(body, _SHARE))
    solver.setDimensions(count, PETSc.DECIDE, PETSc.DECIDE)
    solver.setTolerances(tolerance, 1000)
    transform = solver.getST()
    transform.setType(SLEPc.ST.Type.SINVERT)
    transform.setMatStructure(PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
    linear = transform.getKSP()
    linear.setType("preonly")
    linear.getPC().setType("cholesky")
    linear.getPC().setFactorSolverType("mumps")
    solver.solve()
    if solver.getConverged() < count:
        raise RuntimeError(f"only {solver.getConverged()} of {count} modes converged")
    shape, frequencies, shapes = stiffness.createVecRight(), [], []
    for k in range(count):
        value = solver.getEigenpair(k, shape).real
        field = body.constraint.expand(shape.array.reshape(-1, 3).copy())
        frequencies.append(np.sign(value) * np.sqrt(abs(value)) / (2 * np.pi))
        shapes.append(field / np.sqrt(body.dot(shape.array.reshape(-1, 3), body.apply(body.mass, shape.array))))
    solver.destroy(), stiffness.destroy(), shape.destroy()
    order = np.argsort(frequencies)
    return Modes(np.array(frequencies)[order], np.array(shapes)[order])


def elastic_modes(body, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (count,) [rad/s] and shapes (count, n_owned, 3) of unit modal mass of the lowest elastic modes."""
    if not count:
        return np.zeros(0), np.zeros((0, body.n_owned, 3))
    modes = free_modes(body, count + 6)
    return 2 * np.pi * modes.frequencies[6:], modes.shapes[6:]
