"""The top of the base: a grid of bricks on which feet stand, slide and roll."""

from __future__ import annotations

import numpy as np

from fecolumn.foundation.arrays import Array


class BaseTop:
    """Grid of the nodes on top of the base, a tensor product.

    Parameters
    ----------
    points
        (n, 3) [m] reference positions of the top's nodes in any order.
    """

    #: Side of the squares by which the top follows the foot [m]; this one stays.
    square = 0.0

    def __init__(self, points: Array) -> None:
        self.points = points
        self.x, self.y = (_lines(points[:, axis]) for axis in (0, 1))
        if len(self.x) * len(self.y) != len(points):
            raise ValueError("the top of the base must be a tensor-product grid")
        self.number = np.empty((len(self.x), len(self.y)), np.int64)
        self.number[_line(self.x, points[:, 0]), _line(self.y, points[:, 1])] = np.arange(
            len(points)
        )

    def around(self, positions: Array, rows: int) -> Array:
        """Nodes (k,) under `positions` (n, 3) [m] and so many rows around them, those at the edge
        where a position is beyond it.
        """
        spans = []
        for axis, lines in enumerate((self.x, self.y)):
            cell = np.clip(
                np.searchsorted(lines, positions[:, axis], side="right") - 1, 0, len(lines) - 2
            )
            spans.append(np.clip(cell[:, None] + np.arange(-rows, rows + 2), 0, len(lines) - 1))
        return np.unique(self.number[spans[0][:, :, None], spans[1][:, None, :]])

    def at_edge(self, positions: Array, margin: float) -> bool:
        """Whether any of the `positions` (n, 3) [m] is beyond the edge or nearer to it than
        `margin` [m].
        """
        return any(
            (
                positions[:, axis].min() < lines[0] + margin
                or positions[:, axis].max() > lines[-1] - margin
            )
            for axis, lines in enumerate((self.x, self.y))
        )


def _lines(values: Array) -> Array:
    """Grid lines among coordinates equal up to rounding."""
    values = np.sort(values)
    return values[np.concatenate([[True], np.diff(values) > 1e-9 * np.ptp(values)])]


def _line(lines: Array, values: Array) -> Array:
    """Number of the line nearest to each value."""
    return np.searchsorted((lines[1:] + lines[:-1]) / 2, values)
