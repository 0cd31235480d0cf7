"""Scale factors with which motions fit a target response spectrum, and sets of them whose mean and
dispersion do.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.schema import InputError, meant
from fecolumn.motions.record import UnusableRecord
from fecolumn.motions.text import check_end, read_text
from fecolumn.statistics.csv_table import check_columns, check_row, number_of, read_csv

_NEEDED = "period_s, sa_g or sa_m_s2, and sigma_ln where the dispersion shall fit, too"
_UNITS = {"sa_g": GRAVITY, "sa_m_s2": 1.0}
_KNOWN = ("period_s", *_UNITS, "sigma_ln")
# Passes of swaps at most, each of which tries every motion in every place
_PASSES = 20


@dataclass(frozen=True, slots=True)
class TargetSpectrum:
    """A target of pseudo-accelerations at 5 % damping.

    Attributes
    ----------
    periods
        (p,) rising [s].
    sa
        (p,) median over motions [m/s2].
    sigma
        (p,) standard deviation of ln sa; None where only the mean is asked for.
    """

    periods: NDArray[Any]
    sa: NDArray[Any]
    sigma: NDArray[Any] | None = None

    def within(self, low: float, high: float, count: int = 50) -> TargetSpectrum:
        """At `count` periods evenly spaced in logarithm between two [s], interpolated in the
        logarithms; the standard deviation over the logarithm of the period.
        """
        periods = np.geomspace(low, high, count)
        at, own = np.log(periods), np.log(self.periods)
        sigma = None if self.sigma is None else np.interp(at, own, self.sigma)
        return TargetSpectrum(periods, np.exp(np.interp(at, own, np.log(self.sa))), sigma)


def read_target_spectrum(path: Path | str) -> TargetSpectrum:
    """Target spectrum of a CSV file with columns period_s, sa_g or sa_m_s2 and, if the dispersion
    counts, sigma_ln.

    Raises
    ------
    InputError
        no such file or columns, others than these, a value that cannot be, periods that do not
        rise, a file cut off inside its last number.
    """
    path = Path(path)
    header, rows = read_csv(path, _NEEDED)
    check_columns(path, header, ("period_s",))
    own = [name for name in header if name in _UNITS]
    if len(own) != 1 or header.count("sigma_ln") > 1:
        raise InputError(path, "header", ", ".join(header), f"must have columns {_NEEDED}")
    for name in header:
        if name not in _KNOWN:
            told = f"is not known; must be one of {', '.join(_KNOWN)}{meant(name, _KNOWN)}"
            raise InputError(path, "header", name, told)
    try:
        check_end(read_text(path), [row[-1] for _, row in rows[-12:]])
    except UnusableRecord as error:
        raise InputError(path, f"line {rows[-1][0]}", None, str(error)) from None
    names = ["period_s", own[0], *(["sigma_ln"] if "sigma_ln" in header else [])]
    values = []
    for number, row in rows:
        check_row(path, header, number, row)
        values.append([_value(path, number, name, row[header.index(name)]) for name in names])
        if len(values) > 1 and not values[-1][0] > values[-2][0]:
            told = f"must be greater than the line before it, {values[-2][0]:g} s"
            raise InputError(path, f"line {number}, period_s", values[-1][0], told)
    if len(values) < 2:
        raise InputError(path, "", None, "must have two periods at least")
    table = np.array(values).T
    sa = table[1] * _UNITS[own[0]]
    if sa.max() > 100 * GRAVITY:
        raise InputError(
            path,
            own[0],
            float(table[1].max()),
            f"is {sa.max() / GRAVITY:.4g} g: must be at most 100 g; is it another unit?",
        )
    return TargetSpectrum(table[0], sa, table[2] if len(table) > 2 else None)


def _value(path: Path, number: int, name: str, cell: str) -> float:
    low, high = {"period_s": (1e-3, 100.0), "sigma_ln": (0.0, 3.0)}.get(name, (0.0, 1e6))
    value = number_of(cell)
    if not (low <= value <= high and (value > 0 or name == "sigma_ln")):
        told = f"must be a number greater than 0 and at most {high:g}"
        if low:
            told = f"must be a number from {low:g} to {high:g}"
        raise InputError(path, f"line {number}, {name}", cell, told)
    return value


def scale_factors(spectra: NDArray[Any], target: NDArray[Any]) -> NDArray[Any]:
    """Factors (n,) with which spectra (n, p) fit a target (p,) best: least squares of the
    differences of their logarithms, so that the geometric means over the periods agree.
    """
    found: NDArray[Any] = np.exp((np.log(target) - np.log(spectra)).mean(axis=1))
    return found


def misfits(spectra: NDArray[Any], target: NDArray[Any]) -> NDArray[Any]:
    """Root mean square (n,) over the periods of ln(spectrum / target)."""
    found: NDArray[Any] = np.sqrt((np.log(spectra / target) ** 2).mean(axis=1))
    return found


def distance_of_set(logs: NDArray[Any], target: TargetSpectrum) -> float:
    """Mean over the periods of the squared error of the mean of logarithms (n, p), and of their
    standard deviation where the target has one (Jayaram, Lin and Baker 2011, equation 6).
    """
    error = (logs.mean(axis=0) - np.log(target.sa)) ** 2
    if target.sigma is not None:
        spread = logs.std(axis=0, ddof=1) if len(logs) > 1 else np.zeros(logs.shape[1])
        error = error + (spread - target.sigma) ** 2
    return float(error.mean())


def select_motions(spectra: NDArray[Any], target: TargetSpectrum, n: int) -> list[int]:
    """Rows of n of the spectra (m, p) whose mean and dispersion fit a target at the same periods.

    Greedy, after Jayaram, Lin and Baker (2011) and Baker and Lee (2018): one motion after another
    is taken, each that with which the set is nearest to the target; then each is exchanged for
    whichever of all motions brings it nearer, until none does.
    """
    logs = np.log(spectra)
    chosen: list[int] = []
    for _ in range(n):
        left = [row for row in range(len(logs)) if row not in chosen]
        chosen.append(min(left, key=lambda row: distance_of_set(logs[[*chosen, row]], target)))
    best = distance_of_set(logs[chosen], target)
    for _ in range(_PASSES):
        before = best
        for place in range(n):
            for row in range(len(logs)):
                other = [*chosen[:place], row, *chosen[place + 1 :]]
                if row not in chosen and (found := distance_of_set(logs[other], target)) < best:
                    chosen, best = other, found
        if best == before:
            break
    return sorted(chosen)
