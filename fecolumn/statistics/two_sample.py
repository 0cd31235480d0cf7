"""Two-sample tests of one distribution of u_max against another, overturned runs being ties at the
far end.

A sample is an array with inf where the run overturned (`ecdf.censored`). Ties are few without
overturns and many with them, and p-values made for continuous variables are then wrong: too large
for Kolmogorov and Smirnov, off in either direction for the others. All p-values here are those of
permutations of the pooled sample, ties as they are, which hold for any share of overturns: exactly
for Kolmogorov and Smirnov, by random permutations for the others, with a smallest possible p of 1 /
(resamples + 1) and a standard error of sqrt(p (1 - p) / resamples).

Runs of one record (see `statistics.records`) are drawn or swapped together, so that p counts
records; then Kolmogorov and Smirnov's p is one of random permutations, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.statistics.records import Records, counts_below, record_numbers, record_sums

RESAMPLES = 9999
_CELLS = 4_000_000  # of a matrix of permutations held at a time


@dataclass(frozen=True, slots=True)
class TestResult:
    """A statistic and its p-value under "one distribution"."""

    __test__ = False  # pytest would take it for a test

    statistic: float
    p: float


@dataclass(frozen=True, slots=True)
class _Pooled:
    """Both samples together, in blocks of equal values.

    Attributes
    ----------
    n, m
        sizes of samples a and b.
    size
        (blocks,) runs in each block, values rising.
    end
        (blocks,) runs up to and including each block.
    a
        (1, blocks) runs of sample a up to and including each block.
    of_records
        (records, blocks) runs of each record up to and including each block, those of sample a
        first; None where each run has a record of its own.
    in_a
        number of records of sample a.
    """

    n: int
    m: int
    size: NDArray[Any]
    end: NDArray[Any]
    a: NDArray[Any]
    of_records: NDArray[Any] | None = None
    in_a: int = 0


def kolmogorov_smirnov(
    a: ArrayLike,
    b: ArrayLike,
    records: tuple[Records, Records] = (None, None),
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> TestResult:
    """Two-sample Kolmogorov-Smirnov test: D = sup |F_a - F_b|, p exact for the ties at hand.

    p counts the orders of the pooled sample with a difference of D or more at the end of any block
    of ties (Schroeer & Trenkler 1995, Comput. Stat. Data Anal. 20). Without ties it is scipy's
    exact p; with overturned runs scipy's, made for continuous variables, is larger.

    The samples must be independent. Two settings run with the *same* motions are not: common
    motions make D smaller than chance, so that p is too large, and `paired_kolmogorov_smirnov` is
    the one to use.

    Parameters
    ----------
    records
        of the runs of a and of b; where runs share one, p is that of `resamples` random
        permutations of whole records.
    """
    pooled = _pool(a, b, records)
    if pooled.of_records is not None:
        return _permuted(_kolmogorov_smirnov, pooled, resamples, seed)
    n, total = pooled.n, pooled.n + pooled.m
    distance = int(_distances(pooled, pooled.a)[0])
    block_end = np.zeros(total + 1, bool)
    block_end[pooled.end] = True
    i = np.arange(n + 1)
    reached, beyond = np.zeros(n + 1), 0.0
    reached[0] = 1.0
    for s in range(1, total + 1):
        by_a, by_b = reached[:-1] * (n - i[:-1]), reached * (pooled.m - (s - 1 - i))
        reached = by_b
        reached[1:] += by_a
        reached /= total - s + 1
        if block_end[s]:
            far = np.abs(total * i - n * s) >= distance
            beyond += reached[far].sum()
            reached[far] = 0.0
    return TestResult(distance / (n * pooled.m), float(min(beyond, 1.0)) if distance else 1.0)


def anderson_darling(
    a: ArrayLike,
    b: ArrayLike,
    resamples: int = RESAMPLES,
    seed: int = 0,
    records: tuple[Records, Records] = (None, None),
) -> TestResult:
    """Two-sample Anderson-Darling test, A^2 in its midrank version for ties (Scholz & Stephens
    1987, J. Am. Stat. Assoc. 82, eq. 7).

    A^2 has mean 1 where the distributions are one; `scipy.stats.anderson_ksamp` shows (A^2 - 1) /
    its standard deviation and holds p in [0.001, 0.25], where this one, by permutations, has no
    such bounds. Heavier in the tails than the others.
    """
    return _permuted(_anderson_darling, _pool(a, b, records), resamples, seed)


def cramer_von_mises(
    a: ArrayLike,
    b: ArrayLike,
    resamples: int = RESAMPLES,
    seed: int = 0,
    records: tuple[Records, Records] = (None, None),
) -> TestResult:
    """Two-sample Cramer-von Mises test, averaged over all orders of ties.

    T of Anderson (1962), Annals of Mathematical Statistics 33.

    In which order overturned runs follow each other nobody knows; T is its mean over all orders, in
    closed form. Without ties it is that of `scipy.stats.cramervonmises_2samp`, whose midranks do
    not give this mean where there are many.
    """
    return _permuted(_cramer_von_mises, _pool(a, b, records), resamples, seed)


def paired_kolmogorov_smirnov(
    a: ArrayLike,
    b: ArrayLike,
    resamples: int = RESAMPLES,
    seed: int = 0,
    records: Records = None,
) -> TestResult:
    """D = sup |F_a - F_b| of two settings run with the same motions; p by swapping the settings
    within motions.

    Where the setting does not matter, a motion could as well have given its two results the other
    way round. That makes 2^k equally likely outcomes for k motions whose results differ: all of
    them up to k = 13, random ones beyond. All runs of one record are swapped together.

    Parameters
    ----------
    a, b
        (n,) each, the same motion at the same place.
    records
        (n,) record of each motion, None where each has one of its own.
    """
    a, b = _sample(a), _sample(b)
    if a.size != b.size:
        raise ValueError(f"{a.size} and {b.size} runs: paired samples must have one length")
    values = np.unique(np.concatenate([a, b]))
    steps = (a[:, None] <= values).astype(np.float32) - (b[:, None] <= values)
    numbers = record_numbers(records, a.size)
    steps = steps[a != b] if numbers is None else record_sums(steps, numbers)
    steps = steps if numbers is None else steps[steps.any(axis=1)]
    observed = np.abs(steps.sum(axis=0)).max(initial=0.0)
    if not observed:
        return TestResult(0.0, 1.0)
    k = len(steps)
    if 2**k <= resamples + 1:
        signs = 1 - 2 * ((np.arange(2**k)[:, None] >> np.arange(k)) & 1).astype(np.float32)
        p = np.mean(np.abs(signs @ steps).max(axis=1) >= observed)
    else:
        rng, far = np.random.default_rng(seed), 0
        for count in _chunks(resamples, k + values.size):
            signs = 1 - 2 * rng.integers(0, 2, (count, k), dtype=np.int8).astype(np.float32)
            far += np.count_nonzero(np.abs(signs @ steps).max(axis=1) >= observed)
        p = (far + 1) / (resamples + 1)
    return TestResult(float(observed) / a.size, float(p))


def _permuted(
    statistic: Callable[[_Pooled, NDArray[Any]], NDArray[Any]],
    pooled: _Pooled,
    resamples: int,
    seed: int,
) -> TestResult:
    """p-value of a statistic that is large where the distributions differ (Phipson & Smyth 2010,
    (far + 1) / (resamples + 1)).
    """
    observed = float(statistic(pooled, pooled.a)[0])
    if pooled.size.size == 1:
        return TestResult(observed, 1.0)
    rng, far = np.random.default_rng(seed), 0
    whole = pooled.of_records
    units, in_a = (pooled.n + pooled.m, pooled.n) if whole is None else (len(whole), pooled.in_a)
    labels = np.arange(units) < in_a
    for count in _chunks(resamples, labels.size + (0 if whole is None else whole.shape[1])):
        shuffled = rng.permuted(np.broadcast_to(labels, (count, labels.size)), axis=1)
        counts = (
            np.cumsum(shuffled, axis=1, dtype=np.int32)[:, pooled.end - 1]
            if whole is None
            else np.asarray(np.rint(shuffled.astype(float) @ whole), np.int32)
        )
        # equal in exact arithmetic counts as far, whatever the last digit says
        far += np.count_nonzero(statistic(pooled, counts) >= observed * (1 - 1e-10) - 1e-12)
    return TestResult(observed, (far + 1) / (resamples + 1))


def _sizes(pooled: _Pooled, a: NDArray[Any]) -> tuple[Any, Any]:
    """Runs of samples a and b, (k, 1) each where they differ from one permutation of records of
    different size to the next.
    """
    n = a[:, -1:]
    if (n == pooled.n).all():
        return pooled.n, pooled.m
    return n.astype(float), (pooled.n + pooled.m - n).astype(float)


def _kolmogorov_smirnov(pooled: _Pooled, a: NDArray[Any]) -> NDArray[Any]:
    """D = sup |F_a - F_b| (k,) for counts a (k, blocks)."""
    n, m = _sizes(pooled, a)
    return np.asarray(np.abs(a / n - (pooled.end - a) / m).max(axis=1))


def _distances(pooled: _Pooled, a: NDArray[Any]) -> NDArray[Any]:
    """N m sup |F_a - F_b| (k,), a whole number, for counts a (k, blocks)."""
    lead = np.abs(a.astype(np.int64) * (pooled.n + pooled.m) - pooled.n * pooled.end)
    return np.asarray(lead.max(axis=1))


def _anderson_darling(pooled: _Pooled, a: NDArray[Any]) -> NDArray[Any]:
    """A^2 (k,) for counts a (k, blocks)."""
    (n, m), total = _sizes(pooled, a), pooled.n + pooled.m
    if pooled.size.size == 1:
        return np.zeros(len(a))
    middle = a - 0.5 * np.diff(a, axis=1, prepend=0)
    pooled_middle = pooled.end - 0.5 * pooled.size
    weight = pooled.size / (pooled_middle * (total - pooled_middle) - total * pooled.size / 4)
    summed = np.asarray((total * middle - n * pooled_middle) ** 2 @ weight)
    return np.asarray((total - 1) / total**2 * np.ravel(1 / n + 1 / m) * summed)


def _cramer_von_mises(pooled: _Pooled, a: NDArray[Any]) -> NDArray[Any]:
    """T (k,) for counts a (k, blocks)."""
    (n, m), total, size = _sizes(pooled, a), pooled.n + pooled.m, pooled.size
    after = a / n - (pooled.end - a) / m
    jump = np.diff(after, axis=1, prepend=0.0)
    before = after - jump
    # sum over s = 1..size of (before + jump s / size)^2, then the variance of the number of a among
    # the first s of the block
    line = (
        size * before**2
        + before * jump * (size + 1)
        + jump**2 * (size + 1) * (2 * size + 1) / (6 * size)
    )
    share = np.diff(a, axis=1, prepend=0) / size
    scatter = share * (1 - share) * size * (size + 1) / 6 * (1 / n + 1 / m) ** 2
    return np.asarray(np.ravel(n * m / total**2) * (line + scatter).sum(axis=1))


def _pool(a: ArrayLike, b: ArrayLike, records: tuple[Records, Records] = (None, None)) -> _Pooled:
    a, b = _sample(a), _sample(b)
    values, size = np.unique(np.concatenate([a, b]), return_counts=True)
    of_each = [record_numbers(own, one.size) for own, one in zip(records, (a, b))]
    of_records, in_a = None, 0
    if any(numbers is not None for numbers in of_each):
        of_a, of_b = (
            np.arange(one.size) if numbers is None else numbers
            for numbers, one in zip(of_each, (a, b))
        )
        in_a = int(of_a.max()) + 1
        of_records = counts_below(np.concatenate([a, b]), np.concatenate([of_a, in_a + of_b]))
    return _Pooled(
        a.size,
        b.size,
        size,
        np.cumsum(size),
        np.asarray(np.searchsorted(np.sort(a), values, side="right"))[None],
        of_records,
        in_a,
    )


def _sample(values: ArrayLike) -> NDArray[Any]:
    values = np.asarray(values, float)
    if values.ndim != 1 or not values.size or np.isnan(values).any():
        raise ValueError(
            "a sample must be a list of numbers, inf where the run overturned, not empty"
        )
    return values


def _chunks(resamples: int, cells: int) -> list[int]:
    """Numbers of permutations that fit in memory together, `resamples` in all."""
    size = max(1, _CELLS // cells)
    return [size] * (resamples // size) + ([resamples % size] if resamples % size else [])
