"""Fragility surfaces over PGV and pulse period, and drums beside the monolith."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.stats import binomtest

from benchmarks.fragility.motions import PGV
from benchmarks.fragility.structures import ELASTIC
from fecolumn.engines.ending import OVERTURNED, SLID_OFF
from fecolumn.statistics.binary_regression import DegenerateData, fit_binary
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.store import FAILED

#: Pulse periods [s] at which the PGV that overturns half is told.
PERIODS = (0.7, 1.5, 3.0)
MONOLITH = "monolith"


def lost(row: dict) -> bool:
    """Whether it overturned or slid off."""
    return row["outcome"] in (OVERTURNED, SLID_OFF)


def surface(rows: list[dict]) -> np.ndarray | None:
    """Parameters (4,) of P(lost) = Phi(c0 + c1 ln PGV + c2 ln T + c3 (ln T)^2), T the pulse period
    [s]; None where there are none.
    """
    pgv, period = (np.log([row[key] for row in rows]) for key in ("pgv_m_s", "pulse_period_s"))
    x = np.column_stack([np.ones(len(rows)), pgv, period, period**2])
    try:
        return fit_binary(x, np.array([lost(row) for row in rows]), "probit")[0].params
    except DegenerateData:
        return None


def half_lost(parameters: np.ndarray, period) -> np.ndarray:
    """PGV [m/s] of the surface at which half are lost, at pulse periods [s]; nan where more PGV
    does not overturn more.
    """
    if parameters[1] <= 0:
        return np.full(np.shape(period), np.nan)
    t = np.log(period)
    return np.exp(-(parameters[0] + parameters[2] * t + parameters[3] * t**2) / parameters[1])


def _within(pgv: float) -> str:
    """A PGV as a number where such motions were drawn, else on which side of them it lies."""
    low, high = PGV
    return f"> {high:g}" if not pgv <= high else f"< {low:g}" if pgv < low else f"{pgv:.2f}"


def markdown(found: dict[str, list[dict]]) -> str:
    """Two tables: what became of each structure, and rigid bodies or drums beside others in the
    same motions.
    """
    head = [
        "structure",
        "motions",
        "P(lost)",
        "95 % interval",
        "of them slid off",
        *(f"PGV that loses half, pulse of {period:g} s [m/s]" for period in PERIODS),
        "shift of those that stand, median [m]",
        "9 of 10 below [m]",
        "failed",
        "CPU s an analysis",
    ]
    table = []
    for name, rows in found.items():
        told = [row for row in rows if row["outcome"] != FAILED]
        number = sum(map(lost, told))
        fit = surface(told)
        shifts = [row["shift_m"] for row in told if not lost(row)] or [np.nan]
        low, high = proportion_interval(number, len(told)) if told else (np.nan, np.nan)
        table.append(
            [
                name,
                len(told),
                f"{number / max(len(told), 1):.3f}",
                f"{low:.3f} to {high:.3f}",
                sum(row["outcome"] == SLID_OFF for row in told),
                *(
                    "-" if fit is None else _within(float(half_lost(fit, period)))
                    for period in PERIODS
                ),
                *(f"{value:.2g}" for value in np.quantile(shifts, (0.5, 0.9))),
                len(rows) - len(told),
                f"{np.nanmean([row['cpu_s'] for row in told]) if told else np.nan:.2f}",
            ]
        )
    pairs_head = [
        "pair",
        "motions",
        "first alone is lost",
        "second alone",
        "p (McNemar)",
    ]
    pairs = [
        [f"{one} and {other}", *beside(found[one], found[other])]
        for one, other in pairs_of(list(found))
    ]
    return f"{_table(head, table)}\n\n{_table(pairs_head, pairs)}"


def pairs_of(names: list[str]) -> list[tuple[str, str]]:
    """The monolith beside each column of drums, these beside each other, elastic structures beside
    the rigid ones.
    """
    drums = [name for name in names if name.endswith("drums") and not name.startswith(ELASTIC)]
    columns = [(MONOLITH, name) for name in drums] + list(combinations(drums, 2))
    elastic = [(name.removeprefix(ELASTIC), name) for name in names if name.startswith(ELASTIC)]
    return [pair for pair in (*columns, *elastic) if set(pair) <= set(names)]


def beside(one: list[dict], other: list[dict]) -> list:
    """Motions that both have, those in which one alone is lost, and p of equal chances (McNemar
    1947, exact).
    """
    fates = [
        {row["motion"]: lost(row) for row in rows if row["outcome"] != FAILED}
        for rows in (one, other)
    ]
    both = fates[0].keys() & fates[1].keys()
    first = sum(fates[0][n] and not fates[1][n] for n in both)
    second = sum(fates[1][n] and not fates[0][n] for n in both)
    p = binomtest(first, first + second).pvalue if first + second else 1.0
    return [len(both), first, second, f"{p:.2g}"]


def _table(head, rows) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)
