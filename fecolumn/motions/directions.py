"""Components of a record by the directions of its sensors: x is east, y north, z up."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.motions.record import Recording, UnusableRecord

# Cosine of the angle between horizontal sensors that are told apart as perpendicular: 3 degrees
_SQUARE = 0.053
_DT_TOLERANCE = 1e-6
_COMPASS = {"N": 0.0, "E": 90.0, "S": 180.0, "W": 270.0}


@dataclass(frozen=True)
class Channel:
    """One sensor's record.

    Attributes
    ----------
    values
        (n,) [the record's unit].
    direction
        azimuth clockwise from north [degrees], "up", "down", or "" where the file does not say.
    dt
        sampling step [s].
    told
        direction as the file has it.
    """

    values: NDArray[Any]
    direction: float | str
    dt: float
    told: str


def direction_of(text: str) -> float | str:
    """Direction of words such as `N28W`, `S90E`, `360 Deg`, `Up`, `Vert`; "" of others."""
    word = text.strip().lower()
    if re.match(r"(up|vert|v\b|z\b|u-d)", word):
        return "up"
    if word.startswith("down"):
        return "down"
    if found := re.match(r"(\d{1,3}(?:\.\d*)?)\s*(?:deg|°|$)", word):
        return float(found[1]) % 360 if float(found[1]) <= 360 else ""
    if found := re.match(r"([ns])\s*(\d{1,2}(?:\.\d*)?)\s*([ew])", word):
        off = float(found[2]) * (1 if found[3] == "e" else -1)
        return (off if found[1] == "n" else 180 - off) % 360 if float(found[2]) <= 90 else ""
    return _COMPASS.get(word.upper(), "")


def lengths_differ(shortest: int, longest: int) -> bool:
    """Whether numbers of samples of one record differ by more than 1 % and a sample."""
    return longest > 1.01 * shortest + 1


def recorded(
    channels: list[Channel], units: str, path: Path | str, source: str, kind: str
) -> Recording:
    """Recording of the channels of one file.

    One channel leaves its axis to the case. Of several, two perpendicular horizontal ones in any
    direction are turned to east and north, one alone lies along x, and what points down is turned
    up. Channels that differ by a few samples at their end are cut to the shortest.

    Raises
    ------
    UnusableRecord
        more than three channels, two of one direction, horizontal ones that are not perpendicular,
        different steps or lengths.
    """
    name = Path(path).name
    told = ", ".join(channel.told or "?" for channel in channels)
    source = f"{source} ({told})".strip()
    if not channels:
        raise UnusableRecord(f"holds no accelerations as {kind}")
    if len(channels) == 1:
        one = channels[0]
        return Recording(one.values[:, None], ("",), one.dt, units, name, source, kind)
    if len(channels) > 3:
        raise UnusableRecord(
            f"holds {len(channels)} channels ({told}); at most 3 are read: keep those of one place"
        )
    shortest = min(len(channel.values) for channel in channels)
    if any(abs(one.dt / channels[0].dt - 1) > _DT_TOLERANCE for one in channels):
        raise UnusableRecord(f"has channels of different steps ({told})")
    if lengths_differ(shortest, max(len(one.values) for one in channels)):
        raise UnusableRecord(f"has channels of different lengths ({told}); they may differ by 1 %")
    level = [one for one in channels if isinstance(one.direction, float)]
    upright = [one for one in channels if one.direction in ("up", "down")]
    if len(level) + len(upright) < len(channels) or len(upright) > 1 or len(level) > 2:
        raise UnusableRecord(
            f"has channels in the directions {told}; must be two perpendicular horizontal ones and "
            "one vertical one at most: write the ones to use as CSV"
        )
    columns = _level(level, shortest, told)
    for one in upright:
        columns["z"] = one.values[:shortest] * (1 if one.direction == "up" else -1)
    return Recording(
        np.column_stack(list(columns.values())),
        tuple(columns),
        channels[0].dt,
        units,
        name,
        source,
        kind,
    )


def _level(level: list[Channel], count: int, told: str) -> dict[str, NDArray[Any]]:
    """Columns along x, of one channel, or along x (east) and y (north), of two."""
    if not level:
        return {}
    if len(level) == 1:
        return {"x": level[0].values[:count]}
    angles = [math.radians(float(one.direction)) for one in level]
    if abs(math.cos(angles[0] - angles[1])) > _SQUARE:
        raise UnusableRecord(
            f"has channels in the directions {told}; horizontal ones must be perpendicular: write "
            "the ones to use as CSV"
        )
    # rows: unit vectors of the sensors in (east, north); multiples of 90 degrees stay exact
    sensors = np.array([[round(math.sin(a), 15), round(math.cos(a), 15)] for a in angles])
    east, north = np.linalg.inv(sensors) @ np.stack([one.values[:count] for one in level])
    return {"x": east, "y": north}
