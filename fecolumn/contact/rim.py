"""The round rim of the foot as the circle it is, not the polygon of its nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn._compiled import njit

# Nodes count as a circle: so many at least, their distances from its centre and their sectors equal up to this
_FEWEST, _ROUND = 12, 1e-6


@dataclass(frozen=True, slots=True)
class RimPoints:
    """Points of the circle, one for each of its nodes, all turned along it by the same angle.

    slots: (n,) foot nodes whose places in the contact they take, the nearest ones. carriers: (n, 4) foot nodes that carry them;
    weights: (4,) their shares, which reproduce the circle's points in any rigid motion. index: node of the rim whose point is
    that of the angle asked for. phase: how far each point is past the node whose place it takes, in sectors, -1/2 to 1/2.
    """

    slots: np.ndarray
    carriers: np.ndarray
    weights: np.ndarray
    index: int
    phase: float

    def of(self, values: np.ndarray) -> np.ndarray:
        """Values (n, ...) at the points from those at the foot's nodes, along the first axis."""
        return np.tensordot(self.weights, values[self.carriers], (0, 1))


class Rim:
    """Circle through the outer nodes of a foot.

    A polygon rolls from corner to corner, and each corner that lands takes energy as a plastic impact does. The contact points
    of the circle roll along with its lowest one: in steady rolling none lands.

    Args:
        nodes: (n,) foot nodes on the circle by rising angle, evenly spaced. first: angle of nodes[0] [rad].
        radius: of the circle [m].
    """

    def __init__(self, nodes: np.ndarray, first: float, radius: float):
        self.nodes, self.first, self.radius = nodes, first, radius
        #: Angle between neighbouring nodes [rad].
        self.sector = 2 * np.pi / len(nodes)

    @classmethod
    def find(cls, reference: np.ndarray) -> Rim | None:
        """Rim of a foot with nodes at (n, 3) [m]; None where its farthest nodes are not evenly spaced on a circle."""
        plane = reference[:, :2] - reference[:, :2].mean(axis=0)
        distance = np.linalg.norm(plane, axis=1)
        outer = np.flatnonzero(distance > (1 - _ROUND) * distance.max())
        angles = np.arctan2(plane[outer, 1], plane[outer, 0])
        order = np.argsort(angles)
        sectors = np.diff(angles[order], append=angles[order[0]] + 2 * np.pi)
        even = len(outer) >= _FEWEST and np.ptp(sectors) < _ROUND
        return cls(outer[order], float(angles[order[0]]), float(distance.max())) if even else None

    @staticmethod
    def lowest(rotation: np.ndarray) -> tuple[float, float]:
        """Angle of the circle's lowest point and tilt of its plane [rad] in the rotation (3, 3)."""
        return float(np.arctan2(-rotation[2, 1], -rotation[2, 0])), float(np.hypot(rotation[2, 0], rotation[2, 1]))

    def points(self, angle: float) -> RimPoints:
        """Points of the circle of which one is at `angle` [rad].

        Each is carried by the two nodes beside it and, as it lies outside their chord, by a pull of 1 / n^2 from the far side.
        """
        n = len(self.nodes)
        index, phase, offsets, weights = on_circle(angle, self.first, self.sector, n)
        return RimPoints(self.nodes, self.nodes[(np.arange(n)[:, None] + offsets) % n], weights, index, phase)


@njit
def on_circle(angle, first, sector, n):
    """Number of the node of n whose point is at `angle`, how far that is past it in sectors, and from each node on: offsets (4,) of its
    point's carriers, weights (4,)."""
    index = int(np.rint((angle - first) / sector))
    turn = angle - first - index * sector
    side = 1 if turn >= 0 else -1
    # in a frame with the nearer node at angle 0 and the point at |turn|: nearer, next, and the far two taken together
    far = -np.cos(sector / 2) if n % 2 == 0 else -1.0
    cosine, sine, x, y = np.cos(sector), np.sin(sector), far * np.cos(sector / 2), far * np.sin(sector / 2)
    # near = 1 - beside - pull
    a, b, c, d = cosine - 1, x - 1, sine, y
    right, up = np.cos(turn) - 1, abs(np.sin(turn))
    determinant = a * d - b * c
    beside, pull = (right * d - b * up) / determinant, (a * up - c * right) / determinant
    offsets = side * np.array([0, 1, n // 2 + 1, (n + 1) // 2])
    return index % n, turn / sector, offsets, np.array([1 - beside - pull, beside, pull / 2, pull / 2])
