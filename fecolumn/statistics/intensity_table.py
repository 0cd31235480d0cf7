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
    """

    measures: dict[str, NDArray[Any]]
    overturned: NDArray[Any]
    records: NDArray[Any] | None


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
