"""Fragility: probability of overturning over one or two intensity measures, from ensembles scaled
or as they come.

Runs of one motion scaled to several levels are not independent: their number overstates what is
known. `groups` tells the motion of each run; the curve stays, and its intervals know of the motions
(`fit_binary`). See `statistics.incremental` for the intensity at which each motion first overturns
the column.

Intervals are those of the line a + b ln(im) that is the argument of Phi, with a slope b >= 0, as
its coefficients are nearly normal and the median, -a/b in logarithms, is not. Where the slope is
not told from 0 the median is not bounded, and its interval ends at 0 or inf.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit, ndtr, stdtrit

from fecolumn.statistics.bands import normal_quantile
from fecolumn.statistics.binary_regression import OVERTURN, DegenerateData, fit_binary

__all__ = [
    "DegenerateData",
    "Fragility",
    "LogitFragility",
    "Probability",
    "lognormal",
    "logit",
    "log_columns",
    "median_of",
    "exp_or_inf",
]

# Logarithm that exp turns into a number: doubles end at exp(709.8)
_LARGEST_LOG = 700.0


@dataclass(frozen=True, slots=True)
class Probability:
    """Probability with its pointwise band, arrays of one shape."""

    p: NDArray[Any]
    lower: NDArray[Any]
    upper: NDArray[Any]


@dataclass(frozen=True, slots=True)
class Fragility:
    """P(overturn | im) = Phi(ln(im / median) / beta).

    Attributes
    ----------
    median
        intensity at which half overturn [unit of im].
    beta
        logarithmic standard deviation [-].
    covariance
        (2, 2) of (ln median, beta), inverse of the observed information, or that of whole motions.
    loglik
        log-likelihood at the maximum.
    n, overturned
        runs, and how many overturned.
    clusters
        motions, where runs repeat them: intervals then take Student's t with one degree of freedom
        less; None for independent runs.
    fit
        what statsmodels has fitted, over a column of ones and ln im: fit.summary(), and
        fit.get_influence() of single runs; None of a curve by another likelihood.
    """

    median: float
    beta: float
    covariance: NDArray[Any]
    loglik: float
    n: int
    overturned: int
    clusters: int | None = None
    fit: object = field(default=None, repr=False, compare=False)

    @property
    def parameters(self) -> NDArray[Any]:
        """(median, beta)."""
        return np.array([self.median, self.beta])

    def quantile(self, confidence: float) -> float:
        """Half width of an interval over the standard error."""
        return _quantile(self.clusters, confidence)

    def median_interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Interval of the median: intensities at which the band of `probability` holds 1/2.

        Fieller (1954), Journal of the Royal Statistical Society B 16, of the ratio -a/b, with the
        part of b >= 0: from 0 or to inf where the slope is not told from 0.
        """
        (v, c), (_, w) = self.quantile(confidence) ** 2 * self.covariance / self.beta**2
        square = c * c + (1 - w) * v
        if square <= 0:
            return 0.0, math.inf
        # z^2 <= v + 2 c z + w z^2, of z = ln(end / median) / beta
        root, reach = math.sqrt(square), self.beta * v
        low = self.median * exp_or_inf(-reach / (root + c)) if root + c > 0 else 0.0
        high = self.median * exp_or_inf(reach / (root - c)) if root - c > 0 else math.inf
        return low, high

    def beta_interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Interval of beta, that of the slope 1/beta turned over; inf where that reaches 0."""
        share = self.quantile(confidence) * math.sqrt(self.covariance[1, 1]) / self.beta
        return self.beta / (1 + share), self.beta / (1 - share) if share < 1 else math.inf

    def region(self, confidence: float = 0.95, number: int = 361) -> NDArray[Any]:
        """Coefficients (number, 2) of a + b ln(im), the argument of Phi, around the ellipse whose
        least and largest value of any one quantity are the ends of that quantity's interval, as far
        as b >= 0.

        Venzon & Moolgavkar (1988), Applied Statistics 37, with ln L as its parabola.
        """
        m, slope = math.log(self.median), 1 / self.beta
        to_line = np.array([[-slope, m * slope**2], [0.0, -(slope**2)]])
        (aa, ab), (_, bb) = to_line @ self.covariance @ to_line.T
        reach = self.quantile(confidence) * math.sqrt(bb)
        turn = math.acos(-slope / reach) if slope < reach else math.pi
        angle = np.linspace(-turn, turn, number)
        b = np.maximum(slope + reach * np.cos(angle), 0.0)
        own = math.sqrt(max(aa * bb - ab * ab, 0.0))  # of a, besides what goes with b
        return np.column_stack(
            [-m * slope + reach / bb * (ab * np.cos(angle) + own * np.sin(angle)), b]
        )

    def probability(self, im: ArrayLike, confidence: float = 0.95) -> Probability:
        """P(overturn) at intensities im (any shape), its band by the delta method on the scale of
        Phi's argument.
        """
        eta = np.log(np.asarray(im, float) / self.median) / self.beta
        gradient = np.stack([-np.ones_like(eta), -eta], axis=-1) / self.beta
        reach = self.quantile(confidence) * _deviation(gradient, self.covariance)
        return Probability(ndtr(eta), ndtr(eta - reach), ndtr(eta + reach))


@dataclass(frozen=True, slots=True)
class LogitFragility:
    """P(overturn | im) = 1 / (1 + exp(-(c0 + c1 ln im_1 + c2 ln im_2 ...))).

    Attributes
    ----------
    coefficients
        (k + 1,) c.
    covariance
        (k + 1, k + 1) of c, inverse of the observed information.
    loglik
        log-likelihood at the maximum; with one more intensity measure 2 (difference) is chi-square
        with one degree of freedom where that measure tells nothing.
    n, overturned
        runs, and how many overturned.
    clusters, fit
        as of Fragility.
    """

    coefficients: NDArray[Any]
    covariance: NDArray[Any]
    loglik: float
    n: int
    overturned: int
    clusters: int | None = None
    fit: object = field(default=None, repr=False, compare=False)

    @property
    def parameters(self) -> NDArray[Any]:
        """The coefficients."""
        return self.coefficients

    def probability(self, im: ArrayLike, confidence: float = 0.95) -> Probability:
        """P(overturn) at im (m, k), or (m,) of one measure, with its band by the delta method on
        the scale of the logit.
        """
        x = log_columns(im, len(self.coefficients) - 1)
        quantile = _quantile(self.clusters, confidence)
        eta, reach = x @ self.coefficients, quantile * _deviation(x, self.covariance)
        return Probability(expit(eta), expit(eta - reach), expit(eta + reach))


def _quantile(clusters: int | None, confidence: float) -> float:
    """Of the normal distribution, or of Student's where runs come in clusters."""
    if clusters is None:
        return normal_quantile(confidence)
    return float(stdtrit(clusters - 1, (1 + confidence) / 2))


