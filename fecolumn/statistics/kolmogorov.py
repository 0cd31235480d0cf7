"""The asymptotic p-value of the two-sample Kolmogorov-Smirnov test, as older studies printed it,
and what a printed p says about the samples.

It is MATLAB's `kstest2`: p = 2 sum (-1)^(j-1) exp(-2 j^2 l^2), l = (r + 0.12 + 0.11/r) D, r^2 = n
m/(n + m) (Stephens 1970). For one's own samples there are exact p-values:
`two_sample.kolmogorov_smirnov`.
"""

from __future__ import annotations

import math

import numpy as np

_TERMS = 101  # as many as kstest2 adds


def asymptotic_p(distance: float, n: int, m: int) -> float:
    """P of a distance D between the distribution functions of samples of n and m."""
    if not 0 <= distance <= 1 or n < 1 or m < 1:
        raise ValueError(
            f"distance = {distance:g} must lie in [0, 1], n = {n} and m = {m} be at least 1"
        )
    root = math.sqrt(n * m / (n + m))
    scaled = (root + 0.12 + 0.11 / root) * distance
    j = np.arange(1, _TERMS + 1)
    return (
        float(np.clip(2 * ((-1.0) ** (j - 1) * np.exp(-2 * (scaled * j) ** 2)).sum(), 0, 1))
        if scaled > 0
        else 1.0
    )


def samples_of_p(p: float, least: int, most: int, places: int = 2) -> list[tuple[int, int]]:
    """All (n, k) for which two samples of n each, k/n apart, have this p where it is rounded to so
    many places; the largest n first.
    """
    return [
        (n, k)
        for n in range(most, least - 1, -1)
        for k in range(1, n + 1)
        if abs(asymptotic_p(k / n, n, n) - p) <= 0.5 * 10.0**-places
    ]
