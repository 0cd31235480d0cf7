"""Forces in joints as they lie over the picture: arrows, thrust line, hinges, and their legend."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.figures.style import BLACK, BLUE, VERMILION
from fecolumn.pictures.render.camera import Camera
from fecolumn.pictures.render.frame import Thrust
from fecolumn.pictures.render.thrust import scene_size

if TYPE_CHECKING:
    import pyvista
    from matplotlib.axes import Axes

    from fecolumn.pictures.render.frames import Frames

#: Colour of the thrust line by what colours the bodies, and of arrows
_THRUST, ARROW = {"stress": BLUE, "displacement": VERMILION, "none": VERMILION}, BLACK
# Over the size of the scene [-]: length and half width of an arrow's head, half width of its shaft
# and of the thrust line, width of the white rim of either, radius of a hinge
_HEAD, _WIDE, _SHAFT, _LINE, _RIM, _HINGE = 0.045, 0.0165, 0.0060, 0.0040, 0.0022, 0.017
# Share of a circle's radius that is white where no hinge has opened, and corners of a circle
_HOLE, _CORNERS = 0.58, 24
# Arrow of the legend, at most [in]; first digits of its force
_LEGEND_IN, _DIGITS = 0.5, (1, 2, 5)


class Overlay:
    """The parts of a `Thrust`, flat towards the viewer and before all bodies."""

    def __init__(
        self, plotter: pyvista.Plotter, frames: Frames, camera: Camera, first: Thrust
    ) -> None:
        import pyvista

        self._camera, self._nearer, self._meshes = camera, 2 * frames.result.height, []
        assert frames.forces is not None
        self._size, self._length = scene_size(frames.scene), frames.forces.scale
        self._thrust = _THRUST[frames.colour]
        for colour, points in self._parts(first):
            mesh = pyvista.PolyData.from_regular_faces(*_triangles(points))
            plotter.add_mesh(mesh, color=colour, lighting=False)
            self._meshes.append(mesh)

    def move(self, thrust: Thrust) -> None:
        """Show another instant."""
        for mesh, (_, points) in zip(self._meshes, self._parts(thrust)):
            mesh.points = points.reshape(-1, 3)

    def _parts(self, thrust: Thrust) -> Iterator[tuple[str, np.ndarray]]:
        """Colour and polygons (n, k, 3) [m] of each part, the last before all."""
        size, half = self._size, thrust.lines.reshape(-1, 2, 3)
        tips = thrust.centers
        # of the two sides of a joint the one that is pushed upwards
        upwards = np.where(thrust.resultants[:, 2:] < 0, -self._length, self._length)
        tails = tips - upwards * thrust.resultants
        long = np.linalg.norm(self._flat(tips - tails), axis=1)
        head = np.minimum(_HEAD * size, 0.6 * long)
        along = self._flat(tips - tails) / np.maximum(long, 1e-300)[:, None]
        across = np.cross(self._camera.toward, along)
        necks = tips - along * head[:, None]
        wing = across * (head * _WIDE / _HEAD)[:, None]
        shaft = np.stack([tails, necks], axis=1)
        radius = np.where(thrust.hinges | thrust.at_edges, _HINGE * size, 0.0)
        hole = np.where(thrust.at_edges, _HOLE * radius, 0.0)
        parts = (
            ("white", self._strip(half, (_LINE + _RIM) * size)),
            ("white", self._strip(shaft, (_SHAFT + _RIM) * size)),
            (ARROW, self._strip(shaft, _SHAFT * size)),
            (self._thrust, self._strip(half, _LINE * size)),
            (ARROW, np.stack([tips, necks + wing, necks - wing], axis=1)),
            (BLACK, self._circles(tips, radius)),
            ("white", self._circles(tips, hole)),
        )
        for k, (colour, points) in enumerate(parts):
            shift = self._camera.toward * self._nearer * (1 + 0.02 * k)
            yield colour, np.asarray(points + shift, np.float32)

    def _flat(self, vectors: np.ndarray) -> np.ndarray:
        """Parts of vectors (..., 3) across the direction of view."""
        toward = self._camera.toward
        return vectors - (vectors @ toward)[..., None] * toward

    def _strip(self, ends: np.ndarray, wide: float) -> np.ndarray:
        """Strips (n, 4, 3) of half the width `wide` [m] along ends (n, 2, 3), nothing where these
        are the same.
        """
        along = self._flat(ends[:, 1] - ends[:, 0])
        long = np.linalg.norm(along, axis=1)[:, None]
        unit = along / np.maximum(long, 1e-300)
        across = wide * np.cross(self._camera.toward, unit)
        a, b = ends[:, 0], ends[:, 1]
        return np.stack([a - across, a + across, b + across, b - across], axis=1)

    def _circles(self, centers: np.ndarray, radius: np.ndarray) -> np.ndarray:
        """Circles (n, k, 3) of radii (n,) [m] about centres (n, 3)."""
        angles = np.linspace(0, 2 * np.pi, _CORNERS, endpoint=False)
        round_ = np.outer(np.cos(angles), self._camera.right) + np.outer(
            np.sin(angles), self._camera.up
        )
        return centers[:, None] + radius[:, None, None] * round_


def _triangles(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n k, 3) of convex polygons (n, k, 3), and corners of the triangles that these are cut
    into: VTK would cut them once, where many are but a point.
    """
    n, k = points.shape[:2]
    fan = np.column_stack([np.zeros(k - 2, int), np.arange(1, k - 1), np.arange(2, k)])
    return points.reshape(-1, 3), (fan + k * np.arange(n)[:, None, None]).reshape(-1, 3)


