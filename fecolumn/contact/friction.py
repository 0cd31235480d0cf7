"""Frictional unilateral contact of a few points: find forces r with s = W r + q, r in Coulomb's cone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn._compiled import compiled, njit
from fecolumn.contact import tolerances
from fecolumn.contact.arrays import flat, marked, put, put_points
from fecolumn.contact.interior_point import approach, in_cones


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
    n, result = len(q), np.empty((len(q), 3))
    if n > 8:
        put_points(W @ flat(forces), result)
        for i in range(n):
            for a in range(3):
                result[i, a] += q[i, a]
        return result
    # so small, a call of BLAS costs more than the product
    for i in range(n):
        for a in range(3):
            result[i, a] = q[i, a]
            line = W[3 * i + a]
            for j in range(n):
                result[i, a] += line[3 * j] * forces[j, 0] + line[3 * j + 1] * forces[j, 1] + line[3 * j + 2] * forces[j, 2]
    return result


@njit
def in_cone(x, y, normal, friction):
    """Coulomb's projection of a trial force: its normal part not below 0, its tangential part not above friction times that."""
    normal = max(0.0, normal)
    length = np.sqrt(x * x + y * y)
    if length > friction * normal:
        share = friction * normal / length
        return x * share, y * share, normal
    return x, y, normal


@njit
def law_error(r0, r1, r2, s0, s1, s2, stiffness, friction):
    """Violation of the contact laws by a force r and a slip and gap s [m]: distance of r from the projection of r - stiffness s, over stiffness.

    Zero exactly when gap >= 0, r_n >= 0, r_n gap = 0, |r_t| <= friction r_n and slip is opposed by r_t.
    """
    x, y, normal = in_cone(r0 - stiffness * s0, r1 - stiffness * s1, r2 - stiffness * s2, friction)
    return np.sqrt((r0 - x) ** 2 + (r1 - y) ** 2 + (r2 - normal) ** 2) / stiffness


@njit
def natural_residual(W, q, forces, friction, rho):
    """Largest violation of the contact laws [m], see `law_error`; rho: (n,) stiffness by which it is measured [N/m]."""
    return _violation(slips_and_gaps(W, q, forces), forces, friction, rho)


@njit
def _violation(relative, forces, friction, rho):
    """As `natural_residual`, of known slips and gaps (n, 3)."""
    worst = 0.0
    for i in range(len(forces)):
        worst = max(worst, law_error(forces[i, 0], forces[i, 1], forces[i, 2], relative[i, 0], relative[i, 1], relative[i, 2], rho[i], friction[i]))
    return worst


@njit
def gauss_seidel(W, q, forces, friction, rho, sweeps, tolerance):
    """Projected nonlinear Gauss-Seidel (Jourdan, Alart, Jean 1998); changes `forces`, returns the sweeps made."""
    n, s = len(q), np.empty(3)
    for sweep in range(sweeps):
        change = 0.0
        for i in range(n):
            for a in range(3):
                s[a], row = q[i, a], W[3 * i + a]
                for j in range(n):
                    s[a] += row[3 * j] * forces[j, 0] + row[3 * j + 1] * forces[j, 1] + row[3 * j + 2] * forces[j, 2]
            normal = forces[i, 2] - s[2] / W[3 * i + 2, 3 * i + 2]
            t0, t1, normal = in_cone(forces[i, 0] - rho[i] * s[0], forces[i, 1] - rho[i] * s[1], normal, friction[i])
            change = max(change, abs(t0 - forces[i, 0]), abs(t1 - forces[i, 1]), abs(normal - forces[i, 2]))
            forces[i, 0], forces[i, 1], forces[i, 2] = t0, t1, normal
        if change <= tolerance:
            return sweep + 1
    return sweeps


@njit
def frictionless(W, q, start):
    """Forces (n, 3) without friction by primal-dual active sets, or the last ones before they cycle: a guess of the points that press."""
    n = len(q)
    forces, pressed = np.zeros((n, 3)), np.empty(n, np.bool_)
    for i in range(n):
        pressed[i] = start[i, 2] > 0
    for _ in range(20):
        listed = marked(pressed)
        k = len(listed)
        matrix, normal = np.empty((k, k)), np.empty(k)
        for i in range(k):
            normal[i] = -q[listed[i], 2]
            for j in range(k):
                matrix[i, j] = W[3 * listed[i] + 2, 3 * listed[j] + 2]
        if k and not solve_in_place(matrix, normal):
            break
        for i in range(n):
            forces[i, 2] = 0.0
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
    for i in range(n):
        forces[i, 2] = max(forces[i, 2], 0.0)
    return forces


