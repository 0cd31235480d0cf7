"""Semismooth Newton on the laws of contact (Alart and Curnier 1991)."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.arrays import put
from fecolumn.contact.blocks import FEW_UNKNOWNS, eliminate, solve_columns
from fecolumn.contact.coulomb import slips_and_gaps, violation
from fecolumn.contact.tolerances import SINGULAR
from fecolumn.foundation._compiled import njit


@njit
def newton_steps(W, blocks, q, friction, start, tolerance, rho, rho_alone, give, most, patience):
    """Newton steps until the tolerance is met, or the residual has not fallen for more than
    `patience`, or without `give` W proves singular: best forces, residual, steps made.
    """
    forces, least, stalled, made = start, np.inf, 0, 0
    best = start
    while True:
        relative = slips_and_gaps(W, q, forces)
        residual = violation(relative, forces, friction, rho_alone)
        stalled += 1
        if residual < least:
            best, least, stalled = forces, residual, 0
        if (
            residual <= tolerance
            or stalled > patience
            or made == most
            or give == 0.0
            and not residual <= SINGULAR * least
        ):
            break
        forces, regular = newton_step(W, blocks, q, forces, relative, friction, rho, give)
        if not regular:
            break
        made += 1
    return best.copy(), least, made


@njit
def newton_step(W, blocks, q, forces, relative, friction, rho, give):
    """Forces after one semismooth Newton step on the equations of Alart and Curnier (1991); False
    where it is singular.

    blocks: of `blocks.find_blocks`. relative: (n, 3) slips and gaps under the forces.

    give: compliance [m/N] of each point against a change of its force, in this step alone: 0, or
    little where W leaves open which of many points carry. The laws are not softened by it: where
    the forces change no more, it plays no part.

    With d the direction of the trial force and e across it, a slipping point has r_t = mu r_n d + y
    e. Linearised in r_t, r_n and the slip s_t, its equations leave (1 - c) y + rho c e.s_t = 0, c =
    mu r_n / |trial|: two unknowns, three for a sticking point.
    """
    n, g = len(q), len(blocks.coupled)
    trial, updated = np.empty((n, 3)), np.zeros((n, 3))
    for i in range(n):
        for a in range(3):
            trial[i, a] = forces[i, a] - rho[i] * relative[i, a]
    # unknown u multiplies basis[u] (3,) of the force on point[u], and its equation is the slip or
    # gap along test[u]
    point, basis, test = np.empty(3 * n, np.int64), np.zeros((3 * n, 3)), np.zeros((3 * n, 3))
    stiffening, count = np.zeros(3 * n), 0
    for i in blocks.order:
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
        # scaled to the size of the other equations
        test[count + 1, 0], test[count + 1, 1] = -share * y, share * x
        stiffening[count + 1] = (1 - share) / rho[i]
        count += 2
    if count == 0:
        return updated, True
    # rows and columns of the blocks
    begin = np.zeros(g + 1, np.int64)
    for u in range(count):
        begin[blocks.of[point[u]] + 1] += 1
    for k in range(g):
        begin[k + 1] += begin[k]
    line, matrix, right = np.empty(3 * n), np.empty((count, count)), np.empty(count)
    for u in range(count):
        row, x, y, z = 3 * point[u], test[u, 0], test[u, 1], test[u, 2]
        right[u] = 0.0
        for a in range(3):
            right[u] -= test[u, a] * (q[point[u], a] - give * forces[point[u], a])
        first, second, third = W[row], W[row + 1], W[row + 2]
        for k in range(g):
            if begin[k] == begin[k + 1] or not blocks.coupled[blocks.of[point[u]], k]:
                continue
            # the points of a block are beside each other
            near = 3 * blocks.order[blocks.first[k]]
            for j in range(near, near + 3 * (blocks.first[k + 1] - blocks.first[k])):
                line[j] = x * first[j] + y * second[j] + z * third[j]
            for v in range(begin[k], begin[k + 1]):
                column = 3 * point[v]
                matrix[u, v] = (
                    basis[v, 0] * line[column]
                    + basis[v, 1] * line[column + 1]
                    + basis[v, 2] * line[column + 2]
                )
        # the unknowns of a point are beside each other
        for v in range(max(u - 2, 0), min(u + 3, count)):
            if point[v] == point[u]:
                matrix[u, v] += give * (x * basis[v, 0] + y * basis[v, 1] + z * basis[v, 2])
        matrix[u, u] += stiffening[u]
    if not (
        solve_in_place(matrix, right) if g == 1 else eliminate(matrix, right, begin, blocks.coupled)
    ):
        return updated, False
    for u in range(count):
        for a in range(3):
            updated[point[u], a] += right[u] * basis[u, a]
    return updated, True


@njit
def solve_in_place(matrix, right):
    """Solve for right (n,) in its place with row pivoting, by LAPACK where it pays; overwrites
    both, False where singular.
    """
    n = len(right)
    if n > FEW_UNKNOWNS:
        try:
            put(np.linalg.solve(matrix, right), right)
        except Exception:
            return False
        return True
    return solve_columns(matrix, right.reshape(n, 1))


@njit
def stiffness_alone(W, i):
    """Stiffness [N/m] of point i when it moves alone."""
    return 3 / (W[3 * i, 3 * i] + W[3 * i + 1, 3 * i + 1] + W[3 * i + 2, 3 * i + 2])


@njit
def stiffnesses(W, together):
    """Stiffness (n,) [N/m] of each point alone, or when all move."""
    found = np.empty(len(W) // 3)
    for i in range(len(found)):
        found[i] = stiffness_together(W, i) if together else stiffness_alone(W, i)
    return found


@njit(fastmath={"reassoc", "contract"})
def stiffness_together(W, i):
    """Stiffness [N/m] of point i when all points move: it is less than alone, with which each would
    seem to slip to and fro.
    """
    total = 0.0
    for a in range(3):
        row = W[3 * i + a]
        for j in range(len(row)):
            total += abs(row[j])
    return 3 / total
