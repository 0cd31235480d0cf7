"""The round rim of the foot as the circle it is, not the polygon of its nodes."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.tolerances import ROUND, ROUND_NODES
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


class Rim:
    """Circle through the outer nodes of a foot.

    A polygon rolls from corner to corner, and each corner that lands takes energy as a plastic
    impact does. The contact points of the circle roll along with its lowest one: in steady rolling
    none lands.

    Parameters
    ----------
    nodes
        (n,) foot nodes on the circle by rising angle, evenly spaced.
    first
        angle of nodes[0] [rad].
    radius
        of the circle [m].
    """

    def __init__(self, nodes: Array, first: float, radius: float) -> None:
        self.nodes, self.first, self.radius = nodes, first, radius
        #: Angle between neighbouring nodes [rad].
        self.sector = 2 * np.pi / len(nodes)

    @classmethod
    def find(cls, reference: Array) -> Rim | None:
        """Rim of a foot with nodes at (n, 3) [m]; None where its farthest nodes are not evenly
        spaced on a circle.
        """
        plane = reference[:, :2] - reference[:, :2].mean(axis=0)
        distance = np.linalg.norm(plane, axis=1)
        outer = np.flatnonzero(distance > (1 - ROUND) * distance.max())
        angles = np.arctan2(plane[outer, 1], plane[outer, 0])
        order = np.argsort(angles)
        sectors = np.diff(angles[order], append=angles[order[0]] + 2 * np.pi)
        even = len(outer) >= ROUND_NODES and np.ptp(sectors) < ROUND
        return cls(outer[order], float(angles[order[0]]), float(distance.max())) if even else None


@njit
def lowest(rotation: Array) -> tuple[float, float]:
    """Angle [rad] of the circle's lowest point and tilt [rad] of its plane in the rotation (3,
    3).
    """
    return np.arctan2(-rotation[2, 1], -rotation[2, 0]), np.hypot(rotation[2, 0], rotation[2, 1])


@njit
def on_circle(
    angle: float, first: float, sector: float, n: int, offsets: Array, weights: Array
) -> tuple[int, float]:
    """Put the points of a circle of n nodes where one is at `angle`: number of the node whose place
    that one takes, and how far it is past it in sectors.

    Each is carried by the two nodes beside it and, as it lies outside their chord, by a pull of 1 /
    n^2 from the far side: weights (4,) that reproduce the circle in any rigid motion, of the nodes
    at `offsets` (4,) from its own, each counted from 0 to n - 1.
    """
    index = int(np.rint((angle - first) / sector))
    turn = angle - first - index * sector
    side = 1 if turn >= 0 else -1
    # in a frame with the nearer node at angle 0 and the point at |turn|: nearer, next, and the far
    # two taken together
    far = -np.cos(sector / 2) if n % 2 == 0 else -1.0
    cosine, sine, x, y = (
        np.cos(sector),
        np.sin(sector),
        far * np.cos(sector / 2),
        far * np.sin(sector / 2),
    )
    # near = 1 - beside - pull
    a, b, c, d = cosine - 1, x - 1, sine, y
    right, up = np.cos(turn) - 1, abs(np.sin(turn))
    determinant = a * d - b * c
    beside, pull = (right * d - b * up) / determinant, (a * up - c * right) / determinant
    offsets[0], offsets[1], offsets[2], offsets[3] = (
        0,
        side % n,
        side * (n // 2 + 1) % n,
        side * ((n + 1) // 2) % n,
    )
    weights[0], weights[1], weights[2], weights[3] = 1 - beside - pull, beside, pull / 2, pull / 2
    return index % n, turn / sector
