"""How many motions a CDF needs: sub-ensembles against the whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.statistics.bands import dkw_distance
from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.records import Records, counts_below, record_numbers

_CELLS = 4_000_000


@dataclass(frozen=True, slots=True)
class CdfConvergence:
    """Distance sup |F_n - F_N| of sub-ensembles of n motions, drawn without replacement, from the
    whole of N. Where motions share records, n and N are numbers of records, drawn whole.

    Drawn so, F_n meets F_N at n = N whatever F_N itself is worth: the distance is smaller by
    sqrt((N - n) / (N - 1)), the finite-population factor, than that from the distribution of all
    motions there could be, which dkw_95 bounds.

    Attributes
    ----------
    median, upper_95
        (m,) 50 % and 95 % quantile of the distance.
    dkw_95
        (m,) bound of the distance of F_n from the true F at 95 % (Massart 1990).
    """

    median: NDArray[Any]
    upper_95: NDArray[Any]
    dkw_95: NDArray[Any]


def cdf_convergence(
    u_max: ArrayLike,
    overturned: ArrayLike,
    sizes: ArrayLike,
    resamples: int = 1000,
    seed: int = 0,
    records: Records = None,
) -> CdfConvergence:
    """Convergence of the CDF with the number of motions.

    Parameters
    ----------
    u_max
        (N,) [m]; ignored where the run overturned.
    overturned
        (N,) True where the column overturned.
    sizes
        (m,) numbers of motions, or of records where motions share them, from 1 to N.
    resamples
        sub-ensembles of each size.
    seed
        of the generator.
    records
        (N,) record of each motion, None where each has one of its own.

    Raises
    ------
    ValueError
        a size outside [1, N]; as of `ecdf`.
    """
    given, sizes = censored(u_max, overturned), np.asarray(sizes, int)
    numbers, u = record_numbers(records, given.size), np.sort(given)
    total = u.size if numbers is None else int(numbers.max()) + 1
    if sizes.ndim != 1 or not sizes.size or sizes.min() < 1 or sizes.max() > total:
        raise ValueError(
            f"sizes = {sizes.tolist()}: must be a list of numbers in [1, {total}], the "
            "number of motions"
        )
    end = np.cumsum(np.unique(u, return_counts=True)[1])
    below = None if numbers is None else counts_below(given, numbers)
    rng, quantiles = np.random.default_rng(seed), []
    for n in sizes:
        distances = np.empty(resamples)
        for start in range(0, resamples, max(1, _CELLS // total)):
            part = distances[start : start + max(1, _CELLS // total)]
            drawn = rng.permuted(np.broadcast_to(np.arange(total) < n, (part.size, total)), axis=1)
            if below is None:
                share = np.cumsum(drawn, axis=1)[:, end - 1] / n
            else:
                share = drawn.astype(float) @ below
                share /= share[:, -1:]
            part[:] = np.abs(share - end / u.size).max(axis=1)
        quantiles.append(np.quantile(distances, (0.5, 0.95)))
    median, upper = np.transpose(quantiles)
    return CdfConvergence(median, upper, dkw_distance(sizes))