def median_of(a: float, b: float, event: str = OVERTURN) -> float:
    """Median exp(-a/b) of Phi(a + b ln im); event: as of `fit_binary`.

    Raises
    ------
    DegenerateData
        no number holds it, so flat is the line.
    """
    if abs(a) > _LARGEST_LOG * b:
        raise DegenerateData(
            f"{_noun(event)} hardly depends on the intensity measure: half would "
            f"{'overturn' if event == OVERTURN else 'be beyond the limit'} at no intensity that a "
            "number can tell"
        )
    return math.exp(-a / b)


def _noun(event: str) -> str:
    return "overturning" if event == OVERTURN else event


def exp_or_inf(x: float) -> float:
    """exp, inf beyond the largest number."""
    return math.exp(x) if x < _LARGEST_LOG else math.inf


def lognormal(
    im: ArrayLike,
    overturned: ArrayLike,
    groups: ArrayLike | None = None,
    event: str = OVERTURN,
) -> Fragility:
    """Lognormal fragility by maximum likelihood.

    Shinozuka et al. (2000), Journal of Engineering Mechanics 126; Baker (2015), Earthquake Spectra
    31.

    Serves multiple stripes, incremental analyses and unscaled motions alike, each run being one yes
    or no.

    Parameters
    ----------
    im
        (n,) positive intensity of each run.
    overturned
        (n,) True where the column overturned.
    groups
        (n,) motion of each run, where motions come at several scales; None takes all runs as
        independent.
    event
        what `overturned` tells, for messages, as of `fit_binary`.

    Raises
    ------
    DegenerateData
        all or none overturned, fewer than two motions, intensities that part the two, or
        overturning that gets rarer with intensity.
    ValueError
        intensities that are not positive, lengths that differ.
    """
    im, overturned = np.asarray(im, float), np.asarray(overturned, bool)
    x = _data(im.reshape(-1), overturned)
    fit, covariance, clusters = fit_binary(x, overturned, "probit", groups, event)
    a, b = fit.params
    if b <= 0:
        raise DegenerateData(
            f"{_noun(event)} gets rarer with the intensity measure: it has no lognormal "
            "fragility; logit() shows the trend"
        )
    to_shape = np.array([[-1 / b, a / b**2], [0.0, -1 / b**2]])
    return Fragility(
        median_of(a, b, event),
        1 / b,
        to_shape @ covariance @ to_shape.T,
        float(fit.llf),
        overturned.size,
        int(overturned.sum()),
        clusters,
        fit,
    )


