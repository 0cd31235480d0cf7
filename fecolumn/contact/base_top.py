"""The top of the base plate: a grid of bricks on which the column's foot stands, slides and rolls."""

from __future__ import annotations

import numpy as np


class OffBase(RuntimeError):
    """A contact point has left the base plate: nothing is below it."""


class BaseTop:
    """Bilinear interpolation on the deformed top of the base.

    The top is a tensor-product grid, so that the facet under a point is found by two bisections at any slide. The
    projection is vertical: the top's slope under load is about 1e-5 rad and changes gap and cone by 1e-5 of themselves.

    Args:
        points: (n, 3) [m] reference positions of the top's nodes in any order.
    """

    #: Size of the squares by which the top follows the foot [m]; this one stays.
    size = 0.0

    def __init__(self, points: np.ndarray):
        self.points = points
        self.x, self.y = (_lines(points[:, axis]) for axis in (0, 1))
        self.z = float(points[:, 2].max())
        if len(self.x) * len(self.y) != len(points):
            raise ValueError("the top of the base must be a tensor-product grid")
        self.number = np.empty((len(self.x), len(self.y)), np.int64)
        self.number[_cell(self.x, points[:, 0]), _cell(self.y, points[:, 1])] = np.arange(len(points))

    def at_edge(self, positions: np.ndarray, margin: float) -> bool:
        """Whether any of the `positions` (n, 3) [m] is beyond the edge or nearer to it than `margin` [m]."""
        return any((positions[:, axis].min() < lines[0] + margin or positions[:, axis].max() > lines[-1] - margin)
                   for axis, lines in enumerate((self.x, self.y)))

    def project(self, positions: np.ndarray, touching: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Top nodes (n, 4) and weights (n, 4) under `positions` (n, 3) [m].

        Args:
            touching: (n,) points that need the base below them, all of them if not given. Others may be beyond its edge: they get the
                nodes there.

        Raises:
            OffBase: a position lies outside the plate.
        """
        cells, local = [], []
        for axis, lines in enumerate((self.x, self.y)):
            coordinate = positions[:, axis]
            outside = (coordinate < lines[0]) | (coordinate > lines[-1])
            if touching is not None:
                coordinate, outside = np.clip(coordinate, lines[0], lines[-1]), outside & touching
            if outside.any():
                coordinate = positions[:, axis]
                worst = coordinate[np.argmax(np.abs(coordinate - (lines[0] + lines[-1]) / 2))]
                raise OffBase(f"a contact point left the base plate: {'xy'[axis]} = {worst:.4g} m, the plate ends at {lines[0]:.4g} and {lines[-1]:.4g} m")
            cell = np.clip(np.searchsorted(lines, coordinate, side="right") - 1, 0, len(lines) - 2)
            cells.append(cell)
            local.append((coordinate - lines[cell]) / (lines[cell + 1] - lines[cell]))
        (i, j), (s, t) = cells, local
        nodes = np.stack([self.number[i, j], self.number[i + 1, j], self.number[i, j + 1], self.number[i + 1, j + 1]], axis=1)
        weights = np.stack([(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t], axis=1)
        return nodes, weights


def _lines(values: np.ndarray) -> np.ndarray:
    """Grid lines among coordinates equal up to rounding."""
    values = np.sort(values)
    return values[np.concatenate([[True], np.diff(values) > 1e-9 * np.ptp(values)])]


def _cell(lines: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Number of the line nearest to each value."""
    middles = (lines[1:] + lines[:-1]) / 2
    return np.searchsorted(middles, values)
