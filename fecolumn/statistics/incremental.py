"""Incremental dynamic analysis: each motion scaled up until the column overturns (Vamvatsikos &
Cornell 2002, EESD 31).

The same motion at several scales is one piece of knowledge and not several: what each motion gives
is the intensity at which it first overturns the column, known to lie between two of its scales, or
beyond the largest.

Columns that rock are not monotonic: at a larger scale the same motion may let the column stand
again (resurrection). The intensity of the *first* overturning then lies below what a single run at
that intensity would say; `fragility.lognormal` with `groups` is the probability of overturning *at*
an intensity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import log_ndtr

from fecolumn.statistics.binary_regression import DegenerateData, maximize
from fecolumn.statistics.fragility import Fragility, exp_or_inf, median_of
from fecolumn.statistics.records import Records, record_numbers

FRACTILES = (0.16, 0.5, 0.84)


@dataclass(frozen=True, slots=True)
class IncrementalCurve:
    """One motion at k rising intensities.

    Attributes
    ----------
    motion
        its name.
    im
        (k,) intensities, rising [unit of the measure].
    u_max
        (k,) [m]; of no meaning where the column overturned.
    overturned
        (k,) bool.
    """

    motion: str
    im: NDArray[Any]
    u_max: NDArray[Any]
    overturned: NDArray[Any]

    @property
    def first(self) -> tuple[float, float]:
        """Intensities between which the column first overturns: (0, im_1) where it does at the
        least, (im_k, inf) where it never does.
        """
        if not self.overturned.any():
            return float(self.im[-1]), np.inf
        place = int(np.argmax(self.overturned))
        return (float(self.im[place - 1]) if place else 0.0), float(self.im[place])

    @property
    def stands_again(self) -> bool:
        """Whether the column stands at an intensity above one at which it overturns."""
        return bool(
            (~self.overturned[int(np.argmax(self.overturned)) :]).any() and self.overturned.any()
        )

    def u_at(self, im: ArrayLike) -> NDArray[Any]:
        """u_max [m] at intensities (m,): straight between the runs and from rest at 0; inf beyond
        the first overturning, nan where not known.

        Between the last run that stood and the first that overturned the curve keeps the slope of
        the last two runs that stood.
        """
        im, (stood, fallen) = np.asarray(im, float), self.first
        count = int(np.searchsorted(self.im, stood, side="right")) if stood else 0
        x, y = np.append(0.0, self.im[:count]), np.append(0.0, self.u_max[:count])
        slope = max(0.0, (y[-1] - y[-2]) / (x[-1] - x[-2])) if count else np.nan
        known = np.where(im <= stood, np.interp(im, x, y), y[-1] + slope * (im - stood))
        return np.where(
            im >= fallen, np.inf, np.where((im > stood) & np.isinf(fallen), np.nan, known)
        )


@dataclass(frozen=True, slots=True)
class FirstOverturning(Fragility):
    """Lognormal distribution of the intensity of first overturning.

    What is known of each motion lies about its own intensity, so that median and dispersion are
    those of a sample, and normal in their logarithms.
    """

    def median_interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Student's interval of the mean logarithm."""
        return self._around(self.median, math.sqrt(self.covariance[0, 0]), confidence)

    def beta_interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Interval of beta, normal in its logarithm."""
        return self._around(self.beta, math.sqrt(self.covariance[1, 1]) / self.beta, confidence)

    def _around(self, value: float, error: float, confidence: float) -> tuple[float, float]:
        reach = exp_or_inf(self.quantile(confidence) * error)
        return value / reach, value * reach


def incremental_curves(
    motion: ArrayLike, im: ArrayLike, u_max: ArrayLike, overturned: ArrayLike
) -> list[IncrementalCurve]:
    """Curves of all motions from (n,) runs in any order: names, positive intensities, u_max [m],
    and whether the column overturned.

    Raises
    ------
    ValueError
        an intensity that is not positive, or a motion with two runs of one intensity.
    """
    motion, im, u_max, overturned = (
        np.asarray(motion),
        np.asarray(im, float),
        np.asarray(u_max, float),
        np.asarray(overturned, bool),
    )
    if not (np.isfinite(im) & (im > 0)).all():
        raise ValueError("intensities must be positive and finite")
    curves = []
    for name in dict.fromkeys(motion.tolist()):
        rows = np.flatnonzero(motion == name)
        rows = rows[np.argsort(im[rows], kind="stable")]
        if (np.diff(im[rows]) <= 0).any():
            raise ValueError(f"motion {name}: two runs of one intensity")
        curves.append(IncrementalCurve(str(name), im[rows], u_max[rows], overturned[rows]))
    return curves


def fractile_curves(
    curves: list[IncrementalCurve], grid: ArrayLike, shares: ArrayLike = FRACTILES
) -> NDArray[Any]:
    """Fractiles of u_max given the intensity, (len(shares), m) [m]: inf where that share of the
    motions does not stand, nan where not all motions are known.

    Parameters
    ----------
    curves
        of all motions.
    grid
        (m,) intensities.
    shares
        in (0, 1]; the value of the motion of that rank, so that no number is made from one that
        overturned.
    """
    u = np.sort([curve.u_at(grid) for curve in curves], axis=0)  # nan comes last
    rank = np.maximum(np.ceil(np.round(np.array(shares) * len(curves), 9)).astype(int), 1) - 1
    return np.where(np.isnan(u).any(axis=0), np.nan, u[rank])


def first_overturning(
    lower: ArrayLike, upper: ArrayLike, records: Records = None
) -> FirstOverturning:
    """Lognormal distribution of the intensity of first overturning, by maximum likelihood of what
    is known of each motion.

    ln L = sum ln(Phi((ln upper - ln median) / beta) - Phi((ln lower - ln median) / beta)): of a
    motion that overturns between two scales the part between, of one that never does the tail
    (Baker 2015, Earthq. Spectra 31, with the intervals kept). In the variables 1/beta and
    ln(median)/beta the likelihood is concave. Motions are independent, their scales are not
    counted. The covariance is the inverse of the observed information times n / (n - 1), and
    intervals take Student's t. Each record counts once, however many motions are made of it: the m
    motions of a record have the weight 1 / m each, and n is the number of records, as if the
    motions of a record told nothing but what one of them does.

    Parameters
    ----------
    lower, upper
        (n,) intensities between which each motion first overturns; 0 and inf for not known. A
        motion of which neither end is known tells nothing: it is left out, and n of what is
        returned counts the others.
    records
        (n,) record of each motion, None where each has one of its own.

    Raises
    ------
    DegenerateData
        nothing is known of any motion; all are of one record; none overturns; or one intensity
        parts all motions that stood from all that overturned: the slope is unbounded.
    ValueError
        intervals that are none.
    """
    lower, upper = np.asarray(lower, float), np.asarray(upper, float)
    if (
        lower.shape != upper.shape
        or lower.ndim != 1
        or not lower.size
        or not (lower >= 0).all()
        or not (lower < upper).all()
    ):
        raise ValueError("lower and upper must be lists of one length with 0 <= lower < upper")
    names = list(range(lower.size) if records is None else records)
    record_numbers(names, lower.size)  # as many as motions
    known = (lower > 0) | np.isfinite(upper)
    if not known.any():
        raise DegenerateData(f"of none of {known.size} motions anything is known")
    lower, upper = np.asarray(lower[known]), np.asarray(upper[known])
    n, fallen = lower.size, int(np.isfinite(upper).sum())
    numbers = record_numbers([names[place] for place in np.flatnonzero(known)], n)
    weight = np.ones(n) if numbers is None else 1 / np.bincount(numbers)[numbers]
    count = n if numbers is None else int(numbers.max()) + 1
    if count < 2:
        raise DegenerateData("all motions are of one record: no law of records can be told")
    if not fallen:
        raise DegenerateData(f"none of {n} motions overturns the column at any of its scales")
    if lower.max() <= upper.min():
        raise DegenerateData(
            "one intensity lies between the last standing and the first overturning of "
            "every motion: finer or more scales are needed"
        )
    with np.errstate(divide="ignore"):
        y_low, y_high = np.log(lower), np.log(upper)

    def likelihood(q: NDArray[Any]) -> tuple[float, NDArray[Any], NDArray[Any]]:
        high, low = _end(q, y_high), _end(q, y_low)
        log_p = _log_between(low, high)
        # densities over the probability of the interval; none at an end that lies at infinity
        d_high, d_low = (
            np.exp(-0.5 * end**2 - 0.5 * np.log(2 * np.pi) - log_p) for end in (high, low)
        )
        x_high, x_low = _rows(y_high), _rows(y_low)
        b_high, b_low = np.where(np.isfinite(high), high, 0), np.where(np.isfinite(low), low, 0)
        gradient = x_high.T @ (weight * d_high) - x_low.T @ (weight * d_low)
        cross = x_high.T @ ((weight * d_high * d_low)[:, None] * x_low)
        information = (
            x_high.T @ ((weight * d_high * (b_high + d_high))[:, None] * x_high)
            + x_low.T @ ((weight * d_low * (d_low - b_low))[:, None] * x_low)
            - cross
            - cross.T
        )
        return float((weight * log_p).sum()), gradient, information

    middle = np.where(
        np.isinf(y_high),
        y_low,
        np.where(np.isinf(y_low), y_high, (np.maximum(y_low, -700) + np.minimum(y_high, 700)) / 2),
    )
    beta = max(float(middle.std()), 0.1)
    q, covariance, loglik = maximize(
        likelihood, np.array([1.0, middle.mean()]) / beta, inside=lambda q: bool(q[0] > 0)
    )
    to_shape = np.array([[-q[1] / q[0] ** 2, 1 / q[0]], [-1 / q[0] ** 2, 0.0]])
    return FirstOverturning(
        median_of(-q[1], q[0]),
        float(1 / q[0]),
        count / (count - 1) * to_shape @ covariance @ to_shape.T,
        loglik,
        n,
        fallen,
        clusters=count,
    )


def _end(q: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
    """(y - ln median) / beta with q = (1, ln median) / beta; infinite ends stay."""
    return np.where(np.isfinite(y), q[0] * np.where(np.isfinite(y), y, 0) - q[1], y)


def _rows(y: NDArray[Any]) -> NDArray[Any]:
    """Derivatives (n, 2) of `_end` by q, 0 at infinite ends."""
    finite = np.isfinite(y)
    return np.column_stack([np.where(finite, y, 0), -1.0 * finite])


def _log_between(low: NDArray[Any], high: NDArray[Any]) -> NDArray[Any]:
    """ln(Phi(high) - Phi(low)), from the tail in which both are small."""
    flip = low > 0
    low, high = np.where(flip, -high, low), np.where(flip, -low, high)
    top = log_ndtr(high)
    return np.asarray(top + np.log1p(-np.exp(log_ndtr(low) - top)))
