"""Free vibration modes of a body: what the tied mesh does when nothing holds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from petsc4py import PETSc
from scipy.linalg import eigh

from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.inertia import negative_eigenvalues
from fecolumn.fem.rayleigh import spectral_shift
from fecolumn.fem.whole_groups import SAME_FREQUENCY, with_group
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body

# Shift of the spectrum over the bound of the first elastic frequency's square: K + s M can be
# factored, and 1 / (w^2 + s) still tells the rigid modes from the first elastic ones
_SHARE = 0.01
# Solutions for modes, each for more of them, until none is missing
_TRIES = 6


@dataclass(frozen=True, slots=True)
class Modes:
    """Frequencies (m,) [Hz], rising, and shapes (m, n_owned, 3) with unit modal mass [1/sqrt(kg)].

    A frequency below zero is one whose eigenvalue came out negative by rounding: -sqrt(|w^2|) / 2
    pi.
    """

    frequencies: Array
    shapes: Array


def free_modes(body: Body, count: int, tolerance: float = 1e-10) -> Modes:
    """The `count` lowest modes of K x = w^2 M x, rigid ones included, ties as in the body.

    The six rigid ones are known, and Ritz's method among them tells their frequencies. The elastic
    ones are sought beside them: six equal eigenvalues are not all found by a Krylov method, and one
    that is missed would make the first elastic mode a rigid one. Krylov-Schur with shift-invert
    (SLEPc), the shifted matrix factored by MUMPS. Constrained nodes carry neither mass nor
    stiffness in the reduced matrices; they are pinned far above the wanted frequencies.

    Parameters
    ----------
    count
        at least 6.

    Raises
    ------
    RuntimeError
        fewer modes converged than asked for.
    """
    from slepc4py import SLEPc

    fields, _, masses = rigid_fields(body)
    rigid, turns = eigh(body.sum(fields.T @ body.apply_many(body.stiffness, fields)), masses)
    shapes = list((fields @ turns).T.reshape(6, -1, 3))
    if count == 6:
        return Modes(_hertz(rigid), np.array(shapes))
    stiffness = body.constraint.pinned(body.stiffness.copy())
    solver = SLEPc.EPS().create(body.comm)
    solver.setOperators(stiffness, body.mass)
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTarget(-spectral_shift(body, _SHARE))
    solver.setDimensions(count - 6, PETSc.DECIDE, PETSc.DECIDE)
    solver.setTolerances(tolerance, 1000)
    transform = solver.getST()
    transform.setType(SLEPc.ST.Type.SINVERT)
    transform.setMatStructure(PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
    linear = transform.getKSP()
    linear.setType("preonly")
    linear.getPC().setType("cholesky")
    linear.getPC().setFactorSolverType("mumps")
    constrained, known = body.owned(body.constraint.nodes)[1], []
    for column in fields.T:
        known.append(stiffness.createVecRight())
        free = column.reshape(-1, 3).copy()
        free[constrained] = 0.0
        known[-1].array[:] = free.ravel()
    solver.setDeflationSpace(known)
    shape, values = stiffness.createVecRight(), list(rigid)
    try:
        solver.solve()
        if (converged := solver.getConverged()) < count - 6:
            raise RuntimeError(f"only {converged} of {count - 6} elastic modes converged")
        for k in range(count - 6):
            values.append(solver.getEigenpair(k, shape).real)
            field = body.constraint.expand(shape.array.reshape(-1, 3).copy())
            shapes.append(
                field
                / np.sqrt(body.dot(shape.array.reshape(-1, 3), body.apply(body.mass, shape.array)))
            )
    finally:
        for one in (solver, stiffness, shape, *known):
            one.destroy()
    order = np.argsort(values)
    return Modes(_hertz(np.array(values)[order]), np.array(shapes)[order])


def _hertz(values: Array) -> Array:
    """Frequencies of eigenvalues [1/s2]."""
    return np.sign(values) * np.sqrt(np.abs(values)) / (2 * np.pi)


def elastic_modes(body: Body, count: int) -> tuple[Array, Array]:
    """Frequencies (m,) [rad/s] and shapes (m, n_owned, 3) of unit modal mass of the lowest elastic
    modes: `count` of them and those of the same frequency as the last, or all there are.

    A Krylov method may miss one of two equal eigenvalues: how many lie below the last is counted,
    and more are sought until none is missing.

    Raises
    ------
    RuntimeError
        some stay missing.
    """
    most = 3 * (body.n_nodes - len(body.constraint.nodes)) - 6
    count = min(count, most)
    if count <= 0:
        return np.zeros(0), np.zeros((0, body.n_owned, 3))
    sought = count
    for _ in range(_TRIES):
        modes = free_modes(body, sought + 6)
        frequencies = 2 * np.pi * modes.frequencies[6:]
        there = most
        if sought < most:
            there = modes_below(body, frequencies[-1] * (1 + SAME_FREQUENCY)) - 6
        if there == sought:
            kept = with_group(frequencies, count)
            return frequencies[:kept], modes.shapes[6 : 6 + kept]
        sought = there
        # their memory is needed for the next
        del modes
    raise RuntimeError(f"some of the {sought} lowest elastic modes are not found")


def modes_below(body: Body, frequency: float) -> int:
    """Number of modes, rigid ones included, below a frequency [rad/s]: that of the negative
    eigenvalues of K - w^2 M.
    """
    matrix = body.constraint.pinned(body.stiffness.copy())
    try:
        matrix.axpy(-(frequency**2), body.mass, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)
        return negative_eigenvalues(matrix)
    finally:
        matrix.destroy()
