"""Overturns that come and go with a setting: the same motions, run twice."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def contingency(overturned_a: ArrayLike, overturned_b: ArrayLike) -> NDArray[Any]:
    """Motions by outcome, (2, 2) int: [[both stand, b alone overturns], [a alone overturns, both
    overturn]].

    Parameters
    ----------
    overturned_a, overturned_b
        (n,) each, the same motion at the same place.

    Raises
    ------
    ValueError
        lengths that differ, or no motion.
    """
    a, b = np.asarray(overturned_a, bool), np.asarray(overturned_b, bool)
    if a.ndim != 1 or a.shape != b.shape or not a.size:
        raise ValueError(
            f"overturned_a {a.shape} and overturned_b {b.shape}: must be two lists of "
            "one length, not empty"
        )
    return np.bincount(2 * a + b, minlength=4).reshape(2, 2)


def flips(table: ArrayLike) -> int:
    """Motions that overturn in one setting alone, from `contingency`."""
    table = np.asarray(table)
    return int(table[0, 1] + table[1, 0])


def mcnemar(table: ArrayLike) -> float:
    """p-value of "as many flips one way as the other", so that P(overturn) is the same in both
    settings.

    Exact binomial version of McNemar's test (1947, Psychometrika 12). Many flips that cancel give a
    large p: the motions' fates change, their share does not.
    """
    from scipy.stats import binomtest

    table = np.asarray(table)
    n = flips(table)
    return float(binomtest(int(table[0, 1]), n, 0.5).pvalue) if n else 1.0
