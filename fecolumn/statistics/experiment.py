"""Maxima of an experiment, or of any other source, from a CSV file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.csv_table import check_columns, check_row, number_of, read_csv

_TO_METRES = {"u_max_m": 1.0, "u_max_mm": 1e-3, "u_max_cm": 1e-2}
_WORDS = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}


@dataclass(frozen=True, slots=True)
class Maxima:
    """Peak displacements of an ensemble.

    Attributes
    ----------
    motions
        (n,) names, all different.
    u_max
        (n,) [m], nan where it overturned.
    overturned
        (n,) bool.
    """

    motions: tuple[str, ...]
    u_max: NDArray[Any]
    overturned: NDArray[Any]


def read_maxima(path: Path | str) -> Maxima:
    """Maxima of a CSV file with a header: motion, u_max_mm (or u_max_cm, u_max_m), overturned;
    other columns are ignored.

    overturned is 1 or 0 (true or false, yes or no); u_max may be blank where it is 1, and is not
    used there. Lines that begin with # are comments.

    Raises
    ------
    InputError
        no such file, a column missing or given twice, a value that cannot be used, a motion given
        twice.
    """
    path = Path(path)
    header, rows = read_csv(path, "the columns motion, u_max_mm and overturned")
    columns, factor = _columns(path, header)
    motions, maxima, overturned = [], [], []
    for number, row in rows:
        check_row(path, header, number, row)
        motion, u_text, word = (row[column].strip() for column in columns)
        if not motion or motion in motions:
            raise InputError(
                path,
                f"line {number}, motion",
                motion,
                "must be a name" if not motion else "stands twice in the file",
            )
        motions.append(motion)
        overturned.append(overturned_word(path, number, word))
        maxima.append(
            math.nan
            if overturned[-1]
            else factor * _number(path, number, header[columns[1]], u_text)
        )
    return Maxima(tuple(motions), np.array(maxima), np.array(overturned))


def _columns(path: Path, header: list[str]) -> tuple[tuple[int, int, int], float]:
    """Places of motion, u_max and overturned, and the factor to metres."""
    maxima = [name for name in header if name in _TO_METRES]
    if len(maxima) != 1:
        raise InputError(
            path,
            "header",
            ", ".join(header),
            f"must have one of the columns {', '.join(_TO_METRES)}: the unit is part of the name"
            + ("; columns are parted by commas, semicolons or tabs" if len(header) == 1 else ""),
        )
    check_columns(path, header, ("motion", "overturned"))
    return (
        header.index("motion"),
        header.index(maxima[0]),
        header.index("overturned"),
    ), _TO_METRES[maxima[0]]


def overturned_word(path: Path, number: int, word: str) -> bool:
    """Whether a line of a file says that it overturned; InputError where it says neither."""
    if word.lower() not in _WORDS:
        raise InputError(
            path, f"line {number}, overturned", word, f"must be one of {', '.join(_WORDS)}"
        )
    return _WORDS[word.lower()]


def _number(path: Path, number: int, column: str, text: str) -> float:
    """The displacement of a run that stood, at least 0."""
    value = number_of(text)
    if not (math.isfinite(value) and value >= 0):
        raise InputError(
            path,
            f"line {number}, {column}",
            text,
            f"must be a number of at least 0 [{column.rpartition('_')[2]}]; it may be "
            "blank only where overturned is 1",
        )
    return value
