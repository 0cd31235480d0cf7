"""One line that says how far a study is."""

from __future__ import annotations

import time

from fecolumn.study.plan import Plan
from fecolumn.study.store import DONE, FAILED

_LOG_INTERVAL_S = 10.0


class Progress:
    """Counts of a running study: rewritten in place on a terminal, a line now and then in a log file.

    The remaining time is judged by steps, not by analyses: the longest come first.

    Args:
        plan: the study.
        rows: its ledger at the start.
        stream: terminal or file.
    """

    def __init__(self, plan: Plan, rows: list[dict], stream):
        self._efforts = {a.id: a.effort for a in plan.analyses}
        self._total, self._stream, self._tty = len(rows), stream, stream.isatty()
        self.done = sum(row["state"] == DONE for row in rows)
        self.failed = sum(row["state"] == FAILED for row in rows)
        self.overturned = sum(bool(row["summary"] and row["summary"]["overturned"]) for row in rows)
        self._remaining = sum(self._efforts[row["id"]] for row in rows if row["state"] not in (DONE, FAILED))
        self._start, self._ended, self._worked, self._shown = time.monotonic(), 0, 0.0, -_LOG_INTERVAL_S

    def count(self, case_id: str, state: str, summary: dict | None) -> None:
        """Take note of an analysis that has ended."""
        self.done += state == DONE
        self.failed += state == FAILED
        self.overturned += bool(state == DONE and summary["overturned"])
        self._ended += 1
        self._worked += self._efforts[case_id]
        self._remaining -= self._efforts[case_id]

    def line(self, elapsed_s: float) -> str:
        """The progress after `elapsed_s` of wall time [s]."""
        parts = [f"{self.done + self.failed}/{self._total} analyses"]
        if self._ended:
            parts.append(f"{60 * self._ended / elapsed_s:.3g} a minute")
            if self._remaining > 0:
                parts.append(f"{_clock(elapsed_s * self._remaining / self._worked)} to go")
        return ", ".join(parts + [f"{self.overturned} overturned", f"{self.failed} failed"])

    def show(self) -> None:
        """Write the line, at most once a second on a terminal and every ten in a file."""
        now = time.monotonic()
        if now - self._shown >= (1.0 if self._tty else _LOG_INTERVAL_S):
            self._shown = now
            self._write(now)

    def end(self) -> None:
        """Write the last state and close the line."""
        self._write(time.monotonic())
        if self._tty:
            self._stream.write("\n")

    def _write(self, now: float) -> None:
        line = self.line(max(now - self._start, 1e-9))
        self._stream.write(f"\r\x1b[K{line}" if self._tty else line + "\n")
        self._stream.flush()


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {seconds:02d} s" if minutes else f"{seconds} s"
