"""Ensembles with a share of overturned runs, for the tests."""

import math

import numpy as np


def censor(u, share: float):
    """Sample with inf in place of its values beyond the quantile 1 - share of the standard normal
    law it was drawn from.
    """
    from scipy.stats import norm

    return np.where(u > norm.ppf(1 - share), math.inf, u) if share else u


def assert_uniform(p, resolution: float = 0.0):
    """p-values lie below each level as often as the level says, within three standard errors and
    the resolution of p.
    """
    p = np.asarray(p)
    for level in (0.05, 0.10, 0.25, 0.5, 0.8):
        error = 3 * math.sqrt(level * (1 - level) / p.size)
        assert abs(np.mean(p <= level) - level) <= error + resolution, (level, np.mean(p <= level))
