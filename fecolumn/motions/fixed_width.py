"""Blocks of numbers in columns of fixed width, as strong-motion networks write them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.motions.record import UnusableRecord
from fecolumn.motions.text import finite_number, parse_number

# How far the largest sample may be from the peak that a header states, as a share of that peak and
# in units of the last digit it is written with
_PEAK, _DIGITS = 1e-3, 0.51
_FORMAT = re.compile(r"\(?\s*(?:1P\s*,?\s*)?(\d+)\s*[FEIG]\s*(\d+)(?:\.\d+)?\s*\)?", re.IGNORECASE)


def layout(text: str, row: int) -> tuple[int, int]:
    """Numbers a line and width of a number, of a Fortran format such as (8F10.6).

    Raises
    ------
    UnusableRecord
        the text is no such format, or one of no numbers.
    """
    found = _FORMAT.search(text)
    many, width = (int(found[1]), int(found[2])) if found else (0, 0)
    if not (0 < many <= 100 and 1 < width <= 40):
        raise UnusableRecord(
            f"line {row}: {text.strip()[:40]!r} must be a format of numbers, as in (8F10.6)"
        )
    return many, width


def number_block(
    lines: Sequence[str], first: int, count: int, many: int, width: int
) -> tuple[NDArray[Any], int]:
    """Numbers of a block and the index of the line after it.

    Every line is full but the last one; every number ends where its column does, so that a file
    that lost letters, or was cut off, is found out.

    Parameters
    ----------
    lines
        of the whole file.
    first
        index of the block's first line.
    count
        numbers of the block.
    many
        numbers a line.
    width
        of a number [characters].

    Returns
    -------
    values
        (count,).
    after
        index of the line behind the block.

    Raises
    ------
    UnusableRecord
        lines are missing, too short or too long, or a number is none.
    """
    rows = -(-count // many)
    if first + rows > len(lines):
        raise UnusableRecord(
            f"line {len(lines)}: the file ends after at most {(len(lines) - first) * many} of "
            f"{count} numbers that its header states: it is cut off"
        )
    values = np.empty(count)
    for i in range(rows):
        row, line = first + i + 1, lines[first + i].rstrip()
        here = min(many, count - i * many)
        if len(line) != here * width:
            raise UnusableRecord(
                f"line {row}: {len(line)} characters, where {here} numbers of {width} characters "
                f"are {here * width}"
            )
        for j in range(here):
            values[i * many + j] = finite_number(line[j * width : (j + 1) * width], row)
    return values, first + rows


def check_peak(values: NDArray[Any], stated: str, unit: str) -> None:
    """Refuse values whose largest is not the peak that the header states.

    Parameters
    ----------
    values
        (n,) [unit].
    stated
        the peak, as it is written; of either sign.
    unit
        of both, for the message.

    Raises
    ------
    UnusableRecord
        they differ by more than rounding.
    """
    peak, largest = abs(parse_number(stated)), float(np.abs(values).max())
    mantissa, _, exponent = stated.strip().upper().replace("D", "E").partition("E")
    digits = len(mantissa.partition(".")[2]) - int(exponent or 0)
    if abs(peak - largest) > _PEAK * peak + _DIGITS * 10.0**-digits:
        raise UnusableRecord(
            f"its largest value is {largest:g} {unit} but its header states a peak of "
            f"{stated.strip()} {unit}: samples are damaged or missing"
        )


def above_zero(text: str, row: int, what: str) -> float:
    """Number of a header, in its own unit, such as the step; `what` names it.

    Raises
    ------
    UnusableRecord
        it is no finite number above 0.
    """
    try:
        value = parse_number(text)
    except ValueError:
        value = np.nan
    if not 0 < value < np.inf:
        raise UnusableRecord(f"line {row}: {what} = {text.strip()!r} must be a number above 0")
    return value
