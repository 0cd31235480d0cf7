"""Maximum likelihood of yes-no data: P(yes) = link(X c), by Newton's method, with data that have no maximum refused."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import expit, log_expit, log_ndtr

_MAX_ITERATIONS, _TOLERANCE = 100, 1e-10


class DegenerateData(ValueError):
    """No curve can be fitted, as the likelihood has no maximum; the message says why."""


@dataclass(frozen=True, slots=True)
class BinaryFit:
    """Maximum of the likelihood: c (p,), inverse of the observed information (p, p), log-likelihood."""

    coefficients: np.ndarray
    covariance: np.ndarray
    loglik: float


def fit_binary(x: np.ndarray, yes: np.ndarray, link: str) -> BinaryFit:
    """Fit c of P(yes) = link(x c).

    Args:
        x: (n, p) with a column of ones first.
        yes: (n,) bool.
        link: "probit" or "logit"; both likelihoods are concave.

    Raises:
        DegenerateData: all or none yes; a column that repeats others; a plane that parts yes from no (Albert & Anderson 1984,
            Biometrika 71).
    """
    refuse_degenerate(x, yes)
    terms = _link(link)
    sign = np.where(yes, 1.0, -1.0)[:, None] * x
    return BinaryFit(*maximize(lambda c: _likelihood(terms, sign, c), np.zeros(x.shape[1])))


def clustered_covariance(x: np.ndarray, yes: np.ndarray, link: str, fit: BinaryFit, groups) -> tuple[np.ndarray, int]:
    """Covariance (p, p) of the coefficients where the runs of a group hang together, and the number of groups.

    H^-1 (sum of g g^T over the groups) H^-1 G / (G - 1), with the score g of each of G groups (Liang & Zeger 1986, Biometrika 73).

    Args:
        x, yes, link: as of `fit_binary`; fit: its result.
        groups: (n,) label of each run.

    Raises:
        DegenerateData: one group only.
    """
    labels, group = np.unique(np.asarray(groups), return_inverse=True)
    if group.shape != yes.shape:
        raise ValueError(f"groups {group.shape} and {yes.shape} runs: must have one length")
    if labels.size < 2:
        raise DegenerateData("all runs are of one motion: nothing is known of others")
    sign = np.where(yes, 1.0, -1.0)[:, None] * x
    _, slope, _ = _link(link)(sign @ fit.coefficients)
    scores = np.zeros((labels.size, x.shape[1]))
    np.add.at(scores, group, slope[:, None] * sign)
    return labels.size / (labels.size - 1) * fit.covariance @ scores.T @ scores @ fit.covariance, labels.size


def maximize(function, start: np.ndarray, inside=lambda c: True) -> tuple[np.ndarray, np.ndarray, float]:
    """Maximum of a concave function by damped Newton steps: (c, inverse of -Hessian, value).

    Args:
        function: c -> (value, gradient (p,), minus Hessian (p, p)).
        start: (p,).
        inside: c -> whether c is allowed.
    """
    c, (value, gradient, information) = start, function(start)
    for _ in range(_MAX_ITERATIONS):
        step = np.linalg.solve(information, gradient)
        decrement, size = float(gradient @ step), 1.0
        if decrement < _TOLERANCE:
            return c, np.linalg.inv(information), float(value)
        while not inside(c + size * step) or function(c + size * step)[0] < value + 0.1 * size * decrement:
            size /= 2
            if size < 1e-10:
                raise DegenerateData("the likelihood has no maximum that Newton's method finds")
        c = c + size * step
        value, gradient, information = function(c)
    raise DegenerateData("the likelihood rises without end: the data all but part into yes and no")


def refuse_degenerate(x: np.ndarray, yes: np.ndarray) -> None:
    """Raise DegenerateData where the likelihood has no finite maximum."""
    k, n = int(yes.sum()), yes.size
    if k in (0, n):
        raise DegenerateData(f"{'none' if k == 0 else 'all'} of {n} runs overturned: only a bound of P(overturn) can be told: proportion_interval")
    # columns alike but for one part in 1e5, such as peaks of pulses of one shape, leave the information singular to rounding
    spread = x[:, 1:] - x[:, 1:].mean(axis=0)
    size = np.maximum(np.abs(spread).max(axis=0), 1e-9 * np.abs(x[:, 1:]).max(axis=0) + 1e-300)
    if np.linalg.matrix_rank(spread / size, tol=1e-5 * np.sqrt(len(x))) < spread.shape[1]:
        raise DegenerateData("the intensity measures do not vary, or not independently of each other")
    if _separated(x, yes):
        raise DegenerateData("the intensity parts all runs that overturned from all that stood: the slope of the fragility is unbounded")


def _separated(x: np.ndarray, yes: np.ndarray) -> bool:
    """Whether some c has x c >= 0 for all yes and <= 0 for all no, not all of them 0 (Konis 2007, linear programme)."""
    if x.shape[1] == 2:
        low, high = x[~yes, 1], x[yes, 1]
        return bool(low.max() <= high.min() or high.max() <= low.min())
    from scipy.optimize import linprog

    signed = np.where(yes, 1.0, -1.0)[:, None] * (x / np.abs(x).max(axis=0))
    found = linprog(-signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(yes.size), bounds=(-1, 1), method="highs")
    return bool(-found.fun > 1e-7)


def _likelihood(terms, sign: np.ndarray, c: np.ndarray):
    log_p, slope, curvature = terms(sign @ c)
    return log_p.sum(), sign.T @ slope, sign.T @ (curvature[:, None] * sign)


def _link(name: str):
    return {"probit": _probit, "logit": _logit}[name]


def _probit(eta: np.ndarray):
    """ln Phi, its derivative, and minus its second derivative."""
    log_p = log_ndtr(eta)
    slope = np.exp(-0.5 * eta**2 - log_p) / np.sqrt(2 * np.pi)
    return log_p, slope, slope * (slope + eta)


def _logit(eta: np.ndarray):
    """ln of the logistic function, its derivative, and minus its second derivative."""
    return log_expit(eta), expit(-eta), expit(eta) * expit(-eta)
