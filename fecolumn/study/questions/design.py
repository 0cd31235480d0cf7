"""How large a key of a case has to be for a limit state to hold: ensembles of the same motions at
values of a grid, looked at where bisection asks for them.

Analyses may fail by their response, such as a slide beyond what was prepared. The bisection is made
twice, with none and with all of the failed analyses beyond the limit: a size is decided where both
find the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fecolumn.pictures.figures.axis_text import axis_unit
from fecolumn.statistics.crossing import (
    KEPT,
    CrossingPlace,
    GradedValues,
    crossing_place,
    grade,
)
from fecolumn.statistics.failed_runs import RunCount
from fecolumn.study.outcome import DONE
from fecolumn.study.plan import Plan, PlannedAnalysis, member_of
from fecolumn.study.questions.limit import ShareLimit
from fecolumn.study.setting_rows import failed_of


def grid_of(low: float, high: float, kind: type, steps: int) -> list[float | int]:
    """Values from low to high, both included, in so many steps, each once."""
    values = np.linspace(low, high, steps + 1).tolist()
    if kind is int:
        return sorted({round(value) for value in values if low <= round(value) <= high})
    return list(dict.fromkeys(float(f"{value:.6g}") for value in values))


@dataclass(frozen=True, slots=True)
class LookedAt:
    """One value of the key: its runs, how many of them are beyond the limit and how many failed,
    and whether each motion that is done is beyond it.
    """

    place: int
    value: float
    count: RunCount
    of_motion: dict[tuple[str, ...], bool]


class DesignQuestion:
    """A key, its grid of values, and what is known at each.

    Parameters
    ----------
    plan
        all values by all motions.
    key
        that is varied.
    limit
        the limit state.
    """

    def __init__(self, plan: Plan, key: str, limit: ShareLimit) -> None:
        self.plan, self.key, self.limit = plan, key, limit
        self.grid = list(plan.axes[key])
        self.looked: dict[int, LookedAt] = {}
        self._failed: dict[int, list[dict[str, Any]]] = {}
        self._analyses: dict[int, list[PlannedAnalysis]] = {}
        for analysis in plan.analyses:
            place = self.grid.index(analysis.values[key])
            self._analyses.setdefault(place, []).append(analysis)

    @property
    def unit(self) -> str:
        """Unit of the key with a blank before it, "" where it has none."""
        unit = axis_unit(self.key)
        return "" if unit == "-" else f" {unit}"

    def graded(self, failed_beyond: bool) -> GradedValues:
        """What bisection knows, with all of the failed analyses beyond the limit, or none."""
        limit, grades = self.limit, {}
        for place, one in self.looked.items():
            k = one.count.k + (one.count.failed if failed_beyond else 0)
            grades[place] = grade(k, one.count.runs, limit.share, limit.strict)
        return GradedValues(len(self.grid), grades)

    @property
    def failed(self) -> list[dict[str, Any]]:
        """Rows of the ledger of all analyses that failed at values looked at."""
        return [row for place in sorted(self._failed) for row in self._failed[place]]

    def wanted(self) -> list[int]:
        """Places to look at next, whatever the failed analyses would have been."""
        found = [*self.graded(False).wanted(), *self.graded(True).wanted()]
        return [place for place in dict.fromkeys(found) if place not in self.looked]

    def looks_left(self) -> int:
        """Most values that are still to be looked at."""
        left = self.graded(False).looks_left()
        return left + self.graded(True).looks_left() if self.failed else left

    def ids(self, places: list[int]) -> set[str]:
        """Analyses at places of the grid."""
        return {analysis.id for place in places for analysis in self._analyses[place]}

    def take(self, places: list[int], rows: list[dict[str, Any]]) -> None:
        """Note the runs at places of the grid, from the rows of the ledger.

        Raises
        ------
        InputError
            summaries do not hold what the limit asks for.
        ValueError
            none of the runs at a value is done.
        """
        states = {row["id"]: row for row in rows}
        for place in places:
            found = {
                member_of(analysis.values): self.limit.event.happened(row["summary"])
                for analysis in self._analyses[place]
                if (row := states[analysis.id])["state"] == DONE
            }
            if not found:
                raise ValueError(f"{self.key} = {self.grid[place]}: no analysis is done")
            self._failed[place] = failed_of([states[one.id] for one in self._analyses[place]])
            count = RunCount(sum(found.values()), len(found), len(self._failed[place]))
            self.looked[place] = LookedAt(place, self.grid[place], count, found)

    def again(self) -> int:
        """Motions beyond the limit at a value although not at one that is worse for the rest."""
        found = set()
        places = sorted(self.looked, reverse=not self.graded(False).rising)
        for number, place in enumerate(places):
            for better in places[number + 1 :]:
                worse, later = self.looked[place].of_motion, self.looked[better].of_motion
                found |= {
                    one for one, beyond in later.items() if beyond and not worse.get(one, True)
                }
        return len(found)

    def table(self) -> list[list[Any]]:
        """Header, and a row for each value looked at."""
        shares = ["probability", "wilson_low", "wilson_high"]
        rows: list[list[Any]] = [["key", "value", "n", "reached", *shares, "failed"]]
        for place in sorted(self.looked):
            one, count = self.looked[place], self.looked[place].count
            found = [f"{p:.6f}" for p in (count.share, *count.interval)]
            rows.append([self.key, f"{one.value:g}", count.n, count.k, *found, count.failed])
        return rows

    def place(self) -> CrossingPlace | None:
        """The place sought, once nothing more is wanted; None where the limit is not crossed, or
        failed analyses leave the place open.
        """
        few, many = (crossing_place(self.graded(beyond)) for beyond in (False, True))
        if not few or not many or (few.kept, few.broken) != (many.kept, many.broken):
            return None
        least = most = None
        if few.least is not None and many.least is not None:
            least = min(few.least, many.least)
        if few.most is not None and many.most is not None:
            most = max(few.most, many.most)
        return CrossingPlace(few.kept, few.broken, least, most)

    def kept_at_both_ends(self) -> bool | None:
        """Whether the limit is kept, or broken, at both ends of the grid; None where it is crossed,
        or failed analyses leave it open.
        """
        ends = {
            self.graded(beyond).grades[place] >= KEPT
            for beyond in (False, True)
            for place in (0, len(self.grid) - 1)
        }
        return ends.pop() if len(ends) == 1 else None

    @property
    def decided(self) -> bool:
        """Whether the answer is the same whatever the failed analyses would have been."""
        return self.place() is not None or self.kept_at_both_ends() is not None
