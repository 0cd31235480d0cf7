"""Columns of numbers: CSV with a header row, and plain two-column text."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.motions.column_names import (
    EXAMPLE,
    MOVED,
    NUMBER,
    NamedColumn,
    header_cells,
    may_be_passed_over,
    meaning_of,
    named_column,
    no_acceleration,
    unit_fault,
    units_of_row,
)
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import (
    acceleration_unit,
    check_end,
    check_last,
    parse_number,
    read_text,
    uniform_step,
)
from fecolumn.statistics.csv_table import CELL_MARKS, cells_of_lines, delimiter_of

# Numbers of a column from which its first may be their count: few are, by chance, a sample
_FEWEST_COUNTED = 10


def read_columns(path: Path | str, dt_s: float) -> Recording:
    """Recording of a text file with one row a sample.

    A header row (also as a comment, as numpy.savetxt writes it) names the columns time, ax, ay, az
    with their units in brackets, behind their names or in a row of their own, or the axes EW, NS
    and UD, or channels such as HNE: x is east. Velocities and displacements beside accelerations
    are passed over, as is a column that counts the rows. Without a header two columns are time [s]
    and acceleration, one column is acceleration. Columns are parted by commas, semicolons, tabs or
    spaces, and numbers may have a decimal comma where it parts nothing.

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
    words, comments, lines = _split(text)
    if len(lines) < 2:
        raise UnusableRecord(
            f"holds {len(lines)} sample{'s' * (len(lines) != 1)}; at least 2 are needed"
        )
    try:
        rows = cells_of_lines(lines, delimiter_of(lines[0][1]))
    except ValueError as error:
        raise UnusableRecord(str(error)) from None
    table = _table(rows)
    check_end(text, [row[-1] for _, row in rows[-12:]])
    check_last(text, table[:, -1])
    if table.shape[1] == 1:
        _check_count(rows, table[:, 0])
    columns = _known(_columns(words, comments, table.shape[1]), table)
    accelerations = [i for i, one in enumerate(columns) if one.meaning in ("", "x", "y", "z")]
    stated = {acceleration_unit(columns[i].unit) for i in accelerations}
    if len(stated) > 1:
        listed = ", ".join(columns[i].unit or "none" for i in accelerations)
        raise UnusableRecord(f"its columns have different units ({listed}); one is needed")
    dt = None
    if times := [i for i, one in enumerate(columns) if one.meaning == "time"]:
        time = table[:, times[0]] * columns[times[0]].factor
        dt = uniform_step(time, [row for row, _ in rows], dt_s)
    ((unit, factor),) = stated
    over = ", ".join(one.name for one in columns if one.meaning == MOVED)
    notes = [f"passed over: {over}"] * bool(over)
    if factor != 1.0:
        notes += [f"in {columns[accelerations[0]].unit}, {factor:g} {unit}"]
    return Recording(
        factor * table[:, accelerations],
        tuple(columns[i].meaning or "" for i in accelerations),
        dt,
        unit,
        Path(path).name,
        "; ".join(comments) or Path(path).name,
        "columns of text" + f" ({'; '.join(notes)})" * bool(notes),
    )


def _split(text: str) -> tuple[list[str], list[str], list[tuple[int, str]]]:
    """Lines of words above the numbers, the last one or two of which name the columns, comment
    texts, and the numbered lines of numbers.
    """
    comments: list[str] = []
    rows: list[tuple[int, str]] = []
    words: list[str] = []
    for row, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("#"):
            comments.append(line.strip().lstrip("# "))
        elif not line.strip(CELL_MARKS):
            continue  # blank, or the empty cells that a spreadsheet writes below a table
        elif rows or _begins_with_number(line.strip()):
            rows.append((row, line.strip().rstrip(CELL_MARKS)))
        else:
            words.append(line.strip(" ").rstrip(CELL_MARKS))
    return words, [comment for comment in comments if comment], rows


def _begins_with_number(line: str) -> bool:
    try:
        ((_, cells),) = cells_of_lines([(0, line)], delimiter_of(line))
        parse_number(cells[0])
    except ValueError:
        return False
    return True


def _table(rows: list[tuple[int, list[str]]]) -> NDArray[Any]:
    width = len(rows[0][1])
    values = np.empty((len(rows), width))
    for i, (row, cells) in enumerate(rows):
        if len(cells) != width:
            fewer = f": column {len(cells) + 1} is empty" * (len(cells) < width)
            raise UnusableRecord(f"line {row}: {len(cells)} columns where {width} are usual{fewer}")
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


