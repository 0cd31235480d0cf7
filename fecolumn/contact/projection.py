"""Which nodes of the base lie below a point."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import interpreted, njit
from fecolumn.contact.bodies import node_matrix
from fecolumn.contact.points import BASE, POINT

# Answers of `project`
ON, OFF, UNKNOWN = range(3)


class Base(NamedTuple):
    """Top of the base for compiled code: grid lines x, y [m]; number: (n_x, n_y) of its nodes; slot: (n_top,) of a node in `compliance`, -1 where it
    is not known yet; compliance: (3 k, 3 k) [m/N]. square: side of the squares [m] by which an unbounded base follows the foot, 0 for a plate that stays."""

    x: np.ndarray
    y: np.ndarray
    number: np.ndarray
    slot: np.ndarray
    compliance: np.ndarray
    square: float


def base_for_steps(base) -> Base:
    """The Base of a `contact.base_plate.BasePlate`, or what answers as it does, as far as its compliance is known."""
    return Base(base.grid.x, base.grid.y, base.grid.number, base.slot.copy(), node_matrix(base.compliance), base.grid.square)


@njit
def project(base, positions, listed, points):
    """Find the base's nodes under those of the listed points (k,) at positions (n, 3) that stand on it: ON, OFF its top, or UNKNOWN compliance.

    Bilinear interpolation on the facet vertically below: the top's slope under load is about 1e-5 rad and changes gap and cone by 1e-5 of themselves.
    An unbounded base is moved along with the middle of the positions by whole squares.
    """
    answer, dx, dy = ON, 0.0, 0.0
    if base.square > 0:
        for i in range(len(positions)):
            dx += positions[i, 0] / len(positions)
            dy += positions[i, 1] / len(positions)
        dx, dy = base.square * np.rint(dx / base.square), base.square * np.rint(dy / base.square)
    for i in listed:
        if points[i].master != BASE:
            continue
        x, y = positions[i, 0] - dx, positions[i, 1] - dy
        if not (base.x[0] <= x <= base.x[-1] and base.y[0] <= y <= base.y[-1]):
            return OFF
        a, b = _cell(base.x, x), _cell(base.y, y)
        s, t = (x - base.x[a]) / (base.x[a + 1] - base.x[a]), (y - base.y[b]) / (base.y[b + 1] - base.y[b])
        for q in range(4):
            slot = base.slot[base.number[a + q % 2, b + q // 2]]
            points[i].below[q] = slot
            points[i].shares[q] = (s if q % 2 else 1 - s) * (t if q // 2 else 1 - t)
            if slot < 0:
                answer = UNKNOWN
    return answer


@njit
def _cell(lines, value):
    """Number of the cell of the rising `lines` that holds `value`, by bisection."""
    low, high = 0, len(lines) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if lines[middle] <= value:
            low = middle
        else:
            high = middle
    return low


def nodes_under(grid, positions: np.ndarray, wanted: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (n, 4) of a `contact.base_top.BaseTop` under `positions` (n, 3) [m] and their shares (n, 4), of the wanted ones (mask) if it is given."""
    points, listed = np.zeros(len(positions), POINT), np.arange(len(positions)) if wanted is None else np.flatnonzero(wanted)
    points["master"] = BASE
    base = Base(grid.x, grid.y, grid.number, np.arange(len(grid.points)), np.empty((0, 0)), grid.square)
    interpreted(project)(base, positions, listed, points)
    return points["below"], points["shares"]
