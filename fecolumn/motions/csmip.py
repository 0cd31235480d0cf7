"""Files of the California strong-motion programme, volumes 1 and 2 (CSMIP, CDMG; USGS alike)."""

from __future__ import annotations

import re
from pathlib import Path

from fecolumn.motions.directions import Channel, direction_of, recorded
from fecolumn.motions.fixed_width import above_zero, check_peak, layout, number_block
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import read_text, unit_named

_KIND = "CSMIP"
_NUMBER = r"-?\d*\.?\d*"
# Heads of a channel: text, then a line before each block of samples
_FIRST = re.compile(r"\s*(un)?corrected accelerogram\b", re.IGNORECASE)
_CORRECTED = re.compile(
    rf"^\s*(?P<count>\d+)\s+points of (?P<what>\w+) data equally spaced at\s+(?P<dt>{_NUMBER})\s*"
    r"sec\W*\(?(?:in|units?:?)\s+(?P<unit>[^\s,()]+?)[.,]?\)?\W*\s*(?P<format>\(\s*\d+\s*[a-z][^)]*\))\s*$",
    re.IGNORECASE,
)
_UNCORRECTED = re.compile(
    rf"^\s*(?P<count>\d+)\s+accelerogram points at\s+(?P<rate>{_NUMBER})\s*pts/sec,?\s+in units of "
    r"(?P<unit>\S+)\s*\.?\s+format:\s*(?P<format>\([^)]*\))\s*$",
    re.IGNORECASE,
)
_PEAK = re.compile(rf"^\s*peak acceleration\s*=\s*(?P<peak>{_NUMBER})\s", re.IGNORECASE)
_RAW_PEAK = re.compile(rf"\bmax\s*=\s*(?P<peak>{_NUMBER})\s*g\b", re.IGNORECASE)
_CHANNEL = re.compile(r"chan\s*\d+\s*:\s*(?P<direction>.*?)\s*(?:from\b.*|\(.*)?$", re.IGNORECASE)
# Lines of text and numbers before the samples, at most
_MOST_HEAD = 60


def looks_like_csmip(text: str) -> bool:
    """Whether the first line says corrected or uncorrected accelerogram as CSMIP does, and a line
    before samples tells how many they are.
    """
    head = text.lstrip("\n\r").splitlines()[:2]
    return bool(
        head
        and _FIRST.match(head[0])
        and "gns science" not in head[0].lower()
        and any("uncorrected accelerogram data" in line.lower() for line in head)
    )


def read_csmip(path: Path | str) -> Recording:
    """Recording of a V1 or V2 file of one to three channels; velocities and displacements of V2
    are passed over.

    Count, step, unit and format are those of the line before the samples, the direction that of
    the line `Chan  1: 90 Deg`. Source: Shakal and Huang, Standard tape format for CSMIP
    strong-motion data tapes (CDMG, 1985).

    Raises
    ------
    UnusableRecord
        no line before the samples, blocks cut off, a peak other than stated.
    """
    text = read_text(path)
    lines = text.splitlines()
    starts = [
        i
        for i, line in enumerate(lines)
        if _FIRST.match(line) and not (i and _FIRST.match(lines[i - 1]))
    ]
    channels, units, after = [], "", 0
    for start in starts:
        _only_ends(lines, after, start)
        channel, unit, after = _channel(lines, start)
        if units and unit != units:
            raise UnusableRecord(f"its channels have different units, {units} and {unit}")
        channels.append(channel)
        units = unit
    _only_ends(lines, after, len(lines))
    told = next((line.strip() for line in lines[:12] if "station" in line.lower()), "")
    return recorded(channels, units, path, f"{_KIND}: {' '.join(told.split())}", _KIND)


def _only_ends(lines: list[str], first: int, last: int) -> None:
    """Nothing but marks of an end, or blank lines, may lie between channels."""
    for i in range(first, last):
        line = lines[i].strip()
        if line and not re.match(r"/&|[-\s]*end\b", line, re.IGNORECASE):
            raise UnusableRecord(
                f"line {i + 1}: {line[:40]!r} follows the last value; must be the end of the "
                "channel or the next one"
            )


def _channel(lines: list[str], start: int) -> tuple[Channel, str, int]:
    """A channel, its unit, and the index of the line behind its last block."""
    told, peak = "", None
    for place in range(start, min(start + _MOST_HEAD, len(lines))):
        line = lines[place]
        if (found := _CORRECTED.match(line)) or (found := _UNCORRECTED.match(line)):
            break
        if not told and (named := _CHANNEL.search(line)):
            told = named["direction"]
        if said := _PEAK.search(line) or _RAW_PEAK.search(line):
            peak = said["peak"]
    else:
        raise UnusableRecord(
            f"line {min(start + _MOST_HEAD, len(lines))}: no line tells how many samples follow, "
            "as in 3000 points of accel data equally spaced at .020 sec, in cm/sec2. (8f10.6)"
        )
    row = place + 1
    volume = found.groupdict()
    unit = unit_named(volume["unit"].rstrip("."))
    if not unit:
        raise UnusableRecord(
            f"line {row}: units of {volume['unit']!r} are not known; must be g, m/s2, cm/s2, mm/s2"
        )
    if not volume.get("what", "accel").lower().startswith("accel"):
        raise UnusableRecord(f"line {row}: {volume['what']} data stands before accelerations")
    if "rate" in volume:
        dt = 1.0 / above_zero(volume["rate"], row, "points a second")
    else:
        dt = above_zero(volume["dt"], row, "the step [s]")
    many, width = layout(volume["format"], row)
    values, place = number_block(lines, place + 1, int(volume["count"][:9]), many, width)
    if peak:
        check_peak(values, peak, unit)
    while place < len(lines) and (found := _CORRECTED.match(lines[place])):
        if found["what"].lower().startswith("accel"):
            raise UnusableRecord(f"line {place + 1}: a second block of accelerations")
        many, width = layout(found["format"], place + 1)
        _, place = number_block(lines, place + 1, int(found["count"][:9]), many, width)
    return Channel(values, direction_of(told), dt, told), unit, place
