"""How long each step of an analysis takes, and what it did: `fecolumn run --profile`."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.dynamics.record import Record
from fecolumn.foundation.atomic import write_csv

#: File of the result folder with a row for each step
STEP_TIMES_FILE = "step_times.csv"
COUNTS = tuple(field.name for field in dataclasses.fields(Record))
#: Kinds of steps in the order in which they are told: the first that holds is a step's
HALVED, IN_PARTS, WITH_IMPACT, STANDS_STILL, FLYING = (
    "halved, for it failed",
    "in parts, as a rim rolls fast",
    "with an impact",
    "standing, no iteration",
    "in the air",
)
# Carrying points up to which steps without an impact are counted together
_BANDS = (2, 8, 40, 95)


class StepTimes:
    """Times of steps, made one at a time, and what they did.

    record: of the steps before; call_s: what making one alone takes beside the step itself [s].
    """

    def __init__(self, record: Record, call_s: float = 0.0) -> None:
        self._record, self._call_s = dataclasses.replace(record), call_s
        self._rows: list[list[float]] = []

    def note(self, time_s: float, spent_s: float, points: int, record: Record) -> None:
        """Note a step that ended at `time_s` and took `spent_s` [s].

        points: contact points that carry at its end; record: of all steps so far.
        """
        counts = np.subtract(dataclasses.astuple(record), dataclasses.astuple(self._record))
        self._record = dataclasses.replace(record)
        own = max(spent_s - self._call_s, 0.0)
        self._rows.append([time_s, 1e6 * own, points, *counts.tolist()])

    def write(self, folder: Path) -> None:
        """Write the rows."""
        header = ["time [s]", "step [us]", "carrying_points", *COUNTS]
        write_csv(folder / STEP_TIMES_FILE, [header, *self._rows])


def read_step_times(path: Path) -> NDArray[Any]:
    """Rows (k, 3 + counts) of `StepTimes.write`: time [s], step [us], points, counts."""
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


def kinds_of(rows: NDArray[Any]) -> list[tuple[str, NDArray[Any]]]:
    """Kinds of steps that occur, each with the rows (n, ...) of `read_step_times` that are of it;
    every step is of one kind.
    """
    points = rows[:, 2]
    count = {name: rows[:, 3 + place] for place, name in enumerate(COUNTS)}
    bands = zip((0, *_BANDS), (*_BANDS, np.inf))
    tests = [
        (HALVED, count["cuts"] > 0),
        (IN_PARTS, count["parts"] > 0),
        (WITH_IMPACT, count["impacts"] > 0),
        (FLYING, points == 0),
        (STANDS_STILL, count["contact_iterations"] == 0),
        *(
            (
                f"more than {low} points carry" if high == np.inf else f"{low + 1} to {high} carry",
                (points > low) & (points <= high),
            )
            for low, high in bands
        ),
    ]
    left, found = np.ones(len(rows), bool), []
    for name, holds in tests:
        here = left & holds
        left &= ~holds
        if here.any():
            found.append((name, rows[here]))
    return found


def step_table(rows: NDArray[Any]) -> str:
    """Markdown table of the kinds of steps: how many, their share of the time, how long they take
    and how many iterations they need.
    """
    place = {name: 3 + number for number, name in enumerate(COUNTS)}
    lines = [
        "| steps | number | share of the time | median [us] | 95 % below [us] | longest [us] "
        "| contact iterations a step | of impacts a step |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    whole = max(rows[:, 1].sum(), np.finfo(float).tiny)
    for name, some in [*kinds_of(rows), ("all", rows)]:
        spent = some[:, 1]
        middle, most = np.percentile(spent, [50, 95])
        lines.append(
            f"| {name} | {len(some):,} | {spent.sum() / whole:.0%} | {middle:,.0f} | {most:,.0f} | "
            f"{spent.max():,.0f} | {some[:, place['contact_iterations']].mean():.2g} | "
            f"{some[:, place['impact_iterations']].mean():.2g} |"
        )
    return "\n".join(lines)