def alike(one: Thrust, other: Thrust, length: float, far: float) -> bool:
    """Whether nothing of them differs by more than `far` [m]; length: of the arrow of a newton."""
    return bool(
        np.array_equal(one.hinges, other.hinges)
        and np.array_equal(one.at_edges, other.at_edges)
        and np.abs(one.lines - other.lines).max(initial=0.0) < far
        and length * np.abs(one.resultants - other.resultants).max(initial=0.0) < far
    )


def legend_force(newton_per_inch: float, largest: float) -> float:
    """Force [N] of the legend's arrow, 1, 2 or 5 times a power of ten."""
    return _round(min(newton_per_inch * _LEGEND_IN, largest))


def _round(most: float) -> float:
    """The largest of 1, 2 and 5 times powers of ten that is not above `most`."""
    power = 10.0 ** np.floor(np.log10(most))
    return max(digit * power for digit in _DIGITS if digit * power <= most)


def draw_legend(axes: Axes, frames: Frames, newton_per_inch: float) -> None:
    """What arrows, line and circles are, and a length, where there is room for it, along axes that
    this fills; their unit becomes an inch.
    """
    width, height = axes.get_figure().get_size_inches() * axes.get_position().size
    axes.set(xlim=(0, width), ylim=(-height / 2, height / 2))
    axes.axis("off")
    assert frames.forces is not None
    force = legend_force(newton_per_inch, frames.forces.largest)
    quantity, long = Quantity.of("", "N", force), force / newton_per_inch
    look = dict(arrowstyle="-|>,head_width=0.13,head_length=0.3", color=ARROW, linewidth=1.1)
    axes.annotate("", (0.05 + long, 0), (0.05, 0), arrowprops=look | dict(shrinkA=0, shrinkB=0))
    text = dict(va="center_baseline", fontsize=8)
    axes.text(0.11 + long, 0, f"{force / quantity.scale:g} {quantity.unit}", **text)
    place = 0.11 + long + 0.6
    axes.plot([place, place + 0.28], [0, 0], color=_THRUST[frames.colour], linewidth=1.8)
    axes.text(place + 0.34, 0, "thrust line", **text)
    place += 1.06
    for colour, told, step in ((BLACK, "hinge", 0.5), ("white", "thrust at edge", 1.15)):
        axes.plot(
            place, 0, "o", color=colour, markeredgecolor=BLACK, markersize=4.5, markeredgewidth=1.3
        )
        axes.text(place + 0.09, 0, told, **text)
        place += step
    meter_per_inch = newton_per_inch * frames.forces.scale
    length = _round(meter_per_inch * _LEGEND_IN)
    end = place + length / meter_per_inch
    if end + 0.5 <= width:
        axes.plot([place, end], [0, 0], color=BLACK, linewidth=1.2, marker="|", markersize=6)
        axes.text(end + 0.08, 0, f"{length:g} m", **text)
