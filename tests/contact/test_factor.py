"""Factor of a compliance in blocks, and products of one: as if it were one matrix."""

import numpy as np
import pytest
from coupled import CHAIN, FRAME, compliance

from fecolumn.contact.factor import divide, factorize, multiply, no_blocks, solve_factored

CASES = [
    ([5, 4, 6, 5, 3], CHAIN),
    ([20, 5, 18, 15, 4], CHAIN),
    ([6, 5, 4, 6, 5, 4], FRAME),
    ([8, 9, 10], []),
    ([8, 9, 10], [(0, 1), (0, 2), (1, 2)]),
    ([4], []),
]


def factor_of(W):
    factor = no_blocks(len(W) // 3)
    factorize(W, factor)
    return factor


@pytest.mark.long
@pytest.mark.parametrize("sizes, pairs", CASES)
def test_solutions_are_those_of_the_whole_matrix(sizes, pairs):
    W = compliance(sizes, pairs)
    factor, right = factor_of(W), np.random.default_rng(1).standard_normal((3, len(W)))
    for one in right:
        found = one.copy()
        solve_factored(factor, found)
        assert found == pytest.approx(np.linalg.solve(W, one), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("sizes, pairs", CASES)
def test_products_are_those_of_the_whole_matrix(sizes, pairs):
    """Of another matrix, which is zero between some of the blocks."""
    W, other = compliance(sizes, pairs), compliance(sizes, pairs[1:], seed=3)
    blocked, found, source = (
        no_blocks(sum(sizes)),
        np.full(len(W), 7.0),
        np.random.default_rng(2).standard_normal(len(W)),
    )
    divide(other, factor_of(W), blocked)
    multiply(blocked, source, found)
    assert found == pytest.approx(other @ source, rel=1e-12, abs=1e-12 * np.abs(other).max())


def test_what_is_zero_is_not_kept():
    """A chain has two blocks a joint, whatever its length."""
    kept = []
    for joints in (4, 8):
        W = compliance([8] * joints, [(k, k + 1) for k in range(joints - 1)])
        kept.append((factor_of(W).values != 0.0).sum() / joints)
    assert kept[1] < 1.1 * kept[0]


def test_a_factor_is_found_again_in_the_same_room():
    """For other blocks than before."""
    factor = factor_of(compliance([6, 5, 4, 6, 5, 4], FRAME))
    W = compliance([10, 10, 10], [(0, 1)])
    factorize(W, factor)
    found = np.arange(90.0)
    solve_factored(factor, found)
    assert found == pytest.approx(np.linalg.solve(W, np.arange(90.0)), rel=1e-9)
