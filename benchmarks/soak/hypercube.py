"""Latin hypercubes whose samples know their shares by name."""

from __future__ import annotations

import numpy as np
from scipy.stats import qmc


class Draw:
    """One sample: a share in [0, 1) for each name.

    Parameters
    ----------
    shares
        by name.
    """

    def __init__(self, shares: dict[str, float]):
        self._shares = shares

    def even(self, name: str, low: float, high: float) -> float:
        """Evenly spread."""
        return _rounded(low + self._shares[name] * (high - low))

    def log(self, name: str, low: float, high: float) -> float:
        """Evenly spread in the logarithm."""
        return _rounded(low * (high / low) ** self._shares[name])

    def rarely(self, name: str, probability: float, value):
        """`value(a draw of the same name)` with a probability, else 0."""
        share = self._shares[name] / probability
        return value(Draw({name: share})) if share < 1 else 0.0

    def one_of(self, name: str, weights: dict):
        """A key of `weights`, as often as its weight says."""
        left = self._shares[name] * sum(weights.values())
        for key, weight in weights.items():
            if left < weight:
                return key
            left -= weight
        return key

    def place(self, name: str, count: int) -> int:
        """One of 0 ... count - 1."""
        return min(int(self._shares[name] * count), count - 1)


def hypercube(names, count: int, seed) -> list[Draw]:
    """So many samples of all names; the same for a seed."""
    shares = qmc.LatinHypercube(len(names), seed=np.random.default_rng(seed)).random(count)
    return [Draw(dict(zip(names, row))) for row in shares.tolist()]


def _rounded(value: float) -> float:
    return float(f"{value:.6g}")