def logit(im: ArrayLike, overturned: ArrayLike, groups: ArrayLike | None = None) -> LogitFragility:
    """Logistic regression on the logarithms of one or more intensity measures.

    Parameters
    ----------
    im
        (n, k) or (n,) positive intensities of each run.
    overturned
        (n,) True where the column overturned.
    groups
        as of `lognormal`.

    Raises
    ------
    DegenerateData, ValueError
        as of `lognormal`, but for the direction of the trend.
    """
    overturned = np.asarray(overturned, bool)
    x = _data(im, overturned)
    fit, covariance, clusters = fit_binary(x, overturned, "logit", groups)
    return LogitFragility(
        fit.params,
        covariance,
        float(fit.llf),
        overturned.size,
        int(overturned.sum()),
        clusters,
        fit,
    )


def log_columns(im: ArrayLike, k: int | None = None) -> NDArray[Any]:
    """Matrix (n, k + 1) of a column of ones and ln im; im is (n, k), or (n,) of one measure.

    Raises
    ------
    ValueError
        another number of measures than k, or an intensity that is not positive.
    """
    im = np.asarray(im, float)
    im = im[:, None] if im.ndim == 1 else im
    if im.ndim != 2 or (k is not None and im.shape[1] != k):
        raise ValueError(
            f"im {im.shape}: must be (n, {k or 'k'})" + (", or (n,)" if k in (None, 1) else "")
        )
    if not (np.isfinite(im) & (im > 0)).all():
        raise ValueError("intensities must be positive and finite")
    return np.column_stack([np.ones(len(im)), np.log(im)])


def _data(im: ArrayLike, overturned: NDArray[Any]) -> NDArray[Any]:
    x = log_columns(im)
    if overturned.ndim != 1 or len(x) != overturned.size:
        raise ValueError(
            f"im of {len(x)} runs and overturned {overturned.shape}: must have one length"
        )
    return x


def _deviation(gradient: NDArray[Any], covariance: NDArray[Any]) -> NDArray[Any]:
    """Standard deviation of a linear form of the parameters, its gradient along the last axis."""
    return np.asarray(np.sqrt(np.einsum("...i,ij,...j->...", gradient, covariance, gradient)))
