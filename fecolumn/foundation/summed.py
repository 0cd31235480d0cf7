"""Sums of vectors over the rows that they belong to."""

from __future__ import annotations

import numpy as np

from fecolumn.foundation.arrays import Array

_AXES = np.arange(3)


def summed_at(rows: Array, values: Array, count: int) -> Array:
    """Sums (count, 3) of vectors (..., 3) over their `rows` (...), added in their order: as
    numpy.add.at into zeros to the last digit, at a fraction of its time.
    """
    places = 3 * rows[..., None] + _AXES
    found = np.bincount(places.ravel(), values.ravel(), 3 * count).reshape(count, 3)
    # without rows numpy counts them
    return found.astype(float, copy=False)
