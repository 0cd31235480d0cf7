"""Plane sections and their extrusion to bricks by Gmsh: transfinite, recombined, layered."""

from __future__ import annotations

import contextlib
import inspect
import signal
import threading
from dataclasses import dataclass

import numpy as np

from fecolumn.mesh.bricks import BrickMesh, brick_mesh

_OPTIONS = {"General.Terminal": 0, "Mesh.ElementOrder": 1, "Mesh.SubdivisionAlgorithm": 0, "Mesh.SaveAll": 0}
_HEXAHEDRON = 5  # Gmsh's element type of the 8-node brick, whose node order is VTK's
_SQUARE_CORNER = 0.6  # O-grid: the inner square's corners, as a fraction of the disc's radius


@contextlib.contextmanager
def gmsh_model():
    """The gmsh module with an empty model, leaving a caller's Gmsh session as it was.

    Gmsh is imported here and not at the top: an analysis of an imported mesh can then run without it.
    """
    # Gmsh 4.8 takes Ctrl-C away from Python on import; a study must stay interruptible.
    in_main_thread = threading.current_thread() is threading.main_thread()
    handler = signal.getsignal(signal.SIGINT)
    import gmsh

    running = _is_running(gmsh)
    if not running:
        interruptible = "interruptible" in inspect.signature(gmsh.initialize).parameters
        gmsh.initialize(readConfigFiles=False, **({"interruptible": False} if interruptible else {}))
    before = {key: gmsh.option.getNumber(key) for key in _OPTIONS}
    callers_model = gmsh.model.getCurrent()
    try:
        for key, value in _OPTIONS.items():
            gmsh.option.setNumber(key, value)
        gmsh.model.add("fecolumn")
        yield gmsh
    finally:
        if running:
            gmsh.model.remove()
            for key, value in before.items():
                gmsh.option.setNumber(key, value)
            gmsh.model.setCurrent(callers_model)
        else:
            gmsh.finalize()
        if in_main_thread and handler is not None:
            signal.signal(signal.SIGINT, handler)


def _is_running(gmsh) -> bool:
    """Whether the caller has initialised Gmsh already; Gmsh 4.8 has no question for it."""
    if hasattr(gmsh, "isInitialized"):
        return bool(gmsh.isInitialized())
    try:
        # Before the first session the list is empty, in a session it is not, and after one the question is an error.
        return bool(gmsh.model.list())
    except Exception:  # Gmsh raises no narrower class
        return False


@dataclass(frozen=True, slots=True)
class Annulus:
    """Ring of quadrilaterals with corners exactly on both circles, centred at the origin.

    Attributes:
        inner_radius, outer_radius: [m].
        n_around: quadrilaterals around.
        n_wall: quadrilaterals through the wall.
    """

    inner_radius: float
    outer_radius: float
    n_around: int
    n_wall: int

    def draw(self, geo) -> list[int]:
        """Tags of the four surfaces drawn in a `gmsh.model.geo`."""
        # An arc of Gmsh is shorter than pi, so four arcs share the bricks even where n_around is no multiple of 4.
        split = np.arange(5) * self.n_around // 4
        angles = 2 * np.pi * split[:4] / self.n_around
        centre = geo.addPoint(0, 0, 0)
        inner, outer = ([geo.addPoint(r * np.cos(a), r * np.sin(a), 0) for a in angles]
                        for r in (self.inner_radius, self.outer_radius))
        return _ring(geo, centre, inner, outer, np.diff(split), self.n_wall, curved_inside=True)

    def evened(self, points) -> np.ndarray:
        """(n, 2) points [m] at exactly equal angles and radii."""
        radius, thickness = np.hypot(*points.T), self.outer_radius - self.inner_radius
        ring = np.round((radius - self.inner_radius) / thickness * self.n_wall)
        return _polar(self.inner_radius + ring / self.n_wall * thickness, _even_angle(points, self.n_around, 0.0))


@dataclass(frozen=True, slots=True)
class Disc:
    """O-grid of five blocks: a square in the middle and four blocks up to the circle.

    Attributes:
        radius: [m].
        n_around: quadrilaterals around, a multiple of 4.
        n_ring: quadrilaterals from the square to the circle.
    """

    radius: float
    n_around: int
    n_ring: int

    def draw(self, geo) -> list[int]:
        """Tags of the five surfaces drawn in a `gmsh.model.geo`."""
        n_side = self.n_around // 4
        angles = np.pi / 4 + np.arange(4) * np.pi / 2
        centre = geo.addPoint(0, 0, 0)
        square, circle = ([geo.addPoint(r * np.cos(a), r * np.sin(a), 0) for a in angles]
                          for r in (_SQUARE_CORNER * self.radius, self.radius))
        sides = []
        blocks = _ring(geo, centre, square, circle, [n_side] * 4, self.n_ring, curved_inside=False, inner_curves=sides)
        return blocks + [_quadrilateral(geo, sides, square)]

    def evened(self, points) -> np.ndarray:
        """(n, 2) points [m], those on the rim at exactly equal angles."""
        rim = np.hypot(*points.T) > self.radius * (1 - 1e-6)
        on_rim = _polar(self.radius, _even_angle(points, self.n_around, np.pi / 4))
        return np.where(rim[:, None], on_rim, points)


