"""Runs with their intensities and outcomes from a user's own CSV file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.csv_table import check_columns, check_row, number_of, read_csv
from fecolumn.statistics.experiment import overturned_word

#: Columns that are no intensity measure
_OTHERS = (
    *("motion", "record", "overturned", "outcome", "notes", "number", "impacts"),
    *("duration_s", "end_s"),  # now, and in earlier versions
)
_RESPONSES = ("u_max", "tilt_max")


@dataclass(frozen=True, slots=True)
class FailedRuns:
    """f runs that failed beside n that are done, of which nobody knows how they would have ended.

    Attributes
    ----------
    measures
        name of each intensity measure to its values (g,), positive, of the g <= f runs whose motion
        has an intensity; None where they are not to be found.
    records
        (n + g,) what the motion of each run is of, those that are done first.
    count
        f.
    why
        in words, with what to do.
    """

    measures: dict[str, NDArray[Any]] | None
    records: NDArray[Any]
    count: int
    why: str


@dataclass(frozen=True, slots=True)
class IntensityTable:
    """n runs.

    Attributes
    ----------
    measures
        name of each intensity measure to its values (n,), positive.
    overturned
        (n,) bool.
    records
        (n,) what the motion of each run is of, where runs repeat one; None where each stands for
        itself.
    failed
        runs that failed; None where none did, or none is known of.
    """

    measures: dict[str, NDArray[Any]]
    overturned: NDArray[Any]
    records: NDArray[Any] | None
    failed: FailedRuns | None = None

    def bounds(self) -> tuple[IntensityTable, ...]:
        """Tables of all runs, with none and with all of the failed ones overturned: the extremes of
        what those would have done. None where no run failed, or the intensities of those that
        failed are not known.
        """
        if self.failed is None or self.failed.measures is None:
            return ()
        records, more = self.failed.records, self.failed.measures
        measures = {name: np.append(values, more[name]) for name, values in self.measures.items()}
        return tuple(
            IntensityTable(
                measures,
                np.append(self.overturned, np.full(len(records) - len(self.overturned), fallen)),
                records if len(set(records)) < len(records) else None,
            )
            for fallen in (False, True)
        )


def read_intensity_table(path: Path | str, wanted: tuple[str, ...] = ()) -> IntensityTable:
    """Runs of a CSV file with a header: overturned (1 or 0, true or false, yes or no), and columns
    of intensity measures.

    A column record, or else motion, tells which runs are of one motion at several scales. Lines
    that begin with # are comments.

    Parameters
    ----------
    wanted
        names of the measures; none: all columns of positive numbers that are no response.

    Raises
    ------
    InputError
        no such file, a column missing, a value that cannot be used.
    """
    path = Path(path)
    header, rows = read_csv(path, "the column overturned and one of an intensity measure")
    check_columns(path, header, ("overturned", *wanted))
    for number, row in rows:
        check_row(path, header, number, row)
    columns = {name: [row[place].strip() for _, row in rows] for place, name in enumerate(header)}
    numbers = [number for number, _ in rows]
    fallen = np.array(
        [
            overturned_word(path, number, word)
            for number, word in zip(numbers, columns["overturned"])
        ]
    )
    names = wanted or tuple(
        name
        for name in header
        if name not in _OTHERS
        and not name.startswith(_RESPONSES)
        and all(_positive(text) for text in columns[name])
    )
    if not names:
        raise InputError(
            path,
            "header",
            ", ".join(header),
            "must have a column of an intensity measure, of positive numbers in every line",
        )
    measures = {}
    for name in names:
        for number, text in zip(numbers, columns[name]):
            if not _positive(text):
                raise InputError(
                    path, f"line {number}, {name}", text, "must be a number greater than 0"
                )
        measures[name] = np.array([float(text) for text in columns[name]])
    labels = next(
        (np.array(columns[name]) for name in ("record", "motion") if name in columns), None
    )
    return IntensityTable(
        measures, fallen, labels if labels is not None and len(set(labels)) < len(labels) else None
    )


def _positive(text: str) -> bool:
    return 0 < number_of(text) < math.inf
