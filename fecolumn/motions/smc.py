"""SMC files of the United States Geological Survey: one component of acceleration [cm/s2]."""

from __future__ import annotations

import re
from pathlib import Path

from fecolumn.motions.fixed_width import above_zero, check_peak, number_block
from fecolumn.motions.record import Recording, UnusableRecord
from fecolumn.motions.text import read_text

_KIND = "SMC"
_FIRST = re.compile(r"^\s*\d?\s*(?P<what>UN)?CORRECTED ACCELEROGRAM\s*$")
# Lines of text; whole numbers, eight a line of ten characters; real ones, five of fifteen
_TEXT, _INTEGERS, _REALS = 11, (48, 8, 10), (50, 5, 15)
# Places counted from 0: samples and comments of the whole numbers; rate, largest and least value
_COUNT, _COMMENTS = 16, 15
_RATE, _PEAKS = 1, (29, 31)


def looks_like_smc(text: str) -> bool:
    """Whether the first line names a volume as SMC files do, and stars follow."""
    lines = text.splitlines()[:2]
    return len(lines) == 2 and bool(_FIRST.match(lines[0])) and lines[1].strip() == "*"


def read_smc(path: Path | str) -> Recording:
    """Recording of an SMC file; its axis is left to the case, its direction told.

    Source: Converse and Brady, BAP, USGS Open-File Report 92-296A (1992).

    Raises
    ------
    UnusableRecord
        blocks cut off, letters in numbers, a peak other than stated.
    """
    lines = read_text(path).splitlines()
    if len(lines) < _TEXT or lines[_TEXT - 1].strip() != "*":
        raise UnusableRecord(f"line {_TEXT}: must be a star, the last of {_TEXT} lines of text")
    integers, after = number_block(lines, _TEXT, *_INTEGERS)
    reals, place = number_block(lines, after, *_REALS)
    missing = integers[0]
    count, comments = integers[_COUNT], integers[_COMMENTS]
    if not 1 < count < 10**8 or count == missing:
        raise UnusableRecord(f"line {_TEXT + 3}: states {count:g} samples; at least 2 are needed")
    if comments == missing:
        comments = 0
    if not 0 <= comments < 1000:
        raise UnusableRecord(f"line {_TEXT + 2}: states {comments:g} comment lines")
    for i in range(place, min(place + int(comments), len(lines))):
        if not lines[i].startswith("|"):
            raise UnusableRecord(f"line {i + 1}: must be a comment that starts with |")
    dt = 1.0 / above_zero(str(reals[_RATE]), after + 1, "samples a second")
    values, end = number_block(lines, place + int(comments), int(count), 8, 10)
    if any(line.strip() for line in lines[end:]):
        raise UnusableRecord(f"line {end + 1}: more follows than {count:g} samples")
    peaks = [reals[place] for place in _PEAKS]
    if peaks[0] != reals[0] and peaks[1] != reals[0]:
        check_peak(values, f"{max(map(abs, peaks)):.6E}", "cm/s2")
    told = " ".join(lines[5].split())
    return Recording(
        values[:, None], ("",), dt, "cm/s2", Path(path).name, f"{_KIND}: {told}", _KIND
    )
