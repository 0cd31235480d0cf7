"""Correlation of u_max between two settings, or between computation and test, motion by motion."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.statistics.ecdf import censored, largest_peak


def correlation(
    u_a: ArrayLike, over_a: ArrayLike, u_b: ArrayLike, over_b: ArrayLike, cap_m: float | None = None
) -> float:
    """Pearson's R with overturned runs and larger displacements set to the cap, as Katsamakas &
    Vassiliou do with 250 mm.

    Parameters
    ----------
    u_a, u_b
        (n,) [m] each, the same motion at the same place; ignored where the run overturned.
    over_a, over_b
        (n,) True where the column overturned.
    cap_m
        displacement of an overturned run [m]; the largest peak of those that stood unless given.

    Returns
    -------
    R in [-1, 1]; nan where one of the settings gives the same displacement for every motion.
    """
    cap_m = largest_peak((u_a, over_a), (u_b, over_b)) if cap_m is None else cap_m
    a, b = (np.minimum(censored(u, over), cap_m) for u, over in ((u_a, over_a), (u_b, over_b)))
    if a.size != b.size:
        raise ValueError(
            f"{a.size} and {b.size} runs: a correlation needs the same motions in both"
        )
    if not math.isfinite(cap_m) or np.ptp(a) == 0 or np.ptp(b) == 0:
        return math.nan
    return float(np.clip(np.corrcoef(a, b)[0, 1], -1, 1))