@njit
def newton_step(W, q, forces, relative, friction, rho, give):
    """Forces after one semismooth Newton step on the equations of Alart and Curnier (1991); False where it is singular.

    relative: (n, 3) slips and gaps under the forces.

    give: compliance [m/N] of each point against a change of its force, in this step alone: 0, or little where W leaves open which of many points
    carry. The laws are not softened by it: where the forces change no more, it plays no part.

    With d the direction of the trial force and e across it, a slipping point has r_t = mu r_n d + y e. Linearised in r_t, r_n and the
    slip s_t, its equations leave (1 - c) y + rho c e.s_t = 0, c = mu r_n / |trial|: two unknowns, three for a sticking point.
    """
    n = len(q)
    trial, updated = np.empty((n, 3)), np.zeros((n, 3))
    for i in range(n):
        for a in range(3):
            trial[i, a] = forces[i, a] - rho[i] * relative[i, a]
    # unknown u multiplies basis[u] (3,) of the force on point[u], and its equation is the slip or gap along test[u]
    point, basis, test = np.empty(3 * n, np.int64), np.zeros((3 * n, 3)), np.zeros((3 * n, 3))
    stiffening, count = np.zeros(3 * n), 0
    for i in range(n):
        if not trial[i, 2] > 0:
            continue
        mu = friction[i]
        if mu == 0.0:
            point[count], basis[count, 2], test[count, 2] = i, 1.0, 1.0
            count += 1
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
        stiffening[count + 1] = (1 - share) / rho[i]
        count += 2
    if count == 0:
        return updated, True
    line, matrix, right = np.empty(3 * n), np.empty((count, count)), np.empty(count)
    for u in range(count):
        row, x, y, z = 3 * point[u], test[u, 0], test[u, 1], test[u, 2]
        right[u] = 0.0
        for a in range(3):
            right[u] -= test[u, a] * (q[point[u], a] - give * forces[point[u], a])
        first, second, third = W[row], W[row + 1], W[row + 2]
        for j in range(3 * n):
            line[j] = x * first[j] + y * second[j] + z * third[j]
        for v in range(count):
            column = 3 * point[v]
            matrix[u, v] = basis[v, 0] * line[column] + basis[v, 1] * line[column + 1] + basis[v, 2] * line[column + 2]
        # the unknowns of a point are beside each other
        for v in range(max(u - 2, 0), min(u + 3, count)):
            if point[v] == point[u]:
                matrix[u, v] += give * (x * basis[v, 0] + y * basis[v, 1] + z * basis[v, 2])
        matrix[u, u] += stiffening[u]
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
            put(np.linalg.solve(matrix, right), right)
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


@njit(fastmath={"reassoc", "contract"})
def stiffness_together(W, i):
    """Stiffness [N/m] of point i when all points move: it is less than alone, with which each would seem to slip to and fro."""
    total = 0.0
    for a in range(3):
        row = W[3 * i + a]
        for j in range(len(row)):
            total += abs(row[j])
    return 3 / total


@njit
def iterate(W, q, friction, start, tolerance, near, sweeps):
    """As `solve_contact`, for compiled code: forces (n, 3), residual, Newton iterations and others.

    near: whether `start` is a good guess, from which Newton is tried first; else where it presses counts first.
    """
    n, stiffest, give = len(q), np.inf, 0.0
    rho, rho_t, rho_all = np.empty(n), np.empty(n), np.empty(n)
    for i in range(n):
        xx, yy, zz = W[3 * i, 3 * i], W[3 * i + 1, 3 * i + 1], W[3 * i + 2, 3 * i + 2]
        rho[i], rho_t[i] = 3 / (xx + yy + zz), 1 / np.hypot(xx, yy)
        rho_all[i] = stiffness_together(W, i)
        stiffest, give = min(stiffest, rho[i]), max(give, tolerances.GIVE / rho[i])
    if n == 0:
        return start.copy(), 0.0, 0, 0
    best, least, iterations, others = start, np.inf, 0, 0
    for way in range(2):
        if least <= tolerance:
            break
        if near == (way == 0):
            forces, residual, made = _newtons(W, q, friction, start, tolerance, rho_all, rho, 0.0, tolerances.NEWTON_STEPS, tolerances.NEWTON_STALLED)
        else:
            forces, residual, made = _newtons(W, q, friction, frictionless(W, q, start), tolerance, rho, rho, 0.0, tolerances.FAR_STEPS, tolerances.FAR_STALLED)
        iterations += made
        if residual < least:
            best, least = forces, residual
    if least > tolerance and n > tolerances.FEW_POINTS:
        A, Q = in_cones(W, q, friction)
        R, U, inside, most = np.zeros((n, 3)), np.zeros((n, 3)), 0, tolerances.INSIDE_FIRST
        while inside < tolerances.INSIDE_MOST:
            forces, made = approach(A, Q, friction, R, U, most, np.empty(0))
            inside += made
            # from inside Newton needs a step or two when the active set is right, and costs a tenth
            forces, residual, newtons = _newtons(W, q, friction, forces, tolerance, rho, rho, give, tolerances.NEWTON_STALLED, 2)
            iterations += newtons
            if residual < least:
                best, least = forces, residual
            if least <= tolerance or made < most:
                break
            most = tolerances.INSIDE_TURN
        others += inside
    count = tolerances.SWEEPS_FIRST
    while least > tolerance and count <= sweeps:
        forces = best.copy()
        others += gauss_seidel(W, q, forces, friction, rho_t, count, tolerance * stiffest)
        forces, residual, made = _newtons(W, q, friction, forces, tolerance, rho, rho, give, tolerances.NEWTON_STEPS, tolerances.NEWTON_STALLED)
        iterations += made
        if residual < least:
            best, least = forces, residual
        count *= 4
    if least > tolerance:
        # many small steps, each held by a compliance against change: they end where the active sets of all other ways cycle
        held = give * tolerances.HELD_GIVE / tolerances.GIVE
        forces, residual, made = _newtons(W, q, friction, best, tolerance, rho, rho, held, tolerances.HELD_STEPS, tolerances.HELD_STALLED)
        iterations += made
        if residual < least:
            best, least = forces, residual
    if least > tolerance and tolerances.FEW_POINTS < n <= tolerances.FROZEN_POINTS:
        forces, residual, made, inside = _with_frozen_slips(W, q, friction, tolerance, rho, give)
        iterations += made
        others += inside
        if residual < least:
            best, least = forces, residual
    return best, least, iterations, others


