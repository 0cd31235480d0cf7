"""ASC files of the Engineering Strong Motion database (DYNA format): `KEY: value` lines, then one
value a line.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.motions.fixed_width import above_zero
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import finite_number, read_text, unit_named

_HEADER = re.compile(r"^(?P<key>[A-Z][A-Z0-9_/^.\[\]()-]*):\s*(?P<value>.*)$")


def looks_like_esm(text: str) -> bool:
    """Whether the first lines are `KEY: value` and one of the header's keys is SAMPLING_INTERVAL_S
    or NDATA.
    """
    return bool(re.match(r"\s*EVENT_NAME:", text)) or bool(
        re.search(r"^(SAMPLING_INTERVAL_S|NDATA):", text[:10_000], re.MULTILINE)
    )


def read_esm(path: Path | str) -> Recording:
    """Recording of an ESM ASC file, one component; the stream (HNE, HNN, HNZ) is named in its
    source, its axis left to the case.

    Raises
    ------
    UnusableRecord
        header incomplete, not accelerations, values missing, not numbers or not finite.
    """
    header: dict[str, tuple[int, str]] = {}
    values: list[float] = []
    for row, line in enumerate(read_text(path).splitlines(), 1):
        line = line.strip()
        found = _HEADER.match(line) if not values else None
        if found:
            header[found["key"].upper()] = (row, found["value"].strip())
        elif line:
            values.append(finite_number(line, row))
    kind = header.get("DATA_TYPE", (0, "ACCELERATION"))[1]
    if kind.upper() != "ACCELERATION":
        raise UnusableRecord(
            f"line {header['DATA_TYPE'][0]}: holds no accelerations: DATA_TYPE is {kind!r}"
        )
    dt, points = _stated(header, "SAMPLING_INTERVAL_S"), _stated(header, "NDATA")
    if points != int(points) or points != len(values):
        raise UnusableRecord(
            f"the header states NDATA = {points:g} but {len(values)} values follow"
        )
    row, unit = header.get("UNITS", (0, ""))
    if unit and not unit_named(unit):
        raise UnusableRecord(
            f"line {row}: units of {unit!r} are not known; must be g, m/s2, cm/s2 or mm/s2"
        )
    told = [
        header[key][1]
        for key in ("EVENT_NAME", "EVENT_DATE_YYYYMMDD", "NETWORK", "STATION_CODE", "STREAM")
        if key in header
    ]
    return Recording(
        np.array(values)[:, None],
        ("",),
        dt,
        unit_named(unit),
        Path(path).name,
        "ESM: " + " ".join(filter(None, told)),
        "ESM ASC",
    )


def _stated(header: dict[str, Any], key: str) -> float:
    if key not in header:
        raise UnusableRecord(f"header incomplete: an ESM file states {key}")
    row, text = header[key]
    return above_zero(text, row, key)
