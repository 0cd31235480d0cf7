"""Empirical distribution of the peak displacement of an ensemble in which some runs are lost:
overturned, or slid off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.foundation.deprecated import by_name, warn_of_older_name
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.bands import greenwood, wilson
from fecolumn.statistics.records import Records, effective_runs, record_count


@dataclass(frozen=True, slots=True)
class Ecdf:
    """Right-continuous step function F with its pointwise confidence band.

    Attributes
    ----------
    x
        (m,) distinct finite values, rising [unit of the sample].
    cdf
        (m,) F at and right of x, in [0, 1].
    lower, upper
        (m,) its band, also by the names `low` and `high` that tables have.
    n
        size of the sample, lost runs included: those that overturned or slid off.
    lost
        number of lost runs; F ends at 1 - lost / n.
    records
        number of different records of the runs, which the band counts; n where each has its own.
    lost_interval
        interval of the share of lost runs, as of `share_interval`.
    """

    x: NDArray[Any]
    cdf: NDArray[Any]
    lower: NDArray[Any]
    upper: NDArray[Any]
    n: int
    lost: int
    records: int = 0
    lost_interval: tuple[float, float] = (0.0, 1.0)

    @property
    def low(self) -> NDArray[Any]:
        """Lower end (m,) of the band."""
        return self.lower

    @property
    def high(self) -> NDArray[Any]:
        """Upper end (m,) of the band."""
        return self.upper

    @property
    def overturned(self) -> int:
        """Older name of `lost`."""
        warn_of_older_name("script", "Ecdf.overturned", "Ecdf.lost")
        return self.lost


def _check_share(where: str, name: str, value: float) -> None:
    if not 0 < value < 1:
        raise InputError(where, name, value, "must lie between 0 and 1")


@by_name("confidence")
def ecdf(
    u_max: ArrayLike, lost: ArrayLike, *, confidence: float = 0.95, records: Records = None
) -> Ecdf:
    """Distribution of u_max, lost runs censored at the right.

    A lost run says only that its peak lies beyond every peak of a run that stood. Then
    Kaplan and Meier's estimate is the plain fraction k/n of the runs that stood below x, and
    Greenwood's variance is F (1 - F) / n (Greenwood 1926; Kaplan & Meier 1958, J. Am. Stat. Assoc.
    53; what MATLAB's `ecdf` draws). The band is F +- z sqrt(F (1 - F) / n), clipped to [0, 1]:
    pointwise, and of no width where F is 0 or 1. Where runs share records, the n of the band is the
    number of records: rather too wide than too narrow.

    Parameters
    ----------
    u_max
        (n,) peak displacement of each run [m], or of any other unit; ignored where the run
        was lost.
    lost
        (n,) True, or 1, where the column overturned or slid off; else False, or 0.
    confidence
        level of the band, in (0, 1).
    records
        (n,) record of each run, by any name: runs of one ground motion that is turned, for example,
        share one. None: each run has its own.

    Returns
    -------
    Ecdf
        the distribution at its m distinct peaks, and its band.

    Raises
    ------
    InputError
        empty sample, lengths that differ, a run of which `lost` says something else, a run that
        stood without a finite u_max, or a confidence out of range.
    """
    _check_share("ecdf", "confidence", confidence)
    standing, n = _standing(u_max, lost)
    x, counts = np.unique(standing, return_counts=True)
    cdf = np.cumsum(counts) / n
    count = record_count(records, n)
    return Ecdf(
        x,
        cdf,
        *greenwood(cdf, count, confidence),
        n,
        n - standing.size,
        count,
        share_interval(lost, records, confidence=confidence),
    )


def percentile(u_max: ArrayLike, lost: ArrayLike, fraction: float) -> float:
    """Smallest u with F(u) >= fraction, from a sample with lost runs; inf where that run
    was lost.

    The inverse of the ECDF (type 1 of Hyndman & Fan 1996, The American Statistician 50): no
    interpolation, which would have no meaning between a run that stood and one that was lost.

    Parameters
    ----------
    u_max, lost
        (n,) as of `ecdf`.
    fraction
        of the runs, in (0, 1]; 0.5 of the median.

    Raises
    ------
    InputError
        as of `ecdf`, or a fraction that is not in (0, 1].
    """
    if fraction != 1:
        _check_share("percentile", "fraction", fraction)
    standing, n = _standing(u_max, lost)
    rank = max(1, math.ceil(round(fraction * n, 9)))  # 0.07 * 100 is 7.000000000000001 in binary
    return float(np.sort(standing)[rank - 1]) if rank <= standing.size else math.inf


@by_name("confidence", "method")
def proportion_interval(
    k: int, n: int, *, confidence: float = 0.95, method: str = "wilson"
) -> tuple[float, float]:
    """Confidence interval of a probability after k of n runs, such as P(overturn).

    Parameters
    ----------
    k
        number of runs that were lost, a whole number: not their share.
    n
        number of all runs, a whole number of at least 1.
    confidence
        level, in (0, 1).
    method
        "wilson", the score interval (Wilson 1927, J. Am. Stat. Assoc. 22), close to its level on
        average; "exact", Clopper and Pearson (1934, Biometrika 26), never below its level, wider.

    Raises
    ------
    InputError
        n below 1, k not in [0, n], one of them not whole, a confidence out of range, or another
        method.
    """
    from scipy.stats import binomtest

    where = "proportion_interval"
    _check_share(where, "confidence", confidence)
    for name, value in (("n", n), ("k", k)):
        if not _whole(value):
            raise InputError(where, name, value, "must be a whole number: runs, not their share")
    if n < 1:
        raise InputError(where, "n", n, "must be at least 1")
    if not 0 <= k <= n:
        raise InputError(where, "k", k, f"must be in [0, {n}]")
    if method not in ("wilson", "exact"):
        raise InputError(where, "method", method, "must be 'wilson' or 'exact'")
    if method == "wilson":
        low, high = wilson([int(k)], int(n), confidence)
        return float(low[0]), float(high[0])
    interval = binomtest(int(k), int(n)).proportion_ci(confidence, method=method)
    return float(interval.low), float(interval.high)


def share_interval(
    happened: ArrayLike,
    records: Records = None,
    *,
    confidence: float = 0.95,
    method: str = "wilson",
) -> tuple[float, float]:
    """Confidence interval of a probability from n runs of which some may share records.

    `proportion_interval` of as many independent runs as tell as much, see
    `records.effective_runs`; where each run has a record of its own, of the n runs.

    Parameters
    ----------
    happened
        (n,) bool, such as whether each run overturned.
    records
        (n,) record of each run, None where each has its own.
    confidence, method
        as of `proportion_interval`; "exact" takes Clopper and Pearson's interval at numbers that
        are not whole (Korn & Graubard 1998, Survey Methodology 24).

    Raises
    ------
    InputError
        as of `proportion_interval`.
    ValueError
        another number of records than runs.
    """
    from scipy.stats import beta

    happened = np.asarray(happened, bool)
    k, n = int(happened.sum()), happened.size
    if record_count(records, n) == n:
        return proportion_interval(k, n, confidence=confidence, method=method)
    # its checks
    proportion_interval(k, n, confidence=confidence, method=method)
    runs = effective_runs(happened, records)
    reached = runs * (k / n)
    if method == "wilson":
        low, high = wilson([reached], runs, confidence)
        return float(low[0]), float(high[0])
    tail = (1 - confidence) / 2
    return (
        float(beta.ppf(tail, reached, runs - reached + 1)) if k else 0.0,
        float(beta.ppf(1 - tail, reached + 1, runs - reached)) if k < n else 1.0,
    )


def censored(u_max: ArrayLike, lost: ArrayLike, dimensions: int = 1) -> NDArray[Any]:
    """The sample for rank statistics: u_max, and inf where the run was lost.

    All lost runs are ties beyond every run that stood.

    Parameters
    ----------
    u_max, lost
        as of `ecdf`, (n,), or of n motions at several settings (settings, n).
    dimensions
        1 or 2, which of both.

    Raises
    ------
    InputError
        as of `ecdf`.
    """
    u, over = _checked(u_max, lost, dimensions)
    return np.where(over, math.inf, u)


def largest_peak(*samples: tuple[ArrayLike, ArrayLike]) -> float:
    """Largest peak [m] of the runs that stood, over samples of (u_max, lost); nan where none
    stood.

    What was lost is beyond it: the least that may be said of how far it went, and where axes end.
    """
    peaks = [peak for u_max, lost in samples for peak in _standing(u_max, lost)[0]]
    return float(max(peaks, default=math.nan))


def _standing(u_max: ArrayLike, lost: ArrayLike) -> tuple[NDArray[Any], int]:
    """Peaks of the runs that stood, and the size of the whole sample."""
    u, over = _checked(u_max, lost, 1)
    return u[~over], u.size


def _checked(
    u_max: ArrayLike, lost: ArrayLike, dimensions: int
) -> tuple[NDArray[Any], NDArray[Any]]:
    """u_max, and whether each run was lost (bool), of one shape with so many dimensions."""
    u, over = np.asarray(u_max, float), _truths(lost)
    if u.ndim != dimensions or u.shape != over.shape or u.size == 0:
        what = "two lists of one length" if dimensions == 1 else "two tables of one shape"
        told = f"{over.shape}: u_max {u.shape} and it must be {what}"
        raise InputError("ecdf", "lost", None, f"has shape {told}, not empty")
    if not np.isfinite(u[~over]).all():
        raise InputError(
            "ecdf",
            "u_max",
            None,
            "of a run that stood is not finite; a failed run is neither standing nor lost",
        )
    return u, over


def _truths(lost: ArrayLike) -> NDArray[Any]:
    """Truth values, of these or of numbers 0 and 1; any text would be true to numpy."""
    values = np.asarray(lost)
    if values.dtype != bool:
        for value in values.flat:
            if not isinstance(value, (bool, np.bool_, int, float, np.number)) or value not in (
                0,
                1,
            ):
                told = "must be True or False, or 1 or 0, for each run"
                raise InputError("ecdf", "lost", value, told)
    return values.astype(bool)


def _whole(value: Any) -> bool:
    """Whether a count is a whole number of any kind; truth values are none."""
    kinds = (int, float, np.integer, np.floating)
    if not isinstance(value, kinds) or isinstance(value, bool):
        return False
    return bool(np.isfinite(value)) and value == np.floor(value)
