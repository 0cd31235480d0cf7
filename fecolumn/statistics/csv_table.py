"""Tables of text that a user brings: lines with their numbers, for messages, in cells parted by
semicolons, tabs, commas or blanks, with quotes, and with decimal points or commas.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable
from pathlib import Path

from fecolumn.foundation.files import Unreadable, read_any_text
from fecolumn.foundation.schema import InputError

#: What may stand behind the last cell of a line; a line of nothing else is blank.
CELL_MARKS = ";,\t \r\f\v"
_QUOTED = re.compile(r'"[^"]*"')
# Numbers as they stand between blanks, with a decimal comma, and with a decimal point
_NUMBER = re.compile(r"[-+]?\d+(,\d+)?([eEdD][-+]?\d+)?")
_WITH_COMMA = re.compile(r"[-+]?\d*,\d+([eEdD][-+]?\d+)?")
_WITH_POINT = re.compile(r"[-+]?(\d+\.\d*|\.\d+)([eEdD][-+]?\d+)?")


def number_of(text: str) -> float:
    """The number of a cell; nan where it holds none. Python's grouping, as in 12_5, is none."""
    try:
        return math.nan if "_" in text else float(text)
    except ValueError:
        return math.nan


def delimiter_of(line: str) -> str:
    """What parts the cells of a line, by what stands outside of its quotes: a semicolon, a tab, a
    comma, or else blanks. Commas between numbers that blanks part are decimal commas.
    """
    bare = _QUOTED.sub('""', line)
    delimiter = next((mark for mark in ";\t," if mark in bare), " ")
    if delimiter == "," and (words := bare.split())[1:] and all(map(_NUMBER.fullmatch, words)):
        return " "
    return delimiter


def cells_of_lines(lines: list[tuple[int, str]], delimiter: str) -> list[tuple[int, list[str]]]:
    """Each line's number in the file and its cells, without their quotes; numbers with a decimal
    comma have a decimal point.

    Parameters
    ----------
    lines
        with their numbers in the file.
    delimiter
        as of `delimiter_of`.

    Raises
    ------
    ValueError
        quotes that do not end in their line, or decimal commas and points in one column.
    """
    texts = [line for _, line in lines]
    if delimiter == " ":
        table = [[word.strip('"') for word in text.split()] for text in texts]
    else:
        table = []
        try:
            for row in csv.reader(texts, delimiter=delimiter, skipinitialspace=True, strict=True):
                table.append([cell.strip() for cell in row])
        except csv.Error as error:
            number = lines[min(len(table), len(lines) - 1)][0]
            raise ValueError(f"line {number}: {error}") from None
        if len(table) != len(lines):
            raise ValueError("a quote does not end in its line")
    for place in range(max(map(len, table), default=0)):
        _take_points(lines, table, place)
    return [(number, row) for (number, _), row in zip(lines, table)]


def _take_points(lines: list[tuple[int, str]], table: list[list[str]], place: int) -> None:
    """Give the numbers of a column their decimal points."""
    rows = [row for row in table if place < len(row)]
    commas = [row for row in rows if "," in row[place] and _WITH_COMMA.fullmatch(row[place])]
    if not commas:
        return
    if point := next((row for row in rows if _WITH_POINT.fullmatch(row[place])), None):
        (number, _), comma = next(
            (line, row) for line, row in zip(lines, table) if row is commas[0]
        )
        raise ValueError(
            f"line {number}: {comma[place]!r} has a decimal comma where {point[place]!r} of the "
            "same column has a decimal point"
        )
    for row in commas:
        row[place] = row[place].replace(",", ".")


def read_csv(path: Path, needed: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Header, and each line's number in the file and its cells, as of `cells_of_lines`; lines that
    are blank or begin with # are left out. The header says what parts the cells.

    Parameters
    ----------
    needed
        what columns there must be, for the message of a file without lines.

    Raises
    ------
    InputError
        no such file, not text, no line below the header, quotes that do not end.
    """
    try:
        text = read_any_text(path)
    except Unreadable as error:
        raise InputError(path, "", None, str(error)) from None
    lines = [
        (number, line)
        for number, line in enumerate(re.split(r"\r\n|\n|\r", text), 1)
        if line.strip(CELL_MARKS) and not line.startswith("#")
    ]
    if len(lines) < 2:
        raise InputError(path, "", None, f"holds no line below its header; needed are {needed}")
    try:
        (_, header), *rows = cells_of_lines(lines, delimiter_of(lines[0][1]))
    except ValueError as error:
        raise InputError(path, "", None, f"cannot be read as CSV ({error})") from None
    return header, rows


def check_columns(path: Path, header: list[str], names: Iterable[str]) -> None:
    """InputError where there is not one column of each of these names."""
    for name in names:
        if header.count(name) != 1:
            raise InputError(path, "header", ", ".join(header), f"must have one column {name}")


def check_row(path: Path, header: list[str], number: int, row: list[str]) -> None:
    """InputError where the line of this number has more or fewer cells than the header."""
    if len(row) != len(header):
        raise InputError(
            path,
            f"line {number}",
            None,
            f"has {len(row)} columns where the header has {len(header)}",
        )
