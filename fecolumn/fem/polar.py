"""The rotation nearest to a matrix, compiled: it is asked for several times a step."""

from __future__ import annotations

import math

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

#: Change of an iterate [-] at which the next one is exact to rounding: Newton's iteration squares
#: it
_CHANGE = 1e-9
_ITERATIONS = 40


@njit(alone=True)
def polar_of(moment: Array, rotation: Array) -> bool:
    """Fill in the rotation (3, 3) nearest to `moment` (3, 3), by Newton's iteration with scaling
    (Higham 1986); whether it was found: not of one whose determinant is not positive, or vanishes
    beside its entries.
    """
    rotation[:] = moment
    cofactor = np.empty((3, 3))
    for _ in range(_ITERATIONS):
        for i in range(3):
            for j in range(3):
                k, m, p, q = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
                cofactor[i, j] = rotation[k, p] * rotation[m, q] - rotation[k, q] * rotation[m, p]
        determinant = (
            rotation[0, 0] * cofactor[0, 0]
            + rotation[0, 1] * cofactor[0, 1]
            + rotation[0, 2] * cofactor[0, 2]
        )
        size, other = math.sqrt((rotation**2).sum()), math.sqrt((cofactor**2).sum())
        if not determinant > 1e-12 * size**3:
            return False
        # the inverse's transpose is cofactor / determinant
        scale = math.sqrt(other / (determinant * size))
        change = 0.0
        for i in range(3):
            for j in range(3):
                new = (scale * rotation[i, j] + cofactor[i, j] / (scale * determinant)) / 2
                change = max(change, abs(new - rotation[i, j]))
                rotation[i, j] = new
        if change < _CHANGE:
            return True
    return False
