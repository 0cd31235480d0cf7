"""Least squares by a model that is run, not written down, and profile likelihood: which values of
each parameter fit as well as the best, all others fitted anew.

With n independent residuals of one unknown normal scatter, twice the difference of log-likelihoods
of two parameter sets is n ln(S / S_min), S the sum of squares. A parameter's 95 % interval is
where this deviance, the others fitted anew, stays below the quantile 3.84 of chi-square with one
degree of freedom (Venzon & Moolgavkar 1988, Applied Statistics 37). A parameter whose deviance
stays below it up to the end of its range is not identified there (Raue et al. 2009, Bioinformatics
25). Residuals of neighbouring samples hang together: with their autocorrelation r of lag one, n
samples count as n (1 - r) / (1 + r).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.stats import chi2, qmc

#: Twice the difference of log-likelihoods at the ends of a 95 % interval
THRESHOLD = float(chi2.ppf(0.95, 1))
# Trials over the whole range for each parameter; the best few are starts of a descent
_TRIALS, _STARTS = 24, 3
_DESCENT = 40  # runs of a descent for each parameter
_INNER = 15  # the same, of the others along a profile
_REACH = 11  # steps of a profile, each twice the one before, the last to the end of the range
_BISECTIONS = 6
_SETTLED = 1e-4  # of the range: descents end

#: Residuals (n,) at parameters (d,), each from 0 to 1 over its range
Residuals = Callable[[NDArray[Any]], NDArray[Any]]


@dataclass(frozen=True, slots=True)
class ProfiledParameter:
    """One parameter, in shares of its range.

    Attributes
    ----------
    best
        value of the best fit.
    low, high
        ends of the 95 % interval; None where the range ends before it does.
    at, deviance
        (m,) values looked at, rising, and their deviances.
    """

    best: float
    low: float | None
    high: float | None
    at: NDArray[Any]
    deviance: NDArray[Any]

    @property
    def identified(self) -> bool:
        """Whether the interval ends within the range at both sides."""
        return self.low is not None and self.high is not None

    @property
    def free(self) -> bool:
        """Whether any value of the range fits as well as the best."""
        return self.low is None and self.high is None


@dataclass(frozen=True, slots=True)
class ProfiledFit:
    """The best fit (d,) in shares of the ranges, its residuals (n,), the number of independent
    samples that they count for, and each parameter.
    """

    best: NDArray[Any]
    residuals: NDArray[Any]
    independent: float
    parameters: tuple[ProfiledParameter, ...]

    @property
    def rms(self) -> float:
        """Root mean square of the residuals."""
        return float(np.sqrt(np.mean(self.residuals**2)))


def most_runs(d: int) -> int:
    """Runs that a fit of d parameters and its profiles take, about; for a progress line."""
    inner = _INNER * (d - 1) if d > 1 else 1
    return _TRIALS * d + _STARTS * _DESCENT * d + 2 * d * (_REACH + _BISECTIONS) * inner


def profiled_fit(residuals: Residuals, d: int) -> ProfiledFit:
    """Best fit of d parameters, and their profiles.

    Parameters
    ----------
    residuals
        of parameters (d,) in [0, 1]; infinite ones of a run that failed.
    """
    known: dict[tuple[float, ...], float] = {}

    def squares(u: NDArray[Any]) -> float:
        place = tuple(float(x) for x in np.round(np.clip(u, 0, 1), 9))
        if place not in known:
            known[place] = float(np.sum(residuals(np.array(place)) ** 2))
        return known[place]

    trials = qmc.LatinHypercube(d, seed=0).random(_TRIALS * d)
    starts = sorted(trials, key=squares)[:_STARTS]
    best = min((_descent(squares, start, _DESCENT * d) for start in starts), key=squares)
    for _ in range(3):  # a profile may find a better fit than the best: then it begins there
        left = residuals(best)
        independent = effective_number(left)
        found, better = [], best
        for place in range(d):
            one, seen = _profile(squares, best, place, independent)
            found.append(one)
            better = min((better, seen), key=squares)
        if independent * math.log(max(squares(best), 1e-300) / max(squares(better), 1e-300)) < 0.1:
            break
        best = _descent(squares, better, _DESCENT * d)
    return ProfiledFit(best, left, independent, tuple(found))


def effective_number(residuals: NDArray[Any]) -> float:
    """Independent samples that residuals count for, by their autocorrelation of lag one."""
    size, total = residuals.size, float(np.sum(residuals**2))
    if not 0 < total < math.inf:
        return float(size)
    r = min(max(float(residuals[1:] @ residuals[:-1]) / total, 0.0), 0.999)
    return max(size * (1 - r) / (1 + r), 2.0)


def _descent(
    squares: Callable[[NDArray[Any]], float], start: NDArray[Any], runs: int
) -> NDArray[Any]:
    """Nelder and Mead's descent within the ranges; of the logarithm, so that it settles alike
    whatever the scatter.
    """
    step = 0.05
    simplex = np.clip(np.vstack([start, start + step * np.eye(start.size)]), 0, 1)
    for place in range(start.size):
        if simplex[place + 1, place] == start[place]:
            simplex[place + 1, place] -= step
    found = minimize(
        lambda u: math.log(max(min(squares(u), 1e300), 1e-300)),
        start,
        method="Nelder-Mead",
        bounds=[(0, 1)] * start.size,
        options={
            "maxfev": runs,
            "xatol": _SETTLED,
            "fatol": 1e-6,
            "initial_simplex": simplex,
        },
    )
    return np.asarray(found.x, float)


def _profile(
    squares: Callable[[NDArray[Any]], float], best: NDArray[Any], place: int, number: float
) -> tuple[ProfiledParameter, NDArray[Any]]:
    """Profile of one parameter, and the best fit that it met."""
    least = max(squares(best), 1e-300)
    at, deviances, seen = [float(best[place])], [0.0], best

    def look(value: float, others: NDArray[Any]) -> NDArray[Any]:
        nonlocal seen
        fitted = np.insert(others, place, value)
        if others.size:
            inner = _descent(
                lambda rest: squares(np.insert(rest, place, value)), others, _INNER * others.size
            )
            fitted = min((fitted, np.insert(inner, place, value)), key=squares)
        at.append(value)
        deviances.append(number * math.log(max(squares(fitted), 1e-300) / least))
        seen = min((seen, fitted), key=squares)
        return np.delete(fitted, place)

    ends: list[float | None] = []
    for side in (0.0, 1.0):
        others, inside, outside = np.delete(best, place), float(best[place]), None
        span = side - inside
        for power in range(_REACH - 1, -1, -1):
            if not span:
                break
            others = look(inside_of := float(best[place]) + span / 2**power, others)
            if deviances[-1] > THRESHOLD:
                outside = inside_of
                break
            inside = inside_of
        if outside is None:
            ends.append(None)
            continue
        for _ in range(_BISECTIONS):
            middle = (inside + outside) / 2
            others = look(middle, others)
            if deviances[-1] > THRESHOLD:
                outside = middle
            else:
                inside = middle
        ends.append(outside)
    order = np.argsort(at, kind="stable")
    parameter = ProfiledParameter(
        float(best[place]), ends[0], ends[1], np.array(at)[order], np.array(deviances)[order]
    )
    return parameter, seen
