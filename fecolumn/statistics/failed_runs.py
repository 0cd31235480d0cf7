"""What a count of runs says where some failed: bounds that hold whatever those would have done.

Failed runs are not a random part of all, as many fail by their response. With k events of n runs
that are done and f that failed, the share of events of all lies between k / (n + f), where no
failed run would have been an event, and (k + f) / (n + f), where all would (worst-case bounds of
missing outcomes: Manski 1989, The Journal of Human Resources 24).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from fecolumn.statistics.ecdf import share_interval
from fecolumn.statistics.records import Records


@dataclass(frozen=True, slots=True)
class RunCount:
    """k events of n runs that are done, beside `failed` runs of which nobody knows; n + failed is
    at least 1.
    """

    k: int
    n: int
    failed: int = 0

    @property
    def runs(self) -> int:
        """Those that are done and those that failed."""
        return self.n + self.failed

    @property
    def share(self) -> float:
        """Of events among the runs that are done; nan where none is."""
        return self.k / self.n if self.n else math.nan

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest share of events of all runs, with no failed one and with all."""
        return self.k / self.runs, (self.k + self.failed) / self.runs

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval (Wilson) of the probability, as of `interval_of_all`."""
        return interval_of_all([True] * self.k + [False] * (self.n - self.k), self.failed)

    @property
    def text(self) -> str:
        """Such as "25.0 % [8.9, 53.2]"; of failed runs "between 18.8 and 43.8 % [6.6, 66.8]"."""
        low, high = (f"{100 * end:.1f}" for end in self.interval)
        if not self.failed:
            return f"{100 * self.share:.1f} % [{low}, {high}]"
        least, most = (f"{100 * end:.1f}" for end in self.bounds)
        return f"between {least} and {most} % [{low}, {high}]"


def interval_of_all(
    happened: Sequence[bool], failed: int, records: Records = None
) -> tuple[float, float]:
    """95 % interval (Wilson) of a probability: its lower end with no failed run as an event, its
    upper end with all of them.

    Parameters
    ----------
    happened
        (n,) of the runs that are done.
    failed
        number of those that failed; n + failed is at least 1.
    records
        (n,) record of each run that is done, None where each has its own, as every failed one is
        taken to have.
    """
    of_all = None if records is None else [*records, *range(failed)]
    low, _ = share_interval([*happened, *[False] * failed], of_all)
    _, high = share_interval([*happened, *[True] * failed], of_all)
    return low, high
