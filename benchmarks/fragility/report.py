"""Fragility surfaces over PGV and pulse period, and drums beside the monolith."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.stats import binomtest

from benchmarks.beside import markdown as as_markdown
from benchmarks.fragility import velocity_classes
from benchmarks.fragility.motions import PGV
from benchmarks.fragility.structures import ELASTIC
from fecolumn.engines.ending import OVERTURNED, SLID_OFF, STILL_ROCKING
from fecolumn.statistics.binary_regression import DegenerateData, fit_binary
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.store import FAILED

#: Pulse periods [s] at which the PGV that overturns half is told.
PERIODS = (0.7, 1.5, 3.0)
#: Edges of the classes of pulse periods in which shifts are told [s]
EDGES = (0.0, 1.0, 2.5, np.inf)
#: Ensembles drawn from the motions with repetition, by which the interval of that PGV is told
_DRAWN = 400
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


def half_intervals(rows: list[dict]) -> list[tuple[str, str]]:
    """At each of PERIODS the PGV that loses half, and its 95 % interval by drawing the motions
    with repetition (percentiles).
    """
    fit, random = surface(rows), np.random.default_rng(0)
    if fit is None:
        return [("-", "-")] * len(PERIODS)
    drawn = []
    for _ in range(_DRAWN):
        again = surface([rows[place] for place in random.integers(len(rows), size=len(rows))])
        if again is not None:
            drawn.append(half_lost(again, np.array(PERIODS)))
    # where more PGV does not overturn more, no PGV loses half
    ends = np.quantile(np.nan_to_num(drawn, nan=np.inf), (0.025, 0.975), axis=0, method="nearest")
    return [
        (_within(float(half_lost(fit, period))), " to ".join(dict.fromkeys(map(_within, both))))
        for period, *both in zip(PERIODS, *ends.tolist())
    ]


def periods_table(found: dict[str, list[dict]]) -> str:
    """By pulse period: PGV that loses half with its interval, and shift at the end; found: rows of
    analyses that ended, by structure.
    """
    names = [f"pulses of {low:g} to {high:g} s" for low, high in zip(EDGES, EDGES[1:])]
    names[0], names[-1] = f"pulses below {EDGES[1]:g} s", f"pulses of {EDGES[-2]:g} s and more"
    head = ["structure"]
    for period in PERIODS:
        head += [
            f"PGV that loses half, pulse of {period:g} s [m/s]",
            f"95 % interval, {period:g} s",
        ]
    head += [f"shift at the end, median, {name} [m]" for name in names]
    table = []
    for name, rows in found.items():
        shifts = [
            [
                row["shift_m"]
                for row in rows
                if not lost(row) and low <= row["pulse_period_s"] < high
            ]
            for low, high in zip(EDGES, EDGES[1:])
        ]
        halves = [cell for pair in half_intervals(rows) for cell in pair]
        table.append([name, *halves, *(f"{np.median(one or [np.nan]):.2g}" for one in shifts)])
    return as_markdown(head, table)


def markdown(found: dict[str, list[dict]]) -> str:
    """Four tables: what became of each structure; that by pulse period and by PGV; and rigid bodies
    or drums beside others in the same motions.
    """
    head = [
        "structure",
        "motions",
        "P(lost)",
        "95 % interval",
        "of them slid off",
        "still rocking at the end",
        "shift at the end of those not lost, median [m]",
        "9 of 10 below [m]",
        "failed",
        "CPU s an analysis",
    ]
    ended = {
        name: [one for one in rows if one["outcome"] != FAILED] for name, rows in found.items()
    }
    table = []
    for name, told in ended.items():
        number = sum(map(lost, told))
        shifts = [row["shift_m"] for row in told if not lost(row)] or [np.nan]
        low, high = proportion_interval(number, len(told)) if told else (np.nan, np.nan)
        table.append(
            [
                name,
                len(told),
                f"{number / max(len(told), 1):.3f}",
                f"{low:.3f} to {high:.3f}",
                sum(row["outcome"] == SLID_OFF for row in told),
                sum(row["outcome"] == STILL_ROCKING for row in told),
                *(f"{value:.2g}" for value in np.quantile(shifts, (0.5, 0.9))),
                len(found[name]) - len(told),
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
    tables = [as_markdown(head, table), periods_table(ended), velocity_classes.table(ended, lost)]
    return "\n\n".join([*tables, as_markdown(pairs_head, pairs)])


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
