"""Where the probability of an event falls below a limit, along one parameter: bisection on whole
ensembles, and the interval of the place.

The same motions are run at every value. A value is judged by its count alone: with k events of n
motions the limit p surely does not hold where p lies below Wilson's 95 % interval of P, and surely
holds where p lies above it. The values in between cannot be told from the one sought: they are the
interval of the place, as the values that a test at 5 % does not refuse (Casella and Berger 2002,
section 9.2). Three bisections at once find its two ends and the place itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fecolumn.statistics.bands import normal_quantile
from fecolumn.statistics.ecdf import proportion_interval

#: Grades of a value: the limit is surely broken, broken by the estimate, kept by it, surely kept.
SURELY_BROKEN, BROKEN, KEPT, SURELY_KEPT = range(4)


def grade(k: int, n: int, share: float, strict: bool = True) -> int:
    """Grade of a value at which k of n runs had the event; `strict`: P must be below the share."""
    low, high = proportion_interval(k, n)
    if k / n > share or strict and k / n == share:
        return SURELY_BROKEN if low > share else BROKEN
    return SURELY_KEPT if high < share else KEPT


def runs_needed(share: float) -> int:
    """Least number of runs without a single event that tells P to be below a share: the upper end
    of Wilson's interval is then z^2 / (n + z^2).
    """
    return math.floor(normal_quantile(0.95) ** 2 * (1 - share) / share) + 1


@dataclass(frozen=True, slots=True)
class GradedValues:
    """Grades of some places of a grid of values, both ends among them at last.

    Attributes
    ----------
    count
        places of the grid.
    grades
        grade by place, counted from 0.
    """

    count: int
    grades: dict[int, int]

    @property
    def rising(self) -> bool:
        """Whether the limit is kept at large values rather than at small ones."""
        return self.grades[self.count - 1] >= self.grades[0]

    def wanted(self) -> list[int]:
        """Places to look at next; none where all is known."""
        ends = [place for place in (0, self.count - 1) if place not in self.grades]
        if ends:
            return ends
        wanted: list[int] = []
        for least in (BROKEN, KEPT, SURELY_KEPT):
            pair = self.bracket(least)
            if pair and abs(pair[1] - pair[0]) > 1:
                wanted.append(sum(pair) // 2)
        return list(dict.fromkeys(wanted))

    def bracket(self, least: int) -> tuple[int, int] | None:
        """Places, below the grade `least` and not, between which bisection of what is known ends;
        None where both ends of the grid are on one side.
        """
        below, above = (0, self.count - 1) if self.rising else (self.count - 1, 0)
        if self.grades[below] >= least or self.grades[above] < least:
            return None
        while abs(above - below) > 1 and (middle := (below + above) // 2) in self.grades:
            if self.grades[middle] >= least:
                above = middle
            else:
                below = middle
        return below, above

    def looks_left(self) -> int:
        """Most values that are still to be looked at."""
        pairs = [pair for least in (BROKEN, KEPT, SURELY_KEPT) if (pair := self.bracket(least))]
        return sum((abs(above - below) - 1).bit_length() for below, above in pairs)


@dataclass(frozen=True, slots=True)
class CrossingPlace:
    """The place sought on a grid.

    Attributes
    ----------
    kept
        nearest place at which the limit is kept by the estimate; its neighbour `broken` is not.
    least, most
        ends of the 95 % interval, rising places; None where it is open at that end of the grid.
    """

    kept: int
    broken: int
    least: int | None
    most: int | None


def crossing_place(values: GradedValues) -> CrossingPlace | None:
    """The place, of graded values that want no more; None where the limit is not crossed."""
    middle = values.bracket(KEPT)
    if middle is None:
        return None
    first, last = values.bracket(BROKEN), values.bracket(SURELY_KEPT)
    ends = (first[0] if first else None), (last[1] if last else None)
    least, most = ends if values.rising else ends[::-1]
    return CrossingPlace(middle[1], middle[0], least, most)