def _even_angle(points, n_around, first):
    """Nearest of `n_around` equal angles; Gmsh spaces the points of an arc to 1e-9 rad only, which breaks the symmetry."""
    step = 2 * np.pi / n_around
    return first + step * np.round((np.arctan2(points[:, 1], points[:, 0]) - first) / step)


def _polar(radius, angle):
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def _ring(geo, centre, inner, outer, n_arcs, n_radial, *, curved_inside, inner_curves=None) -> list[int]:
    """Surfaces of four blocks between four inner and four outer points."""
    def curve(start, end, curved, n):
        tag = geo.addCircleArc(start, centre, end) if curved else geo.addLine(start, end)
        geo.mesh.setTransfiniteCurve(tag, int(n) + 1)
        return tag

    follow = [1, 2, 3, 0]
    insides = [curve(inner[i], inner[follow[i]], curved_inside, n_arcs[i]) for i in range(4)]
    outsides = [curve(outer[i], outer[follow[i]], True, n_arcs[i]) for i in range(4)]
    spokes = [curve(inner[i], outer[i], False, n_radial) for i in range(4)]
    if inner_curves is not None:
        inner_curves.extend(insides)
    return [_quadrilateral(geo, [spokes[i], outsides[i], -spokes[follow[i]], -insides[i]],
                           [inner[i], outer[i], outer[follow[i]], inner[follow[i]]]) for i in range(4)]


def _quadrilateral(geo, curves, corners) -> int:
    surface = geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.mesh.setTransfiniteSurface(surface, cornerTags=corners)
    geo.mesh.setRecombine(2, surface)
    return surface


def extruded(section: Annulus | Disc, bottom: float, height: float, n_layers: int, part: int) -> BrickMesh:
    """Bricks of a section extruded upwards in equal layers.

    Args:
        section: what is extruded.
        bottom: height of the lowest points [m].
        height: extruded length [m].
        n_layers: bricks along the height.
        part: part of the bricks.
    """
    with gmsh_model() as gmsh:
        geo = gmsh.model.geo
        surfaces = [(2, tag) for tag in section.draw(geo)]
        geo.extrude(surfaces, 0, 0, height, numElements=[n_layers], recombine=True)
        points, cells = _generated(gmsh)
    points[:, :2] = section.evened(points[:, :2])
    return brick_mesh(points, cells, part).shifted(bottom)


def swept_grid(x, y, z, part: int) -> BrickMesh:
    """Tensor-product grid: a point swept along x, the line along y, the rectangle along z.

    Args:
        x, y, z: rising grid lines [m].
        part: part of the bricks.

    Returns:
        Bricks whose points lie exactly on the lines; point (i, j, k) has the number i + n_x (j + n_y k).
    """
    lines = [np.asarray(line, dtype=float) for line in (x, y, z)]
    with gmsh_model() as gmsh:
        geo = gmsh.model.geo
        swept = (0, geo.addPoint(*(line[0] for line in lines)))
        for axis, line in enumerate(lines):
            length = line[-1] - line[0]
            along = np.eye(3)[axis] * length
            # Gmsh returns the far end first, then what was swept.
            swept = geo.extrude([swept], *along, numElements=[1] * (len(line) - 1),
                                heights=list((line[1:] - line[0]) / length), recombine=True)[1]
        points, cells = _generated(gmsh)
    places = [_nearest(line, points[:, axis]) for axis, line in enumerate(lines)]
    number = places[0] + len(lines[0]) * (places[1] + len(lines[1]) * places[2])
    if len(np.unique(number)) != len(number) or len(number) != np.prod([len(line) for line in lines]):
        raise RuntimeError("Gmsh did not return a tensor-product grid")
    grid = np.empty_like(points)
    grid[number] = np.stack([line[place] for line, place in zip(lines, places)], axis=1)
    return brick_mesh(grid, number[cells], part)


def _nearest(line, values):
    """Number of the grid line nearest to each value."""
    return np.searchsorted((line[1:] + line[:-1]) / 2, values)


def _generated(gmsh) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) [m] and bricks (m, 8) of the current model."""
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(3)
    kinds, _, nodes = gmsh.model.mesh.getElements(3)
    if list(kinds) != [_HEXAHEDRON]:
        raise RuntimeError(f"Gmsh returned the element types {list(kinds)}, not 8-node bricks alone")
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    used, cells = np.unique(nodes[0], return_inverse=True)
    order = np.argsort(tags)
    points = np.asarray(coordinates).reshape(-1, 3)[order[np.searchsorted(tags[order], used)]]
    return points, cells.reshape(-1, 8)
