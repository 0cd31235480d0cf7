"""A CSV file with a header that a user brings: its lines with their numbers, for messages."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from pathlib import Path

from fecolumn.foundation.files import Unreadable, read_bytes
from fecolumn.foundation.schema import InputError


def read_csv(path: Path, needed: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Header, and each line's number in the file and its cells; lines that are blank or begin with
    # are left out.

    Parameters
    ----------
    needed
        what columns there must be, for the message of a file without lines.

    Raises
    ------
    InputError
        no such file, not text in UTF-8, no line below the header, quotes that do not end.
    """
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except Unreadable as error:
        raise InputError(path, "", None, str(error)) from None
    except UnicodeDecodeError as error:
        raise InputError(path, "", None, f"cannot be read as text in UTF-8 ({error})") from None
    lines = [
        (number, line)
        for number, line in enumerate(re.split(r"\r\n|\n|\r", text), 1)
        if line.strip() and not line.startswith("#")
    ]
    try:
        table = list(csv.reader([line for _, line in lines], skipinitialspace=True, strict=True))
    except csv.Error as error:
        raise InputError(path, "", None, f"cannot be read as CSV ({error})") from None
    if len(table) != len(lines):
        raise InputError(path, "", None, "cannot be read as CSV: a quote does not end in its line")
    if len(table) < 2:
        raise InputError(path, "", None, f"holds no line below its header; needed are {needed}")
    return [name.strip() for name in table[0]], [
        (number, row) for (number, _), row in zip(lines[1:], table[1:])
    ]


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
