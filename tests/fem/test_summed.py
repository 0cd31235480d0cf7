"""Sums of vectors over the rows that they belong to."""

import numpy as np
import pytest

from fecolumn.fem.rotation import into_frames
from fecolumn.foundation.summed import summed_at


@pytest.mark.parametrize("shape", [(40, 4), (25,), (0, 4)])
def test_sums_are_those_in_order_to_the_last_digit(shape):
    rng = np.random.default_rng(3)
    rows, values = rng.integers(0, 7, shape), rng.normal(size=(*shape, 3))
    values *= 10.0 ** rng.integers(-9, 9, (*shape, 1))
    expected = np.zeros((9, 3))
    np.add.at(expected, rows, values)
    found = summed_at(rows, values, 9)
    assert found.shape == (9, 3) and found.dtype == float
    assert np.array_equal(found, expected)


@pytest.mark.parametrize("ends", [(0, 5, 10, 15), (0, 5, 9, 15), (0, 15), (0, 1, 2, 3)])
def test_bodies_of_equal_size_turn_as_one_by_one(ends):
    rng = np.random.default_rng(4)
    rows = [slice(first, last) for first, last in zip(ends, ends[1:])]
    values = rng.normal(size=(ends[-1], 3))
    rotation = np.linalg.qr(rng.normal(size=(len(rows), 3, 3)))[0]
    for turns in (rotation, rotation.swapaxes(-1, -2)):
        found = into_frames(values, turns, rows)
        for own, turn in zip(rows, turns):
            assert np.array_equal(found[own], values[own] @ turn)