@njit
def _with_frozen_slips(W, q, friction, tolerance, rho, give):
    """Forces by a fixed point on the sizes of the slips (Acary, Cadoux, Lemarechal and Malick 2011, ZAMM 91): best forces, residual, steps of Newton, iterations inside.

    With these sizes frozen the problem is convex, and an interior point solves it to its end; Newton tries from each solution.
    """
    n, slips, least, iterations, others = len(q), np.zeros(len(q)), np.inf, 0, 0
    A, Q = in_cones(W, q, friction)
    best = np.zeros((n, 3))
    for _ in range(tolerances.FROZEN_TURNS):
        forces, inside = approach(A, Q, friction, np.zeros((n, 3)), np.zeros((n, 3)), tolerances.FROZEN_INSIDE, slips)
        relative = slips_and_gaps(W, q, forces)
        for i in range(n):
            slips[i] = np.hypot(relative[i, 0], relative[i, 1])
        forces, residual, made = _newtons(W, q, friction, forces, tolerance, rho, rho, give, tolerances.NEWTON_STALLED, 2)
        iterations += made
        others += inside
        if residual < least:
            best, least = forces, residual
        if least <= tolerance:
            break
    return best, least, iterations, others


@njit
def _newtons(W, q, friction, start, tolerance, rho, rho_alone, give, most, patience):
    """Newton steps until the tolerance is met, or the residual has not fallen for more than `patience`: best forces, residual, steps made."""
    forces, least, stalled, made = start, np.inf, 0, 0
    best = start
    while True:
        relative = slips_and_gaps(W, q, forces)
        residual = _violation(relative, forces, friction, rho_alone)
        stalled += 1
        if residual < least:
            best, least, stalled = forces, residual, 0
        if residual <= tolerance or stalled > patience or made == most:
            break
        forces, regular = newton_step(W, q, forces, relative, friction, rho, give)
        if not regular:
            break
        made += 1
    return best.copy(), least, made


def solve_contact(W, q, mu, start, tolerance: float = 1e-12, sweeps: int = tolerances.SWEEPS_MOST) -> ContactSolution:
    """Solve the frictional contact problem of n points.

    Args:
        W: (3 n, 3 n) compliance [m/N], symmetric positive definite; per point x, y (tangential), z (normal).
        q: (n, 3) [m] slip (x, y) and gap (z) without contact forces; gap > 0 is open.
        mu: Coulomb friction coefficient, of all points or (n,) of each.
        start: (n, 3) [N] first guess.
        tolerance: residual at convergence [m].

    Semismooth Newton, stick and slip judged by the stiffness of all points together; where its active set cycles, the frictionless
    forces, an interior point and, should they fail, Gauss-Seidel sweeps give it a better start. The residual returned
    is the true one: the caller decides what to do with a solution that has not converged.
    """
    W, q, start = (np.ascontiguousarray(array, float) for array in (W, q, start))
    friction = np.ascontiguousarray(np.broadcast_to(np.asarray(mu, float), len(q)))
    return ContactSolution(*iterate(W, q, friction, start, tolerance, True, sweeps))


def prepare_solver(say=lambda text: None) -> None:
    """Have the solver compiled, so that the first step costs what all cost.

    Args:
        say: told why it takes long, if it does.
    """
    if not compiled(iterate):
        say("compiling the contact solver, once on this machine: half a minute")
    solve_contact(np.eye(3), np.zeros((1, 3)), 0.0, np.zeros((1, 3)))
