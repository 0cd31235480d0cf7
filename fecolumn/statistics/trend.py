"""Test whether the peak of one and the same motion rises or falls with a parameter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

_RESAMPLES = 2000


@dataclass(frozen=True, slots=True)
class Trend:
    """Trend of u_max along rising levels of a parameter, motion by motion.

    Attributes
    ----------
    n
        motions.
    levels
        levels of the parameter.
    tau, tau_low, tau_high
        mean over the motions of Kendall's tau-a between level and u_max [-1, 1], with its 95 %
        interval (bootstrap over motions). 0: as many pairs of levels rise as fall; 1: u_max of
        every motion rises at each level.
    rising, falling
        motions with tau above, below zero.
    p
        two-sided p of no trend: Page's L test (1963, J. Am. Stat. Assoc. 58) in its normal limit,
        for two levels the sign test.
    """

    n: int
    levels: int
    tau: float
    tau_low: float
    tau_high: float
    rising: int
    falling: int
    p: float


def trend(u_max: ArrayLike, overturned: ArrayLike, seed: int = 0) -> Trend:
    """Trend along levels; overturned runs lie beyond every standing one and tie among themselves.

    Parameters
    ----------
    u_max
        (levels, n) [m], levels in rising order of the parameter, the same motion in a column.
    overturned
        (levels, n) True where the column overturned.
    seed
        of the bootstrap.

    Raises
    ------
    ValueError
        fewer than two levels or no motion.
    """
    from scipy.stats import binomtest, page_trend_test

    u = np.where(np.asarray(overturned, bool), np.inf, np.asarray(u_max, float))
    if u.ndim != 2 or u.shape[0] < 2 or u.shape[1] < 1:
        raise ValueError(f"u_max {u.shape}: at least two levels and one motion are needed")
    levels, n = u.shape
    first, second = np.triu_indices(levels, 1)
    tau = ((u[second] > u[first]) * 1.0 - (u[second] < u[first])).mean(axis=0)
    drawn = np.random.default_rng(seed).integers(0, n, (_RESAMPLES, n))
    low, high = np.quantile(tau[drawn].mean(axis=1), [0.025, 0.975])
    rising, falling = int((tau > 0).sum()), int((tau < 0).sum())
    if levels > 2:
        finite = np.where(np.isinf(u), np.finfo(float).max, u)  # ranks are all that counts
        p = (
            min(
                1.0,
                2
                * min(
                    page_trend_test(rows, method="asymptotic").pvalue
                    for rows in (finite.T, finite[::-1].T)
                ),
            )
            if n > 1
            else 1.0
        )
    else:
        p = binomtest(rising, rising + falling).pvalue if rising + falling else 1.0
    return Trend(n, levels, float(tau.mean()), float(low), float(high), rising, falling, float(p))
