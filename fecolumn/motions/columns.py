"""Columns of numbers: CSV with a header row, and plain two-column text."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import (
    check_end,
    check_last,
    parse_number,
    read_text,
    uniform_step,
    unit_named,
)

# Axes by the compass, as `directions` has them: x is east, y north, z up
_COMPASS = {
    "x": ("ew", "e-w", "e_w", "e", "east"),
    "y": ("ns", "n-s", "n_s", "n", "north"),
    "z": ("ud", "u-d", "u_d", "up", "vertical", "vert"),
}
_NAMES = {
    "time": ("time", "t", "seconds", "zeit", "temps", "tempo", "tiempo"),
    **{
        axis: tuple(
            f"{before}{name}"
            for name in (axis, *compass)
            for before in ("", "a", "a_", "acc", "acc_", "acc ")
        )
        for axis, compass in _COMPASS.items()
    },
    "": ("a", "acc", "accel", "acceleration", "beschleunigung", "accelerazione", "aceleracion"),
}
_MEANING = {name: meaning for meaning, names in _NAMES.items() for name in names}
# Words of a header, in several tongues, that say what a column is not
_NO_ACCELERATION = re.compile(
    r"vel|disp|weg|geschw|^[vud][xyz]?$|index|sample|^no$|^nr$|#", re.IGNORECASE
)
# Units behind names, as in time_s, acc_x_m_s2
_SUFFIX = re.compile(
    r"(?P<name>.+?)_(?P<unit>m_s2|cm_s2|mm_s2|m_s_2|m/s2|cm/s2|mm/s2|mps2|gal|g|sec|ms|s)"
)
_WRITTEN = {"m_s2": "m/s2", "m_s_2": "m/s2", "mps2": "m/s2", "cm_s2": "cm/s2", "mm_s2": "mm/s2"}
_SECONDS = {"": 1.0, "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3}
_COMMA = re.compile(r"[-+]?\d+(,\d+)?([eEdD][-+]?\d+)?")
_CELL = re.compile(
    r"""["']?\s*(?P<name>[^\[\](),;\t"']*?)\s*(?:[\[(]\s*(?P<unit>[^\])]*?)\s*[\])])?\s*["']?"""
)
_SPACED_CELL = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
_EXAMPLE = "a header row such as: time [s], ax [g], ay [g]"


def read_columns(path: Path | str, dt_s: float) -> Recording:
    """Recording of a text file with one row a sample.

    A header row (also as a comment, as numpy.savetxt writes it) names the columns time, ax, ay, az
    with their units in brackets, or the axes EW, NS and UD: x is east. Without a header two columns
    are time [s] and acceleration, one column is acceleration. Columns are parted by commas,
    semicolons, tabs or spaces; with semicolons or tabs a decimal comma is understood.

    Parameters
    ----------
    path
        the file; lines that start with # are comments.
    dt_s
        sampling step stated by the case [s], 0 if none.

    Raises
    ------
    UnusableRecord
        unknown columns or units, rows of different length, no number, no even time.
    """
    text = read_text(path)
    header, comments, rows = _split(text)
    if len(rows) < 2:
        raise UnusableRecord(
            f"holds {len(rows)} sample{'s' * (len(rows) != 1)}; at least 2 are needed"
        )
    lines = [row for row, _ in rows]
    table = _table(rows)
    check_end(text, [_cells(row)[-1] for _, row in rows[-12:]])
    check_last(text, table[:, -1])
    meanings, units = _columns(header, comments, table)
    accelerations = [i for i, meaning in enumerate(meanings) if meaning != "time"]
    stated = {unit_named(units[i]) if units[i] else "" for i in accelerations}
    if len(stated) > 1:
        listed = ", ".join(units[i] or "none" for i in accelerations)
        raise UnusableRecord(f"its columns have different units ({listed}); one is needed")
    dt = None
    if "time" in meanings:
        time = meanings.index("time")
        dt = uniform_step(table[:, time] * _SECONDS[units[time].lower()], lines, dt_s)
    return Recording(
        table[:, accelerations],
        tuple(meanings[i] for i in accelerations),
        dt,
        stated.pop(),
        Path(path).name,
        "; ".join(comments) or Path(path).name,
        "columns of text",
    )


def _split(text: str) -> tuple[str, list[str], list[tuple[int, str]]]:
    """Header line or "", comment texts, and the numbered lines of numbers."""
    comments: list[str] = []
    rows: list[tuple[int, str]] = []
    header = ""
    for row, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if line.startswith("#"):
            comments.append(line.lstrip("# "))
        elif line and not rows and not _is_number(_cells(line)[0]):
            # of several lines of words the last one names the columns
            comments += [header] if header else []
            header = line
        elif line:
            rows.append((row, line))
    return header, [comment for comment in comments if comment], rows


def _cells(line: str) -> list[str]:
    delimiter = next((mark for mark in ";\t," if mark in line), None)
    if delimiter == "," and (words := line.split())[1:] and all(map(_COMMA.fullmatch, words)):
        delimiter = None  # spaces between numbers with decimal commas
    cells = line.rstrip(";,").split(delimiter)
    return [cell.strip() if delimiter == "," else cell.strip().replace(",", ".") for cell in cells]


def _is_number(cell: str) -> bool:
    try:
        parse_number(cell)
    except ValueError:
        return False
    return True


def _table(rows: list[tuple[int, str]]) -> NDArray[Any]:
    width = len(_cells(rows[0][1]))
    values = np.empty((len(rows), width))
    for i, (row, line) in enumerate(rows):
        cells = _cells(line)
        if len(cells) != width:
            raise UnusableRecord(f"line {row}: {len(cells)} columns where {width} are usual")
        for j, cell in enumerate(cells):
            try:
                values[i, j] = parse_number(cell)
            except ValueError:
                raise UnusableRecord(f"line {row}: {cell[:40]!r} is not a number") from None
            if not np.isfinite(values[i, j]):
                raise UnusableRecord(
                    f"line {row}: {cell} in column {j + 1}; every value must be finite"
                )
    return values


def _header_cells(line: str) -> list[tuple[str, str]]:
    cells = (
        re.split(r"[,;\t]", line.rstrip(",;"))
        if re.search(r"[,;\t]", line)
        else _SPACED_CELL.findall(line)
    )
    found = [_CELL.fullmatch(cell.strip()) for cell in cells]
    return [
        (cell["name"].lower(), cell["unit"] or "") if cell else (text.strip(), "")
        for cell, text in zip(found, cells)
    ]


def _columns(header: str, comments: list[str], table: NDArray[Any]) -> tuple[list[str], list[str]]:
    """Meaning and unit of each column.

    A name that is not known is taken where it leaves no choice: of two columns, one of which is the
    time or rises evenly, the other is the acceleration.
    """
    width = table.shape[1]
    cells = _header_cells(header) if header else []
    if not header and comments:
        commented = _header_cells(comments[-1])
        cells = (
            commented
            if len(commented) == width and all(name in _MEANING for name, _ in commented)
            else []
        )
    if not cells:
        if width > 2:
            raise UnusableRecord(f"{width} columns need {_EXAMPLE}")
        return (["time", ""][-width:], [""] * width)
    if len(cells) != width:
        raise UnusableRecord(f"the header names {len(cells)} columns but {width} follow")
    meanings: list[str] = []
    units: list[str] = []
    cells = [_unit_apart(name, unit) for name, unit in cells]
    for column, (name, unit) in enumerate(cells):
        meaning = _MEANING.get(name)
        if meaning is None and width == 2 and not _NO_ACCELERATION.search(name):
            others = _MEANING.get(cells[1 - column][0])
            if column == 0 and others in (None, "") and _rises_evenly(table[:, 0]):
                meaning, unit = "time", unit if unit.lower() in _SECONDS else ""
            elif meanings[:1] == ["time"]:
                meaning, unit = "", unit if unit_named(unit) else ""
        if meaning is None:
            raise UnusableRecord(
                f"column {name!r} is not known; must be one of time, ax, ay, az, or EW, NS, UD, "
                f"in {_EXAMPLE}"
            )
        if meaning in meanings:
            raise UnusableRecord(f"column {name!r}: there are two of its kind; needs {_EXAMPLE}")
        if meaning == "time" and unit.lower() not in _SECONDS:
            raise UnusableRecord(f"time in {unit!r} is not known; must be s or ms")
        if meaning != "time" and unit and not unit_named(unit):
            raise UnusableRecord(
                f"unit {unit!r} of column {name!r} is not known; must be g, m/s2, cm/s2 or mm/s2"
            )
        meanings.append(meaning)
        units.append(unit)
    if meanings == ["time"]:
        raise UnusableRecord(f"holds no acceleration; needs {_EXAMPLE}")
    if "" in meanings and {"x", "y", "z"} & set(meanings):
        raise UnusableRecord(f"does not name the axis of each component; needs {_EXAMPLE}")
    return meanings, units


def _unit_apart(name: str, unit: str) -> tuple[str, str]:
    """Name and unit of a column such as time_s."""
    found = None if unit or name in _MEANING else _SUFFIX.fullmatch(name)
    return (found["name"], _WRITTEN.get(found["unit"], found["unit"])) if found else (name, unit)


def _rises_evenly(values: NDArray[Any]) -> bool:
    steps = np.diff(values)
    return bool(steps.min() > 0 and np.ptp(steps) < 0.1 * steps.mean())
