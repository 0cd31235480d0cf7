"""Confidence bands of distributions and of probabilities: pointwise and simultaneous.

A pointwise band holds the true F with the stated confidence at one u chosen beforehand, a
simultaneous one at all u together. A curve of another ensemble may leave a pointwise band somewhere
although both ensembles have one distribution.
"""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def greenwood(
    cdf: ArrayLike, n: int, confidence: float = 0.95
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Pointwise band F +- z sqrt(F (1 - F) / n), clipped to [0, 1] (Greenwood 1926; what MATLAB's
    `ecdf` draws).

    Greenwood's variance is the binomial one here, as all censored runs lie beyond all others. Too
    narrow where n F or n (1 - F) is below about 5, and of no width where F is 0 or 1: `wilson` is
    not.

    Parameters
    ----------
    cdf
        (m,) F.
    n
        size of the sample, overturned runs included.
    confidence
        level, in (0, 1).

    Returns
    -------
    lower, upper: (m,) each.
    """
    cdf = np.asarray(cdf, float)
    reach = normal_quantile(confidence) * np.sqrt(cdf * (1 - cdf) / n)
    return np.maximum(cdf - reach, 0.0), np.minimum(cdf + reach, 1.0)


def wilson(k: ArrayLike, n: float, confidence: float = 0.95) -> tuple[NDArray[Any], NDArray[Any]]:
    """Score interval of a probability after k of n runs, close to its level on average.

    Wilson (1927), Journal of the American Statistical Association 22.

    Parameters
    ----------
    k
        (m,) counts in [0, n]: runs that overturned, or n F for a pointwise band of F.
    n
        all runs, at least 1; not whole where it is `records.effective_runs`.
    confidence
        level, in (0, 1).

    Returns
    -------
    lower, upper: (m,) each.
    """
    k = _counts(k, n)
    z2, p = normal_quantile(confidence) ** 2, k / n
    centre, reach = p + z2 / (2 * n), np.sqrt(z2 * (p * (1 - p) + z2 / (4 * n)) / n)
    lower, upper = (centre - reach) / (1 + z2 / n), (centre + reach) / (1 + z2 / n)
    return np.where(k == 0, 0.0, lower), np.where(k == n, 1.0, upper)


def dkw(cdf: ArrayLike, n: int, confidence: float = 0.95) -> tuple[NDArray[Any], NDArray[Any]]:
    """Simultaneous band F +- `dkw_distance`, clipped to [0, 1].

    Parameters
    ----------
    cdf
        (m,) F.
    n
        size of the sample, overturned runs included.
    confidence
        level, in (0, 1).

    Returns
    -------
    lower, upper: (m,) each.
    """
    cdf, reach = np.asarray(cdf, float), dkw_distance(n, confidence)
    return np.maximum(cdf - reach, 0.0), np.minimum(cdf + reach, 1.0)


def dkw_distance(n: ArrayLike, confidence: float = 0.95) -> Any:
    """Largest distance sup |F_n - F| at a confidence: sqrt(ln(2 / (1 - confidence)) / (2 n)).

    Dvoretzky, Kiefer & Wolfowitz (1956) with the constant of Massart (1990, Ann. Probab. 18); holds
    for any F and n.
    """
    if not 0 < confidence < 1:
        raise ValueError(f"confidence = {confidence}: must lie in (0, 1)")
    return np.sqrt(math.log(2 / (1 - confidence)) / (2 * np.asarray(n, float)))[()]


def normal_quantile(confidence: float) -> float:
    """Half-width of the two-sided interval of a standard normal variable: 1.96 for 0.95."""
    return NormalDist().inv_cdf((1 + confidence) / 2)


def _counts(k: ArrayLike, n: float) -> NDArray[Any]:
    k = np.asarray(k, float)
    if n < 1 or (k < 0).any() or (k > n).any():
        raise ValueError(f"k = {k}, n = {n}: counts must lie in [0, n], n at least 1")
    return k
