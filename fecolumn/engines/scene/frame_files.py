"""Names of the files of single frames, which have their times."""

from __future__ import annotations

import math
from pathlib import Path

# Digits of a name that are of whole seconds
_WHOLE = 6


def frame_digits(interval_s: float) -> int:
    """Digits after the point of times in names, by the least time between frames [s]: microseconds,
    or as many as tell frames apart.
    """
    return max(6, math.ceil(-math.log10(interval_s) - 1e-9))


def frame_name(time: float, digits: int) -> str:
    """Name of the file of a frame at a time [s], with so many digits after the point."""
    return f"frame_{round(time * 10**digits):0{digits + _WHOLE}d}.h5"


def time_of_frame(file: Path) -> float:
    """Time [s] of the frame in a file of this name."""
    number = file.stem.partition("_")[2]
    return int(number) / 10.0 ** (len(number) - _WHOLE)
