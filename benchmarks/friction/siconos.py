"""Siconos 4.4 (Debian python3-siconos), run by the system's Python: its solvers on friction
problems, and its judgement of forces.

    /usr/bin/python3 -P siconos.py FOLDER

Each NAME.problem.npz (W, q, mu in the project's order x, y, z, and forces, `ours`, where there are
some) gets NAME.SOLVER.npz: forces, seconds of CPU, iterations, Siconos' code and its own error of
the forces; those of `ours` are in NAME.judged.npz. Siconos has the normal component first. All
solvers aim at 1e-12 of |q|; one that makes no more headway goes on to its limit.
"""

import sys
import time
from pathlib import Path

import numpy as np
import siconos.numerics as sn
from scipy import sparse

# Iterations at most: those of Newton and ADMM are Siconos' defaults, Gauss-Seidel gets twenty times
# its own
SOLVERS = {
    "nsgs": (sn.SICONOS_FRICTION_3D_NSGS, 20_000),
    "newton": (sn.SICONOS_FRICTION_3D_NSN_AC, 200),
    "admm": (sn.SICONOS_FRICTION_3D_ADMM, 20_000),
}
# What is faster is done so often that it takes so long: the clock of the CPU has ticks [s]
LEAST_S = 0.02


def normal_first(n):
    """Of components x, y, z of n points, the order z, x, y (3 n,): x, y, z stays right-handed."""
    return (3 * np.arange(n)[:, None] + [2, 0, 1]).ravel()


def posed(W, q, mu):
    """Siconos' problem, and the unit of its forces; sparse: W of many bodies mostly is, and Siconos
    makes use of it.

    In units in which the largest |q| and the mean diagonal of W are 1: Siconos' errors and ADMM's
    penalty add forces to slips, so that N and m would decide what it finds.
    """
    order, n = normal_first(len(q)), len(q)
    length, compliance = np.abs(q).max() or 1.0, np.trace(W) / len(W)
    matrix = sparse.csc_matrix(W[np.ix_(order, order)] / compliance)
    return sn.FrictionContactProblem(
        3, matrix, q.ravel()[order] / length, np.broadcast_to(mu, n).copy()
    ), length / compliance


def own_error(problem, reaction):
    """Siconos' error of forces in its units, the normal first: the norm over all points of r - P(r
    - (u + mu |u_t| n)), over |q|.
    """
    options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_NSGS)
    return sn.fc3d_compute_error(
        problem, reaction, np.zeros_like(reaction), 1e-12, options, np.linalg.norm(problem.q)
    )[1]


def solve(W, q, mu, solver):
    """Forces (n, 3), seconds of CPU, iterations, 0 where converged, Siconos' own error."""
    number, most = SOLVERS[solver]
    order, n = normal_first(len(q)), len(q)
    (problem, unit), options = posed(W, q, mu), sn.SolverOptions(number)
    options.iparam[sn.SICONOS_IPARAM_MAX_ITER], options.dparam[sn.SICONOS_DPARAM_TOL] = most, 1e-12
    if solver == "newton":
        # Jean and Moreau's variant of Alart and Curnier's equations: it solves 77 % of the
        # assemblies, Siconos' default 62 %
        options.iparam[sn.SICONOS_FRICTION_3D_NSN_FORMULATION] = (
            sn.SICONOS_FRICTION_3D_NSN_FORMULATION_JEANMOREAU_STD
        )
    reaction, velocity, began, seconds, made = (
        np.zeros(3 * n),
        np.zeros(3 * n),
        time.process_time(),
        0.0,
        0,
    )
    while seconds < LEAST_S:
        reaction[:] = velocity[:] = 0.0
        code = sn.fc3d_driver(problem, reaction, velocity, options)
        seconds, made = time.process_time() - began, made + 1
    seconds, forces = seconds / made, np.empty(3 * n)
    forces[order] = reaction * unit
    return (
        forces.reshape(n, 3),
        seconds,
        int(options.iparam[sn.SICONOS_IPARAM_ITER_DONE]),
        int(code),
        own_error(problem, reaction),
    )


if __name__ == "__main__":
    for path in sorted(Path(sys.argv[1]).glob("*.problem.npz")):
        given = np.load(path)
        W, q, mu = given["W"], given["q"], given["mu"]
        if "ours" in given:
            problem, unit = posed(W, q, mu)
            judged = own_error(problem, given["ours"].ravel()[normal_first(len(q))] / unit)
            np.savez(path.with_name(path.name.replace("problem", "judged")), own_error=judged)
        for solver in SOLVERS:
            forces, seconds, iterations, code, error = solve(W, q, mu, solver)
            name = path.name.replace("problem", solver)
            np.savez(
                path.with_name(name),
                forces=forces,
                seconds=seconds,
                iterations=iterations,
                code=code,
                own_error=error,
            )
