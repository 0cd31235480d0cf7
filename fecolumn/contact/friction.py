"""Frictional unilateral contact of a few points: find forces r with s = W r + q, r in Coulomb's cone."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np


@dataclass(frozen=True, slots=True)
class ContactSolution:
    """Forces (n, 3) [N], residual of the contact laws [m], Newton iterations and Gauss-Seidel sweeps used."""

    forces: np.ndarray
    residual: float
    iterations: int
    sweeps: int


@numba.njit(cache=True)
def natural_residual(W, q, forces, mu, rho):
    """Violation of the contact laws at each point [m]: distance of r from its projection, over rho.

    Zero exactly when gap >= 0, r_n >= 0, r_n gap = 0, |r_t| <= mu r_n and slip is opposed by r_t.
    """
    n = len(q)
    relative = (W @ forces.ravel()).reshape(n, 3) + q
    error = np.zeros(n)
    for i in range(n):
        normal = max(0.0, forces[i, 2] - rho[i] * relative[i, 2])
        t0 = forces[i, 0] - rho[i] * relative[i, 0]
        t1 = forces[i, 1] - rho[i] * relative[i, 1]
        length = np.sqrt(t0 * t0 + t1 * t1)
        if length > mu * normal:
            t0 *= mu * normal / length
            t1 *= mu * normal / length
        d0, d1, d2 = forces[i, 0] - t0, forces[i, 1] - t1, forces[i, 2] - normal
        error[i] = np.sqrt(d0 * d0 + d1 * d1 + d2 * d2) / rho[i]
    return error


@numba.njit(cache=True)
def gauss_seidel(W, q, forces, mu, rho, sweeps, tolerance):
    """Projected nonlinear Gauss-Seidel (Jourdan, Alart, Jean 1998); changes `forces`, returns the sweeps made."""
    n = len(q)
    for sweep in range(sweeps):
        change = 0.0
        for i in range(n):
            s = q[i].copy()
            for a in range(3):
                row = W[3 * i + a]
                for j in range(n):
                    s[a] += row[3 * j] * forces[j, 0] + row[3 * j + 1] * forces[j, 1] + row[3 * j + 2] * forces[j, 2]
            normal = max(0.0, forces[i, 2] - s[2] / W[3 * i + 2, 3 * i + 2])
            t0, t1 = forces[i, 0] - rho[i] * s[0], forces[i, 1] - rho[i] * s[1]
            length = np.sqrt(t0 * t0 + t1 * t1)
            if length > mu * normal:
                t0 *= mu * normal / length
                t1 *= mu * normal / length
            change = max(change, abs(t0 - forces[i, 0]), abs(t1 - forces[i, 1]), abs(normal - forces[i, 2]))
            forces[i, 0], forces[i, 1], forces[i, 2] = t0, t1, normal
        if change <= tolerance:
            return sweep + 1
    return sweeps


def newton_step(W, q, forces, mu, rho):
    """Forces after one semismooth Newton step on the equations of Alart and Curnier (1991)."""
    n = len(q)
    trial = forces - rho[:, None] * ((W @ forces.ravel()).reshape(n, 3) + q)
    touching = np.flatnonzero(trial[:, 2] > 0)
    updated = np.zeros_like(forces)
    if not len(touching):
        return updated
    length = np.hypot(trial[touching, 0], trial[touching, 1])
    slipping = length > mu * trial[touching, 2]
    dofs = (3 * touching[:, None] + np.arange(3)).ravel()
    matrix, right = W[np.ix_(dofs, dofs)], -q[touching].ravel()
    for k in np.flatnonzero(slipping):
        # r_t = mu r_n d with d the direction of the trial force, linearised in r_t, r_n and the slip
        i, rows = touching[k], slice(3 * k, 3 * k + 2)
        direction = trial[i, :2] / length[k]
        pressure = max(forces[i, 2], 0.0)
        turn = min(mu * pressure / length[k], 1.0) * (np.eye(2) - np.outer(direction, direction))
        slip_rows = matrix[rows].copy()
        matrix[rows] = rho[i] * turn @ slip_rows
        matrix[rows, rows] += np.eye(2) - turn
        matrix[rows, 3 * k + 2] -= mu * direction
        # Newton about the present forces, written for the new ones: turn (r_t - rho q_t) drops out along d
        right[rows] = -rho[i] * turn @ q[i, :2]
    updated[touching] = np.linalg.solve(matrix, right).reshape(-1, 3)
    return updated


def solve_contact(W, q, mu: float, start, tolerance: float = 1e-12, max_newton: int = 25, rounds: int = 6) -> ContactSolution:
    """Solve the frictional contact problem of n points.

    Args:
        W: (3 n, 3 n) compliance [m/N], symmetric positive definite; per point x, y (tangential), z (normal).
        q: (n, 3) [m] slip (x, y) and gap (z) without contact forces; gap > 0 is open.
        mu: Coulomb friction coefficient.
        start: (n, 3) [N] first guess.
        tolerance: residual at convergence [m].

    Semismooth Newton; where its active set cycles, Gauss-Seidel sweeps give it a better start. The residual returned
    is the true one: the caller decides what to do with a solution that has not converged.
    """
    n = len(q)
    if not n:
        return ContactSolution(np.zeros((0, 3)), 0.0, 0, 0)
    rho = 3.0 / np.diag(W).reshape(n, 3).sum(axis=1)
    rho_t = 1.0 / np.linalg.norm(np.stack([np.diag(W)[0::3], np.diag(W)[1::3]]), axis=0)
    forces = np.array(start, float)
    best, least = forces, np.inf
    iterations = sweeps = 0
    for round_ in range(rounds):
        for _ in range(max_newton):
            residual = natural_residual(W, q, forces, mu, rho).max()
            if residual < least:
                best, least = forces, residual
            if residual <= tolerance:
                return ContactSolution(best, least, iterations, sweeps)
            try:
                forces = newton_step(W, q, forces, mu, rho)
            except np.linalg.LinAlgError:
                break
            iterations += 1
        forces = best.copy()
        sweeps += gauss_seidel(W, q, forces, mu, rho_t, 50 * 2**round_, tolerance * rho.min())
    return ContactSolution(best, least, iterations, sweeps)
