"""Runs of one record, such as one ground motion turned into several directions, are one cluster:
they are not independent, and a sample holds as much as its records, not its runs.

Everywhere `records` is (n,), the record of each run by any name, or None where each run has one of
its own; then, and where all names differ, every statistic is that of n independent runs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Names of the records of n runs, None where each has one of its own
Records = Sequence[object] | NDArray[Any] | None


def record_numbers(records: Records, n: int) -> NDArray[Any] | None:
    """Number of each run's record (n,), from 0 in the order of the runs; None where each of the n
    runs has a record of its own.

    Raises
    ------
    ValueError
        another number of names than runs.
    """
    if records is None:
        return None
    names = list(records)
    if len(names) != n:
        raise ValueError(f"{len(names)} records of {n} runs: each run must have one")
    order = {name: number for number, name in enumerate(dict.fromkeys(names))}
    return np.array([order[name] for name in names]) if len(order) < n else None


def record_count(records: Records, n: int) -> int:
    """Number of different records of n runs."""
    numbers = record_numbers(records, n)
    return n if numbers is None else int(numbers.max()) + 1


def run_count(n: int, records: Records, what: str = "run") -> str:
    """Number of runs in words, such as "8 runs", or "72 runs of 8 records" where they share some;
    `what` they are: a word to which an s is added.
    """
    of = record_count(records, n)
    text = f"{n} {what}{'' if n == 1 else 's'}"
    return text if of == n else f"{text} of {of} record{'' if of == 1 else 's'}"


def counted_unit(n: int, count: int) -> str:
    """What statistics of n motions of so many different records count, in words."""
    return "motions" if count == n else "records"


def by_record(values: ArrayLike, records: Records) -> NDArray[Any]:
    """Values of G records from those of their n runs, (G, ...): their sums times G / n.

    Their mean is that of the runs, and where all records have as many runs each value is the mean
    of its record. The same array where each run has a record of its own.

    Parameters
    ----------
    values
        (n, ...) of each run.
    """
    values = np.asarray(values, float)
    numbers = record_numbers(records, len(values))
    if numbers is None:
        return values
    summed = record_sums(values, numbers)
    return summed * (len(summed) / len(values))


def record_sums(values: NDArray[Any], numbers: NDArray[Any]) -> NDArray[Any]:
    """Sums (G, ...) over the runs of each record, in the type of values (n, ...)."""
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.diff(numbers[order], prepend=-1))
    return np.asarray(np.add.reduceat(values[order], starts, axis=0))


def counts_below(values: NDArray[Any], numbers: NDArray[Any]) -> NDArray[Any]:
    """Runs of each record up to and including each of the different values of all runs, these
    rising: (G, different values), as floating-point numbers.

    Parameters
    ----------
    values, numbers
        (n,) of each run, and the number of its record.
    """
    different, place = np.unique(values, return_inverse=True)
    cells = np.ravel(numbers * different.size + np.ravel(place))
    size = int(numbers.max() + 1) * different.size
    counted = np.bincount(cells, minlength=size).reshape(-1, different.size)
    return np.asarray(np.cumsum(counted, axis=1), float)


def effective_runs(happened: ArrayLike, records: Records) -> float:
    """Number of independent runs that would tell a share as well as n runs of G records.

    n / deff with the design effect of clusters (Kish 1965, Survey Sampling, chapter 5). With the
    share p and k_g of m_g runs of record g the variance of p is v = G / (G - 1) sum (k_g - p m_g)^2
    / n^2, that of a ratio over clusters (Cochran 1977, Sampling Techniques, eq. 11.12), and that
    of N independent runs p (1 - p) / (N - 1), hence N = 1 + p (1 - p) / v. As v is known no better
    than by G - 1 degrees of freedom, N is multiplied by (t(N - 1) / t(G - 1))^2, quantiles of
    Student's t at 97.5 % (Korn & Graubard 1998, Survey Methodology 24). N is at most n, and at
    least the number that holds where all runs of a record agree, n^2 / sum m_g^2: G where each has
    as many runs. It is that one, too, where the event happens in all runs or in none.

    Parameters
    ----------
    happened
        (n,) bool.

    Returns
    -------
    n where each run has a record of its own.
    """
    from scipy.stats import t

    happened = np.asarray(happened, bool)
    n = happened.size
    numbers = record_numbers(records, n)
    if numbers is None:
        return float(n)
    m, k = np.bincount(numbers), np.bincount(numbers, happened)
    p, least = k.sum() / n, n**2 / float((m.astype(float) ** 2).sum())
    if m.size == 1 or ((k == 0) | (k == m)).all():
        return least
    v = m.size / (m.size - 1) * float(((k - p * m) ** 2).sum()) / n**2
    found = min(1 + p * (1 - p) / v, n) if v > 0 else float(n)
    certainty = (t.ppf(0.975, found - 1) / t.ppf(0.975, m.size - 1)) ** 2
    return float(min(n, max(least, found * certainty)))
