"""Wall time of a second of analysed motion, and claim (d): what time step and numerical damping
cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.claim import NOT_SUPPORTED, SUPPORTED, UNDECIDED, Claim
from fecolumn.study.report.notation import axis_name, count, fixed, interval, level_text, number
from fecolumn.study.report.sweep import DT_KEY, Setting, Sweep

_RESAMPLES = 2000
_SMALL = 1.5  # a factor below it is a small increase


def second_cost(setting: Setting, motions: Sequence[str] | None = None) -> NDArray[Any]:
    """Wall time per second of analysed motion [s/s], one a motion: stepping alone, no start, no
    files, nothing made once.
    """
    step_s, steps, duration_s = (
        setting.column(name, motions) for name in ("s_per_step", "steps", "duration_s")
    )
    return np.divide(
        step_s * steps, duration_s, out=np.full(step_s.shape, np.nan), where=duration_s > 0
    )


@dataclass(frozen=True, slots=True)
class CostRatio:
    """Cost at one level over that at the next lower one: geometric mean over motions and lines, 95
    % interval over motions.
    """

    low: Any
    high: Any
    n: int
    ratio: float
    ratio_low: float
    ratio_high: float


def cost_ratios(sweep: Sweep, axis: str, ends: bool = False) -> list[CostRatio]:
    """Cost of each level relative to the one below it, or of the highest to the lowest, from pairs
    of equal motion and setting.
    """
    levels, found = sweep.axes[axis], []
    for low, high in [(levels[0], levels[-1])] if ends else zip(levels, levels[1:]):
        logs: dict[str, list[float]] = {}
        for a, b in sweep.pairs(axis, low, high):
            motions = [motion for motion in a.runs if motion in b.runs]
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = np.log(second_cost(b, motions) / second_cost(a, motions))
            for motion, value in zip(motions, ratio):
                if np.isfinite(value):
                    logs.setdefault(motion, []).append(float(value))
        if logs:
            means = np.array([np.mean(values) for values in logs.values()])
            drawn = means[
                np.random.default_rng(0).integers(0, means.size, (_RESAMPLES, means.size))
            ].mean(axis=1)
            found.append(
                CostRatio(
                    low,
                    high,
                    means.size,
                    *(
                        float(np.exp(x))
                        for x in (means.mean(), *np.quantile(drawn, [0.025, 0.975]))
                    ),
                )
            )
    return found


def cost_claims(sweep: Sweep) -> list[Claim]:
    """A smaller time step costs much more, less numerical damping a little more."""
    return [
        _step_claim(sweep, cost_ratios(sweep, DT_KEY)),
        _alpha_claim(sweep, cost_ratios(sweep, ALPHA_KEY, ends=True)),
    ]


def _step_claim(sweep: Sweep, ratios: list[CostRatio]) -> Claim:
    paper = "A smaller Δt increases the solution time significantly."
    rule = (
        "supported: at every smaller Δt the cost rises by a factor above 1.5 (95 % "
        "interval); not supported: the interval lies below "
        "1.5 at one; else undecided"
    )
    if not ratios:
        return Claim("d1", paper, "No motion has been run at two time steps yet.", rule, UNDECIDED)
    parts = [
        f"From {level_text(DT_KEY, one.high)} to {level_text(DT_KEY, one.low)}, the cost of a "
        "second of motion grows by a factor of "
        f"{number(1 / one.ratio)} "
        f"{interval(1 / one.ratio_high, 1 / one.ratio_low, number)}; the steps alone "
        "make "
        f"{number(one.high / one.low)}."
        for one in reversed(ratios)
    ]
    if all(1 / one.ratio_high > _SMALL for one in ratios):
        verdict = SUPPORTED
    else:
        verdict = NOT_SUPPORTED if any(1 / one.ratio_low < _SMALL for one in ratios) else UNDECIDED
    if any(1 / one.ratio < 0.8 * one.high / one.low for one in ratios):
        parts.append(
            "Cost grows more slowly than the number of steps. "
            f"{_iterations(sweep, DT_KEY, ratios[0].low, ratios[-1].high)}"
        )
    return Claim("d1", paper, " ".join(parts), rule, verdict)


def _alpha_claim(sweep: Sweep, ratios: list[CostRatio]) -> Claim:
    paper = "Less numerical damping (α nearer 0) increases the solution time a little."
    rule = (
        f"supported: the 95 % interval of the factor lies between 1 and {_SMALL}; not "
        "supported: it lies outside; else undecided"
    )
    if not ratios:
        return Claim("d2", paper, "No motion has been run at two values of α yet.", rule, UNDECIDED)
    one = ratios[0]
    text = (
        f"From α = {level_text(ALPHA_KEY, one.low)} to {level_text(ALPHA_KEY, one.high)} the "
        f"cost changes by a factor of {fixed(one.ratio)} "
        f"{interval(one.ratio_low, one.ratio_high)} (geometric mean, {count(one.n, 'motion')})."
    )
    inside, outside = (
        1 < one.ratio_low and one.ratio_high < _SMALL,
        one.ratio_high < 1 or one.ratio_low > _SMALL,
    )
    if outside:
        text += f" Here ours disagrees. {_iterations(sweep, ALPHA_KEY, one.low, one.high)}"
    return Claim(
        "d2", paper, text, rule, SUPPORTED if inside else NOT_SUPPORTED if outside else UNDECIDED
    )


def _iterations(sweep: Sweep, axis: str, low: object, high: object) -> str:
    """Work of a step at two levels, as far as the analyses count it."""
    words = []
    for name, what in (("iterations", "iterations"), ("contact_iterations", "contact iterations")):
        means = []
        for level in (low, high):
            shares = np.concatenate(
                [s.column(name) / s.column("steps") for s in sweep.done if s.values[axis] == level]
            )
            means.append(float(np.nanmean(shares)) if np.isfinite(shares).any() else np.nan)
        if np.isfinite(means).all():
            words.append(f"{number(means[0])} and {number(means[1])} {what}")
    return (
        f"At {axis_name(axis)} = {level_text(axis, low)} and {level_text(axis, high)} a "
        f"step takes {' and '.join(words)}."
        if words
        else ""
    )
