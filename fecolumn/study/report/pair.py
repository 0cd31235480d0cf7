"""Pairs of settings that differ in one axis alone, compared as distributions and motion by
motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fecolumn.statistics.compare import Comparison, compare
from fecolumn.statistics.equivalence import distance_bound
from fecolumn.statistics.holm import holm
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.sweep import DT_KEY, FINE_DT_S, Line, Sweep
from fecolumn.study.setting_pairs import chosen_pairs

_MOST = 240  # beyond it only the extreme levels of each line are compared, axes in turn
_LEAST_MOTIONS = 2
FINE_STEPS, WITH_COARSE_STEP = "time steps of 1 ms and below", "with a time step above 1 ms"


@dataclass(frozen=True, slots=True)
class ComparedPair:
    """Two settings that differ in one axis.

    Attributes
    ----------
    axis, low, high
        the axis and its two levels.
    others
        values of all other axes.
    partners
        of the axes whose values go with those of `axis`, as of one `[[zip]]`, their two values.
    comparison
        of the low level (a) with the high one (b), over the motions done in both.
    distance, bound
        largest distance of the two CDFs, and what the data exclude at 95 %.
    family
        the tests that are judged together.
    comparisons
        how many they are.
    p_holm
        paired p of the distance, corrected for the family.
    p_lost
        name of the share of columns that the distributions end short of.
    """

    axis: str
    low: Any
    high: Any
    others: dict[str, Any]
    partners: dict[str, tuple[Any, Any]]
    comparison: Comparison
    distance: float
    bound: float
    family: str
    comparisons: int
    p_holm: float
    p_lost: str


def read_pairs(sweep: Sweep) -> list[ComparedPair]:
    """Every pair that differs in one axis, or where these are too many, the extreme levels of each
    line.
    """
    lines = [line for axis in sweep.leading for line in sweep.lines(axis)]
    chosen = chosen_pairs([(line.axis, len(line.settings)) for line in lines], _MOST)
    found = []
    for place, low, high in chosen:
        line = lines[place]
        whole = Line(line.axis, line.others, (line.settings[low], line.settings[high]))
        if len(whole.motions()) < _LEAST_MOTIONS:
            continue
        (u, over), records = whole.peaks(), whole.records()
        result = compare(
            u[0],
            over[0],
            u[1],
            over[1],
            paired=True,
            cap_m=sweep.limit_m,
            records=(records, records),
        )
        found.append(
            (whole, result, *distance_bound(u[0], over[0], u[1], over[1], records=records))
        )
    families = [_family(line) for line, *_ in found]
    corrected: dict[int, float] = {}
    for family in dict.fromkeys(families):
        members = [place for place, name in enumerate(families) if name == family]
        corrected |= dict(
            zip(members, holm(np.array([found[place][1].paired_p for place in members], float)))
        )
    return [
        ComparedPair(
            line.axis,
            low,
            high,
            line.others,
            {
                key: (line.settings[0].values[key], line.settings[1].values[key])
                for key in sweep.together(line.axis)
                if key != line.axis
            },
            result,
            distance,
            bound,
            families[place],
            families.count(families[place]),
            float(corrected[place]),
            sweep.p_lost,
        )
        for place, (line, result, distance, bound) in enumerate(found)
        for low, high in [line.levels]
    ]


def _family(line: Line) -> str:
    """Tests that answer one question: an axis, and whether a coarse time step takes part."""
    steps = [setting.values[DT_KEY] for setting in line.settings if DT_KEY in setting.values]
    if line.axis not in (DT_KEY, ALPHA_KEY) or not steps:
        return line.axis
    return f"{line.axis}, {FINE_STEPS if max(steps) <= FINE_DT_S else WITH_COARSE_STEP}"
