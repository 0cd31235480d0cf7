"""How far two distributions may differ without the data being able to exclude it: "not significant" is not "equal"."""

from __future__ import annotations

import numpy as np

from fecolumn.statistics.ecdf import normal_quantile


def distance_bound(u_a, overturned_a, u_b, overturned_b, confidence: float = 0.95) -> tuple[float, float]:
    """Largest distance of the two distributions, and the distance the data exclude at `confidence`.

    The same motions in both settings: at each u the difference F_a - F_b is that of two paired proportions, and its
    standard error counts the motions that lie below u in one setting alone (Agresti & Min 2005, Statistics in Medicine 24,
    half a motion added to each cell). The bound is the largest over u of |F_a - F_b| + z s(u), z one-sided. The true
    largest difference sits at some u*, and there the bound of one proportion already holds, so none is needed for all u at
    once (intersection-union test, Berger 1982, Technometrics 24).

    Args:
        u_a, u_b: (n,) [m] peaks of the same n motions; ignored where the run overturned.
        overturned_a, overturned_b: (n,) True where the column overturned: beyond every u.

    Returns:
        Largest |F_a - F_b| over u, and its upper confidence bound, both in [0, 1].
    """
    a, b = (np.where(np.asarray(over, bool), np.inf, np.asarray(u, float)) for u, over in ((u_a, overturned_a), (u_b, overturned_b)))
    if a.shape != b.shape or a.ndim != 1 or a.size == 0:
        raise ValueError(f"u_a {a.shape} and u_b {b.shape}: must be peaks of the same motions, at least one")
    at = np.unique(np.concatenate([a, b]))
    at = at[np.isfinite(at)]
    if not at.size:
        at = np.zeros(1)
    below_a, below_b = a[:, None] <= at, b[:, None] <= at
    only_a, only_b = (below_a & ~below_b).sum(axis=0), (below_b & ~below_a).sum(axis=0)
    distance = float(np.abs(only_a - only_b).max() / a.size)
    n, only_a, only_b = a.size + 2, only_a + 0.5, only_b + 0.5
    error = np.sqrt(np.maximum(only_a + only_b - (only_a - only_b)**2 / n, 0)) / n
    reach = normal_quantile(2 * confidence - 1)
    return distance, float(min(1.0, max(distance, (np.abs(only_a - only_b) / n + reach * error).max())))
