"""Copy and multiply small arrays in compiled code; list the arrays of a NamedTuple.

These are plain loops: each assignment of a whole array would make numba compile broadcasting and
its error messages, for half a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


def arrays_of(whole: Any) -> dict[str, Array]:
    """The arrays of a NamedTuple by name, those of a NamedTuple within it as "part.name": for a
    checkpoint.
    """
    found: dict[str, Array] = {}
    for name, value in whole._asdict().items():
        found |= (
            {f"{name}.{part}": array for part, array in arrays_of(value).items()}
            if isinstance(value, tuple)
            else {name: value}
        )
    return found


@njit
def put(source: Array, target: Array) -> None:
    """Copy a one-dimensional array."""
    for i in range(len(source)):
        target[i] = source[i]


@njit
def put_matrix(source: Array, target: Array) -> None:
    """Copy a two-dimensional array."""
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            target[i, j] = source[i, j]


@njit
def put_points(flat: Array, target: Array) -> None:
    """Copy (3 n,) to (n, 3)."""
    for i in range(len(target)):
        target[i, 0], target[i, 1], target[i, 2] = flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]


@njit
def flat(points: Array) -> Array:
    """(3 n,) from (n, 3)."""
    result = np.empty(3 * len(points))
    for i in range(len(points)):
        result[3 * i], result[3 * i + 1], result[3 * i + 2] = (
            points[i, 0],
            points[i, 1],
            points[i, 2],
        )
    return result


@njit
def marked(mask: Array) -> Array:
    """Places (k,) at which a mask (n,) is true."""
    count, k = 0, 0
    for i in range(len(mask)):
        count += mask[i]
    listed = np.empty(count, np.int64)
    for i in range(len(mask)):
        if mask[i]:
            listed[k] = i
            k += 1
    return listed


@njit
def largest(points: Array) -> float:
    """Largest absolute value in (n, 3)."""
    most = 0.0
    for i in range(len(points)):
        for a in range(3):
            most = max(most, abs(points[i, a]))
    return most
