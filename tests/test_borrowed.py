"""Arrays that compiled code borrows."""

import sys
from typing import NamedTuple

import numba
import numpy as np

from fecolumn._borrowed import borrowed


class Pair(NamedTuple):
    first: np.ndarray
    number: int
    others: tuple


@numba.njit
def doubled(pair):
    pair = borrowed(pair)
    part = pair.first[1:]
    for i in range(len(part)):
        part[i] *= pair.number
    pair.others[1][0, 0] = part[0]
    return part.sum()


def test_borrowed_arrays_are_the_callers_and_stay_so():
    first, second = np.arange(4.0), np.zeros((2, 2))
    pair = Pair(first, 2, (np.zeros(1), second))
    held = sys.getrefcount(first)
    for _ in range(100):
        first[:] = np.arange(4.0)
        assert doubled(pair) == 12.0
    assert second[0, 0] == 2.0 and list(first) == [0.0, 2.0, 4.0, 6.0]
    assert sys.getrefcount(first) == held
