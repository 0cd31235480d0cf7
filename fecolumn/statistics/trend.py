"""Test whether the peak of one and the same motion rises or falls with a parameter."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.flips import swapped_p
from fecolumn.statistics.records import Records, by_record, record_numbers, record_sums

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
        interval (bootstrap over motions, or over records where motions share them). 0: as many
        pairs of levels rise as fall; 1: u_max of every motion rises at each level.
    rising, falling
        motions with tau above, below zero.
    p
        two-sided p of no trend: Page's L test (1963, J. Am. Stat. Assoc. 58) in its normal limit,
        for two levels the sign test. Levels of all motions of a record are permuted together.
    """

    n: int
    levels: int
    tau: float
    tau_low: float
    tau_high: float
    rising: int
    falling: int
    p: float


def trend(u_max: ArrayLike, overturned: ArrayLike, seed: int = 0, records: Records = None) -> Trend:
    """Trend along levels; overturned runs lie beyond every standing one and tie among themselves.

    Parameters
    ----------
    u_max
        (levels, n) [m], levels in rising order of the parameter, the same motion in a column.
    overturned
        (levels, n) True where the column overturned.
    seed
        of the bootstrap.
    records
        (n,) record of each motion, None where each has one of its own.

    Raises
    ------
    ValueError
        as of `ecdf`; fewer than two levels.
    """
    from scipy.stats import binomtest, page_trend_test

    u = censored(u_max, overturned, 2)
    if u.shape[0] < 2:
        raise ValueError(f"u_max {u.shape}: at least two levels are needed")
    levels, n = u.shape
    first, second = np.triu_indices(levels, 1)
    tau = ((u[second] > u[first]) * 1.0 - (u[second] < u[first])).mean(axis=0)
    numbers, of_records = record_numbers(records, n), by_record(tau, records)
    count = len(of_records)
    drawn = np.random.default_rng(seed).integers(0, count, (_RESAMPLES, count))
    low, high = np.quantile(of_records[drawn].mean(axis=1), [0.025, 0.975])
    rising, falling = int((tau > 0).sum()), int((tau < 0).sum())
    if numbers is not None:
        p = (
            _page_of_records(u, numbers)
            if levels > 2
            else swapped_p(record_sums(np.sign(tau).astype(int), numbers))
        )
    elif levels > 2:
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


def _page_of_records(u: NDArray[Any], numbers: NDArray[Any]) -> float:
    """Two-sided p of Page's L, levels permuted alike in all motions of a record, normal limit.

    L sums level times rank. Of one motion its variance is V = k^2 (k + 1) (k^2 - 1) / 144, ties not
    counted, of a record of m motions m V r: r is the sum of squares of its summed ranks over the
    sum of those of its single motions, each from their mean; 1 where the motions have nothing in
    common, m where they are one.
    """
    from scipy.stats import norm, rankdata

    if not numbers.any():
        return 1.0
    levels = len(u)
    ranks = rankdata(u, axis=0).T - (levels + 1) / 2
    summed, size = record_sums(ranks, numbers), np.bincount(numbers)
    alone = record_sums((ranks**2).sum(axis=1), numbers)
    together = (summed**2).sum(axis=1)
    ratio = np.where(alone > 0, together / np.where(alone > 0, alone, 1), size)
    one = levels**2 * (levels + 1) * (levels**2 - 1) / 144
    variance = float((size * one * ratio).sum())
    score = float((summed @ np.arange(1, levels + 1)).sum())
    return min(1.0, 2 * float(norm.sf(abs(score) / math.sqrt(variance)))) if variance else 1.0
