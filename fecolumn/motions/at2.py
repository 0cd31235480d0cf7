"""PEER's AT2 files: one component, four header lines, then the accelerations in rows of five."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import check_end, check_last, parse_number, read_text, unit_named

_HEADER_LINES = 4
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
_NAMES_FIRST = re.compile(
    rf"NPTS\s*=\s*(?P<points>\d+)\b.*?DT\s*=\s*(?P<dt>{_NUMBER})", re.IGNORECASE
)
_NUMBERS_FIRST = re.compile(rf"^\s*(?P<points>\d+)[\s,]+(?P<dt>{_NUMBER})[\s,]+NPTS", re.IGNORECASE)
_UNITS = re.compile(r"UNITS?\s*(?:OF|:|=)\s*(?P<unit>[^\s,;]+)", re.IGNORECASE)


def looks_like_at2(path: Path | str, text: str) -> bool:
    """Whether the name ends in .AT2, or NPTS stands among the first lines."""
    return (
        Path(path).suffix.lower() == ".at2"
        or "NPTS" in "\n".join(text.splitlines()[: 2 * _HEADER_LINES]).upper()
    )


def read_at2(path: Path | str) -> Recording:
    """Recording of an AT2 file, `NPTS= 4000, DT= .0100 SEC` or the older `4000 0.0100 NPTS, DT` in
    its fourth line.

    Raises
    ------
    UnusableRecord
        header incomplete, not accelerations, values missing, not numbers or not finite.
    """
    text = read_text(path)
    lines = [(row, line) for row, line in enumerate(text.splitlines(), 1) if line.strip()]
    head = next(
        (i for i, (_, line) in enumerate(lines[:_HEADER_LINES]) if "NPTS" in line.upper()), None
    )
    if head is None:
        raise UnusableRecord(
            "header incomplete: an AT2 file has four header lines, the fourth with NPTS and DT"
        )
    row, line = lines[head]
    found = _NAMES_FIRST.search(line) or _NUMBERS_FIRST.match(line)
    if not found:
        raise UnusableRecord(
            f"line {row}: {line.strip()!r} must state number and step, as in NPTS= "
            "4000, DT= .0100 SEC"
        )
    points, dt = found["points"], parse_number(found["dt"])
    if not 0 < dt < np.inf:
        raise UnusableRecord(f"line {row}: DT = {dt:g} s must be finite and greater than 0")
    values = _values(lines[head + 1 :])
    if points.lstrip("0") != str(len(values)):
        raise UnusableRecord(
            f"the header states NPTS = {points[:20]} but {len(values)} values follow"
        )
    check_end(text, " ".join(line for _, line in lines[head + 1 :][-4:]).split()[-12:])
    check_last(text, values)
    header = [line.strip() for _, line in lines[:head]]
    return Recording(
        values[:, None],
        ("",),
        dt,
        _stated_units(header),
        Path(path).name,
        "; ".join(header),
        "PEER AT2",
    )


def _stated_units(header: list[str]) -> str:
    for text in header:
        if re.match(r"(VELOCITY|DISPLACEMENT)\b", text, re.IGNORECASE):
            raise UnusableRecord(f"holds no accelerations: {text!r}")
    stated = [found["unit"].rstrip(".") for found in map(_UNITS.search, header) if found]
    if not stated:
        return ""
    if not unit_named(stated[-1]):
        raise UnusableRecord(
            f"units of {stated[-1]!r} are not known; must be g, m/s2, cm/s2 or mm/s2"
        )
    return unit_named(stated[-1])


def _values(lines: list[tuple[int, str]]) -> NDArray[Any]:
    values = []
    for row, line in lines:
        for word in line.split():
            try:
                values.append(parse_number(word))
            except ValueError:
                raise UnusableRecord(f"line {row}: {word[:40]!r} is not a number") from None
            if not np.isfinite(values[-1]):
                raise UnusableRecord(
                    f"line {row}: sample {len(values)} is {word}; every acceleration must be finite"
                )
    return np.array(values)
