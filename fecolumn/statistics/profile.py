"""Least squares by a model that is run, not written down, and profile likelihood: which values of
each parameter fit as well as the best, all others fitted anew.

With n independent residuals of one unknown normal scatter, twice the difference of log-likelihoods
of two parameter sets is n ln(S / S_min), S the sum of squares. A parameter's 95 % interval is
where this deviance, the others fitted anew, stays below the quantile 3.84 of chi-square with one
degree of freedom (Venzon & Moolgavkar 1988, Applied Statistics 37). A parameter whose deviance
stays below it up to the end of its range is not identified there (Raue et al. 2009, Bioinformatics
25). Residuals of neighbouring samples hang together: with their autocorrelation r of lag one, n
samples count as n (1 - r) / (1 + r).

S may have many minima: after an impact on a pad the tilt depends on the phase of its bounces. The
descents therefore start at every minimum of a Sobol sequence of trials, which is doubled until it
leads to no better fit, then at those of trials close to the best one. Other minima that fit as well
as the best belong to the interval.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.spatial import cKDTree
from scipy.stats import chi2, qmc

#: Twice the difference of log-likelihoods at the ends of a 95 % interval
THRESHOLD = float(chi2.ppf(0.95, 1))
# Trials over the whole range for each parameter, doubled so many times at most; at each stage
# descents start at the best of their minima, until so many have led to worse fits, or so many all
# in all
_TRIALS, _DOUBLINGS, _STARTS, _MOST_STARTS = 32, 3, 3, 12
# Way from the best fit, over the range, within which others are looked for in the same way: bounces
# on a pad have minima a thousandth of two decades apart
_BESIDE = 5e-3
_DESCENT = 40  # runs of a descent for each parameter
_INNER = 15  # the same, of the others along a profile
_REACH = 11  # steps of a profile, each twice the one before, the last to the end of the range
_BISECTIONS = 6
_SETTLED = 1e-4  # of the range: descents end
_APART = 1e-3  # of the range: minima that are nearer are one
# Deviance by which a fit has to be better to be another one
_BETTER = 0.1
# Correlation from which on two parameters trade
_TRADED = 0.8

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
    fitted
        (m, d) parameters there, the others fitted anew.
    apart
        values of other fits within the interval that are as good as the best, and which worse ones
        separate from it.
    """

    best: float
    low: float | None
    high: float | None
    at: NDArray[Any]
    deviance: NDArray[Any]
    fitted: NDArray[Any]
    apart: tuple[float, ...] = ()

    @property
    def identified(self) -> bool:
        """Whether the interval ends within the range at both sides."""
        return self.low is not None and self.high is not None

    @property
    def free(self) -> bool:
        """Whether any value of the range fits as well as the best."""
        return self.low is None and self.high is None and not self.apart


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

    def trades(self) -> list[tuple[int, int]]:
        """Pairs of parameters that hang together: along either's interval the other, fitted anew,
        goes through most of its own. Of a normal distribution the share is their correlation.
        """
        d = len(self.parameters)
        return [
            (a, b)
            for a in range(d)
            for b in range(a + 1, d)
            if min(self._followed(a, b), self._followed(b, a)) >= _TRADED
        ]

    def _followed(self, place: int, other: int) -> float:
        """Share of another parameter's interval through which it goes along that of `place`."""
        one, two = self.parameters[place], self.parameters[other]
        path = one.fitted[one.deviance <= THRESHOLD, other]
        low, high = 0.0 if two.low is None else two.low, 1.0 if two.high is None else two.high
        return float(np.ptp(path) / max(high - low, _SETTLED))


class _Squares:
    """Sum of squares at parameters (d,); what has been looked at is not run again."""

    def __init__(self, residuals: Residuals) -> None:
        self._residuals = residuals
        self._known: dict[tuple[float, ...], float] = {}

    def __call__(self, u: NDArray[Any]) -> float:
        place = tuple(float(x) for x in np.round(np.clip(u, 0, 1), 9))
        if place not in self._known:
            self._known[place] = float(np.sum(self._residuals(np.array(place)) ** 2))
        return self._known[place]

    def deviance(self, u: NDArray[Any], best: NDArray[Any], number: float) -> float:
        """Deviance at u from the best fit, of so many independent samples."""
        return number * math.log(max(self(u), 1e-300) / max(self(best), 1e-300))


