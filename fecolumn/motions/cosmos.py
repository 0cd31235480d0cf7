"""COSMOS files, versions V1 and V2 (format 1.20): one or several channels."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from fecolumn.motions.directions import Channel, direction_of, recorded
from fecolumn.motions.fixed_width import above_zero, check_peak, layout, number_block
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import read_text

_KIND = "COSMOS"
_FIRST = re.compile(r"\(\s*format\s+v[\d. ]+with\s+(\d+)\s+text lines", re.IGNORECASE)
_BLOCK = re.compile(
    r"^\s*(?P<count>\d+)\s+(?P<what>integer-header|real-header|comment|\w+)\b.*?"
    r"(?:format\s*=?\s*(?P<format>\([^)]*\)))?\s*:?\s*$",
    re.IGNORECASE,
)
# Physical units by their number in the integer header (COSMOS table 2): its name, ours, and by what
# to multiply
_UNITS = {
    2: ("g", "g", 1.0),
    4: ("cm/s2", "cm/s2", 1.0),
    7: ("in/s2", "cm/s2", 2.54),
    10: ("gal", "cm/s2", 1.0),
    11: ("mg", "g", 1e-3),
}
# Physical parameters by their number (COSMOS table 1): what is read, and what is passed over
_ACCELERATION, _MOVED = 1, {2: "velocity", 3: "displacement"}
# Directions by number (table 8) beside azimuths of 0 to 360 degrees; of sensors that are told by
# the structure they stand on, the first lies along y as north does, the second along x
_DIRECTIONS: dict[int, float | str] = {
    **dict.fromkeys((400, 402), "up"),
    401: "down",
    **dict.fromkeys((500, 600, 700), 0.0),
    **dict.fromkeys((501, 601, 701), 90.0),
}
# Places in the headers, counted from 0
_PARAMETER, _UNIT, _AZIMUTH = 1, 2, 53
_STEP_MS, _PEAK = 61, 63
# What stands in the real header where a number is not known
_UNKNOWN = -999.0


def looks_like_cosmos(text: str) -> bool:
    """Whether the first line tells a format such as (Format v01.20 with 13 text lines)."""
    return bool(_FIRST.search(text.lstrip("\n\r ").split("\n", 1)[0]))


def read_cosmos(path: Path | str) -> Recording:
    """Recording of a COSMOS file of one to three channels of acceleration; those of velocity and
    displacement beside them are passed over.

    The size of each block is that of its header line, the step that of the real header (62nd
    number), the direction that of the integer header (54th). Source: COSMOS Strong Motion Data
    Format (2001).

    Raises
    ------
    UnusableRecord
        raw counts, no acceleration, blocks cut off, a peak other than stated.
    """
    lines = read_text(path).splitlines()
    channels, place, units, source = [], _next(lines, 0), "", ""
    while place < len(lines):
        channel, unit, told, place = _channel(lines, place)
        source, place = source or told, _next(lines, place)
        if channel is None:
            continue
        if units and unit != units:
            raise UnusableRecord(f"its channels have different units, {units} and {unit}")
        channels.append(channel)
        units = unit
    return recorded(channels, units, path, f"{_KIND}: {source}", _KIND)


def _next(lines: list[str], place: int) -> int:
    """Index of the next channel's first line, past blank lines and the mark of an end."""
    while place < len(lines):
        line = lines[place].strip()
        if _FIRST.search(line):
            break
        if line and not re.match(r"(/&|-+)?\s*end[- ]of|/&|-+$", line, re.IGNORECASE):
            raise UnusableRecord(
                f"line {place + 1}: {line[:40]!r} follows the last value; must be the end of the "
                "channel or the next one"
            )
        place += 1
    return place


def _channel(lines: list[str], first: int) -> tuple[Channel | None, str, str, int]:
    """A channel, None of a velocity or a displacement, its unit, the station, and the index of the
    line behind it.
    """
    found = _FIRST.search(lines[first])
    place = first + int(found[1] if found else 0)
    if not 0 < place < len(lines):
        raise UnusableRecord(f"line {len(lines)}: the file ends within the header: it is cut off")
    if re.search(r"\braw\b", lines[first], re.IGNORECASE):
        raise UnusableRecord(f"line {first + 1}: holds raw counts; take the file of V1 or V2")
    integers, place = _numbers(lines, place, "integer-header", 100)
    row = place + 1
    reals, place = _numbers(lines, place, "real-header", 100)
    comments = _head(lines, place, "comment")
    place += 1 + int(comments["count"])
    parameter = int(integers[_PARAMETER])
    values, place = _values(lines, place, parameter)
    station = lines[first + 4].strip() if first + 4 < len(lines) else ""
    if parameter in _MOVED:
        return None, "", station, place
    if parameter != _ACCELERATION:
        raise UnusableRecord(
            f"line {first + 1}: holds no accelerations: physical parameter "
            f"{parameter} of its integer header; {_ACCELERATION} is acceleration"
        )
    if int(integers[_UNIT]) not in _UNITS:
        raise UnusableRecord(
            f"line {first + 1}: unit {int(integers[_UNIT])} of its integer header is not known; "
            f"must be one of {', '.join(map(str, _UNITS))} (g, cm/s2, in/s2, gal, mg)"
        )
    stated, unit, factor = _UNITS[int(integers[_UNIT])]
    if float(reals[_PEAK]) != _UNKNOWN:
        check_peak(values, reals[_PEAK], stated)
    azimuth = int(integers[_AZIMUTH])
    direction = _DIRECTIONS.get(azimuth, direction_of(str(azimuth)) if azimuth >= 0 else "")
    told = f"{direction:g} deg" if isinstance(direction, float) else direction
    dt = 1e-3 * above_zero(reals[_STEP_MS], row, "the step, 62nd number of the real header, [ms]")
    return Channel(factor * values, direction, dt, told), unit, station, place


def _head(lines: list[str], place: int, what: str) -> re.Match[str]:
    """The line at the head of a block, which says how many numbers follow."""
    line = lines[place] if place < len(lines) else ""
    found = _BLOCK.match(line)
    if not found or (what and found["what"].lower() != what) or len(found["count"]) > 8:
        raise UnusableRecord(
            f"line {min(place, len(lines)) + 1}: {line.strip()[:40]!r} must say how many "
            f"{what or 'samples'} follow, as in 100 Integer-header values follow ..."
        )
    return found


def _numbers(lines: list[str], place: int, what: str, least: int) -> tuple[list[str], int]:
    """Numbers of a header as they are written, and the index of the line behind it."""
    head = _head(lines, place, what)
    many, width = layout(head["format"] or "", place + 1)
    count = int(head["count"])
    if count < least:
        raise UnusableRecord(f"line {place + 1}: {count} numbers; a COSMOS header has {least}")
    _, after = number_block(lines, place + 1, count, many, width)
    text = "".join(line.rstrip() for line in lines[place + 1 : after])
    return [text[i * width : (i + 1) * width] for i in range(count)], after


def _values(lines: list[str], place: int, parameter: int) -> tuple[NDArray[Any], int]:
    """Samples of a physical parameter, and the index of the line behind them."""
    head = _head(lines, place, "")
    if parameter not in _MOVED and not re.match(
        r"acc|uncor|corr|data", head["what"], re.IGNORECASE
    ):
        raise UnusableRecord(
            f"line {place + 1}: holds no accelerations: {lines[place].strip()[:60]!r}"
        )
    many, width = layout(head["format"] or "", place + 1)
    return number_block(lines, place + 1, int(head["count"]), many, width)
