"""Siconos 4.4 (Debian python3-siconos), run by the system's Python: its solvers on friction problems.

    /usr/bin/python3 -P siconos.py FOLDER

Each NAME.problem.npz (W, q, mu in the project's order x, y, z) gets NAME.SOLVER.npz: forces, seconds, iterations and Siconos' own judgement.
Siconos has the normal component first. Both solvers aim at 1e-12 of |q|; one that makes no more headway goes on to its limit.
"""

import sys
import time
from pathlib import Path

import numpy as np
import siconos.numerics as sn
from scipy import sparse

# Iterations at most: Newton's are Siconos' default
SOLVERS = {"nsgs": (sn.SICONOS_FRICTION_3D_NSGS, 5000), "newton": (sn.SICONOS_FRICTION_3D_NSN_AC, 200)}


def normal_first(n):
    """Of components x, y, z of n points, the order z, x, y (3 n,): x, y, z stays right-handed."""
    return (3 * np.arange(n)[:, None] + [2, 0, 1]).ravel()


def solve(W, q, mu, solver):
    """Forces (n, 3), seconds, iterations, 0 where converged."""
    number, most = SOLVERS[solver]
    order, n = normal_first(len(q)), len(q)
    # sparse: W of many bodies mostly is, and Siconos makes use of it
    matrix = sparse.csc_matrix(W[np.ix_(order, order)])
    problem = sn.FrictionContactProblem(3, matrix, q.ravel()[order], np.broadcast_to(mu, n).copy())
    options = sn.SolverOptions(number)
    options.iparam[sn.SICONOS_IPARAM_MAX_ITER], options.dparam[sn.SICONOS_DPARAM_TOL] = most, 1e-12
    if solver == "newton":
        # Jean and Moreau's variant of Alart and Curnier's equations: it solves 77 % of the assemblies, Siconos' default 62 %
        options.iparam[sn.SICONOS_FRICTION_3D_NSN_FORMULATION] = sn.SICONOS_FRICTION_3D_NSN_FORMULATION_JEANMOREAU_STD
    reaction, velocity = np.zeros(3 * n), np.zeros(3 * n)
    began = time.perf_counter()
    code = sn.fc3d_driver(problem, reaction, velocity, options)
    seconds, forces = time.perf_counter() - began, np.empty(3 * n)
    forces[order] = reaction
    return forces.reshape(n, 3), seconds, int(options.iparam[sn.SICONOS_IPARAM_ITER_DONE]), int(code)


if __name__ == "__main__":
    for path in sorted(Path(sys.argv[1]).glob("*.problem.npz")):
        given = np.load(path)
        for solver in SOLVERS:
            forces, seconds, iterations, code = solve(given["W"], given["q"], given["mu"], solver)
            name = path.name.replace("problem", solver)
            np.savez(path.with_name(name), forces=forces, seconds=seconds, iterations=iterations, code=code)
