"""Pairs of settings of a study that differ in one axis, or in axes that change together, and how
far their distributions are apart.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Hashable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fecolumn.engines.ending import lost
from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.equivalence import distance_bound
from fecolumn.statistics.records import counted_unit, record_count
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov
from fecolumn.study.substeps import SettingTables

#: Records below which nothing is compared. Motions of one record are swapped together: there are
#: 2^n ways to swap two settings within n records, two of them extreme, and with n = 5 no p-value
#: falls below 2/32 = 0.06
LEAST_RECORDS = 6
#: Pairs above which only the first and the last setting of each line are compared, and lines above
#: which these are taken from all axes in turn: a comparison takes some tenths of a second
MOST_PAIRS = 60
#: Levels of an axis above which a report, which has no study file, takes it for a sampled one
SAMPLED = 8

#: Record of each motion of a plan
MotionRecords = dict[tuple[str, ...], str]
#: Axes that change together, and settings that differ in them alone
SettingLine = tuple[tuple[str, ...], list[SettingTables]]


@dataclass(frozen=True, slots=True)
class SettingPair:
    """Two settings that differ in one axis, or in those of one `[[zip]]`: its keys, their axis
    values and names, motions in both, distance of their CDFs, its upper bound, its paired p, and
    different records of the motions.
    """

    axis: str
    settings: tuple[dict[str, Any], dict[str, Any]]
    names: tuple[str, str]
    n: int
    distance: float
    bound: float
    p: float
    records: int

    @property
    def unit(self) -> str:
        """What the statistics count."""
        return counted_unit(self.n, self.records)


def setting_lines(
    settings: list[SettingTables], sampled: Collection[str] = ()
) -> list[SettingLine]:
    """Lines of at least two settings that differ in one axis alone, or in axes that change
    together (`axes_together`); samples of several axes, those `sampled`, are none.
    """
    lines: dict[tuple[Any, ...], SettingLine] = {}
    for axes in axes_together([values for values, _ in settings]):
        for values, runs in settings:
            others = tuple(repr(item) for item in values.items() if item[0] not in axes)
            lines.setdefault((axes, *others), (axes, []))[1].append((values, runs))
    return [
        line
        for line in lines.values()
        if len(line[1]) > 1 and not (len(line[0]) > 1 and set(line[0]) & set(sampled))
    ]


def axes_together(settings: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Axes of settings, those in one group whose values determine each other in every setting, as
    those of one `[[zip]]` do; axes of one value are groups of their own.
    """
    if not settings:
        return []
    groups: list[tuple[str, ...]] = []
    for key in settings[0]:
        place = next(
            (n for n, group in enumerate(groups) if _together(settings, group[0], key)), None
        )
        if place is None:
            groups.append((key,))
        else:
            groups[place] = (*groups[place], key)
    return groups


def _together(settings: list[dict[str, Any]], one: str, other: str) -> bool:
    both = {(repr(values[one]), repr(values[other])) for values in settings}
    levels = [{pair[place] for pair in both} for place in (0, 1)]
    return 1 < len(both) == len(levels[0]) == len(levels[1])


def pairs_of(
    settings: list[SettingTables],
    records: MotionRecords,
    confidence: float = 0.95,
    sampled: Collection[str] = (),
) -> list[SettingPair]:
    """Pairs of settings of one line, over the motions done in both; records: of each motion;
    confidence: of the bound of their distance; sampled: as of `setting_lines`.

    Where they are more than 60, the first and the last setting of each line; where there are more
    lines than that, of lines of all axes in turn (`pair_count` has the number of all).
    """
    lines = setting_lines(settings, sampled)
    chosen = chosen_pairs([(axes, len(line)) for axes, line in lines], MOST_PAIRS)
    found = []
    for place, low, high in chosen:
        axes, line = lines[place]
        (first, runs_a), (second, runs_b) = line[low], line[high]
        common = [motion for motion in runs_a if motion in runs_b]
        own = [records[motion] for motion in common]
        count = record_count(own, len(own))
        if count < LEAST_RECORDS:
            continue
        (u_a, over_a), (u_b, over_b) = (
            tuple(
                np.array([measure(runs[motion]) for motion in common]) for measure in (_peak, lost)
            )
            for runs in (runs_a, runs_b)
        )
        shown = axes if len(lines) == 1 else tuple(first)
        p = paired_kolmogorov_smirnov(censored(u_a, over_a), censored(u_b, over_b), records=own).p
        found.append(
            SettingPair(
                " with ".join(axes),
                (first, second),
                (setting_name(first, shown), setting_name(second, shown)),
                len(common),
                *distance_bound(u_a, over_a, u_b, over_b, confidence, own),
                p,
                count,
            )
        )
    return found


def pair_count(settings: list[SettingTables], sampled: Collection[str] = ()) -> int:
    """Number of pairs of settings on one line; sampled: as of `setting_lines`."""
    return sum(len(line) * (len(line) - 1) // 2 for _, line in setting_lines(settings, sampled))


def chosen_pairs(lines: Sequence[tuple[Hashable, int]], most: int) -> list[tuple[int, int, int]]:
    """Place of a line and of two of its settings, of all pairs of settings on a line; where these
    are more than `most`, of the first and the last of each line, and of so many lines, taken from
    all axes in turn.

    Parameters
    ----------
    lines
        of each what varies along it, and how many settings it has.
    """
    pairs = [
        (place, *two)
        for place, (_, number) in enumerate(lines)
        for two in itertools.combinations(range(number), 2)
    ]
    if len(pairs) <= most:
        return pairs
    of_axes: dict[Hashable, list[int]] = {}
    for place, (axes, _) in enumerate(lines):
        of_axes.setdefault(axes, []).append(place)
    turns = itertools.zip_longest(*of_axes.values())
    places = [place for turn in turns for place in turn if place is not None][:most]
    return [(place, 0, lines[place][1] - 1) for place in sorted(places)]


def _peak(summary: dict[str, Any]) -> float:
    return float(summary["u_max_m"])


def setting_name(values: dict[str, Any], shown: tuple[str, ...] | None = None) -> str:
    """Values of axes, such as "dt_s = 0.02, alpha_hht = 0", of all or of those `shown`; keys by
    their last words, as many as tell them apart.
    """
    return ", ".join(f"{_short(key, values)} = {values[key]}" for key in shown or tuple(values))


def _short(key: str, keys: dict[str, Any]) -> str:
    words = key.split(".")
    for number in range(1, len(words)):
        ending = words[-number:]
        if sum(other.split(".")[-number:] == ending for other in keys) == 1:
            return ".".join(ending)
    return key
