"""Semismooth Newton on the laws of contact (Alart and Curnier 1991)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put
from fecolumn.contact.blocks import FEW_UNKNOWNS, eliminate, solve_columns
from fecolumn.contact.coulomb import violation
from fecolumn.contact.coupling import columns_used, slips_by_whole, slips_under
from fecolumn.contact.tolerances import SINGULAR
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.blocks import Blocks
    from fecolumn.contact.coupling import Coupling


class NewtonLimits(NamedTuple):
    """How Newton steps are made, and when they end.

    tolerance: residual [m] at which the laws are obeyed. rho: (n,) stiffness [N/m] by which stick
    and slip are told, rho_alone: (n,) by which the residual is measured. give: as of `newton_step`
    [m/N]. most: steps at most; patience: those without a better residual after which it ends.
    """

    tolerance: float
    rho: Array
    rho_alone: Array
    give: float
    most: int
    patience: int


@njit
def newton_steps(
    coupling: Coupling, q: Array, friction: Array, start: Array, limits: NewtonLimits
) -> tuple[Array, float, int]:
    """Newton steps until the tolerance is met, or the residual falls no more, or without give W
    proves singular: best forces, residual, steps made.
    """
    forces, least, stalled, made = start, np.inf, 0, 0
    best, W = start, coupling.whole
    while True:
        relative = slips_by_whole(W, q, forces) if len(W) else slips_under(coupling, q, forces)
        residual = violation(relative, forces, friction, limits.rho_alone)
        stalled += 1
        if residual < least:
            best, least, stalled = forces, residual, 0
        if (
            residual <= limits.tolerance
            or stalled > limits.patience
            or made == limits.most
            or limits.give == 0.0
            and not residual <= SINGULAR * least
        ):
            break
        forces, regular = newton_step(
            coupling, q, forces, relative, friction, limits.rho, limits.give
        )
        if not regular:
            break
        made += 1
    return best.copy(), least, made


@njit
def newton_step(
    coupling: Coupling,
    q: Array,
    forces: Array,
    relative: Array,
    friction: Array,
    rho: Array,
    give: float,
) -> tuple[Array, bool]:
    """Forces after one semismooth Newton step on the equations of Alart and Curnier (1991); False
    where it is singular.

    relative: (n, 3) slips and gaps under the forces.

    give: compliance [m/N] of each point against a change of its force, in this step alone: 0, or
    little where W leaves open which of many points carry. The laws are not softened by it: where
    the forces change no more, it plays no part.

    With d the direction of the trial force and e across it, a slipping point has r_t = mu r_n d + y
    e. Linearised in r_t, r_n and the slip s_t, its equations leave (1 - c) y + rho c e.s_t = 0, c =
    mu r_n / |trial|: two unknowns, three for a sticking point.
    """
    n, by_levers = len(q), len(coupling.whole) == 0
    # unknown u multiplies basis[u] (3,) of the force on point[u], where it is guess[u] now, and its
    # equation is the slip or gap along test[u]
    point, basis, test = np.empty(3 * n, np.int64), np.zeros((3 * n, 3)), np.zeros((3 * n, 3))
    guess, stiffening, count = np.zeros(3 * n), np.zeros(3 * n), 0
    for j in range(n):
        i = j if by_levers else coupling.blocks.order[j]
        t0, t1, normal = (
            forces[i, 0] - rho[i] * relative[i, 0],
            forces[i, 1] - rho[i] * relative[i, 1],
            forces[i, 2] - rho[i] * relative[i, 2],
        )
        if not normal > 0:
            continue
        mu = friction[i]
        if mu == 0.0:
            point[count], basis[count, 2], test[count, 2] = i, 1.0, 1.0
            guess[count] = forces[i, 2]
            count += 1
            continue
        length = np.sqrt(t0 * t0 + t1 * t1)
        if length <= mu * normal:
            for a in range(3):
                point[count], guess[count] = i, forces[i, a]
                basis[count, a] = test[count, a] = 1.0
                count += 1
            continue
        x, y = t0 / length, t1 / length
        share = min(mu * max(forces[i, 2], 0.0) / length, 1.0)
        point[count] = point[count + 1] = i
        basis[count, 0], basis[count, 1], basis[count, 2] = mu * x, mu * y, 1.0
        guess[count], guess[count + 1] = forces[i, 2], x * forces[i, 1] - y * forces[i, 0]
        test[count, 2] = 1.0
        basis[count + 1, 0], basis[count + 1, 1] = -y, x
        # scaled to the size of the other equations
        test[count + 1, 0], test[count + 1, 1] = -share * y, share * x
        stiffening[count + 1] = (1 - share) / rho[i]
        count += 2
    updated = np.zeros((n, 3))
    if count == 0:
        return updated, True
    point, basis, test, stiffening, guess = (
        point[:count],
        basis[:count],
        test[:count],
        stiffening[:count],
        guess[:count],
    )
    solved, regular = (
        _by_levers(coupling, q, forces, relative, give, point, basis, test, stiffening, guess)
        if by_levers
        else _by_whole(
            coupling.whole, coupling.blocks, q, forces, give, point, basis, test, stiffening
        )
    )
    if regular:
        for u in range(count):
            for a in range(3):
                updated[point[u], a] += solved[u] * basis[u, a]
    return updated, regular


@njit
def _by_whole(
    W: Array,
    blocks: Blocks,
    q: Array,
    forces: Array,
    give: float,
    point: Array,
    basis: Array,
    test: Array,
    stiffening: Array,
) -> tuple[Array, bool]:
    """Unknowns (count,) of a Newton step by the whole matrix, and whether it is regular."""
    g, count = len(blocks.coupled), len(point)
    # rows and columns of the blocks
    begin = np.zeros(g + 1, np.int64)
    for u in range(count):
        begin[blocks.of[point[u]] + 1] += 1
    for k in range(g):
        begin[k + 1] += begin[k]
    # how many from one on are of its point, the first of a point beside them
    unknowns = np.ones(count, np.int64)
    for u in range(count - 2, -1, -1):
        if point[u] == point[u + 1]:
            unknowns[u] += unknowns[u + 1]
    mixed, matrix, right = np.empty(3 * len(q)), np.empty((count, count)), np.empty(count)
    for u in range(count):
        row, x, y, z = 3 * point[u], test[u, 0], test[u, 1], test[u, 2]
        right[u] = 0.0
        for a in range(3):
            right[u] -= test[u, a] * (q[point[u], a] - give * forces[point[u], a])
        first, second, third = W[row], W[row + 1], W[row + 2]
        # most equations are along an axis
        along = 0 if x == 1.0 else 1 if y == 1.0 else 2 if z == 1.0 else -1
        line = mixed if along < 0 else W[row + along]
        for k in range(g):
            if begin[k] == begin[k + 1] or not blocks.coupled[blocks.of[point[u]], k]:
                continue
            v = begin[k]
            while v < begin[k + 1]:
                column = 3 * point[v]
                if along < 0:
                    for j in range(column, column + 3):
                        mixed[j] = x * first[j] + y * second[j] + z * third[j]
                if unknowns[v] == 3:  # it sticks: along the axes
                    for a in range(3):
                        matrix[u, v + a] = line[column + a]
                elif unknowns[v] == 2:
                    for c in range(v, v + 2):
                        matrix[u, c] = (
                            basis[c, 0] * line[column]
                            + basis[c, 1] * line[column + 1]
                            + basis[c, 2] * line[column + 2]
                        )
                else:  # without friction: along the normal
                    matrix[u, v] = line[column + 2]
                v += unknowns[v]
        # the unknowns of a point are beside each other
        for v in range(max(u - 2, 0), min(u + 3, count)):
            if point[v] == point[u]:
                matrix[u, v] += give * (x * basis[v, 0] + y * basis[v, 1] + z * basis[v, 2])
        matrix[u, u] += stiffening[u]
    regular = (
        solve_in_place(matrix, right) if g == 1 else eliminate(matrix, right, begin, blocks.coupled)
    )
    return right, regular


@njit
def _by_levers(
    coupling: Coupling,
    q: Array,
    forces: Array,
    relative: Array,
    give: float,
    point: Array,
    basis: Array,
    test: Array,
    stiffening: Array,
    guess: Array,
) -> tuple[Array, bool]:
    """As `_by_whole`, by the formula of Woodbury (1950): (D + L R^T) y = b with D of each point
    alone and w columns of L and R a body leaves equations of the bodies, 1 + R^T D^-1 L.

    Solved for the change of the unknowns from their guess (count,), so that rounding, which grows
    with L R^T over D, is that of a change that becomes small.
    """
    bodies, blocks, count = coupling.bodies, coupling.blocks, len(point)
    start, same = np.zeros((len(q), 3)), True
    for u in range(count):
        for a in range(3):
            start[point[u], a] += guess[u] * basis[u, a]
    for i in range(len(q)):
        for a in range(3):
            same &= start[i, a] == forces[i, a]
    if not same:
        relative = slips_under(coupling, q, start)
    width, columns = coupling.levers.shape[2] // 2, columns_used(coupling)
    solved, left, across = np.empty(count), np.empty((count, columns)), np.empty((count, columns))
    for u in range(count):
        i = point[u]
        solved[u] = -stiffening[u] * guess[u]
        for a in range(3):
            solved[u] -= test[u, a] * (relative[i, a] + give * (start[i, a] - forces[i, a]))
        _along(coupling.levers[i], test[u], left[u])
        _along(coupling.levers[i], basis[u], across[u])
    if not _divide(coupling, give, point, basis, test, stiffening, solved, left):
        return solved, False
    rows, begin = blocks.first[-1], 0
    matrix, right = np.zeros((rows, rows)), np.zeros(rows)
    for j in range(rows):
        matrix[j, j] = 1.0
    while begin < count:
        # the unknowns of points between the same two bodies
        one, end = bodies[point[begin]], begin + 1
        while end < count and bodies[point[end], 0] == one[0] and bodies[point[end], 1] == one[1]:
            end += 1
        block = across[begin:end].T @ left[begin:end]
        along = across[begin:end].T @ solved[begin:end]
        for side in range(2):
            if one[side] < 0:
                continue
            top = blocks.first[blocks.of[one[side]]]
            for a in range(width):
                right[top + a] += along[width * side + a]
                for t in range(2):
                    if one[t] >= 0:
                        first = blocks.first[blocks.of[one[t]]]
                        for c in range(width):
                            matrix[top + a, first + c] += block[width * side + a, width * t + c]
        begin = end
    if rows and not eliminate(matrix, right, blocks.first, blocks.coupled):
        return solved, False
    for u in range(count):
        solved[u] += guess[u]
        for side in range(2):
            b = bodies[point[u], side]
            if b >= 0:
                first = blocks.first[blocks.of[b]]
                for c in range(width):
                    solved[u] -= left[u, width * side + c] * right[first + c]
    return solved, True


@njit
def _along(levers: Array, direction: Array, target: Array) -> None:
    """Target (c,): the first c columns of levers (3, 2 w) along a direction (3,)."""
    x, y, z = direction[0], direction[1], direction[2]
    for c in range(len(target)):
        target[c] = x * levers[0, c] + y * levers[1, c] + z * levers[2, c]


@njit
def _divide(
    coupling: Coupling,
    give: float,
    point: Array,
    basis: Array,
    test: Array,
    stiffening: Array,
    right: Array,
    left: Array,
) -> bool:
    """Divide right (count,) and left (count, 2 w) by what each point gives alone: False where one
    gives nothing.
    """
    own, D, first = coupling.own, np.empty((2, 2)), 0
    while first < len(point):
        i, last = point[first], first + 1
        while last < len(point) and point[last] == i:
            last += 1
        if last == first + 2:
            # of a point that slips: along its force, and across
            for u in range(2):
                for v in range(2):
                    D[u, v] = stiffening[first + u] if u == v else 0.0
                    for a in range(3):
                        D[u, v] += test[first + u, a] * basis[first + v, a] * (own[i, a] + give)
            size = D[0, 0] * D[1, 1] - D[0, 1] * D[1, 0]
            if size == 0.0:
                return False
            x, y = right[first], right[last - 1]
            right[first] = (D[1, 1] * x - D[0, 1] * y) / size
            right[last - 1] = (D[0, 0] * y - D[1, 0] * x) / size
            for c in range(left.shape[1]):
                x, y = left[first, c], left[last - 1, c]
                left[first, c] = (D[1, 1] * x - D[0, 1] * y) / size
                left[last - 1, c] = (D[0, 0] * y - D[1, 0] * x) / size
        else:
            for u in range(first, last):
                alone = give
                for a in range(3):
                    alone += test[u, a] * basis[u, a] * own[i, a]
                if alone == 0.0:
                    return False
                right[u] /= alone
                inverse = 1 / alone
                for c in range(left.shape[1]):
                    left[u, c] *= inverse
        first = last
    return True


@njit
def solve_in_place(matrix: Array, right: Array) -> bool:
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
