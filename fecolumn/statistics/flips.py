"""Overturns that come and go with a setting: the same motions, run twice."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.statistics.records import Records, record_numbers, record_sums


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


def flips_p(overturned_a: ArrayLike, overturned_b: ArrayLike, records: Records = None) -> float:
    """p-value of `mcnemar` where runs may share records.

    The settings of all runs of a record are swapped together: with d_g more flips of record g one
    way than the other, p is the share of the 2^G sums of +- d_g that are as far from 0 as the sum
    of d_g (randomization test, Fisher 1935, The Design of Experiments). All of them count: their
    distribution is the convolution of those of the records. Where each run has a record of its own
    that is McNemar's exact test.

    Parameters
    ----------
    overturned_a, overturned_b
        (n,) each, the same motion at the same place.
    records
        (n,) record of each motion, None where each has one of its own.

    Raises
    ------
    ValueError
        as of `contingency`.
    """
    table = contingency(overturned_a, overturned_b)
    a, b = np.asarray(overturned_a, bool), np.asarray(overturned_b, bool)
    numbers = record_numbers(records, a.size)
    if numbers is None:
        return mcnemar(table)
    return swapped_p(record_sums(a.astype(int) - b.astype(int), numbers))


def swapped_p(net: NDArray[Any]) -> float:
    """Share of the 2^G sums of +- net (G,), whole numbers, that are as far from 0 as their sum."""
    most = int(np.abs(net).sum())
    share = np.zeros(2 * most + 1)  # of the sums -most, ..., most
    share[most] = 1.0
    for step in np.abs(net[net != 0]):
        share = 0.5 * (np.roll(share, step) + np.roll(share, -step))
    sums = np.arange(-most, most + 1)
    return float(min(1.0, share[np.abs(sums) >= abs(int(net.sum()))].sum()))
