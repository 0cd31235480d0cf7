"""Symmetric matrices of points in blocks (`contact.blocks`), made once for many products and right
sides: these cost what the blocks move, not the square of all points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.arrays import put_matrix
from fecolumn.contact.blocks import find_blocks
from fecolumn.contact.tolerances import HARDLY_REGULAR
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


class Blocked(NamedTuple):
    """Symmetric matrix (3 n, 3 n) of n points in g blocks, or its factor, by their order of
    elimination.

    values: (9 n^2,) room for the blocks that are not zero, one after another, each row by row.
    place: (n, n) where block k, l begins in it, -1 where it is zero; of a symmetric matrix l >= k.
    rows: (n, 2) first row of each block and the row after its last. number: (1,) of blocks, 0
    before there are any.
    """

    values: Array
    place: Array
    rows: Array
    number: Array


def no_blocks(n: int) -> Blocked:
    """Of n points, not found yet."""
    return Blocked(
        np.zeros(9 * n * n),
        np.zeros((n, n), np.int64),
        np.zeros((n, 2), np.int64),
        np.zeros(1, np.int64),
    )


@njit
def factorize(W: Array, factor: Blocked) -> bool:
    """Find the factor of a symmetric positive definite W (3 n, 3 n): of each block, once those
    before are eliminated, its inverse D^-1, and D^-1 times what couples it to those after it. False
    where W is singular: where points move by fewer ways than they have.
    """
    blocks = find_blocks(W)
    g = len(blocks.coupled)
    factor.number[0] = g
    for k in range(g):
        # the points of a block are beside each other
        begin = 3 * blocks.order[blocks.first[k]]
        factor.rows[k, 0], factor.rows[k, 1] = (
            begin,
            begin + 3 * (blocks.first[k + 1] - blocks.first[k]),
        )
    _take_blocks(W, blocks.coupled, factor)
    for k in range(g):
        if not _eliminate_block(factor, k):
            return False
    return True


@njit
def divide(matrix: Array, factor: Blocked, blocked: Blocked) -> None:
    """Find the blocks of a symmetric matrix (3 n, 3 n) that are those of a factor."""
    g = factor.number[0]
    blocked.number[0], moves = g, np.zeros((g, g), np.bool_)
    for k in range(g):
        blocked.rows[k, 0], blocked.rows[k, 1] = factor.rows[k, 0], factor.rows[k, 1]
    for k in range(g):
        for l in range(k, g):
            for i in range(blocked.rows[k, 0], blocked.rows[k, 1]):
                for j in range(blocked.rows[l, 0], blocked.rows[l, 1]):
                    moves[k, l] |= matrix[i, j] != 0.0
    _take_blocks(matrix, moves, blocked)


@njit
def _take_blocks(matrix: Array, coupled: Array, blocked: Blocked) -> None:
    """Take over the blocks of a matrix (3 n, 3 n) that are `coupled` (g, g)."""
    end, rows = 0, blocked.rows
    for k in range(blocked.number[0]):
        for l in range(k, blocked.number[0]):
            blocked.place[k, l] = end if coupled[k, l] else -1
            if coupled[k, l]:
                for i in range(rows[k, 0], rows[k, 1]):
                    for j in range(rows[l, 0], rows[l, 1]):
                        blocked.values[end] = matrix[i, j]
                        end += 1


@njit
def _block(blocked: Blocked, k: int, l: int) -> Array:
    """Block k, l: (rows of k, rows of l)."""
    m, n, begin = (
        blocked.rows[k, 1] - blocked.rows[k, 0],
        blocked.rows[l, 1] - blocked.rows[l, 0],
        blocked.place[k, l],
    )
    return blocked.values[begin : begin + m * n].reshape(m, n)


@njit
def _eliminate_block(factor: Blocked, k: int) -> bool:
    """Invert block k, take from the later ones what it does to them, and divide what couples it to
    them by it; False where it is singular.
    """
    own = _block(factor, k, k)
    inverse = np.empty_like(own)
    try:
        put_matrix(np.linalg.inv(own), inverse)
    except Exception:
        return False
    size = found = 0.0
    for i in range(len(own)):
        for j in range(len(own)):
            size, found = max(size, abs(own[i, j])), max(found, abs(inverse[i, j]))
    if not size * found < HARDLY_REGULAR:
        return False
    for i in range(len(own)):
        for j in range(i + 1):
            inverse[i, j] = inverse[j, i] = own[i, j] = own[j, i] = (
                inverse[i, j] + inverse[j, i]
            ) / 2
    for l in range(k + 1, factor.number[0]):
        if factor.place[k, l] < 0:
            continue
        beside = _block(factor, k, l)
        divided = inverse @ beside
        for m in range(l, factor.number[0]):
            if factor.place[k, m] >= 0:
                # beside[m] is not divided yet
                later, taken = (
                    _block(factor, l, m),
                    np.ascontiguousarray(divided.T) @ _block(factor, k, m),
                )
                for i in range(len(later)):
                    for j in range(later.shape[1]):
                        later[i, j] -= taken[i, j]
        for i in range(len(beside)):
            for j in range(beside.shape[1]):
                beside[i, j] = divided[i, j]
    return True


@njit
def solve_factored(factor: Blocked, right: Array) -> None:
    """Solve for right (3 n,) in its place."""
    g, values, place, rows = factor.number[0], factor.values, factor.place, factor.rows
    for k in range(g):
        for l in range(k + 1, g):
            if place[k, l] >= 0:
                _add_transposed(values, place[k, l], rows[k], rows[l], -1.0, right, right)
    solved = np.zeros(len(right))
    for k in range(g - 1, -1, -1):
        _add_block(values, place[k, k], rows[k], rows[k], 1.0, right, solved)
        for l in range(k + 1, g):
            if place[k, l] >= 0:
                _add_block(values, place[k, l], rows[k], rows[l], -1.0, solved, solved)
    for i in range(len(right)):
        right[i] = solved[i]


@njit
def multiply(blocked: Blocked, source: Array, target: Array) -> None:
    """Target (3 n,): a symmetric matrix times source (3 n,)."""
    values, place, rows = blocked.values, blocked.place, blocked.rows
    for i in range(len(target)):
        target[i] = 0.0
    for k in range(blocked.number[0]):
        for l in range(k, blocked.number[0]):
            if place[k, l] >= 0:
                _add_block(values, place[k, l], rows[k], rows[l], 1.0, source, target)
                if l > k:
                    _add_transposed(values, place[k, l], rows[k], rows[l], 1.0, source, target)


@njit(fastmath={"reassoc", "contract"})
def _add_block(
    values: Array,
    begin: int,
    rows: Array,
    columns: Array,
    factor: float,
    source: Array,
    target: Array,
) -> None:
    """Add to `target` in the rows, first and the one after the last, the factor times a block that
    begins in `values` there, times `source` in the columns.
    """
    count = columns[1] - columns[0]
    part = source[columns[0] : columns[1]]
    for i in range(rows[0], rows[1]):
        line, total = values[begin : begin + count], 0.0
        for j in range(count):
            total += line[j] * part[j]
        target[i] += factor * total
        begin += count


@njit
def _add_transposed(
    values: Array,
    begin: int,
    rows: Array,
    columns: Array,
    factor: float,
    source: Array,
    target: Array,
) -> None:
    """Add to `target` in the columns the factor times the transpose of a block, times `source` in
    the rows.
    """
    count = columns[1] - columns[0]
    part = target[columns[0] : columns[1]]
    for i in range(rows[0], rows[1]):
        line, value = values[begin : begin + count], factor * source[i]
        for j in range(count):
            part[j] += value * line[j]
        begin += count
