"""Which parameter moves the distribution most."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fecolumn.statistics.records import record_count
from fecolumn.statistics.sensitivity import Sensitivity, sensitivity
from fecolumn.study.report.sweep import (
    ENGINE_KEY,
    Setting,
    Sweep,
    common_motions,
    common_peaks,
)
from fecolumn.study.setting_pairs import LEAST_RECORDS, SAMPLED


@dataclass(frozen=True, slots=True)
class Rank:
    """An axis, the levels compared, and its effect.

    Attributes
    ----------
    low, high
        extreme levels, or for an axis of many levels the ranges (least, largest) of its outer
        quarters.
    settings
        settings of all other parameters over which the effect is averaged.
    """

    axis: str
    low: Any
    high: Any
    settings: int
    effect: Sensitivity


def ranking(sweep: Sweep) -> list[Rank]:
    """Axes by the distance of the CDF between their extreme levels, the largest first; not the
    engines, which have none and a section of their own.
    """
    found = [
        rank
        for axis in sweep.varied
        if axis != ENGINE_KEY
        for rank in [
            _sampled(sweep, axis) if len(sweep.axes[axis]) > SAMPLED else _crossed(sweep, axis)
        ]
        if rank
    ]
    return sorted(found, key=lambda rank: -rank.effect.distance)


def _crossed(sweep: Sweep, axis: str) -> Rank | None:
    """Extreme levels at equal values of all others."""
    low, high = sweep.axes[axis][0], sweep.axes[axis][-1]
    ends = sweep.pairs(axis, low, high)
    return _effect(axis, low, high, [a for a, _ in ends], [b for _, b in ends])


def _sampled(sweep: Sweep, axis: str) -> Rank | None:
    """Lower against upper quarter of the samples, whatever the others are."""
    samples = sorted(sweep.done, key=lambda setting: sweep.axes[axis].index(setting.values[axis]))
    quarter = len(samples) // 4
    low, high = samples[:quarter], samples[-quarter:] if quarter else []
    if not quarter:
        return None
    return _effect(
        axis,
        (low[0].values[axis], low[-1].values[axis]),
        (high[0].values[axis], high[-1].values[axis]),
        low,
        high,
    )


def _effect(
    axis: str, low: object, high: object, at_low: list[Setting], at_high: list[Setting]
) -> Rank | None:
    motions = common_motions(at_low + at_high) if at_low else []
    records = at_low[0].records_of(motions) if at_low else []
    if record_count(records, len(records)) < LEAST_RECORDS:
        return None
    effect = sensitivity(
        *common_peaks(at_low, motions), *common_peaks(at_high, motions), records=records
    )
    return Rank(axis, low, high, len(at_low), effect)
