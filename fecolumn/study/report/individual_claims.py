"""Claim (a): one by one, the peaks depend on time step and numerical damping, without trend."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.statistics.holm import holm
from fecolumn.statistics.trend import Trend, trend
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.claim import NOT_SUPPORTED, SUPPORTED, UNDECIDED, Claim
from fecolumn.study.report.notation import (
    axis_name,
    count,
    fixed,
    interval,
    p_clause,
    percent,
    setting_text,
)
from fecolumn.study.report.sweep import (
    DT_KEY,
    FINE_DT_S,
    Line,
    Setting,
    Sweep,
    common_motions,
    common_peaks,
)

_STRONG_SPREAD, _LITTLE_SPREAD = 1.25, 1.05
_OFTEN = 0.05
_WEAK = 0.3  # |tau| below it: at most 65 % of the pairs of levels go one way


@dataclass(frozen=True, slots=True)
class SettingSpread:
    """What the settings of a study do to one and the same motion.

    Attributes
    ----------
    settings, motions
        settings, and the motions done in all of them.
    factor
        (k,) largest over smallest u_max [-] of each motion that stands in every setting and moves.
    flipped
        motions that are lost, overturned or slid off, in some settings and stand in others.
    always, never
        motions that are lost in all settings, in none.
    """

    settings: int
    motions: int
    factor: NDArray[Any]
    flipped: int
    always: int
    never: int


def setting_spread(settings: Sequence[Setting]) -> SettingSpread:
    """Spread of the peaks over settings, motion by motion."""
    motions = common_motions(settings)
    u, over = common_peaks(settings, motions)
    times = over.sum(axis=0)
    stands = (times == 0) & (u.min(axis=0) > 0)
    return SettingSpread(
        len(settings),
        len(motions),
        u[:, stands].max(axis=0) / u[:, stands].min(axis=0),
        int(((times > 0) & (times < len(settings))).sum()),
        int((times == len(settings)).sum()),
        int((times == 0).sum()),
    )


@dataclass(frozen=True, slots=True)
class LineTrend:
    """Trend along a line of settings, its p corrected for all lines of the axis, and the trend
    without coarse steps.
    """

    line: Line
    trend: Trend
    p_holm: float
    fine: Trend | None


def line_trends(sweep: Sweep, axis: str) -> list[LineTrend]:
    """Trend along each line of an axis."""
    lines = sweep.lines(axis)
    trends = [trend(*line.peaks(), records=line.records()) for line in lines]
    corrected = holm([found.p for found in trends])
    return [
        LineTrend(line, found, float(p), _fine_trend(line))
        for line, found, p in zip(lines, trends, corrected)
    ]


def individual_claims(sweep: Sweep, axes: Iterable[str]) -> list[Claim]:
    """That peaks change with the setting, and that no trend is in it, for each of the axes."""
    return [_change(sweep), *(_trend(sweep, axis) for axis in axes)]


def _fine_trend(line: Line) -> Trend | None:
    fine = [s for s in line.settings if s.values.get(DT_KEY, 1.0) <= FINE_DT_S]
    chosen = Line(line.axis, line.others, tuple(fine))
    return (
        trend(*chosen.peaks(), records=chosen.records())
        if line.axis == DT_KEY and 1 < len(fine) < len(line.settings)
        else None
    )


def _change(sweep: Sweep) -> Claim:
    found = setting_spread(sweep.done)
    n, paper = (
        found.motions,
        "Changing the time step or α changes the peak of one and the same motion "
        "significantly, often even whether it overturns.",
    )
    rule = (
        f"supported: median factor of at least {_STRONG_SPREAD} between largest and "
        f"smallest peak, or at least {percent(_OFTEN)} of the "
        f"motions flip; not supported: factor below {_LITTLE_SPREAD} and no flip"
    )
    if not n or found.settings < 2:
        return Claim("a1", paper, "No motion has been run in two settings yet.", rule, UNDECIDED)
    parts = [
        f"Over {count(found.settings, 'setting')}, {found.flipped} of "
        f"{count(n, 'motion')} ({percent(found.flipped / n)}) "
        f"{'are lost' if sweep.slides else 'overturn'} "
        f"in some and stand in others; {found.always} "
        f"{'are lost' if sweep.slides else 'overturn'} in all, {found.never} in none."
    ]
    median = float(np.median(found.factor)) if found.factor.size else float("nan")
    if found.factor.size:
        parts.append(
            f"Of those that always stand, the largest peak is {fixed(median)} times the "
            "smallest in the median, "
            f"{fixed(float(found.factor.max()), 1)} times at most."
        )
    strong = median >= _STRONG_SPREAD or found.flipped / n >= _OFTEN
    little = not found.flipped and median < _LITTLE_SPREAD
    return Claim(
        "a1",
        paper,
        " ".join(parts),
        rule,
        SUPPORTED if strong else NOT_SUPPORTED if little else UNDECIDED,
    )


def _trend(sweep: Sweep, axis: str) -> Claim:
    name, found = axis_name(axis), line_trends(sweep, axis)
    key, paper = f"a2, {name}", f"One by one, no clear trend of the peak with {name} emerges."
    rule = (
        f"mean Kendall τ of the peak with {name} over the motions; supported: its 95 % "
        f"interval lies within ±{_WEAK} on every line; not "
        "supported: outside it on one, with p < 0.05 (Page or sign test, Holm over all "
        "lines); else undecided"
    )
    if not found:
        return Claim(
            key, paper, f"No motion has been run at two levels of {name} yet.", rule, UNDECIDED
        )
    clear = [one for one in found if one.p_holm < 0.05]
    outside = [one for one in found if max(-one.trend.tau_low, one.trend.tau_high) > _WEAK]
    wrong = [one for one in clear if one in outside]
    verdict = NOT_SUPPORTED if wrong else UNDECIDED if outside else SUPPORTED
    low, high = min(one.trend.tau for one in found), max(one.trend.tau for one in found)
    reach = (
        f"τ = {fixed(low)}"
        if len(found) == 1
        else f"τ from {fixed(low)} to {fixed(high)} over {count(len(found), 'line')}"
    )
    up, down = sum(one.trend.rising for one in found), sum(one.trend.falling for one in found)
    parts = [f"Along {name}, {reach}; with rising {name}, peaks rise {up} and fall {down} times."]
    worst = min(found, key=lambda one: (one not in wrong, one.p_holm))
    if wrong:
        parts.append(
            f"Here ours disagrees: {_line(worst)} the trend is τ = {fixed(worst.trend.tau)} "
            f"{interval(worst.trend.tau_low, worst.trend.tau_high)}, {p_clause(worst.p_holm)}."
        )
    elif clear:
        parts.append(
            f"A drift is detected ({_line(worst)} {p_clause(worst.p_holm)}), too weak "
            "to foretell a single motion."
            if not outside
            else f"A drift is detected ({_line(worst)} {p_clause(worst.p_holm)}), its "
            "strength is not settled."
        )
    else:
        parts.append(f"Not one is significant (smallest {p_clause(worst.p_holm)}).")
    if axis == ALPHA_KEY and sweep.alpha_note:
        parts.append(sweep.alpha_note)
    if verdict == UNDECIDED:
        widest = max(outside, key=lambda one: one.trend.tau_high - one.trend.tau_low)
        parts.append(
            f"{count(widest.trend.n, 'motion')} leave τ "
            f"{interval(widest.trend.tau_low, widest.trend.tau_high)} open "
            f"{_line(widest)}."
        )
    if clear and (fine := [one.fine for one in found if one.fine]):
        p = float(holm([one.p for one in fine]).min())
        parts.append(
            "Among time steps of 1 ms and below alone, τ lies between "
            f"{fixed(min(t.tau for t in fine))} and "
            f"{fixed(max(t.tau for t in fine))} (smallest {p_clause(p)}): "
            + (
                "the trend is that of the coarse step."
                if p > 0.05
                else "it is not the coarse step alone."
            )
        )
    return Claim(key, paper, " ".join(parts), rule, verdict)


def _line(one: LineTrend) -> str:
    return f"at {setting_text(one.line.others)}" if one.line.others else "over all settings"
