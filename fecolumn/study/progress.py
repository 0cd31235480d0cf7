"""One line that says how far a study is."""

from __future__ import annotations

import json
import math
import time
from typing import TextIO

from fecolumn.foundation.progress import Bar, clock
from fecolumn.study.outcome import DONE, FAILED, TaskOutcome

# A study that takes longer [s] is told what would make it shorter
_LONG_S = 60.0


class StudyProgress(Bar):
    """Counts of a running study.

    The remaining time is judged by the work, not by analyses: the longest come first. Time in which
    workers wait for what is made once on a machine is told, and left out of it.

    Parameters
    ----------
    counts
        of the ledger at the start, number by state.
    effort
        expected work of what is missing, see `plan.PlannedAnalysis.effort`.
    workers
        how many there are.
    stream
        terminal or file; None for no progress.
    """

    def __init__(
        self, counts: dict[str, int], effort: float, workers: int, stream: TextIO | None
    ) -> None:
        super().__init__(effort, quiet=stream is None, stream=stream, pause_s=1.0)
        self.overturned, self.slid_off = counts.get("overturned", 0), counts.get("slid_off", 0)
        self._analyses = sum(counts.values()) - self.overturned - self.slid_off
        self._workers = max(workers, 1)
        self.done, self.failed = counts.get(DONE, 0), counts.get(FAILED, 0)
        self._remaining, self._worked, self.ended, self._busy_s = effort, 0.0, 0, 0.0
        self._shown = -math.inf
        self._preparing, self._prepared_s, self._began_s = "", 0.0, 0.0
        self._s_per_effort = 0.0

    def count(self, outcome: TaskOutcome, effort: float) -> None:
        """Take note of an analysis that has ended."""
        self.done += outcome.word == DONE
        self.failed += outcome.word == FAILED
        self.overturned += outcome.overturned
        self.slid_off += outcome.slid_off
        self.ended += 1
        self._busy_s += analysis_s(outcome) if outcome.started is not None else 0.0
        self._worked += effort
        self._remaining -= effort

    def busy(self, elapsed_s: float) -> float:
        """Share of the workers' time [-] that went into analyses that have ended, after `elapsed_s`
        of wall time [s], preparation apart.
        """
        return self._busy_s / (self._workers * max(elapsed_s - self._prepared_s, 1e-9))

    def prepare(self, words: str, elapsed_s: float) -> None:
        """Take note of what the workers wait for before they can begin, empty for nothing: that
        time is no analysis'.

        Parameters
        ----------
        words
            such as "compiling the reduced engine, once on this machine".
        elapsed_s
            wall time since the start [s].
        """
        if words:
            self._began_s = elapsed_s if words != self._preparing else self._began_s
            self._prepared_s = elapsed_s
        self._preparing = words

    def foresee(self, whole_s: float, effort: float, cheaper: str) -> None:
        """Take note of how long a running analysis will take [s], and of the keys that would make
        it cheaper, which are told once where all take long.
        """
        first, self._s_per_effort = not self._s_per_effort, whole_s / effort
        left = self._s_per_effort * self._remaining / self._workers
        if first and left > _LONG_S:
            self.say(
                f"one analysis takes about {clock(whole_s)}, all that are missing {clock(left)}; "
                f"{cheaper}"
            )

    def line(self, elapsed_s: float) -> str:
        """The progress after `elapsed_s` of wall time [s]."""
        parts = [f"{self.done + self.failed}/{self._analyses} analyses"]
        working_s = max(elapsed_s - self._prepared_s, 1e-9)
        if self._preparing:
            parts.append(f"{self._preparing} ... {clock(elapsed_s - self._began_s)}")
        if self.ended:
            rate = self.ended / working_s
            parts.append(f"{rate:.3g} a second" if rate >= 2 else f"{60 * rate:.3g} a minute")
            if self.done + self.failed < self._analyses:
                parts.append(f"{clock(working_s * max(self._remaining, 0.0) / self._worked)} to go")
        elif self._s_per_effort:
            whole = self._s_per_effort * self._remaining / self._workers
            parts.append(f"about {clock(max(whole - working_s, 0.0))} to go")
        parts += [
            f"{self.overturned} overturned",
            *([f"{self.slid_off} slid off"] if self.slid_off else []),
            f"{self.failed} failed",
        ]
        return ", ".join(
            parts + ([f"workers {100 * self.busy(elapsed_s):.0f} % busy"] if self.ended else [])
        )

    def show(self, preparing: str = "") -> None:
        """Draw the line where it is time to; `preparing` as of `prepare`."""
        self.prepare(preparing, time.monotonic() - self._began)
        if self.due():
            self._tell()

    def end(self) -> None:
        """Draw the last state and close the line."""
        self._preparing = ""
        self._tell()
        super().end()

    def _tell(self) -> None:
        self.draw(self._worked, self.line(max(time.monotonic() - self._began, 1e-9)))


def analysis_s(outcome: TaskOutcome) -> float:
    """Wall time of an analysis itself [s], without what it made or compiled for all: as its summary
    says, else as its worker has measured.
    """
    measured = outcome.wall_s or 0.0
    try:
        stated = json.loads(outcome.summary or "{}").get("wall_s")
    except (ValueError, AttributeError):
        return measured
    plain = isinstance(stated, (int, float)) and not isinstance(stated, bool)
    return min(measured, stated) if plain and stated > 0 else measured