def most_runs(d: int) -> int:
    """Runs that a fit of d parameters and its profiles usually take at most; for a progress line:
    a fit of many minima takes more.
    """
    inner = _INNER * (d - 1) if d > 1 else 1
    return 3 * _first(d) + _STARTS * _DESCENT * d + 2 * d * (_REACH + _BISECTIONS) * inner


def profiled_fit(residuals: Residuals, d: int) -> ProfiledFit:
    """Best fit of d parameters, and their profiles.

    Parameters
    ----------
    residuals
        of parameters (d,) in [0, 1]; infinite ones of a run that failed.
    """
    squares = _Squares(residuals)
    minima = _minima(squares, residuals, d)
    for _ in range(3):  # a profile may find a better fit than the best: then it begins there
        best = minima[0]
        left = residuals(best)
        number = effective_number(left)
        alike = [one for one in minima if squares.deviance(one, best, number) <= THRESHOLD]
        profiles = [_Profile(squares, place, number, alike) for place in range(d)]
        found = tuple(profile.parameter() for profile in profiles)
        better = min((profile.seen for profile in profiles), key=squares)
        if squares.deviance(better, best, number) > -_BETTER:
            break
        minima = [_descent(squares, better, _DESCENT * d), *minima]
    return ProfiledFit(best, left, number, found)


def _first(d: int) -> int:
    """Trials at first: a power of 2, as the sequence of Sobol wants."""
    return int(2 ** math.ceil(math.log2(_TRIALS * d)))


def _minima(squares: _Squares, residuals: Residuals, d: int) -> list[NDArray[Any]]:
    """Minima (d,) that descents lead to, the best first."""
    sequence = qmc.Sobol(d, scramble=True, seed=0)
    trials = sequence.random(_first(d))
    minima: list[NDArray[Any]] = []
    for stage in range(_DOUBLINGS + 1):
        if stage:
            trials = np.vstack([trials, sequence.random(len(trials))])
        spacing = len(trials) ** (-1 / d)
        before = minima[0] if minima else None
        _descend(squares, residuals, trials, minima, spacing)
        minima.sort(key=squares)
        number = effective_number(residuals(minima[0]))
        if before is not None and squares.deviance(minima[0], before, number) > -_BETTER:
            break
    for stage in range(_DOUBLINGS):
        best = minima[0]
        beside = qmc.Sobol(d, scramble=True, seed=stage).random(_first(d))
        trials = np.clip(best + _BESIDE * (2 * beside - 1), 0, 1)
        _descend(squares, residuals, trials, minima, 2 * _BESIDE * len(trials) ** (-1 / d))
        minima.sort(key=squares)
        if minima[0] is best:
            break
    return minima


def _descend(
    squares: _Squares,
    residuals: Residuals,
    trials: NDArray[Any],
    minima: list[NDArray[Any]],
    spacing: float,
) -> None:
    """Add to the minima what descents from the best of the trials (n, d) lead to, until _STARTS of
    them have led to worse fits; spacing: of the trials.
    """
    worse = 0
    for start in _starts(squares, trials, minima, spacing)[:_MOST_STARTS]:
        minima.append(_descent(squares, start, _DESCENT * start.size, spacing / 4))
        best = min(minima, key=squares)
        number = effective_number(residuals(best))
        worse += squares.deviance(minima[-1], best, number) > THRESHOLD
        if worse == _STARTS:
            break


def _starts(
    squares: _Squares, trials: NDArray[Any], minima: list[NDArray[Any]], spacing: float
) -> list[NDArray[Any]]:
    """Of trials (n, d) those that are better than their neighbours, the best first; none so near to
    a minimum that is known that a descent would lead there again.
    """
    values = np.array([squares(trial) for trial in trials])
    _, near = cKDTree(trials).query(trials, k=2 * trials.shape[1] + 1)
    lowest = [k for k in np.argsort(values, kind="stable") if values[k] <= values[near[k]].min()]
    return [
        trials[k]
        for k in lowest
        if not any(np.abs(trials[k] - one).max() <= spacing for one in minima)
    ]


