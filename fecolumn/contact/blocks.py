"""Points in blocks of which not all move one another: feet of different columns, joints of a stack
that no body has in common.

Where W is zero between two blocks, so are the equations of Newton; what elimination fills in
between them is little in a good order. What they cost then grows with the number of a stack's
joints, not with its third power.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Unknowns up to which plain loops solve equations as one: a call of LAPACK costs more, and so does
# dividing them into blocks
FEW_UNKNOWNS = 40


class Blocks(NamedTuple):
    """Points (n,) in g blocks, by their order of elimination. order: (n,) the points block by
    block; first: (g + 1,) places of the blocks in it; of: (n,) block of each point; coupled: (g, g)
    whether the equations of two are, once those eliminated before are gone.
    """

    order: Array
    first: Array
    of: Array
    coupled: Array


@njit
def one_block(n: int) -> Blocks:
    """All n points as one."""
    first = np.zeros(2, np.int64)
    first[1] = n
    return Blocks(np.arange(n), first, np.zeros(n, np.int64), np.ones((1, 1), np.bool_))


@njit
def find_blocks(W: Array) -> Blocks:
    """Blocks of the points of a compliance (3 n, 3 n): those beside each other that move the same
    others; one block where dividing them gains nothing.
    """
    n = len(W) // 3
    if 3 * n <= FEW_UNKNOWNS:
        return one_block(n)
    moves, start, g = np.empty((n, n), np.bool_), np.empty(n + 1, np.int64), 0
    for i in range(n):
        for j in range(i + 1):
            moves[i, j] = moves[j, i] = _any(W, 3 * i, 3 * j)
    for i in range(n):
        new = i == 0
        for j in range(n):
            new |= moves[i, j] != moves[i - 1, j]
        if new:
            start[g] = i
            g += 1
    start[g] = n
    if g == 1:
        return one_block(n)
    coupled = np.empty((g, g), np.bool_)
    for k in range(g):
        for l in range(g):
            coupled[k, l] = moves[start[k], start[l]]
    ranks = least_filling(start, coupled)
    blocks = Blocks(
        np.empty(n, np.int64),
        np.zeros(g + 1, np.int64),
        np.empty(n, np.int64),
        np.empty((g, g), np.bool_),
    )
    place, every = 0, True
    for k in range(g):
        for l in range(g):
            blocks.coupled[k, l] = coupled[ranks[k], ranks[l]]
            every &= blocks.coupled[k, l]
        for i in range(start[ranks[k]], start[ranks[k] + 1]):
            blocks.order[place], blocks.of[i] = i, k
            place += 1
        blocks.first[k + 1] = place
    return one_block(n) if every else blocks


@njit
def _any(W: Array, row: int, column: int) -> bool:
    """Whether a point moves another at all."""
    for a in range(3):
        for b in range(3):
            if W[row + a, column + b] != 0.0:
                return True
    return False


@njit
def least_filling(start: Array, coupled: Array) -> Array:
    """Order of elimination (g,) of blocks of start[k + 1] - start[k] points, next always the one
    coupled to the fewest points; adds to `coupled` (g, g) what it fills.
    """
    g = len(coupled)
    ranks, gone, others = np.empty(g, np.int64), np.zeros(g, np.bool_), np.zeros(g, np.int64)
    for k in range(g):
        for l in range(g):
            others[k] += start[l + 1] - start[l] if coupled[k, l] else 0
    beside = np.empty(g, np.int64)
    for rank in range(g):
        chosen, count = -1, 0
        for k in range(g):
            if not gone[k] and (chosen < 0 or others[k] < others[chosen]):
                chosen = k
        ranks[rank], gone[chosen] = chosen, True
        for k in range(g):
            if not gone[k] and coupled[chosen, k]:
                beside[count] = k
                others[k] -= start[chosen + 1] - start[chosen]
                count += 1
        # only what is coupled to the chosen one is filled in
        for i in range(count):
            k = beside[i]
            for j in range(count):
                l = beside[j]
                if not coupled[k, l]:
                    coupled[k, l] = True
                    others[k] += start[l + 1] - start[l]
    return ranks


@njit
def eliminate(matrix: Array, right: Array, first: Array, coupled: Array) -> bool:
    """Solve by Gaussian elimination block by block, rows pivoted within a block; overwrites both,
    False where singular.

    Parameters
    ----------
    matrix
        (m, m), of which the blocks of those not coupled are never looked at.
    right
        (m,).
    first
        (g + 1,) rows and columns of the blocks.
    coupled
        (g, g) as of Blocks.
    """
    g = len(coupled)
    for k in range(g):
        begin, n, width = first[k], first[k + 1] - first[k], 1
        if n == 0:
            continue
        for l in range(k + 1, g):
            width += first[l + 1] - first[l] if coupled[k, l] else 0
        # the rows of the block beside each other: what is coupled to it, and the right side
        own, beside = (
            np.ascontiguousarray(matrix[begin : begin + n, begin : begin + n]),
            np.empty((n, width)),
        )
        for i in range(n):
            column = 0
            for l in range(k + 1, g):
                if coupled[k, l]:
                    for j in range(first[l], first[l + 1]):
                        beside[i, column] = matrix[begin + i, j]
                        column += 1
            beside[i, column] = right[begin + i]
        if n > FEW_UNKNOWNS:
            try:
                beside = np.ascontiguousarray(np.linalg.solve(own, beside))
            except Exception:
                return False
        elif not solve_columns(own, beside):
            return False
        for i in range(n):
            column = 0
            for l in range(k + 1, g):
                if coupled[k, l]:
                    for j in range(first[l], first[l + 1]):
                        matrix[begin + i, j] = beside[i, column]
                        column += 1
            right[begin + i] = beside[i, column]
        for m in range(k + 1, g):
            if coupled[k, m] and first[m + 1] > first[m]:
                product = (
                    np.ascontiguousarray(matrix[first[m] : first[m + 1], begin : begin + n])
                    @ beside
                )
                for i in range(len(product)):
                    row, column = first[m] + i, 0
                    for l in range(k + 1, g):
                        if coupled[k, l]:
                            for j in range(first[l], first[l + 1]):
                                matrix[row, j] -= product[i, column]
                                column += 1
                    right[row] -= product[i, column]
    for k in range(g - 2, -1, -1):
        for l in range(k + 1, g):
            if coupled[k, l]:
                for i in range(first[k], first[k + 1]):
                    for j in range(first[l], first[l + 1]):
                        right[i] -= matrix[i, j] * right[j]
    return True


@njit
def solve_columns(matrix: Array, right: Array) -> bool:
    """Solve for all columns of right (n, m) in their place by Gaussian elimination with row
    pivoting, where n is small; False where singular.
    """
    n, m = right.shape
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
            for j in range(m):
                right[k, j], right[pivot, j] = right[pivot, j], right[k, j]
        inverse = 1 / matrix[k, k]
        for i in range(k + 1, n):
            factor = matrix[i, k] * inverse
            if factor != 0.0:
                for j in range(k + 1, n):
                    matrix[i, j] -= factor * matrix[k, j]
                for j in range(m):
                    right[i, j] -= factor * right[k, j]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            for j in range(m):
                right[i, j] -= matrix[i, k] * right[k, j]
        for j in range(m):
            right[i, j] /= matrix[i, i]
    return True
