"""Hazard curves of a site, and how often a structure reaches a limit state there.

With the mean annual frequency L(x) at which an intensity x is exceeded and the fragility P(x), the
limit state is reached at the mean annual frequency

    L_f = integral of P(x) |dL(x)|

(Cornell, Jalayer, Hamburger & Foutch 2002, Journal of Structural Engineering 128). The curve is
straight between its points in logarithms. For L = k0 x^-k at all x and a lognormal fragility of
median m and dispersion b the integral is k0 m^-k exp(k^2 b^2 / 2).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr, roots_legendre

# Gauss and Legendre's points in pieces of this width of ln x: exact to 1e-8 for dispersions above
# 0.05
_WIDTH, _POINTS = 0.05, 4
_BINS = 15

#: P(limit state | x) of x (n,) for r parameter sets: (r, n)
Probabilities = Callable[[NDArray[Any]], NDArray[Any]]


@dataclass(frozen=True, slots=True)
class HazardCurve:
    """Mean annual frequencies of exceedance.

    Attributes
    ----------
    measure
        name of the intensity measure, with its unit at the end.
    im
        (n,) intensities, positive and rising.
    frequency
        (n,) mean annual frequency at which each is exceeded [1/year], positive, not rising.
    """

    measure: str
    im: NDArray[Any]
    frequency: NDArray[Any]

    def at(self, im: ArrayLike) -> NDArray[Any]:
        """Frequency [1/year] at intensities within the curve, straight in logarithms."""
        line = np.interp(np.log(np.asarray(im, float)), np.log(self.im), np.log(self.frequency))
        return np.asarray(np.exp(line))

    def pieces(self) -> tuple[NDArray[Any], NDArray[Any]]:
        """Intensities (p,) and the annual frequencies (p,) [1/year] that they stand for: those of
        the quadrature.
        """
        points, weights = roots_legendre(_POINTS)
        at, rate = [], []
        x, y = np.log(self.im), np.log(self.frequency)
        for x0, x1, y0, y1 in zip(x, x[1:], y, y[1:]):
            edges = np.linspace(x0, x1, max(1, math.ceil((x1 - x0) / _WIDTH)) + 1)
            half = (edges[1] - edges[0]) / 2
            place = ((edges[:-1] + half)[:, None] + half * points).ravel()
            slope = (y0 - y1) / (x1 - x0)
            level = np.exp(y0 - slope * (place - x0))
            at.append(np.exp(place))
            rate.append(slope * level * half * np.tile(weights, len(edges) - 1))
        return np.concatenate(at), np.concatenate(rate)


@dataclass(frozen=True, slots=True)
class AnnualFrequency:
    """How often a limit state is reached.

    Attributes
    ----------
    value
        mean annual frequency [1/year] of r parameter sets, (r,).
    beyond
        (r,) [1/year] the most that intensities above the curve's last add to it: they are taken to
        be as bad as the last.
    below
        (r,) share that intensities below the curve's first would add if the curve went on as it
        begins, at most; it tells whether the curve begins low enough.
    edges
        (b + 1,) bins of the intensity, of one width in logarithms.
    parts
        (r, b) annual frequency [1/year] that comes from each bin; the last has what lies above.
    """

    value: NDArray[Any]
    beyond: NDArray[Any]
    below: NDArray[Any]
    edges: NDArray[Any]
    parts: NDArray[Any]


def annual_frequency(curve: HazardCurve, probabilities: Probabilities) -> AnnualFrequency:
    """Frequency of a limit state from a hazard curve and its probability given the intensity."""
    at, rate = curve.pieces()
    p = np.atleast_2d(probabilities(at)) * rate
    first, last = np.atleast_2d(probabilities(curve.im[[0, -1]])).T
    top = last * curve.frequency[-1]
    value = p.sum(axis=1) + top
    edges = np.exp(np.linspace(math.log(curve.im[0]), math.log(curve.im[-1]), _BINS + 1))
    bins = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, _BINS - 1)
    parts = np.stack([p[:, bins == place].sum(axis=1) for place in range(_BINS)], axis=1)
    parts[:, -1] += top
    with np.errstate(divide="ignore", invalid="ignore"):
        below = np.where(value > 0, first * curve.frequency[0] / value, 0.0)
    return AnnualFrequency(value, (1 - last) * curve.frequency[-1], below, edges, parts)


def lognormal_probabilities(medians: ArrayLike, betas: ArrayLike) -> Probabilities:
    """P of lognormal fragilities of r medians and dispersions."""
    median, beta = (np.atleast_1d(np.asarray(one, float)) for one in (medians, betas))
    return probit_probabilities(
        np.column_stack([-np.log(median), np.ones_like(beta)]) / beta[:, None]
    )


def probit_probabilities(lines: ArrayLike) -> Probabilities:
    """P = Phi(a + b ln im) of r lines (a, b), lines (r, 2)."""
    a, b = (one[:, None] for one in np.asarray(lines, float).T)
    return lambda im: np.asarray(ndtr(a + b * np.log(np.asarray(im))))


def probability_in_years(frequency: ArrayLike, years: float) -> NDArray[Any]:
    """Probability that it is reached at least once, of a Poisson process."""
    return np.asarray(-np.expm1(-np.asarray(frequency, float) * years))


def stated_region(
    median: tuple[float, float, float], beta: tuple[float, float, float], number: int = 361
) -> NDArray[Any]:
    """As `Fragility.region`, of a fragility of which value, low and high of median and dispersion
    are stated: lines (number, 2), ln median and 1/beta taken as independent of one another.
    """
    angle = np.linspace(-math.pi, math.pi, number)
    m, b = (
        value + np.where(part > 0, high - value, value - low) * part
        for (value, low, high), part in (
            ([math.log(one) for one in median], np.cos(angle)),
            ((1 / beta[0], 1 / beta[2], 1 / beta[1]), np.sin(angle)),
        )
    )
    return np.column_stack([-m * b, b])
