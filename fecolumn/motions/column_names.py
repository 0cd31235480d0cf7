"""What the columns of a record are, by their names and units."""

from __future__ import annotations

import re
from dataclasses import dataclass

from fecolumn.motions.record import UnusableRecord
from fecolumn.motions.text import ACCELERATIONS, acceleration_unit
from fecolumn.statistics.csv_table import cells_of_lines, delimiter_of

# Axes by the compass, as `directions` has them: x is east, y north, z up
_COMPASS = {
    "x": ("ew", "e-w", "e_w", "e", "east"),
    "y": ("ns", "n-s", "n_s", "n", "north"),
    "z": ("ud", "u-d", "u_d", "up", "vertical", "vert"),
}
_NAMES = {
    "time": ("time", "t", "seconds", "zeit", "temps", "tempo", "tiempo"),
    **{
        axis: tuple(f"{before}{name}" for name in (axis, *compass) for before in ("", "a", "a_"))
        for axis, compass in _COMPASS.items()
    },
    "": ("a", "acc", "accel", "acceleration", "beschleunigung", "accelerazione", "aceleracion"),
}
_MEANING = {name: meaning for meaning, names in _NAMES.items() for name in names}
# With the word acceleration or a short form of it, as in "acc_x", "Acceleration Y", "acc. vertical"
# and "ground acceleration in north direction"
_AXIS_OF_WORD = {word: axis for axis, words in _COMPASS.items() for word in (axis, *words)}
_WORDS = re.compile(
    r"(?:ground[ _-])?acc(?:\.|el\.?|eleration)?[ _-]*(?:(?:in|along)[ _-])?"
    rf"(?P<axis>{'|'.join(sorted(_AXIS_OF_WORD, key=len, reverse=True))})"
    r"(?:[ _-](?:direction|dir\.?|component|comp\.?|axis))?"
)
#: What is no acceleration: a velocity or displacement, and the number of a sample.
MOVED, NUMBER = "moved", "number"
# Channels such as HNE: band, instrument (N accelerometer; H and L seismometer, a velocity), and
# direction; the first of two that are not along the compass lies along y as north does
_CHANNEL = re.compile(r"(?:.*[._ -])?[bcdefghlms](?P<instrument>[nhl])(?P<axis>[enz123])")
_CHANNEL_AXES = {"e": "x", "2": "x", "n": "y", "1": "y", "z": "z", "3": "z"}
# Words of a header, in several tongues, that say what a column is not
_MOVED = re.compile(r"vel|disp|weg|geschw|^[vud][xyz]?$", re.IGNORECASE)
_NUMBER = re.compile(r"index|sample|^no$|^nr$|^unnamed: \d+$|#", re.IGNORECASE)
# Units behind names, as in time_s, acc_x_m_s2, vel_cm_s
_SUFFIX = re.compile(
    r"(?P<name>.+?)_(?P<unit>(?:m|cm|mm|ft|in)[_/](?:s2|s_2|s)|mps2|gal|%g|mg|g|sec|ms|s|min"
    r"|mm|cm|m|ft|kn|pa|kpa|mpa|mv|volts?|degc?|rad|hz|kg|counts?)"
)
_SECONDS = {"": 1.0, "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3}
_LENGTHS = ("m", "cm", "mm", "ft", "in")
_MOVED_UNITS = ("", *_LENGTHS, *(f"{length}/{s}" for length in _LENGTHS for s in ("s", "sec")))
_CELL = re.compile(
    r"""["']?\s*(?P<name>[^\[\](),;\t"']*?)\s*(?:[\[(]\s*(?P<unit>[^\])]*?)\s*[\])])?\s*["']?"""
)
_SPACED_CELL = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
_BRACKETS = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
EXAMPLE = "a header row such as: time [s], ax [g], ay [g]"


@dataclass(frozen=True, slots=True)
class NamedColumn:
    """A column by its header.

    Attributes
    ----------
    name, unit
        as they are written, the name in small letters; "" for none.
    meaning
        "time", "x", "y", "z", "" for an acceleration of any axis, MOVED, NUMBER, or None where the
        name is not known.
    """

    name: str
    unit: str = ""
    meaning: str | None = ""

    @property
    def factor(self) -> float:
        """To seconds, or to the unit of `acceleration_unit`."""
        if self.meaning == "time":
            return _SECONDS[self.unit.lower()]
        return acceleration_unit(self.unit)[1]


def named_column(name: str, unit: str) -> NamedColumn:
    """Column of a name and a unit; a unit behind the name, as in time_s, is taken apart."""
    found = None if unit or meaning_of(name) is not None else _SUFFIX.fullmatch(name)
    if found:
        name, unit = found["name"], found["unit"].replace("_", "/", 1).replace("s_2", "s2")
        unit = "m/s2" if unit == "mps2" else unit
    return NamedColumn(name, unit, meaning_of(name))


def meaning_of(name: str) -> str | None:
    """Meaning of the name of a column, as of NamedColumn."""
    if name in _MEANING:
        return _MEANING[name]
    if words := _WORDS.fullmatch(name):
        return _AXIS_OF_WORD[words["axis"]]
    if channel := _CHANNEL.fullmatch(name):
        return _CHANNEL_AXES[channel["axis"]] if channel["instrument"] == "n" else MOVED
    if _MOVED.search(name):
        return MOVED
    return NUMBER if _NUMBER.search(name) else None


def header_cells(line: str) -> list[tuple[str, str]]:
    """Names in small letters and units of a header line."""
    cells = _cells(line) if re.search(r"[,;\t]", line) else _SPACED_CELL.findall(line)
    found = [_CELL.fullmatch(cell) for cell in cells]
    return [
        (cell["name"].lower(), cell["unit"] or "") if cell else (text.lower(), "")
        for cell, text in zip(found, cells)
    ]


def _cells(line: str) -> list[str]:
    """Cells of a line of words, whatever its quotes."""
    try:
        ((_, cells),) = cells_of_lines([(0, line)], delimiter_of(line))
    except ValueError:
        return [cell.strip() for cell in re.split(r"[,;\t]", line)]
    return cells


def units_of_row(line: str) -> list[str] | None:
    """Units of a line below the names, as in (s),(g),(g); None of a line of anything else."""
    cells = _cells(line)
    found = [_BRACKETS.fullmatch(cell) for cell in cells]
    units = [one[1] if one else cell for one, cell in zip(found, cells)]
    bracketed = all(one or cell in ("", "-") for one, cell in zip(found, cells))
    known = all(
        unit in ("", "-") or unit.lower() in _SECONDS or acceleration_unit(unit)[0]
        for unit in units
    )
    return [unit.strip("-") for unit in units] if any(units) and (bracketed or known) else None


def unit_fault(column: NamedColumn) -> str:
    """Why the unit of a time or an acceleration cannot be used; "" where it can."""
    if column.meaning == "time":
        known = column.unit.lower() in _SECONDS
        return "" if known else f"time in {column.unit!r} is not known; must be s or ms"
    if not column.unit or acceleration_unit(column.unit)[0]:
        return ""
    what = column.name or "of the acceleration"
    return (
        f"unit {column.unit!r} of column {what!r} is not known as one of an acceleration; must be "
        f"{ACCELERATIONS}"
    )


def may_be_passed_over(column: NamedColumn) -> bool:
    """Whether a column beside accelerations is a velocity or a displacement."""
    unit = column.unit.lower().replace(" ", "")
    return unit in _MOVED_UNITS and (
        column.meaning == MOVED or (column.meaning is None and unit != "")
    )


def no_acceleration(column: NamedColumn) -> UnusableRecord:
    """Refusal of a column that is none of a record."""
    if column.meaning == MOVED and (channel := _CHANNEL.fullmatch(column.name)):
        letter = channel["instrument"].upper()
        return UnusableRecord(
            f"column {column.name!r} is not known as an acceleration: the second letter {letter} "
            "of a channel stands for a velocity, N for an acceleration, as in HNE"
        )
    if column.meaning == MOVED:
        return UnusableRecord(
            f"column {column.name!r} is not known as an acceleration: it is a velocity or a "
            f"displacement{f' [{column.unit}]' if column.unit else ''}; needs {EXAMPLE}"
        )
    return UnusableRecord(
        f"column {column.name!r} is not known; must be one of time, ax, ay, az, or EW, NS, UD, or "
        f"HNE, HNN, HNZ, in {EXAMPLE}"
    )
