"""Text files of Turkey's national network (AFAD, NSMN): three columns [cm/s2]."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from fecolumn.motions.fixed_width import above_zero
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import check_end, finite_number, read_text

_KIND = "AFAD"
_FIRST = "STRONG GROUND MOTION RECORDS OF TURK"
_AXES = {"N-S": "y", "E-W": "x", "U-D": "z"}


def looks_like_afad(text: str) -> bool:
    """Whether the first line is that of the network's files."""
    return text.lstrip().upper().startswith(_FIRST)


def read_afad(path: Path | str) -> Recording:
    """Recording of a file of AFAD: `KEY : value` lines, a line with N-S, E-W and U-D, then a row a
    sample [cm/s2]. Downloads in the format of ESM are read as those.

    Raises
    ------
    UnusableRecord
        header incomplete, rows missing, not numbers or not finite.
    """
    text = read_text(path)
    lines = text.splitlines()
    names = next(
        (i for i, line in enumerate(lines[:40]) if sorted(line.split()) == sorted(_AXES)), None
    )
    if names is None:
        raise UnusableRecord("header incomplete: no line names the columns N-S, E-W and U-D")
    header = {}
    for row, line in enumerate(lines[:names], 1):
        key, mark, value = line.partition(":")
        if mark:
            header[key.split("(")[0].strip().upper()] = (row, value.strip())
    for key in ("NUMBER OF DATA", "SAMPLING INTERVAL"):
        if key not in header:
            raise UnusableRecord(f"header incomplete: an AFAD file states {key}")
    row, count = header["NUMBER OF DATA"]
    rows = [(i, line) for i, line in enumerate(lines[names + 1 :], names + 2) if line.strip()]
    if not re.fullmatch(r"\d{1,8}", count) or int(count) != len(rows):
        raise UnusableRecord(
            f"line {row}: the header states NUMBER OF DATA = {count[:20]} but {len(rows)} rows "
            "follow"
        )
    values = np.array([_row(line, i) for i, line in rows]).reshape(-1, 3)
    check_end(text, [line.split()[-1] for _, line in rows[-12:]])
    row, step = header["SAMPLING INTERVAL"]
    told = [header[key][1] for key in ("STATION ID", "PLACE", "EARTHQUAKE DATE") if key in header]
    return Recording(
        values,
        tuple(_AXES[name] for name in lines[names].split()),
        above_zero(step, row, "SAMPLING INTERVAL [s]"),
        "cm/s2",
        Path(path).name,
        f"{_KIND}: {' '.join(told)}",
        _KIND,
    )


def _row(line: str, row: int) -> list[float]:
    words = line.split()
    if len(words) != 3:
        raise UnusableRecord(f"line {row}: {len(words)} numbers; must be 3: N-S, E-W, U-D")
    return [finite_number(word, row) for word in words]
