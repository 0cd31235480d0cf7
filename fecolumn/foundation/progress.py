"""Progress: a bar of tqdm with words behind it, in place on a terminal and in a notebook; in a log
the words alone, every ten seconds.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from typing import Any, TextIO


class Bar:
    """A bar of `total`, in any unit, on `stream` (default: stderr), drawn in place at most every
    `pause_s` [s]; `keep`: its last state stays.
    """

    def __init__(
        self,
        total: float,
        quiet: bool = False,
        stream: TextIO | None = None,
        pause_s: float = 0.3,
        keep: bool = True,
    ) -> None:
        self.total, self._quiet, self._stream, self._keep = total, quiet, stream or sys.stderr, keep
        # a notebook's
        self._in_place = self._stream.isatty() or "ipykernel" in type(self._stream).__module__
        self._pause_s = pause_s if self._in_place else 10.0
        self._bar: Any = None
        self._began = self._shown = time.monotonic()

    def due(self) -> bool:
        """Whether it is time to draw."""
        return not self._quiet and time.monotonic() - self._shown >= self._pause_s

    def draw(self, done: float, words: str) -> None:
        """Draw it; a log on a full disk, or a terminal that is gone, ends nothing."""
        if self._quiet:
            return
        self._shown = time.monotonic()
        with contextlib.suppress(OSError):
            if not self._in_place:
                print(words, file=self._stream, flush=True)
                return
            if self._bar is None:
                from tqdm.auto import tqdm

                self._bar = tqdm(
                    total=self.total,
                    file=self._stream,
                    nrows=24,
                    leave=self._keep,
                    bar_format="{percentage:3.0f} %|{bar:12}| {desc}",
                )
            self._bar.ncols = _width(self._stream)
            self._bar.n = min(done, self.total)
            self._bar.set_description_str(words)

    def say(self, words: str) -> None:
        """A line of words above the bar, or in the log."""
        if self._quiet:
            return
        with contextlib.suppress(OSError):
            if self._bar is None:
                print(words, file=self._stream, flush=True)
            else:
                self._bar.write(words, file=self._stream)

    def left(self, done: float, total: float) -> str:
        """Time that the rest takes at the pace so far."""
        return clock((time.monotonic() - self._began) / done * (total - done))

    def end(self) -> None:
        """Close the line of a terminal."""
        if self._bar is not None:
            with contextlib.suppress(OSError):
                self._bar.close()


class Progress(Bar):
    """t, step, tilt, contact nodes, iterations and the time left of one analysis."""

    def __init__(
        self, steps: int, dt: float, quiet: bool = False, until_rest_from: int | None = None
    ) -> None:
        """`steps` to be made; from step `until_rest_from` on, where it is given, these are the most
        that are, and rest may come before.
        """
        super().__init__(steps if until_rest_from is None else until_rest_from, quiet)
        self.steps, self.dt = steps, dt
        self._first: int | None = None

    def show(self, step: int, measures: dict[str, Any], record: Any) -> None:
        """Show the state after `step` where it is time to."""
        if self._first is None:  # the first steps may compile, and tell nothing of the rest
            self._first, self._iterations, self._counted = step, record.iterations, step
            self._began = time.monotonic()
        elif self.due():
            rests = step >= self.total
            left = (
                "until at rest"
                if rests
                else self.left(step - self._first, self.total - self._first)
            )
            end = (
                f"at most {self.steps * self.dt:.2f} s"
                if rests and self.total < self.steps
                else f"{self.total * self.dt:.2f} s"
            )
            mean = (record.iterations - self._iterations) / max(step - self._counted, 1)
            self.draw(
                step,
                f"t {measures['time']:8.4f} of {end}  left {left}  step {step}  "
                f"tilt {measures['tilt']:.5f} rad  contact "
                f"{measures['active_nodes']:3d} nodes  iterations {mean:.1f}/step",
            )
            self._iterations, self._counted = record.iterations, step


class CountProgress(Bar):
    """How many of a number of things are done, and the time left."""

    def __init__(self, total: int, things: str, quiet: bool = False) -> None:
        """`total` of `things`, such as "pictures"."""
        super().__init__(total, quiet, keep=False)
        self._things = things

    def show(self, done: int) -> None:
        """Show that `done` are done where it is time to."""
        if self.due():
            self.draw(
                done, f"{done} of {self.total} {self._things}, left {self.left(done, self.total)}"
            )


def _width(stream: TextIO) -> int | None:
    """Columns of a terminal; None where it does not know, such as one without a screen."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or None
    except (OSError, ValueError, AttributeError):
        return None


def clock(seconds: float) -> str:
    """A time such as 1 h 05 min, 5 min 03 s or 3 s."""
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return (
        f"{hours} h {minutes:02d} min"
        if hours
        else f"{minutes} min {seconds:02d} s"
        if minutes
        else f"{seconds} s"
    )
