"""How large a key of a case has to be for a limit state to hold: ensembles of the same motions at
values of a grid, looked at where bisection asks for them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fecolumn.pictures.figures.axis_text import axis_unit
from fecolumn.statistics.crossing import (
    BROKEN,
    KEPT,
    SURELY_KEPT,
    CrossingPlace,
    GradedValues,
    crossing_place,
    grade,
    runs_needed,
)
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.outcome import DONE
from fecolumn.study.plan import Plan, PlannedAnalysis, member_of
from fecolumn.study.questions.limit import ShareLimit


def grid_of(low: float, high: float, kind: type, steps: int) -> list[float | int]:
    """Values from low to high, both included, in so many steps, each once."""
    values = np.linspace(low, high, steps + 1).tolist()
    if kind is int:
        return sorted({round(value) for value in values if low <= round(value) <= high})
    return list(dict.fromkeys(float(f"{value:.6g}") for value in values))


@dataclass(frozen=True, slots=True)
class LookedAt:
    """One value of the key: n runs done, k of them beyond the limit, and whether each motion's
    was.
    """

    place: int
    value: float
    k: int
    n: int
    of_motion: dict[tuple[str, ...], bool]

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's 95 % interval of the probability."""
        return proportion_interval(self.k, self.n)


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
        self._analyses: dict[int, list[PlannedAnalysis]] = {}
        for analysis in plan.analyses:
            place = self.grid.index(analysis.values[key])
            self._analyses.setdefault(place, []).append(analysis)

    @property
    def unit(self) -> str:
        """Unit of the key with a blank before it, "" where it has none."""
        unit = axis_unit(self.key)
        return "" if unit == "-" else f" {unit}"

    @property
    def graded(self) -> GradedValues:
        """What bisection knows."""
        limit = self.limit
        return GradedValues(
            len(self.grid),
            {
                place: grade(one.k, one.n, limit.share, limit.strict)
                for place, one in self.looked.items()
            },
        )

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
            self.looked[place] = LookedAt(
                place, self.grid[place], sum(found.values()), len(found), found
            )

    def again(self) -> int:
        """Motions beyond the limit at a value although not at one that is worse for the rest."""
        found = set()
        places = sorted(self.looked, reverse=not self.graded.rising)
        for number, place in enumerate(places):
            for better in places[number + 1 :]:
                worse, later = self.looked[place].of_motion, self.looked[better].of_motion
                found |= {
                    one for one, beyond in later.items() if beyond and not worse.get(one, True)
                }
        return len(found)

    def table(self) -> list[list[Any]]:
        """Header, and a row for each value looked at."""
        rows: list[list[Any]] = [
            ["key", "value", "n", "reached", "probability", "wilson_low", "wilson_high"]
        ]
        for place in sorted(self.looked):
            one = self.looked[place]
            shares = (one.k / one.n, *one.interval)
            rows.append([self.key, f"{one.value:g}", one.n, one.k, *(f"{p:.6f}" for p in shares)])
        return rows

    def place(self) -> CrossingPlace | None:
        """The place sought, once nothing more is wanted."""
        return crossing_place(self.graded)

    def answer(self) -> str:
        """One sentence with the size, its interval and unit, and what it rests on."""
        found, unit = self.place(), self.unit
        if found is None:
            return self._answer_of_ends()
        rising = self.graded.rising
        kept = self.looked[found.kept]
        low, high = kept.interval
        resolution = abs(self.grid[found.kept] - self.grid[found.broken])
        open_ends = found.least is None and found.most is None
        nothing = "; every value of the range may be the size" if open_ends else ""
        return (
            f"{self.limit.text} needs {self.key} of at {'least' if rising else 'most'} "
            f"{kept.value:g}{unit}, 95 % interval {self._interval(found)} ({kept.n} motions, the "
            f"same at each value; values {resolution:.3g}{unit} apart; P there "
            f"{100 * kept.k / kept.n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]){nothing}."
        )

    def _interval(self, found: CrossingPlace) -> str:
        ends = [
            "below the range" if found.least is None else f"{self.grid[found.least]:g}",
            "beyond the range" if found.most is None else f"{self.grid[found.most]:g}",
        ]
        return f"[{ends[0]}, {ends[1]}]{self.unit}"

    def _answer_of_ends(self) -> str:
        grades = self.graded.grades
        kept = grades[0] >= KEPT
        ends = ", ".join(
            f"{one.k} of {one.n} at {one.value:g}{self.unit}"
            for one in (self.looked[0], self.looked[len(self.grid) - 1])
        )
        pair = self.graded.bracket(SURELY_KEPT if kept else BROKEN)
        doubt = ""
        if pair:
            sure = self.grid[pair[1] if kept else pair[0]]
            doubt = f", with 95 % confidence {'from' if kept else 'up to'} {sure:g}{self.unit}"
            if not self.graded.rising:
                doubt = doubt.replace("from", "up to") if kept else doubt.replace("up to", "from")
        elif grades[0] in (BROKEN, KEPT):
            doubt = ", though the motions cannot tell it for sure"
        return (
            f"{self.limit.text} is {'kept' if kept else 'broken'} at both ends of {self.key} = "
            f"{self.grid[0]:g}:{self.grid[-1]:g}{self.unit}{doubt} ({ends}): the size lies beyond "
            "this range; give --vary another one."
        )

    def notes(self) -> list[str]:
        """What a reader has to know besides: motions too few, or motions that return."""
        told = []
        n = max((one.n for one in self.looked.values()), default=0)
        needed = runs_needed(self.limit.share)
        if n < needed:
            told.append(
                f"{n} motions cannot tell that {self.limit.text} even where none is beyond it: "
                f"{needed} can, so the interval of the size stays open"
            )
        if self.looked and (again := self.again()):
            told.append(
                f"{again} of {n} motions are beyond the limit at a value that is better for the "
                "rest: single motions are not monotone, and the size is that of the ensemble"
            )
        place = self.place() if self.graded.grades.keys() >= {0, len(self.grid) - 1} else None
        if place and n >= needed and None in (place.least, place.most):
            told.append("the interval of the size ends beyond --vary: give it a wider range")
        return told
