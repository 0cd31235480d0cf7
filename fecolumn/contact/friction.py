"""Frictional unilateral contact of a few points: find forces r with s = W r + q, r in Coulomb's cone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn._compiled import compiled, njit
from fecolumn.contact.interior_point import approach, in_cones

# Newton steps from a given guess, at most and without a better residual, after which another way is tried; and from frictionless forces,
# from where Newton finds its way late rather than never
STEPS, STALLED, LONG, LATE = 25, 6, 60, 15
# More points than that, and an interior point helps; its iterations before Newton's first try, between two tries, and at most
FEW, FIRST, TURN, INSIDE = 4, 6, 3, 30


@dataclass(frozen=True, slots=True)
class ContactSolution:
    """Forces (n, 3) [N], residual of the contact laws [m], Newton iterations, and interior point iterations and Gauss-Seidel sweeps used."""

    forces: np.ndarray
    residual: float
    iterations: int
    sweeps: int


@njit
def slips_and_gaps(W, q, forces):
    """W r + q as (n, 3)."""
    n = len(q)
    if n > 8:
        return (W @ forces.ravel()).reshape(n, 3) + q
    # so small, a call of BLAS costs more than the product
    result = q.copy()
    for i in range(n):
        for a in range(3):
            line = W[3 * i + a]
            for j in range(n):
                result[i, a] += line[3 * j] * forces[j, 0] + line[3 * j + 1] * forces[j, 1] + line[3 * j + 2] * forces[j, 2]
    return result


@njit
def natural_residual(W, q, forces, mu, rho):
    """Violation of the contact laws at each point [m]: distance of r from its projection, over rho.

    Zero exactly when gap >= 0, r_n >= 0, r_n gap = 0, |r_t| <= mu r_n and slip is opposed by r_t.
    """
    n = len(q)
    relative = slips_and_gaps(W, q, forces)
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


@njit
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


@njit
def frictionless(W, q, start, most=20):
    """Forces (n, 3) without friction by primal-dual active sets, or the last ones before they cycle: a guess of the points that press."""
    n = len(q)
    forces, pressed = np.zeros((n, 3)), start[:, 2] > 0
    for _ in range(most):
        listed = np.flatnonzero(pressed)
        k = len(listed)
        matrix, normal = np.empty((k, k)), np.empty(k)
        for i in range(k):
            normal[i] = -q[listed[i], 2]
            for j in range(k):
                matrix[i, j] = W[3 * listed[i] + 2, 3 * listed[j] + 2]
        if k and not solve_in_place(matrix, normal):
            break
        forces[:] = 0.0
        for i in range(k):
            forces[listed[i], 2] = normal[i]
        changed = False
        for i in range(n):
            gap = q[i, 2]
            for j in range(k):
                gap += W[3 * i + 2, 3 * listed[j] + 2] * normal[j]
            new = forces[i, 2] > 0 if pressed[i] else gap < 0
            changed |= new != pressed[i]
            pressed[i] = new
        if not changed:
            break
    forces[:, 2] = np.maximum(forces[:, 2], 0.0)
    return forces


@njit
def newton_step(W, q, forces, mu, rho):
    """Forces after one semismooth Newton step on the equations of Alart and Curnier (1991); False where it is singular.

    With d the direction of the trial force and e across it, a slipping point has r_t = mu r_n d + y e. Linearised in r_t, r_n and the
    slip s_t, its equations leave (1 - c) y + rho c e.s_t = 0, c = mu r_n / |trial|: two unknowns, three for a sticking point.
    """
    n = len(q)
    trial = forces - rho.reshape(n, 1) * slips_and_gaps(W, q, forces)
    updated = np.zeros_like(forces)
    # unknown u multiplies basis[u] (3,) of the force on point[u], and its equation is the slip or gap along test[u]
    point, basis, test = np.empty(3 * n, np.int64), np.zeros((3 * n, 3)), np.zeros((3 * n, 3))
    own, count = np.zeros(3 * n), 0
    for i in range(n):
        if not trial[i, 2] > 0:
            continue
        length = np.hypot(trial[i, 0], trial[i, 1])
        if length <= mu * trial[i, 2]:
            for a in range(3):
                point[count] = i
                basis[count, a] = test[count, a] = 1.0
                count += 1
            continue
        x, y = trial[i, 0] / length, trial[i, 1] / length
        share = min(mu * max(forces[i, 2], 0.0) / length, 1.0)
        point[count] = point[count + 1] = i
        basis[count, 0], basis[count, 1], basis[count, 2] = mu * x, mu * y, 1.0
        test[count, 2] = 1.0
        basis[count + 1, 0], basis[count + 1, 1] = -y, x
        # of the size of the others' equations
        test[count + 1, 0], test[count + 1, 1] = -share * y, share * x
        own[count + 1] = (1 - share) / rho[i]
        count += 2
    if count == 0:
        return updated, True
    half, matrix, right = np.empty((count, 3 * n)), np.empty((count, count)), np.empty(count)
    for u in range(count):
        row, x, y, z = 3 * point[u], test[u, 0], test[u, 1], test[u, 2]
        right[u] = -(x * q[point[u], 0] + y * q[point[u], 1] + z * q[point[u], 2])
        if x == 0.0 and y == 0.0 and z == 1.0:
            half[u] = W[row + 2]
        else:
            for j in range(3 * n):
                half[u, j] = x * W[row, j] + y * W[row + 1, j] + z * W[row + 2, j]
        for v in range(count):
            column = 3 * point[v]
            matrix[u, v] = basis[v, 0] * half[u, column] + basis[v, 1] * half[u, column + 1] + basis[v, 2] * half[u, column + 2]
        matrix[u, u] += own[u]
    if not solve_in_place(matrix, right):
        return updated, False
    for u in range(count):
        for a in range(3):
            updated[point[u], a] += right[u] * basis[u, a]
    return updated, True


@njit
def solve_in_place(matrix, right):
    """Solve by Gaussian elimination with row pivoting, LAPACK where it pays; overwrites both, False where singular."""
    n = len(right)
    if n > 40:
        try:
            right[:] = np.linalg.solve(matrix, right)
        except Exception:
            return False
        return True
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if matrix[pivot, k] == 0.0:
            return False
        if pivot != k:
            for j in range(k, n):
                matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
            right[k], right[pivot] = right[pivot], right[k]
        inverse = 1 / matrix[k, k]
        for i in range(k + 1, n):
            factor = matrix[i, k] * inverse
            if factor != 0.0:
                for j in range(k + 1, n):
                    matrix[i, j] -= factor * matrix[k, j]
                right[i] -= factor * right[k]
    for i in range(n - 1, -1, -1):
        value = right[i]
        for j in range(i + 1, n):
            value -= matrix[i, j] * right[j]
        right[i] = value / matrix[i, i]
    return True


@njit
def iterate(W, q, mu, start, tolerance, near=True, sweeps=800):
    """As `solve_contact`, for compiled code: forces (n, 3), residual, Newton iterations and others.

    near: whether `start` is a good guess; else only where it presses counts.
    """
    n = len(q)
    rho, rho_t, rho_all = np.empty(n), np.empty(n), np.empty(n)
    for i in range(n):
        xx, yy, zz = W[3 * i, 3 * i], W[3 * i + 1, 3 * i + 1], W[3 * i + 2, 3 * i + 2]
        rho[i], rho_t[i] = 3 / (xx + yy + zz), 1 / np.hypot(xx, yy)
        # points that move together are more compliant than one alone: with its own rho each would seem to slip to and fro
        rho_all[i] = 3 / np.abs(W[3 * i:3 * i + 3]).sum()
    if n == 0:
        return start.copy(), 0.0, 0, 0
    best, least, iterations, others = start, np.inf, 0, 0
    if near:
        best, least, iterations = _newtons(W, q, mu, start, tolerance, rho_all, rho, STEPS, STALLED)
    if least > tolerance:
        forces, residual, made = _newtons(W, q, mu, frictionless(W, q, start), tolerance, rho, rho, LONG, LATE)
        iterations += made
        if residual < least:
            best, least = forces, residual
    if least > tolerance and mu > 0 and n > FEW:
        A, Q = in_cones(W, q, mu)
        R, U, inside, most = np.zeros((n, 3)), np.zeros((n, 3)), 0, FIRST
        while inside < INSIDE:
            forces, made = approach(A, Q, mu, R, U, most)
            inside += made
            # from inside Newton needs a step or two when the active set is right, and costs a tenth
            forces, residual, newtons = _newtons(W, q, mu, forces, tolerance, rho, rho, STALLED, 2)
            iterations += newtons
            if residual < least:
                best, least = forces, residual
            if least <= tolerance or made < most:
                break
            most = TURN
        others += inside
    count = 50
    while least > tolerance and count <= sweeps:
        forces = best.copy()
        others += gauss_seidel(W, q, forces, mu, rho_t, count, tolerance * rho.min())
        forces, residual, made = _newtons(W, q, mu, forces, tolerance, rho, rho, STEPS, STALLED)
        iterations += made
        if residual < least:
            best, least = forces, residual
        count *= 4
    return best, least, iterations, others


@njit
def _newtons(W, q, mu, start, tolerance, rho, rho_own, most, patience):
    """Newton steps until the tolerance is met, or the residual has not fallen for more than `patience`: best forces, residual, steps made."""
    forces, least, stalled, made = start, np.inf, 0, 0
    best = start
    while True:
        residual = natural_residual(W, q, forces, mu, rho_own).max()
        stalled += 1
        if residual < least:
            best, least, stalled = forces, residual, 0
        if residual <= tolerance or stalled > patience or made == most:
            break
        forces, regular = newton_step(W, q, forces, mu, rho)
        if not regular:
            break
        made += 1
    return best.copy(), least, made


def solve_contact(W, q, mu: float, start, tolerance: float = 1e-12, sweeps: int = 800) -> ContactSolution:
    """Solve the frictional contact problem of n points.

    Args:
        W: (3 n, 3 n) compliance [m/N], symmetric positive definite; per point x, y (tangential), z (normal).
        q: (n, 3) [m] slip (x, y) and gap (z) without contact forces; gap > 0 is open.
        mu: Coulomb friction coefficient.
        start: (n, 3) [N] first guess.
        tolerance: residual at convergence [m].

    Semismooth Newton, stick and slip judged by the stiffness of all points together; where its active set cycles, the frictionless
    forces, an interior point and, should they fail, Gauss-Seidel sweeps give it a better start. The residual returned
    is the true one: the caller decides what to do with a solution that has not converged.
    """
    W, q, start = (np.ascontiguousarray(array, float) for array in (W, q, start))
    return ContactSolution(*iterate(W, q, float(mu), start, tolerance, True, sweeps))


def prepare_solver(say=lambda text: None) -> None:
    """Have the solver compiled, so that the first step costs what all cost.

    Args:
        say: told why it takes long, if it does.
    """
    if not compiled(iterate):
        say("compiling the contact solver, once on this machine: half a minute")
    solve_contact(np.eye(3), np.zeros((1, 3)), 0.0, np.zeros((1, 3)))
