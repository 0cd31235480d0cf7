"""Fewer points for the same drawing: a history is kept where a straight line between its neighbours
would miss it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.foundation._compiled import njit


def thinned(time: ArrayLike, values: ArrayLike, tolerance: ArrayLike) -> NDArray[Any]:
    """Rows of a history that suffice to draw it; straight lines between them miss no row by more
    than the tolerance.

    Parameters
    ----------
    time
        (n,) rising.
    values
        (n, k).
    tolerance
        (k,), above 0, in the units of the values.
    """
    scaled = np.asarray(values, float) / np.asarray(tolerance, float)
    # copies: one kind of array, for which the set-up compiled
    return np.flatnonzero(_kept(np.array(time, float), np.array(scaled, order="C")))


@njit(alone=True)
def _kept(time: NDArray[Any], values: NDArray[Any]) -> NDArray[Any]:
    """Whether each row is kept; `values` in tolerances.

    From the row kept last, lines through all rows since, each missed by 1 at most, have slopes in
    an interval that narrows from row to row. Where the line to a row leaves it, the row before is
    kept.
    """
    n, k = values.shape
    kept = np.zeros(n, np.bool_)
    if n == 0:
        return kept
    kept[0] = kept[n - 1] = True
    low, high = np.full(k, -np.inf), np.full(k, np.inf)
    start = 0
    for row in range(1, n):
        span = time[row] - time[start]
        inside = True
        for c in range(k):
            slope = (values[row, c] - values[start, c]) / span
            inside = inside and low[c] <= slope <= high[c]
        if not inside:
            start = row - 1
            kept[start] = True
            span = time[row] - time[start]
            low[:], high[:] = -np.inf, np.inf
        for c in range(k):
            rise = values[row, c] - values[start, c]
            low[c], high[c] = max(low[c], (rise - 1) / span), min(high[c], (rise + 1) / span)
    return kept
