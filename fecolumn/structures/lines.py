"""Grid lines that are fine where bodies meet and coarse elsewhere."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.mesh.base_plate import growing_count, growing_steps
from fecolumn.mesh.column import divisions

#: Low and high end of a spot along a line, and element size in it [m].
Span = tuple[float, float, float]


def fine_at_ends(length: float, fine: float, coarse: float) -> NDArray[Any]:
    """Grid line (n,) from 0 to `length` [m] with steps near `fine` at both ends, growing to
    `coarse` in the middle.
    """
    if length <= 3 * fine:
        return np.linspace(0.0, length, max(2, divisions(length, fine)) + 1)
    half = np.concatenate([[fine], growing_steps(length / 2 - fine, fine, coarse)])
    line = np.concatenate([[0.0], np.cumsum(np.concatenate([half, half[::-1]]))])
    scaled: NDArray[Any] = line * (length / line[-1])
    return scaled


def count_at_ends(length: float, fine: float, coarse: float) -> int:
    """Steps of `fine_at_ends`, told without making them."""
    return (
        max(2, divisions(length, fine))
        if length <= 3 * fine
        else 2 + 2 * growing_count(length / 2 - fine, fine, coarse)
    )


def fine_at_spots(length: float, spots: Iterable[Span], coarse: float) -> NDArray[Any]:
    """Grid line (n,) from -length/2 to length/2 [m], fine in spots and growing to `coarse` between
    them.

    Parameters
    ----------
    spots
        (low, high, size) [m] of each; those that meet or nearly do become one of the smaller size.
    """
    line = [-length / 2]
    for low, high, fine in _joined(spots, length):
        if low > line[-1]:
            line += list(_between(line[-1], low, fine, coarse, from_spot=len(line) > 1))
        line += list(np.linspace(low, high, divisions(high - low, fine) + 1)[1:])
        last = fine
    if line[-1] < length / 2:
        steps = (
            growing_steps(length / 2 - line[-1], last, coarse)
            if len(line) > 1
            else np.full(divisions(length, coarse), 1.0)
        )
        line += list(line[-1] + np.cumsum(steps) * ((length / 2 - line[-1]) / steps.sum()))
    line[-1] = length / 2
    return np.array(line)


def count_at_spots(length: float, spots: Iterable[Span], coarse: float) -> int:
    """Steps of `fine_at_spots`, told without making them."""
    count, end = 0, -length / 2
    for low, high, fine in _joined(spots, length):
        if low > end:
            count += (
                2 * growing_count((low - end) / 2, fine, coarse)
                if count
                else growing_count(low - end, fine, coarse)
            )
        count, end, last = count + divisions(high - low, fine), high, fine
    if end < length / 2:
        count += (
            growing_count(length / 2 - end, last, coarse) if count else divisions(length, coarse)
        )
    return count


def _between(low: float, high: float, fine: float, coarse: float, from_spot: bool) -> NDArray[Any]:
    """Places after `low` up to `high`, where a spot begins: steps that shrink towards it, and grow
    from a spot before.
    """
    if not from_spot:
        steps = growing_steps(high - low, fine, coarse)[::-1]
    else:
        half = growing_steps((high - low) / 2, fine, coarse)
        steps = np.concatenate([half, half[::-1]])
    places: NDArray[Any] = low + np.cumsum(steps) * ((high - low) / steps.sum())
    places[-1] = high
    return places


def _joined(spots: Iterable[Span], length: float) -> list[Span]:
    """Spots within the line by rising place, those joined that leave less than a step between them;
    slivers at the ends are taken in.
    """
    found: list[Span] = []
    for low, high, fine in sorted(
        (max(low, -length / 2), min(high, length / 2), fine) for low, high, fine in spots
    ):
        if high <= low:
            continue
        if found and low - found[-1][1] < fine:
            found[-1] = found[-1][0], max(high, found[-1][1]), min(fine, found[-1][2])
        else:
            found.append((low, high, fine))
    ends = [
        (
            -length / 2 if low + length / 2 < fine / 2 else low,
            length / 2 if length / 2 - high < fine / 2 else high,
            fine,
        )
        for low, high, fine in found
    ]
    return ends
