"""Bricks of the base plate: a tensor-product grid, fine under the column and coarser outside."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from scipy.optimize import brentq

from fecolumn.mesh.bricks import BASE, BrickMesh
from fecolumn.mesh.column import divisions
from fecolumn.mesh.gmsh_section import swept_grid
from fecolumn.mesh.outline import foot_sides
from fecolumn.mesh.upright import Upright

GROWTH = 1.5  # largest ratio of neighbouring bricks


def base_mesh(case: Upright) -> BrickMesh:
    """Rectangular plate centred on the axis, its top at z = 0.

    Squares of `fine_size_m` cover the footprint and the slide allowance; outside and downwards the
    bricks grow geometrically to `base_size_m`. Contact finds the brick below a point from the grid
    lines alone, so the mesh is a strict tensor-product grid (see `swept_grid` for its numbering). A
    base without edges has no bricks.
    """
    if case.base.kind != "plate":
        return BrickMesh(np.zeros((0, 3)), np.zeros((0, 8), np.int64), np.zeros(0, np.int8))
    base, fine, largest = case.base, case.mesh.fine_size_m, case.mesh.base_size_m
    x, y = (
        _symmetric_line(side + 2 * base.slide_allowance_m, length, fine, largest)
        for side, length in zip(foot_sides(case), (base.length_m, base.width_m))
    )
    return swept_grid(x, y, levels(case)[::-1], BASE)


def levels(case: Upright) -> np.ndarray:
    """Levels (n,) of the base's nodes from 0 at the top, falling [m]."""
    return depths(case.base.thickness_m, case.mesh.fine_size_m, case.mesh.base_size_m)


def depths(thickness: float, fine: float, largest: float) -> np.ndarray:
    """Levels (n,) of a layer's nodes from 0 at its top, falling [m]."""
    return -_growing_line(fine, thickness, fine, largest)


def plate_line(
    spans: Iterable[tuple[float, float]], low: float, high: float, fine: float, largest: float
) -> np.ndarray:
    """Grid line from `low` to `high` [m], with equal steps near `fine` over each of the spans
    (start, end), which come one after another and apart, and growing ones around them.
    """
    fine_spans = [[max(start, low), min(end, high)] for start, end in spans]
    # a margin below half a fine brick would be a sliver: the fine bricks stretch over it
    if fine_spans[0][0] - low < fine / 2:
        fine_spans[0][0] = low
    if high - fine_spans[-1][1] < fine / 2:
        fine_spans[-1][1] = high
    pieces: list[np.ndarray | list[float]] = []
    last = low
    for start, end in fine_spans:
        if pieces:
            half = (start - last) / 2
            steps = np.cumsum(growing_steps(half, fine, largest))[:-1]
            pieces += [last + steps, [(last + start) / 2], start - steps[::-1]]
        elif start > low:
            steps = np.cumsum(growing_steps(start - low, fine, largest))[:-1]
            pieces += [[low], start - steps[::-1]]
        pieces.append(np.linspace(start, end, divisions(end - start, fine) + 1))
        last = end
    if last < high:
        pieces += [last + np.cumsum(growing_steps(high - last, fine, largest))[:-1], [high]]
    return np.concatenate(pieces)


def base_counts(case: Upright) -> tuple[int, int, int] | None:
    """Bricks of the base along x, y and z, told without making it; None of a base without edges."""
    if case.base.kind != "plate":
        return None
    base, fine, largest = case.base, case.mesh.fine_size_m, case.mesh.base_size_m
    x, y = (
        _symmetric_count(side + 2 * base.slide_allowance_m, length, fine, largest)
        for side, length in zip(foot_sides(case), (base.length_m, base.width_m))
    )
    below = base.thickness_m - fine
    return x, y, 1 if below < fine / 2 else 1 + growing_count(below, fine, largest)


def _symmetric_count(fine_width: float, length: float, fine: float, largest: float) -> int:
    """Steps of `_symmetric_line`."""
    if (length - fine_width) / 2 < fine / 2:
        return divisions(length, fine)
    outside = length / 2 - fine_width / 2
    return divisions(fine_width, fine) + 2 * growing_count(outside, fine, largest)


def _symmetric_line(fine_width: float, length: float, fine: float, largest: float) -> np.ndarray:
    """Grid line from -length/2 to length/2, equal steps near `fine` in the middle."""
    span = -fine_width / 2, fine_width / 2
    return plate_line([span], -length / 2, length / 2, fine, largest)


def _growing_line(first: float, length: float, fine: float, largest: float) -> np.ndarray:
    """Grid line from 0 to `length`: one step `first`, then growing ones."""
    if length - first < fine / 2:
        return np.array([0.0, length])
    line = np.concatenate(
        [[0.0, first], first + np.cumsum(growing_steps(length - first, fine, largest))]
    )
    line[-1] = length
    return line


def growing_steps(length: float, fine: float, largest: float) -> np.ndarray:
    """Steps that fill `length`, each at most GROWTH times the one before, none above `largest` [m].

    With n steps, step k is min(fine g^k, largest), k = 1..n; n is the smallest number that reaches
    the length with g = GROWTH, and g is then lowered until the steps fit.
    """

    def steps(growth: float, n: int) -> np.ndarray:
        return np.minimum(fine * growth ** np.arange(1.0, n + 1), largest)

    n = growing_count(length, fine, largest)
    if steps(1.0, n).sum() < length < steps(GROWTH, n).sum():
        found = steps(
            brentq(lambda growth: steps(growth, n).sum() - length, 1.0, GROWTH, xtol=1e-14), n
        )
    else:
        found = steps(1.0, n)
    return found * (length / found.sum())


def growing_count(length: float, fine: float, largest: float) -> int:
    """Smallest number n of steps min(fine GROWTH^k, largest), k = 1..n, that reaches `length`
    [m].
    """
    length *= 1 - 1e-12
    reached, step, n = 0.0, fine, 0
    while reached < length and step * GROWTH < largest:
        step *= GROWTH
        reached, n = reached + step, n + 1
    return max(1, n + math.ceil(max(0.0, length - reached) / largest))
