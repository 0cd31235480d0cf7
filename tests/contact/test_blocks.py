"""Equations of points that do not all move one another: those of a chain of joints, of columns
below a slab, of feet on ground that does not give.
"""

import numpy as np
import pytest
from coupled import CHAIN, FRAME, compliance

from fecolumn.contact.blocks import eliminate, find_blocks
from fecolumn.contact.friction import solve_contact


@pytest.mark.long
@pytest.mark.parametrize(
    "sizes, pairs",
    [
        ([5, 4, 6, 5, 3], CHAIN),
        ([20, 5, 18, 15, 4], CHAIN),
        ([6, 5, 4, 6, 5, 4], FRAME),
        ([20, 16, 15, 17, 14, 19], FRAME),
        ([8, 9, 10], []),
        ([8, 9, 10], [(0, 1), (0, 2), (1, 2)]),
    ],
)
def test_equations_in_blocks_are_solved_as_if_they_were_one(sizes, pairs):
    W = compliance(sizes, pairs)
    blocks, right = find_blocks(W), np.random.default_rng(1).standard_normal(len(W))
    rows = (3 * blocks.order[:, None] + np.arange(3)).ravel()
    matrix, found = W[np.ix_(rows, rows)], right[rows]
    # what is not coupled is not looked at
    outside = ~np.kron(
        blocks.coupled[np.ix_(blocks.of[blocks.order], blocks.of[blocks.order])],
        np.ones((3, 3), bool),
    )
    matrix[outside] = np.nan
    assert eliminate(matrix, found, 3 * blocks.first, blocks.coupled)
    assert found == pytest.approx(np.linalg.solve(W, right)[rows], rel=1e-9, abs=1e-12)


def test_points_that_all_move_one_another_are_one_block():
    assert len(find_blocks(compliance([20], [])).coupled) == 1
    assert len(find_blocks(compliance([8, 9], [(0, 1)])).coupled) == 1


def test_few_points_are_one_block_whatever_they_move():
    assert len(find_blocks(compliance([3, 4], [])).coupled) == 1


def test_feet_are_eliminated_before_the_heads_that_a_slab_joins():
    """Heads first would couple all feet."""
    blocks = find_blocks(compliance([6] * 6, FRAME))
    assert list(blocks.of[:18:6]) == [3, 4, 5] and set(blocks.of[18:]) == {0, 1, 2}
    assert not blocks.coupled[np.ix_([0, 1, 2], [0, 1, 2])][~np.eye(3, dtype=bool)].any()


def test_a_singular_block_is_told():
    matrix, right = np.zeros((6, 6)), np.ones(6)
    matrix[3:, 3:] = np.eye(3)
    assert not eliminate(matrix, right, np.array([0, 3, 6]), np.eye(2, dtype=bool))


@pytest.mark.parametrize("pairs", [CHAIN, FRAME])
def test_forces_in_blocks_are_those_of_all_points_at_once(pairs):
    """The same problem with an entry between each two blocks that is next to nothing is one
    block.
    """
    sizes = [9, 8, 7, 9, 8, 7][: max(map(max, pairs)) + 1]
    W, n = 1e-9 * compliance(sizes, pairs), sum(sizes)
    q = 1e-6 * np.random.default_rng(2).standard_normal((n, 3)) - [0, 0, 1e-6]
    dense = np.where(W == 0.0, 1e-40, W)
    assert len(find_blocks(W).coupled) == len(sizes) and len(find_blocks(dense).coupled) == 1
    found, every = (solve_contact(one, q, 0.4, np.zeros_like(q), 1e-15) for one in (W, dense))
    assert found.residual <= 1e-15 and found.forces == pytest.approx(
        every.forces, abs=1e-9 * np.abs(every.forces).max()
    )
