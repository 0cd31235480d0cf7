"""Arrays that compiled code borrows."""

import os
import subprocess
import sys
from typing import NamedTuple

import numba
import numpy as np
import pytest

from fecolumn.foundation._borrowed import borrowed


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


BORROWER = """
import numpy as np
from fecolumn.foundation._borrowed import borrowed
from fecolumn.foundation._compiled import njit

@njit(alone=True)
def one(table, i):
    row = table[i]
    return row[0] + row[1]

@njit(alone=True)
def all_of(table):
    table, total = borrowed(table), 0.0
    for i in range(len(table)):
        total += one(table, i)
    return total

@njit(alone=True)
def counted(tables):
    kept = tables[0]
    for i in range(len(tables[0])):
        kept = tables[i % 2][i:] if tables[0][i, 0] > 1.0 else kept
    return kept
"""

# numba counts by an atomic operation on a number of the owner
LOOK = """
import numpy as np
from borrower import all_of, counted
table = np.ones((1000, 2))
assert all_of(table) == 2000.0
counted((table, table))
for function in (all_of, counted):
    print("atomicrmw" in next(iter(function.inspect_llvm().values())))
"""


@pytest.mark.long
def test_references_to_borrowed_arrays_are_not_counted(tmp_path):
    (tmp_path / "borrower.py").write_text(BORROWER)
    environment = os.environ | {
        "FECOLUMN_CACHE": str(tmp_path / "cache"),
        "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]),
    }
    ran = subprocess.run(
        [sys.executable, "-c", LOOK],
        env=environment,
        text=True,
        capture_output=True,
        timeout=300,
        check=True,
    )
    assert ran.stdout.split() == ["False", "True"]
