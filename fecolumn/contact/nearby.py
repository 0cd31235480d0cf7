"""Pairs of convex bodies whose boxes are near each other.

The box of a body stands along the axes of the table frame, about the box of its hull, which turns
along; it is grown by the way that the body may go until pairs are looked for again. Boxes are swept
in the order of their lower ends along the axis along which the bodies are spread most. An order
changes little from step to step, and so is mended by insertion.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.convex import TOGETHER
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.convex import Hulls


class Boxes(NamedTuple):
    """low, high: (N, 3) of each body's box [m]; order: (N,) bodies by their lower ends."""

    low: Array
    high: Array
    order: Array


def boxes_for(count: int) -> Boxes:
    """Boxes of `count` bodies, not yet found."""
    return Boxes(np.zeros((count, 3)), np.zeros((count, 3)), np.arange(count))


def pair_keys(pairs: Sequence[tuple[int, int]], count: int) -> Array:
    """Keys (k,) in their order of pairs (k, 2) of `count` bodies, for `find_pairs` to leave out."""
    rows = np.sort(np.asarray(pairs, np.int64).reshape(-1, 2), axis=1)
    return np.unique(rows[:, 0] * count + rows[:, 1])


@njit(alone=TOGETHER)
def find_boxes(
    hulls: Hulls, centers: Array, rotations: Array, margins: Array, boxes: Boxes
) -> None:
    """Find the boxes of bodies with centres of mass (N, 3) [m], turned by (N, 3, 3), each grown by
    its margin (N,) [m].
    """
    for b in range(len(centers)):
        for i in range(3):
            at, half = centers[b, i], margins[b]
            for k in range(3):
                at += rotations[b, i, k] * hulls.middle[b, k]
                half += abs(rotations[b, i, k]) * hulls.half[b, k]
            boxes.low[b, i], boxes.high[b, i] = at - half, at + half


@njit(alone=TOGETHER)
def _is_left_out(key: int, keys: Array) -> bool:
    first, last = 0, len(keys)
    while first < last:
        half = (first + last) // 2
        if keys[half] < key:
            first = half + 1
        else:
            last = half
    return first < len(keys) and keys[first] == key


@njit(alone=TOGETHER)
def _widest_axis(boxes: Boxes) -> int:
    """Axis along which the boxes' middles vary most."""
    axis, most, n = 0, -1.0, max(len(boxes.low), 1)
    for i in range(3):
        mean = squares = 0.0
        for b in range(len(boxes.low)):
            mean += (boxes.low[b, i] + boxes.high[b, i]) / n
        for b in range(len(boxes.low)):
            squares += (boxes.low[b, i] + boxes.high[b, i] - mean) ** 2
        if squares > most:
            axis, most = i, squares
    return axis


@njit(alone=TOGETHER)
def find_pairs(hulls: Hulls, boxes: Boxes, left_out: Array, pairs: Array) -> int:
    """Find pairs whose boxes overlap, the lower number first; how many they are, of which no more
    than have room are put into pairs (P, 2).

    Parameters
    ----------
    boxes
        of `find_boxes`; their order is changed.
    left_out
        of `pair_keys`.
    """
    low, high, order, axis, found = boxes.low, boxes.high, boxes.order, _widest_axis(boxes), 0
    for i in range(1, len(order)):
        body, k = order[i], i
        while k > 0 and low[order[k - 1], axis] > low[body, axis]:
            order[k] = order[k - 1]
            k -= 1
        order[k] = body
    one, two = (axis + 1) % 3, (axis + 2) % 3
    for i in range(len(order)):
        a = order[i]
        if hulls.first[a + 1, 0] == hulls.first[a, 0]:
            continue
        for k in range(i + 1, len(order)):
            b = order[k]
            if low[b, axis] > high[a, axis]:
                break
            if (
                low[b, one] > high[a, one]
                or low[a, one] > high[b, one]
                or low[b, two] > high[a, two]
                or low[a, two] > high[b, two]
                or hulls.first[b + 1, 0] == hulls.first[b, 0]
                or _is_left_out(min(a, b) * len(order) + max(a, b), left_out)
            ):
                continue
            if found < len(pairs):
                pairs[found, 0], pairs[found, 1] = min(a, b), max(a, b)
            found += 1
    return found
