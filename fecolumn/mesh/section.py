"""Plane sections of a column in quadrilaterals: ring, disc and rectangle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fecolumn.mesh.section_blocks import quadrilateral, ring_of_blocks

_SQUARE_CORNER = 0.6  # O-grid: the inner square's corners, as a fraction of the disc's radius


@dataclass(frozen=True, slots=True)
class Annulus:
    """Ring of quadrilaterals with corners exactly on both circles, centred at the origin.

    Attributes
    ----------
    inner_radius, outer_radius
        [m].
    n_around
        quadrilaterals around.
    n_wall
        quadrilaterals through the wall.
    """

    inner_radius: float
    outer_radius: float
    n_around: int
    n_wall: int

    @property
    def n_cells(self) -> int:
        """Quadrilaterals."""
        return self.n_around * self.n_wall

    def n_nodes(self, order: int = 1) -> int:
        """Lagrange nodes of elements of an order."""
        return order * self.n_around * (order * self.n_wall + 1)

    @property
    def equal_area(self) -> float:
        """Factor on the radii that gives the polygon of the nodes the area of the ring."""
        return equal_area(self.n_around)

    def outline(self, points: np.ndarray) -> np.ndarray:
        """Distance (n,) of the polygon of its nodes from the middle at `points` (n, 2 or more) [m],
        over that of its corners.
        """
        return _polygon(points, self.n_around, 0.0)

    def draw(self, geo: Any) -> list[int]:
        """Tags of the four surfaces drawn in a `gmsh.model.geo`."""
        # An arc of Gmsh is shorter than pi, so four arcs share the bricks even where n_around is no
        # multiple of 4.
        split = np.arange(5) * self.n_around // 4
        angles = 2 * np.pi * split[:4] / self.n_around
        centre = geo.addPoint(0, 0, 0)
        inner, outer = (
            [geo.addPoint(r * np.cos(a), r * np.sin(a), 0) for a in angles]
            for r in (self.inner_radius, self.outer_radius)
        )
        return ring_of_blocks(
            geo, centre, inner, outer, np.diff(split), self.n_wall, curved_inside=True
        )

    def evened(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) points [m] at exactly equal angles and radii."""
        radius, thickness = np.hypot(*points.T), self.outer_radius - self.inner_radius
        ring = np.round((radius - self.inner_radius) / thickness * self.n_wall)
        return _polar(
            self.inner_radius + ring / self.n_wall * thickness,
            _even_angle(points, self.n_around, 0.0),
        )


@dataclass(frozen=True, slots=True)
class Disc:
    """O-grid of five blocks: a square in the middle and four blocks up to the circle.

    Attributes
    ----------
    radius
        [m].
    n_around
        quadrilaterals around, a multiple of 4.
    n_ring
        quadrilaterals from the square to the circle.
    """

    radius: float
    n_around: int
    n_ring: int

    @property
    def n_cells(self) -> int:
        """Quadrilaterals."""
        return (self.n_around // 4) ** 2 + self.n_around * self.n_ring

    def n_nodes(self, order: int = 1) -> int:
        """Lagrange nodes of elements of an order."""
        return (order * self.n_around // 4 + 1) ** 2 + order * self.n_around * order * self.n_ring

    @property
    def equal_area(self) -> float:
        """Factor on the radius that gives the polygon of the nodes the area of the disc."""
        return equal_area(self.n_around)

    def outline(self, points: np.ndarray) -> np.ndarray:
        """As of Annulus; 1 at points inside, which need not move with the rim."""
        rim = np.hypot(points[:, 0], points[:, 1]) > self.radius * (1 - 1e-6)
        return np.where(rim, _polygon(points, self.n_around, np.pi / 4), 1.0)

    def draw(self, geo: Any) -> list[int]:
        """Tags of the five surfaces drawn in a `gmsh.model.geo`."""
        n_side = self.n_around // 4
        angles = np.pi / 4 + np.arange(4) * np.pi / 2
        centre = geo.addPoint(0, 0, 0)
        square, circle = (
            [geo.addPoint(r * np.cos(a), r * np.sin(a), 0) for a in angles]
            for r in (_SQUARE_CORNER * self.radius, self.radius)
        )
        sides: list[int] = []
        blocks = ring_of_blocks(
            geo,
            centre,
            square,
            circle,
            [n_side] * 4,
            self.n_ring,
            curved_inside=False,
            inner_curves=sides,
        )
        return blocks + [quadrilateral(geo, sides, square)]

    def evened(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) points [m], those on the rim at exactly equal angles."""
        rim = np.hypot(*points.T) > self.radius * (1 - 1e-6)
        on_rim = _polar(self.radius, _even_angle(points, self.n_around, np.pi / 4))
        return np.where(rim[:, None], on_rim, points)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Grid of equal quadrilaterals, centred at the origin.

    Attributes
    ----------
    length, width
        along x and y [m].
    n_x, n_y
        quadrilaterals along them.
    """

    length: float
    width: float
    n_x: int
    n_y: int

    @property
    def n_cells(self) -> int:
        """Quadrilaterals."""
        return self.n_x * self.n_y

    def n_nodes(self, order: int = 1) -> int:
        """Lagrange nodes of elements of an order."""
        return (order * self.n_x + 1) * (order * self.n_y + 1)

    @property
    def lines(self) -> tuple[np.ndarray, np.ndarray]:
        """Grid lines along x and y [m]."""
        return (
            np.linspace(-self.length / 2, self.length / 2, self.n_x + 1),
            np.linspace(-self.width / 2, self.width / 2, self.n_y + 1),
        )

    @property
    def equal_area(self) -> float:
        """1: the grid has the rectangle's area."""
        return 1.0

    def outline(self, points: np.ndarray) -> np.ndarray:
        """Ones (n,)."""
        return np.ones(len(points))


def _polygon(points: np.ndarray, n_around: int, first: float) -> np.ndarray:
    """Distance of the sides of a regular polygon from its middle, in the direction of `points`,
    over that of its corners.
    """
    step = 2 * np.pi / n_around
    past = np.mod(np.arctan2(points[:, 1], points[:, 0]) - first, step)
    return np.cos(step / 2) / np.cos(past - step / 2)


def equal_area(n_around: int) -> float:
    """Factor on the radius of a regular polygon of n corners inscribed in a circle that gives it
    the circle's area.

    Its second moment of area is then that of the circle up to (2 pi / n)^4 / 180: 1.3e-4 at 16
    corners.
    """
    step = 2 * math.pi / n_around
    return math.sqrt(step / math.sin(step))


def _even_angle(points: np.ndarray, n_around: int, first: float) -> np.ndarray:
    """Nearest of `n_around` equal angles; Gmsh spaces the points of an arc to 1e-9 rad only, which
    breaks the symmetry.
    """
    step = 2 * np.pi / n_around
    return first + step * np.round((np.arctan2(points[:, 1], points[:, 0]) - first) / step)


def _polar(radius: np.ndarray | float, angle: np.ndarray) -> np.ndarray:
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
