"""Progress lines: of one analysis, and of a count of things."""

from __future__ import annotations

import sys
import time


class Progress:
    """Writes t, step, tilt, contact nodes, iterations and the time left to stderr: in place on a terminal, every
    ten seconds in a log."""

    def __init__(self, steps: int, dt: float, quiet: bool = False, until_rest_from: int | None = None):
        """`steps` to be made; from step `until_rest_from` on, where it is given, these are the most that are, and rest may come before."""
        self.steps, self.dt, self.quiet, self._known = steps, dt, quiet, steps if until_rest_from is None else until_rest_from
        self._terminal = sys.stderr.isatty()
        self._began = self._shown = time.perf_counter()
        self._first: int | None = None
        self._iterations = 0

    def show(self, step: int, measures: dict, record) -> None:
        """Show the state after `step`, at most a few times a second."""
        now = time.perf_counter()
        if self._first is None:
            self._first, self._iterations, self._counted = step - 1, record.iterations, step
        if self.quiet or now - self._shown < (0.3 if self._terminal else 10.0):
            return
        left = _clock((now - self._began) / (step - self._first) * (self._known - step)) if step < self._known else "until at rest"
        end = f"{self._known * self.dt:.2f} s" if step < self._known or self._known == self.steps else f"at most {self.steps * self.dt:.2f} s"
        mean = (record.iterations - self._iterations) / max(step - self._counted, 1)
        line = (f"t {measures['time']:8.4f} of {end}  step {step}  tilt {measures['tilt']:.5f} rad  "
                f"contact {measures['active_nodes']:3d} nodes  iterations {mean:.1f}/step  left {left}")
        print(("\r" + line + "\x1b[K") if self._terminal else line, end="" if self._terminal else "\n", file=sys.stderr, flush=True)
        self._shown, self._iterations, self._counted = now, record.iterations, step

    def end(self) -> None:
        """Close the line on a terminal."""
        if self._terminal and not self.quiet:
            print(file=sys.stderr)


class CountProgress:
    """Writes how many of a number of things are done and the time left to stderr: in place on a terminal, every ten seconds in a log."""

    def __init__(self, total: int, things: str, quiet: bool = False):
        """`total` of `things`, such as "pictures"."""
        self.total, self.things, self.quiet = total, things, quiet
        self._terminal = sys.stderr.isatty()
        self._began = self._shown = time.perf_counter()

    def show(self, done: int) -> None:
        """Show that `done` are done, at most a few times a second."""
        now = time.perf_counter()
        if self.quiet or now - self._shown < (0.3 if self._terminal else 10.0):
            return
        line = f"{done} of {self.total} {self.things}, {100 * done / self.total:.0f} %, left {_clock((now - self._began) / done * (self.total - done))}"
        print(("\r" + line + "\x1b[K") if self._terminal else line, end="" if self._terminal else "\n", file=sys.stderr, flush=True)
        self._shown = now

    def end(self) -> None:
        """Clear the line on a terminal."""
        if self._terminal and not self.quiet:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"
