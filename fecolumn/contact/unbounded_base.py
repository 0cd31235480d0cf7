"""A base without edges: a layer of the base plate's thickness and material that goes on for
ever.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.contact.base_top import BaseTop
from fecolumn.contact.layer import layer_response
from fecolumn.foundation.arrays import Array

# Rows of nodes around the foot of which the compliance is known from the start: a cell, and the
# foot's place within one
ROWS = 3


class UnboundedBase:
    """Static compliance of a layer's top, the same wherever the column goes.

    It answers as `contact.base_plate.BasePlate` does. Its nodes are those of a window that follows
    the foot by whole bricks: all bricks are equal, so that the window may move at any time and
    nothing changes.

    Parameters
    ----------
    size
        of a brick in plan [m].
    response
        of `layer_response`.
    reference
        (n, 3) the foot's nodes [m].
    frequency
        lowest of the layer [Hz].
    feet
        how many stand on it.
    """

    body, dofs, made_s, made_cpu_s = None, 0, 0.0, 0.0

    def __init__(
        self, size: float, response: Array, reference: Array, frequency: float, feet: int = 1
    ) -> None:
        self.response, self.frequency = response, frequency
        self.grid = MovingTop(size, (len(response) - 1) // 4)
        self.slot = np.full(len(self.grid.points), -1, np.int64)
        self.known = np.zeros(0, np.int64)
        if feet > 1:
            self.need(self.grid.around(reference, ROWS))
            return
        distance = np.linalg.norm(reference[:, :2] - reference[:, :2].mean(axis=0), axis=1)
        away, reach = np.linalg.norm(self.grid.points[:, :2], axis=1), ROWS * size
        self.need(
            np.flatnonzero((away <= distance.max() + reach) & (away >= distance.min() - reach))
        )

    def need(self, wanted: Array) -> None:
        """Make sure that the compliance holds the nodes `wanted` of the window."""
        new = np.unique(wanted[self.slot[wanted] < 0])
        if not len(new):
            return
        self.slot[new] = np.arange(len(self.known), len(self.known) + len(new))
        self.known = np.concatenate([self.known, new])
        lines, middle = len(self.grid.y), len(self.response) // 2
        i, j = np.divmod(self.known, lines)
        #: Blocks (k, k, 3, 3) [m/N] of the known nodes.
        self.compliance = np.ascontiguousarray(
            self.response[middle + i[:, None] - i, middle + j[:, None] - j]
        )


class MovingTop(BaseTop):
    """Equal squares under the foot, moved along with it by whole squares."""

    def __init__(self, size: float, count: int) -> None:
        lines = size * np.arange(-count, count + 1)
        x, y = np.meshgrid(lines, lines, indexing="ij")
        super().__init__(np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1))
        self.square = size

    def around(self, positions: Array, rows: int) -> Array:
        """Nodes (k,) of the window around all points of the feet at `positions` (n, 3) [m]."""
        moved = np.zeros(3)
        moved[:2] = self.square * np.round(positions[:, :2].mean(axis=0) / self.square)
        return super().around(positions - moved, rows)

    def at_edge(self, positions: Array, margin: float) -> bool:
        """False: it has no edge."""
        return False


def window(size: float, reference: Array, travel: float = 0.0) -> int:
    """Squares to each side of the middle of the feet's points (n, 3) that hold the feet however
    they are turned, and move apart by `travel` [m].
    """
    return (
        int(
            np.ceil(
                (
                    np.linalg.norm(reference[:, :2] - reference[:, :2].mean(axis=0), axis=1).max()
                    + travel
                )
                / size
            )
        )
        + ROWS
    )


def unbounded_base(
    size: float,
    depths: Array,
    material: Any,
    reference: Array,
    feet: int = 1,
    travel: float = 0.0,
) -> UnboundedBase:
    """The base of bricks `size` x `size` in plan with levels `depths` (n,) [m], falling from 0;
    travel: by which several feet may move apart [m].

    Raises
    ------
    ValueError
        too thick for its bricks; see `layer_response`.
    """
    response = layer_response(size, depths, material, 2 * window(size, reference, travel))
    return UnboundedBase(size, response, reference, shear_frequency(material, -depths[-1]), feet)


def rigid_base(reference: Array) -> UnboundedBase:
    """A rigid flat below points (n, 3) [m]: squares as wide as all of them, which do not give."""
    size = float(np.ptp(reference[:, :2], axis=0).max())
    sides = 4 * window(size, reference) + 1
    return UnboundedBase(size, np.zeros((sides, sides, 3, 3)), reference, np.inf)


def shear_frequency(material: Any, thickness: float) -> float:
    """Lowest shear mode through a thickness [m] that is held at its bottom [Hz]."""
    shear = material.youngs_modulus_pa / (2 * (1 + material.poissons_ratio))
    return float(np.sqrt(shear / material.density_kg_m3) / (4 * thickness))
