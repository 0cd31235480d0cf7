"""Objects of a list ranked by how likely they reach limit states, from the runs of all of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from fecolumn.engines.ending import lost
from fecolumn.statistics.ecdf import percentile
from fecolumn.statistics.failed_runs import RunCount
from fecolumn.study.failures import why_failed
from fecolumn.study.plan import Plan
from fecolumn.study.questions.limit import LimitEvent
from fecolumn.study.questions.objects import ListedObject
from fecolumn.study.setting_rows import failed_of, rows_by_setting

_NAMED = 5  # objects in a sentence


@dataclass(frozen=True, slots=True)
class ScreenedObject:
    """An object with its n runs and those that failed: of each limit state how many reached it, and
    the median of the largest displacement of its top [m] of those that are done, inf where half are
    lost, nan where none is done.
    """

    object: ListedObject
    n: int
    counts: tuple[int, ...]
    median_m: float
    failed: int = 0

    def count(self, place: int) -> RunCount:
        """Runs that reached a limit state, beside those that failed."""
        return RunCount(self.counts[place], self.n, self.failed)

    def share(self, place: int) -> tuple[float, float, float]:
        """Share of a limit state in what is done, nan where nothing is, with the 95 % interval
        (Wilson) of its probability, whatever the failed analyses would have been.
        """
        count = self.count(place)
        return count.share, *count.interval

    @property
    def order(self) -> tuple[float, ...]:
        """What sorts objects, the most endangered first: by shares with all failed runs as events,
        as what may be in danger is not to be passed over.
        """
        shares = [self.count(place).bounds[1] for place in range(len(self.counts))]
        median = math.inf if math.isnan(self.median_m) else self.median_m
        return (*(-share for share in shares), -median)


def screened(
    objects: list[ListedObject], plan: Plan, rows: list[dict[str, Any]], limits: list[LimitEvent]
) -> list[ScreenedObject]:
    """All objects, the most endangered first: by the share of the first limit state, failed
    analyses taken as having reached it, then of the others, then by the median displacement.

    Parameters
    ----------
    plan
        of `objects.tables_of_objects`, whose settings come in the order of the objects.
    rows
        its ledger.
    """
    different = list(dict.fromkeys(one.values for one in objects))
    settings = dict(zip(different, rows_by_setting(plan, rows), strict=True))
    found = []
    for one in objects:
        setting = settings[one.values]
        done, lacking = setting.summaries, len(setting.failed)
        if not done and not lacking:
            continue
        counts = tuple(sum(limit.happened(run) for run in done) for limit in limits)
        median = math.nan
        if done:
            peaks = [run["u_max_m"] for run in done]
            median = percentile(peaks, [lost(run) for run in done], fraction=0.5)
        found.append(ScreenedObject(one, len(done), counts, median, lacking))
    return sorted(found, key=lambda one: one.order)


def answer_of(
    ranked: list[ScreenedObject], limits: list[LimitEvent], rows: list[dict[str, Any]]
) -> str:
    """A sentence on the most endangered object, and how many cannot be told from it; where analyses
    failed, which objects may be it, how many failed, why, and what to do; rows: of the ledger.
    """
    first = ranked[0]
    count, (_, low, _) = first.count(0), first.share(0)
    alike = sum(one.share(0)[2] >= low for one in ranked[1:])
    reach = f"the intervals of {alike or 'no'} others reach into this one"
    event = limits[0].text
    failed = failed_of(rows)
    if not failed and not any(one.count(0).k for one in ranked):
        return (
            f"{event} happens to none of {len(ranked)} in any of {count.n} motions: P({event}) is "
            f"{count.text} of each (95 % interval); the largest median displacement is that of "
            f"{first.object.name!r}.{_others(ranked, limits)}"
        )
    if not failed:
        return (
            f"Most endangered of {len(ranked)} is {first.object.name!r}: P({event}) is "
            f"{count.text} ({count.k} of {count.n} motions, 95 % interval); {reach}."
        )
    said = f"P({event}) is {count.text} ({count.k} of {count.n} motions and {count.failed} failed"
    told = (
        f"{len(failed)} of {len(rows)} analyses failed, and intervals are whatever they would have "
        f"been. {why_failed(failed)}"
    )
    most = max(one.count(0).bounds[0] for one in ranked)
    others = [one for one in ranked[1:] if one.count(0).bounds[1] >= most and one.failed]
    if count.bounds[0] >= most and not others:
        return (
            f"Most endangered of {len(ranked)} is {first.object.name!r}: {said}, 95 % interval); "
            f"{reach}. {told}"
        )
    names = [repr(one.object.name) for one in ranked if one.count(0).bounds[1] >= most]
    may = ", ".join(names[:_NAMED]) + (" and others" if len(names) > _NAMED else "")
    return (
        f"Which of {len(ranked)} is most endangered is not decided, since analyses failed: it may "
        f"be {may}. Of {first.object.name!r}, which may be the worst, {said}, 95 % interval); "
        f"{reach}. {told}"
    )


def _others(ranked: list[ScreenedObject], limits: list[LimitEvent]) -> str:
    """A sentence on each further limit that is reached: by which object most often."""
    told = ""
    for place, limit in enumerate(limits[1:], 1):
        worst = max(ranked, key=lambda one: one.count(place).k)
        if k := worst.count(place).k:
            count = worst.count(place)
            told += (
                f" {limit.text} happens most often to {worst.object.name!r}: in {k} of "
                f"{count.n} motions, P {count.text} (95 % interval)."
            )
    return told


def screening_table(ranked: list[ScreenedObject], limits: list[LimitEvent]) -> list[list[Any]]:
    """Header and, of each object, a row for each limit state, for a CSV file; u_max_50_m is inf
    where more than half overturned or slid off, empty, as the probability, where nothing is done.
    """
    sizes = ["width_m", "depth_m", "height_m", "mass_kg", "friction"]
    shares = ["probability", "wilson_low", "wilson_high"]
    rows: list[list[Any]] = [
        ["rank", "name", *sizes, "u_max_50_m", "event", "n", "reached", *shares, "failed"]
    ]
    for rank, one in enumerate(ranked, 1):
        values = [f"{value:g}" for value in one.object.values]
        median = "" if math.isnan(one.median_m) else f"{one.median_m:.6g}"
        for place, (limit, count) in enumerate(zip(limits, one.counts)):
            found = ["" if math.isnan(p) else f"{p:.6f}" for p in one.share(place)]
            told = [rank, one.object.name, *values, median, limit.text, one.n, count, *found]
            told.append(one.failed)
            rows.append(told)
    return rows
