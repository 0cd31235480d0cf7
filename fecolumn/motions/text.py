"""What all text formats share: reading a file, numbers as Fortran writes them, names of units."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.files import Unreadable, read_any_text
from fecolumn.motions.record import UnusableRecord
from fecolumn.motions.spike import SPIKE_JUMPS, SPIKE_SAMPLES

_SPELLINGS = {
    "g": ("g", "g's"),
    "m/s2": ("m/s2", "m/s/s", "ms-2"),
    "cm/s2": ("cm/s2", "cm/s/s", "cms-2", "gal", "gals"),
    "mm/s2": ("mm/s2", "mm/s/s", "mms-2"),
}
# Times since 1970 are below it [s]; and what numbers of their size may be rounded by, as a share of
# a step
_LATEST_S, _RESOLVED = 1e13, 1e-4
_UNITS = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}
# Units that columns may have besides, each as one of ours and a factor
_FURTHER = {
    "%g": ("g", 0.01),
    "mg": ("g", 1e-3),
    "ft/s2": ("m/s2", 0.3048),
    "ft/s/s": ("m/s2", 0.3048),
    "in/s2": ("m/s2", 0.0254),
    "in/s/s": ("m/s2", 0.0254),
}
#: Units of accelerations in columns, for messages.
ACCELERATIONS = "g, %g, mg, m/s2, cm/s2, mm/s2, ft/s2 or in/s2"


def read_text(path: Path | str) -> str:
    """Text of a file, as of `read_any_text`.

    Raises
    ------
    UnusableRecord
        there is no such file, it may not be read, is empty, or is not text.
    """
    try:
        text = read_any_text(path)
    except Unreadable as error:
        raise UnusableRecord(str(error)) from None
    if not text.strip():
        raise UnusableRecord("is empty")
    return text


def parse_number(word: str) -> float:
    """Value of a number such as `-.1234E-02` or `.1D+01`.

    Raises
    ------
    ValueError
        not a number.
    """
    if "_" in word:  # as Python writes numbers, and no recorder does
        raise ValueError(word)
    try:
        return float(word)
    except ValueError:
        return float(word.upper().replace("D", "E", 1))


def finite_number(word: str, row: int) -> float:
    """Value of a number, as `parse_number`, that stands in a row of a record.

    Raises
    ------
    UnusableRecord
        not a number, or not finite; the message names the row.
    """
    try:
        value = parse_number(word)
    except ValueError:
        raise UnusableRecord(f"line {row}: {word.strip()[:40]!r} is not a number") from None
    if not math.isfinite(value):
        raise UnusableRecord(f"line {row}: {word.strip()}; every value must be finite")
    return value


def check_end(text: str, words: list[str]) -> None:
    """Refuse a file that was cut off inside its last number: it ends without a line's end, and its
    last number has fewer digits than all before, which are written alike.

    Parameters
    ----------
    text
        the file.
    words
        the last numbers of the file, or of its last column, as they are written.

    Raises
    ------
    UnusableRecord
        so it is.
    """
    if text[-1:] in "\r\n" or len(words) < 4:
        return
    *before, last = (word.upper().replace("D", "E") for word in words)
    shapes = {_shape(word) for word in before}
    if len(shapes) == 1 and _shape(last) < shapes.pop():
        raise UnusableRecord(
            f"ends inside a number, {last!r} after {before[-1]!r}, without a line's end: the file "
            "is cut off"
        )


def check_last(text: str, values: NDArray[Any]) -> None:
    """Refuse a file that ends in a spike, without a line's end: that of 9.1e-08 cut off after its
    first digits.

    Parameters
    ----------
    values
        (n,) of the file, or of its last column.

    Raises
    ------
    UnusableRecord
        so it is.
    """
    if text[-1:] in "\r\n" or len(values) < SPIKE_SAMPLES:
        return
    steps = np.abs(np.diff(values))
    if steps[-1] > SPIKE_JUMPS * steps[:-1].max():
        raise UnusableRecord(
            f"ends in a spike, {values[-1]:g} after {values[-2]:g}, without a line's end: the file "
            "is cut off inside its last number; end its last line if it is whole"
        )


def _shape(word: str) -> tuple[int, int, int]:
    """Whether a number has an exponent, digits of it, and digits behind its point."""
    mantissa, mark, exponent = word.partition("E")
    return bool(mark), len(exponent.lstrip("+-")), len(mantissa.partition(".")[2])


def unit_named(text: str) -> str:
    """Unit of acceleration by any of its spellings, such as CM/SEC**2; "" for none of ours."""
    return _UNITS.get(_plain_unit(text), "")


def acceleration_unit(text: str) -> tuple[str, float]:
    """Unit of ours for a unit of acceleration, and the factor to it, 0.3048 m/s2 of ft/s2; "" and 1
    for a unit of anything else.
    """
    word = _plain_unit(text)
    return _FURTHER.get(word, (_UNITS.get(word, ""), 1.0))


def _plain_unit(text: str) -> str:
    """A unit in small letters, without blanks and marks of exponents."""
    word = text.strip().lower().replace("²", "2").replace("**", "").replace("^", "")
    return word.replace(" ", "").replace("sec", "s")


def uniform_step(time: NDArray[Any], lines: list[int], dt_s: float, line: str = "line") -> float:
    """Sampling step of a column of times [s].

    No sample may lie further than a twentieth of a step from an even grid. Times rounded more
    coarsely are accepted once the case states the step: then none may lie further than half a step
    from its grid, and no gap can hide.

    Parameters
    ----------
    time
        (n_steps,) [s].
    lines
        line of the file each time stands in.
    dt_s
        step stated by the case [s], 0 if none.
    line
        what `lines` number, for messages.

    Raises
    ------
    UnusableRecord
        times fall, repeat, or are not even.
    """
    latest = float(np.abs(time).max())
    if latest > _LATEST_S:
        raise UnusableRecord(
            f"{line} {lines[int(np.argmax(np.abs(time)))]}: t = {latest:g} s; times must "
            f"be at most {_LATEST_S:g} s"
        )
    steps = np.diff(time)
    dt = (time[-1] - time[0]) / len(steps)
    if np.spacing(latest) > _RESOLVED * dt > 0:
        raise UnusableRecord(
            f"times around {latest:g} s do not tell steps of {dt:.3g} s apart: subtract "
            "the first one"
        )
    rounded = dt_s > 0 and abs(dt - dt_s) * len(steps) < 0.5 * dt_s
    worst = int(np.argmin(steps))
    if steps[worst] < 0 or (steps[worst] == 0 and not rounded):
        what = "falls" if steps[worst] < 0 else "repeats"
        raise UnusableRecord(
            f"{line} {lines[worst + 1]}: time {what}, t = {time[worst + 1]:g} s after "
            f"{time[worst]:g} s; "
            "it must rise evenly"
        )
    grid, tolerance = (dt_s, 0.5) if rounded else (dt, 0.05)
    if np.abs(time - time[0] - grid * np.arange(len(time))).max() > tolerance * grid:
        usual = float(np.median(steps))
        worst = int(np.argmax(np.abs(steps - usual)))
        raise UnusableRecord(
            f"{line} {lines[worst + 1]}: step of {steps[worst]:g} s before t = "
            f"{time[worst + 1]:g} s where {usual:g} s "
            "is usual; samples must be even, without gaps (where times are only "
            "rounded, state motion.dt_s)"
        )
    return grid
