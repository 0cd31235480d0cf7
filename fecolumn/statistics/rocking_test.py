"""Tilt over time of a free-rocking or pull-release test, from a CSV file."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.csv_table import check_row, number_of, read_csv

_TIMES = {"time_s": 1.0, "time_ms": 1e-3}
_TILTS = {"tilt_rad": 1.0, "tilt_mrad": 1e-3, "tilt_deg": math.pi / 180}
_NEEDED = (
    f"one column of {', '.join(_TIMES)} and one of {', '.join(_TILTS)}; time [s], tilt [deg] and "
    "the like do as well"
)
# A name with its unit in brackets, as fecolumn writes histories
_IN_BRACKETS = re.compile(r"(time|tilt) ?\[(\w+)\]")
_FEWEST = 20  # samples
# What a test in its right unit keeps to. A block of 50 m falls upright from near its balance within
# some seconds: samples further apart [s] do not show it rock. The smallest object, of 1 cm, takes
# longer to fall upright than the shortest test [s]; no test takes longer than the longest [s]
_FURTHEST, _SHORTEST, _LONGEST = 1.0, 0.05, 3600.0
_LEAST_TILT = 1e-5  # [rad] at the release: less is noise of any sensor


@dataclass(frozen=True, slots=True)
class RockingTest:
    """Times (n,) [s] from the release on, rising from 0, and the size of the tilt (n,) [rad]."""

    time: NDArray[Any]
    tilt: NDArray[Any]


def read_rocking_test(path: Path | str) -> RockingTest:
    """A test whose first line is the moment of release from rest; the tilt's sign is not used.

    Raises
    ------
    InputError
        no such file or column, a value that cannot be, times that do not rise, no tilt at the
        release.
    """
    path = Path(path)
    header, rows = read_csv(path, _NEEDED)
    columns = []
    for units in (_TIMES, _TILTS):
        names = [_IN_BRACKETS.sub(r"\1_\2", name) for name in header]
        there = [(place, units[name]) for place, name in enumerate(names) if name in units]
        if len(there) != 1:
            raise InputError(path, "header", ", ".join(header), f"must have {_NEEDED}")
        columns.append(there[0])
    values: list[list[float]] = []
    for number, row in rows:
        check_row(path, header, number, row)
        cells = []
        for place, factor in columns:
            text = row[place].strip()
            cell = factor * number_of(text)
            if not math.isfinite(cell):
                raise InputError(
                    path, f"line {number}, {header[place]}", text, "must be a finite number"
                )
            cells.append(cell)
        if values and cells[0] <= values[-1][0]:
            raise InputError(
                path,
                f"line {number}, {header[columns[0][0]]}",
                row[columns[0][0]].strip(),
                "must be later than the line before",
            )
        if abs(cells[1]) >= math.pi / 2:
            raise InputError(
                path,
                f"line {number}, {header[columns[1][0]]}",
                row[columns[1][0]].strip(),
                "must be below a quarter of a turn: check its unit",
            )
        values.append(cells)
    if len(values) < _FEWEST:
        raise InputError(
            path, "", None, f"has {len(values)} samples; at least {_FEWEST} are needed"
        )
    time, tilt = np.array(values).T
    if abs(tilt[0]) < _LEAST_TILT:
        raise InputError(
            path,
            f"line {rows[0][0]}, {header[columns[1][0]]}",
            rows[0][1][columns[1][0]].strip(),
            f"must not be below {_LEAST_TILT:g} rad: the first line is the release, cut off what "
            "is before it, and check its unit",
        )
    _check_times(path, header[columns[0][0]], time - time[0])
    return RockingTest(time - time[0], np.abs(tilt))


def _check_times(path: Path, name: str, time: NDArray[Any]) -> None:
    """Refuse times of another unit than their name says."""
    apart, long = float(np.median(np.diff(time))), float(time[-1])
    if apart > _FURTHEST:
        told = f"half of the samples are {apart:.3g} s or more apart, which must be at most "
        raise InputError(path, name, None, f"{told}{_FURTHEST:g} s: check its unit")
    if not _SHORTEST <= long <= _LONGEST:
        told = f"the test lasts {long:.3g} s, which must be {_SHORTEST:g} to {_LONGEST:g} s"
        raise InputError(path, name, None, f"{told}: check its unit")