def effective_number(residuals: NDArray[Any]) -> float:
    """Independent samples that residuals count for, by their autocorrelation of lag one."""
    size, total = residuals.size, float(np.sum(residuals**2))
    if not 0 < total < math.inf:
        return float(size)
    r = min(max(float(residuals[1:] @ residuals[:-1]) / total, 0.0), 0.999)
    return max(size * (1 - r) / (1 + r), 2.0)


def _descent(
    squares: Callable[[NDArray[Any]], float], start: NDArray[Any], runs: int, step: float = 0.05
) -> NDArray[Any]:
    """Nelder and Mead's descent within the ranges; of the logarithm, so that it settles alike
    whatever the scatter. The first step is a share `step` of the range.
    """
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


class _Profile:
    """Profile of the parameter `place`; `seen` is the best fit (d,) that it met.

    Parameters
    ----------
    number
        independent samples.
    alike
        fits (d,) as good as the best, which comes first.
    """

    def __init__(
        self, squares: _Squares, place: int, number: float, alike: list[NDArray[Any]]
    ) -> None:
        self._squares, self._place, self._number = squares, place, number
        self._alike = sorted(alike, key=lambda one: float(one[place]))
        self._best = self.seen = alike[0]
        self._fitted: list[NDArray[Any]] = [*alike]
        self._deviances = [squares.deviance(one, self._best, number) for one in alike]

    def parameter(self) -> ProfiledParameter:
        """Walk from the outermost of the fits that are alike to the ends of the interval."""
        low, high = self._end(self._alike[0], 0.0), self._end(self._alike[-1], 1.0)
        apart = self._apart()
        fitted = np.array(self._fitted)
        order = np.argsort(fitted[:, self._place], kind="stable")
        return ProfiledParameter(
            float(self._best[self._place]),
            low,
            high,
            fitted[order, self._place],
            np.array(self._deviances)[order],
            fitted[order],
            apart,
        )

    def _look(self, value: float, near: NDArray[Any]) -> tuple[float, NDArray[Any]]:
        """Deviance and parameters (d,) at a value, the others fitted from those of `near`."""
        place, others = self._place, np.delete(near, self._place)
        fitted = np.insert(others, place, value)
        if others.size:
            inner = _descent(
                lambda rest: self._squares(np.insert(rest, place, value)),
                others,
                _INNER * others.size,
            )
            fitted = min((fitted, np.insert(inner, place, value)), key=self._squares)
        self._fitted.append(fitted)
        self._deviances.append(self._squares.deviance(fitted, self._best, self._number))
        self.seen = min((self.seen, fitted), key=self._squares)
        return self._deviances[-1], fitted

    def _end(self, start: NDArray[Any], side: float) -> float | None:
        """End of the interval towards a side of the range; None where the range ends first."""
        inside, near = float(start[self._place]), start
        outside: float | None = None
        for power in range(_REACH - 1, -1, -1):
            value = float(start[self._place]) + (side - float(start[self._place])) / 2**power
            if value == inside:
                break
            deviance, near = self._look(value, near)
            if deviance > THRESHOLD:
                outside = value
                break
            inside = value
        if outside is None:
            return None
        for _ in range(_BISECTIONS):
            middle = (inside + outside) / 2
            deviance, near = self._look(middle, near)
            if deviance > THRESHOLD:
                outside = middle
            else:
                inside = middle
        return outside

    def _apart(self) -> tuple[float, ...]:
        """Values of the fits that are alike, but for the best, where worse ones lie between."""
        found = [[self._alike[0]]]
        for one in self._alike[1:]:
            last = found[-1][-1]
            a, b = float(last[self._place]), float(one[self._place])
            if b - a > _APART and self._look((a + b) / 2, last)[0] > THRESHOLD:
                found.append([])
            found[-1].append(one)
        groups = [group for group in found if not any(one is self._best for one in group)]
        return tuple(float(min(group, key=self._squares)[self._place]) for group in groups)
