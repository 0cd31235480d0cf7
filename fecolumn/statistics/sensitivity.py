"""How much a parameter moves the distribution of u_max between two of its levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.statistics.bands import normal_quantile
from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.equivalence import paired_error, upper_bound
from fecolumn.statistics.records import Records, by_record

_CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """Effect of a parameter, averaged over the settings of all others.

    Attributes
    ----------
    n
        motions, or records where motions share them.
    distance
        largest difference of the two mean distributions [-], with its 95 % interval, which holds
        it. The lower end is 0 where the data are what no effect at all may give.
    chance
        distance that levels swapped at random within each motion exceed in 5 % of cases; below it
        there is no evidence.
    change
        change of P(overturn) from the low to the high level [-], with its 95 % interval.
    """

    n: int
    distance: float
    distance_low: float
    distance_high: float
    chance: float
    change: float
    change_low: float
    change_high: float


def sensitivity(
    u_low: ArrayLike,
    overturned_low: ArrayLike,
    u_high: ArrayLike,
    overturned_high: ArrayLike,
    resamples: int = 1000,
    seed: int = 0,
    records: Records = None,
) -> Sensitivity:
    """Effect between two levels of a parameter.

    Parameters
    ----------
    u_low, u_high
        (g, n) [m] peaks of n motions at the low and the high level, at g settings of all other
        parameters.
    overturned_low, overturned_high
        (g, n) True where the column overturned.
    resamples
        of the bootstrap and of the swaps; all settings of a motion, and all motions of a record,
        are drawn or swapped together.
    records
        (n,) record of each motion, None where each has one of its own.

    A largest distance is biased upwards: noise adds to it wherever it is largest, and once more in
    samples drawn anew, whose distances therefore lie above that of the data. The interval is made
    without them. Its lower end subtracts the distance that 97.5 % of the differences drawn anew
    keep to the difference of the data, at all u together (a band for the whole difference contains
    the difference at its largest). Its upper end is what the data exclude, see
    `equivalence.distance_bound`.

    Raises
    ------
    ValueError
        as of `ecdf`; two shapes at the two levels.
    """
    low, high = censored(u_low, overturned_low, 2), censored(u_high, overturned_high, 2)
    if low.shape != high.shape:
        raise ValueError(
            f"u_low {low.shape} and u_high {high.shape}: must be peaks of the same "
            "settings and motions"
        )
    n = low.shape[1]
    values = np.concatenate([low, high])
    at = np.unique(values[np.isfinite(values)])
    if at.size > 400:  # a fine enough comb: the distance it misses is below 1/400
        at = np.quantile(at, np.linspace(0, 1, 400), method="nearest")
    at = np.append(at, np.finfo(float).max)  # the last point is P(overturn)
    below = np.stack(
        [
            np.searchsorted(np.sort(side, axis=0)[:, k], at, side="right")
            for side in (high, low)
            for k in range(n)
        ]
    )
    # (n, points), of each motion, or of each record
    difference = by_record((below[:n] - below[n:]) / low.shape[0], records)
    n = len(difference)
    rng = np.random.default_rng(seed)
    weights = rng.multinomial(n, np.full(n, 1 / n), resamples) / n
    drawn = weights @ difference
    signs = rng.choice([-1.0, 1.0], (resamples, n)) / n
    whole = difference.mean(axis=0)
    distance, tail = float(np.abs(whole).max()), (1 - _CONFIDENCE) / 2
    reach = float(np.quantile(np.abs(drawn - whole).max(axis=1), 1 - tail))
    centre, error = paired_error(-difference[:, -1])
    half = normal_quantile(_CONFIDENCE) * error
    return Sensitivity(
        n,
        distance,
        max(0.0, distance - reach),
        upper_bound(difference, 1 - tail),
        float(np.quantile(np.abs(signs @ difference).max(axis=1), 0.95)),
        float(-whole[-1]),
        max(-1.0, float(centre - half)),
        min(1.0, float(centre + half)),
    )
