"""Files of GeoNet, New Zealand, volumes 1 and 2 (V1A, V2A): three components [mm/s2]."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from fecolumn.motions.directions import Channel, direction_of, recorded
from fecolumn.motions.fixed_width import check_peak, number_block
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import read_text

_KIND = "GeoNet"
_FIRST = re.compile(r"^\s*(?P<raw>un)?corrected accelerogram\b.*\bgns science", re.IGNORECASE)
# Lines of text, then ten lines of ten numbers, all of eight characters
_TEXT, _ROWS, _WIDTH = 16, 10, 8


def looks_like_geonet(text: str) -> bool:
    """Whether the first line says corrected or uncorrected accelerogram of GNS Science."""
    return bool(_FIRST.match(text.lstrip("\n\r").split("\n", 1)[0]))


def read_geonet(path: Path | str) -> Recording:
    """Recording of a V1A or V2A file; velocities and displacements of V2A are passed over.

    Counts, step and peak are those of the ten rows of numbers behind the text. Source: GeoNet,
    Strong-motion file formats (2004).

    Raises
    ------
    UnusableRecord
        blocks cut off, letters in numbers, a peak other than stated.
    """
    lines = read_text(path).splitlines()
    while lines and not lines[-1].strip():
        lines.pop()
    channels, place, source = [], 0, ""
    while place < len(lines):
        if not _FIRST.match(lines[place]):
            raise UnusableRecord(
                f"line {place + 1}: {lines[place].strip()[:40]!r} must be the first line of a "
                "component, (un)corrected accelerogram ... GNS Science"
            )
        channel, after = _channel(lines, place)
        channels.append(channel)
        source = source or " ".join(lines[place + 1].split())
        place = after
    return recorded(channels, "mm/s2", path, f"{_KIND}: {source}", _KIND)


def _channel(lines: list[str], start: int) -> tuple[Channel, int]:
    """A component and the index of the line behind its last block."""
    raw = "uncorrected" in lines[start].lower()
    first = start + _TEXT
    header, place = number_block(lines, first, _ROWS * 10, 10, _WIDTH)
    head = header.reshape(_ROWS, 10)
    counts = [head[3, 0] if raw else head[3, 3], head[3, 4], head[3, 5]]
    if not all(count == int(count) and 0 <= count < 10**8 for count in counts) or counts[0] < 2:
        raise UnusableRecord(
            f"line {first + 4}: states {', '.join(f'{count:g}' for count in counts)} samples"
        )
    dt = head[6, 5]
    if not 0 < dt < np.inf:
        raise UnusableRecord(f"line {first + 7}: a step of {dt:g} s must be above 0")
    values, place = number_block(lines, place, int(counts[0]), 10, _WIDTH)
    for count in counts[1:]:
        _, place = number_block(lines, place, int(count), 10, _WIDTH)
    if peak := head[7, 0] if raw else head[7, 5]:
        check_peak(values, f"{peak:.1f}", "mm/s2")
    told = re.match(r"\s*component\s+(\S+)", lines[start + 12], re.IGNORECASE)
    if not told:
        raise UnusableRecord(f"line {start + 13}: must tell the component, as in Component N28W")
    return Channel(values, direction_of(told[1]), dt, told[1]), place
