"""Objects of a list ranked by how likely they reach limit states, from the runs of all of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from fecolumn.engines.ending import lost
from fecolumn.statistics.ecdf import percentile, proportion_interval
from fecolumn.study.plan import Plan
from fecolumn.study.questions.limit import LimitEvent
from fecolumn.study.questions.objects import ListedObject
from fecolumn.study.table import combinations


@dataclass(frozen=True, slots=True)
class ScreenedObject:
    """An object with its n runs: of each limit state how many reached it, and the median of the
    largest displacement of its top [m], inf where half are lost.
    """

    object: ListedObject
    n: int
    counts: tuple[int, ...]
    median_m: float

    def share(self, place: int) -> tuple[float, float, float]:
        """Probability of a limit state with its 95 % interval (Wilson)."""
        low, high = proportion_interval(self.counts[place], self.n)
        return self.counts[place] / self.n, low, high


def screened(
    objects: list[ListedObject], plan: Plan, rows: list[dict[str, Any]], limits: list[LimitEvent]
) -> list[ScreenedObject]:
    """All objects with runs, the most endangered first: by the share of the first limit state, then
    of the others, then by the median displacement.

    Parameters
    ----------
    plan
        of `objects.tables_of_objects`, whose settings come in the order of the objects.
    rows
        its ledger.
    """
    different = list(dict.fromkeys(one.values for one in objects))
    runs = {
        values: done
        for values, (_, done, _) in zip(different, combinations(plan, rows), strict=True)
    }
    found = []
    for one in objects:
        if not (done := runs[one.values]):
            continue
        counts = tuple(sum(limit.happened(run) for run in done) for limit in limits)
        median = percentile(
            [run["u_max_m"] for run in done], [lost(run) for run in done], fraction=0.5
        )
        found.append(ScreenedObject(one, len(done), counts, median))
    return sorted(found, key=lambda one: (*(-count / one.n for count in one.counts), -one.median_m))


def answer_of(ranked: list[ScreenedObject], limits: list[LimitEvent]) -> str:
    """One sentence on the most endangered object, and how many cannot be told from it."""
    first = ranked[0]
    share, low, high = first.share(0)
    alike = sum(one.share(0)[2] >= low for one in ranked[1:])
    return (
        f"Most endangered of {len(ranked)} is {first.object.name!r}: P({limits[0].text}) is "
        f"{100 * share:.1f} % [{100 * low:.1f}, {100 * high:.1f}] ({first.counts[0]} of {first.n} "
        f"motions, 95 % interval); the intervals of {alike or 'no'} others reach into this one."
    )


def screening_table(ranked: list[ScreenedObject], limits: list[LimitEvent]) -> list[list[Any]]:
    """Header and, of each object, a row for each limit state, for a CSV file; u_max_50_m is inf
    where half are lost.
    """
    sizes = ["width_m", "depth_m", "height_m", "mass_kg", "friction"]
    shares = ["probability", "wilson_low", "wilson_high"]
    rows: list[list[Any]] = [
        ["rank", "name", *sizes, "u_max_50_m", "event", "n", "reached", *shares]
    ]
    for rank, one in enumerate(ranked, 1):
        values = [f"{value:g}" for value in one.object.values]
        median = "inf" if math.isinf(one.median_m) else f"{one.median_m:.6g}"
        for place, (limit, count) in enumerate(zip(limits, one.counts)):
            found = [f"{p:.6f}" for p in one.share(place)]
            told = [rank, one.object.name, *values, median, limit.text, one.n, count, *found]
            rows.append(told)
    return rows