def _check_count(rows: list[tuple[int, list[str]]], values: NDArray[Any]) -> None:
    """Refuse a single column that begins with the number of its samples, as some programs write
    it, with the step in the next line or without.
    """
    count = len(values)
    if count >= _FEWEST_COUNTED and values[0] in (count - 1, count - 2):
        line, then = rows[0][0], "" if values[0] == count - 1 else " and the step"
        raise UnusableRecord(
            f"line {line}: {values[0]:g} is the number of samples{then}, no sample: take it out"
        )


def _columns(words: list[str], comments: list[str], width: int) -> list[NamedColumn]:
    """Columns as lines of words, or the last comment, name them; what they are without a header."""
    cells: list[tuple[str, str]] = []
    if words:
        cells, units = header_cells(words[-1]), units_of_row(words[-1])
        title = len(words) - 1
        if units and title and len(named := header_cells(words[-2])) == len(units):
            cells = [(name, own or unit) for (name, own), unit in zip(named, units)]
            title -= 1
        comments += words[:title]
        if len(cells) == width + 1 and cells[0] == ("", ""):
            del cells[0]  # a line that begins with a tab
        if len(cells) != width:
            raise UnusableRecord(f"the header names {len(cells)} columns but {width} follow")
    elif comments:
        commented = header_cells(comments[-1])
        named_all = all(meaning_of(name) not in (None, MOVED, NUMBER) for name, _ in commented)
        cells = commented if len(commented) == width and named_all else []
    if cells:
        return [named_column(name, unit) for name, unit in cells]
    if width > 2:
        raise UnusableRecord(f"{width} columns need {EXAMPLE}")
    return [NamedColumn("time", "", "time"), NamedColumn("acceleration")][-width:]


def _known(columns: list[NamedColumn], table: NDArray[Any]) -> list[NamedColumn]:
    """The columns with what each is: time, acceleration, MOVED or NUMBER, which are passed over.

    A name that is not known is taken where it leaves no choice: of two columns, one of which is the
    time or rises evenly, the other is the acceleration.
    """
    columns = [_numbering(place, one, table) for place, one in enumerate(columns)]
    left = [place for place, one in enumerate(columns) if one.meaning != NUMBER]
    if not left:
        raise UnusableRecord(f"holds no acceleration; needs {EXAMPLE}")
    first, last = left[0], left[-1]
    timeless = columns[first].meaning is None and all(one.meaning != "time" for one in columns)
    no_choice = len(left) == 2 and columns[last].meaning in (None, "")
    if timeless and (no_choice or not columns[first].name) and _rises_evenly(table[:, first]):
        columns[first] = replace(columns[first], meaning="time")
    if len(left) == 2 and columns[first].meaning == "time" and columns[last].meaning is None:
        columns[last] = replace(columns[last], meaning="")
    beside = any(columns[place].meaning in ("", "x", "y", "z") for place in left)
    for place in left:
        one = columns[place]
        if beside and may_be_passed_over(one):
            columns[place] = replace(one, meaning=MOVED)
        elif one.meaning in (None, MOVED):
            raise no_acceleration(one)
        elif fault := unit_fault(one):
            raise UnusableRecord(fault)
    known = [columns[place] for place in left if columns[place].meaning != MOVED]
    meanings = [one.meaning for one in known]
    for place, one in enumerate(known):
        if one.meaning in meanings[:place]:
            raise UnusableRecord(f"column {one.name!r}: there are two of its kind; needs {EXAMPLE}")
    if not beside:
        raise UnusableRecord(f"holds no acceleration; needs {EXAMPLE}")
    if "" in meanings and {"x", "y", "z"} & set(meanings):
        raise UnusableRecord(f"does not name the axis of each component; needs {EXAMPLE}")
    return columns


def _numbering(place: int, column: NamedColumn, table: NDArray[Any]) -> NamedColumn:
    """A column that counts the rows as NUMBER; the index of a pandas.DataFrame has no name."""
    values = table[:, place]
    if column.meaning == NUMBER or (place == 0 and not column.name and not column.unit):
        if table.shape[1] > 1 and values[0] in (0, 1) and (np.diff(values) == 1).all():
            return replace(column, meaning=NUMBER)
    if column.meaning == NUMBER:
        raise no_acceleration(column)
    return column


def _rises_evenly(values: NDArray[Any]) -> bool:
    steps = np.diff(values)
    return bool(steps.min() > 0 and np.ptp(steps) < 0.1 * steps.mean())
