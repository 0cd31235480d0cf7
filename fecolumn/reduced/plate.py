"""The base plate under the foot, for compiled code: which of its nodes carry a point, and how they give."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit

# Answers of `project`
ON, OFF, UNKNOWN = range(3)


class Plate(NamedTuple):
    """Top of the base: grid lines x, y [m]; number: (n_x, n_y) of its nodes; slot: (n_top,) of a node in `compliance`, -1 where it is not
    known yet; compliance: (3 k, 3 k) [m/N]. size: of the squares [m] by which an unbounded base follows the foot, 0 for a plate that stays."""

    x: np.ndarray
    y: np.ndarray
    number: np.ndarray
    slot: np.ndarray
    compliance: np.ndarray
    size: float


class Footing(NamedTuple):
    """Where the points stand: slots and weights (n, 4) of the plate's nodes below; even: (n, 3, 3) as `Interface._evened`."""

    slots: np.ndarray
    weights: np.ndarray
    even: np.ndarray


def plate_of(base) -> Plate:
    """The plate of a `contact.base_plate.BasePlate` as far as it is known."""
    k = len(base.compliance)
    flat = np.ascontiguousarray(base.compliance.transpose(0, 2, 1, 3)).reshape(3 * k, 3 * k)
    return Plate(base.grid.x, base.grid.y, base.grid.number, base.slot.copy(), flat, base.grid.size)


def no_footing(n: int) -> Footing:
    return Footing(np.zeros((n, 4), np.int64), np.zeros((n, 4)), np.zeros((n, 3, 3)))


@njit
def project(plate, positions, wanted, footing):
    """Find the nodes under the wanted points (mask) at positions (n, 3): ON, OFF the plate, or UNKNOWN compliance."""
    answer, dx, dy = ON, 0.0, 0.0
    if plate.size > 0:
        # as MovingTop.project
        for i in range(len(positions)):
            dx += positions[i, 0] / len(positions)
            dy += positions[i, 1] / len(positions)
        dx, dy = plate.size * np.rint(dx / plate.size), plate.size * np.rint(dy / plate.size)
    for i in range(len(wanted)):
        if not wanted[i]:
            continue
        x, y = positions[i, 0] - dx, positions[i, 1] - dy
        if not (plate.x[0] <= x <= plate.x[-1] and plate.y[0] <= y <= plate.y[-1]):
            return OFF
        a = min(np.searchsorted(plate.x, x, side="right") - 1, len(plate.x) - 2)
        b = min(np.searchsorted(plate.y, y, side="right") - 1, len(plate.y) - 2)
        s, t = (x - plate.x[a]) / (plate.x[a + 1] - plate.x[a]), (y - plate.y[b]) / (plate.y[b + 1] - plate.y[b])
        for q in range(4):
            slot = plate.slot[plate.number[a + q % 2, b + q // 2]]
            footing.slots[i, q] = slot
            footing.weights[i, q] = (s if q % 2 else 1 - s) * (t if q // 2 else 1 - t)
            if slot < 0:
                answer = UNKNOWN
    return answer
