"""A scene in three dimensions, drawn off-screen frame by frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.style import BLACK, VERMILION
from fecolumn.pictures.off_screen import light_and_look, off_screen_plotter
from fecolumn.pictures.render.camera import Camera
from fecolumn.pictures.render.frame import Frame
from fecolumn.pictures.render.overlay import Overlay, alike
from fecolumn.pictures.render.sharp_edges import sharp_edges

if TYPE_CHECKING:
    import pyvista

    from fecolumn.engines.scene.scene import Outside
    from fecolumn.pictures.render.frame import Thrust
    from fecolumn.pictures.render.frames import Frames

#: Colour maps from light to dark, which all eyes tell apart and print in grey keeps (Brewer,
#: colorbrewer2.org); at rest the column is light
COLOUR_MAPS = {"stress": "YlOrRd", "displacement": "GnBu"}
_BASE, _EDGE = "#d9dbd6", "#4a4f54"
# Points of the path of the top: more are not told apart
_PATH_POINTS = 2000
# Of links, and of bodies that have no stress
_LINK, _RIGID = "#1f4e79", "#b9bfc4"
# Of all bodies where nothing colours them
_PLAIN = "#dcd6c8"
# Of a quick scene: how much finer it is drawn; what is not seen to move [pixels], and to change its
# colour, of all colours [-]
_FINER, _UNSEEN, _ALIKE = 1.5, 0.1, 1 / 256
# Lift of lines above the base that they lie on, over the height shown [-]
_LIFT = 2e-3


class Canvas:
    """The bodies and the ground as VTK draws them; `image` gives the pixels of a frame.

    To be closed.

    Parameters
    ----------
    frames
        for what is drawn and the ranges of colours; the way of the top
        is drawn up to each frame's time.
    camera
        Camera.
    size
        (width, height) of the images [pixels].
    quick
        smooth edges by drawing finer than `size`, which takes half the time of VTK's samples in
        each pixel; and draw nothing anew that nobody sees move.
    """

    def __init__(
        self, frames: Frames, camera: Camera, size: tuple[int, int], quick: bool = False
    ) -> None:
        pixels = [round(_FINER * side) for side in size] if quick else list(size)
        self._plotter = off_screen_plotter(pixels)
        import pyvista

        self._frames, self._camera, path = frames, camera, frames.result.path
        every = max(1, -(-len(path) // _PATH_POINTS))
        # in parallel projection what is moved towards the viewer looks the same, and nothing hides
        # it
        self._path, self._path_times = (
            np.asarray(path[::every] + 2 * frames.result.height * camera.toward, np.float32),
            frames.result.time[::every],
        )
        self._size, self._quick = size, quick
        # what was drawn of the last frame, and its image
        self._last: tuple[tuple[np.ndarray, np.ndarray, Thrust | None], np.ndarray] | None = None
        if quick:
            self._plotter.render_window.SetMultiSamples(0)
        self._line_width = max(1.0, size[1] / 720)
        first = frames.frame(0)
        self._bodies = self._add(frames.scene.surface, first, first.colour)
        self._base = self._add_base(first)
        self._lines = [
            (name, self._add_lines(getattr(first, name), colour, 2.0))
            for name, colour in (("links", _LINK), ("struts", _EDGE))
            if getattr(first, name) is not None
        ]
        self._outlines = None
        if not frames.coloured:
            self._edges = frames.scene.surface.nodes[
                sharp_edges(
                    frames.scene.points[frames.scene.surface.nodes], frames.scene.surface.faces
                )
            ]
            self._outlines = self._add_lines(self._lifted(first.points[self._edges]), BLACK, 2.0)
        self._trace = (
            pyvista.lines_from_points(np.array(self._path))
            if len(self._path) > 1 and first.thrust is None
            else None
        )
        if self._trace is not None:
            self._plotter.add_mesh(
                self._trace, color=VERMILION, line_width=1.6 * self._line_width, lighting=False
            )
        # where the feet stood before they moved
        self._add_lines(self._lifted(frames.scene.outlines), BLACK, 1.2)
        self._overlay = first.thrust and Overlay(self._plotter, frames, camera, first.thrust)
        reach = 20 * camera.half_height + 5 * frames.result.height
        view = camera.right, camera.up, camera.toward
        light_and_look(self._plotter, camera.focus, view, camera.half_height, reach, 0.8)

    @property
    def legend(self) -> float:
        """Force [N] whose arrow is as long as the image is high; 0 where none are drawn."""
        forces = self._frames.forces
        return 2 * self._camera.half_height / forces.scale if forces else 0.0

    def _lifted(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) [m] a little before the face that they lie on."""
        return points + self._camera.toward * _LIFT * 2 * self._camera.half_height

    def _add_lines(self, ends: np.ndarray, color: str, width: float) -> pyvista.PolyData:
        """Straight lines with ends (n, 2, 3) [m]."""
        import pyvista

        lines = np.column_stack(
            [np.full(len(ends), 2), np.arange(len(ends) * 2).reshape(-1, 2)]
        ).ravel()
        mesh = pyvista.PolyData(np.array(ends, np.float32).reshape(-1, 3), lines=lines)
        self._plotter.add_mesh(
            mesh, color=color, line_width=width * self._line_width, lighting=False
        )
        return mesh

    def _add(self, surface: Outside, frame: Frame, colour: np.ndarray) -> pyvista.PolyData:
        """A surface coloured by values of its faces or of its points."""
        mesh = _mesh_of(surface, frame)
        quantity = self._frames.colour_quantity
        if not self._frames.coloured:
            look = self._bricks() | dict(show_edges=False)
            self._plotter.add_mesh(mesh, color=_PLAIN, **look)
            return mesh
        self._coloured(mesh)["colour"] = np.asarray(colour, np.float32)
        # the edges of bricks show how the column turns about its axis
        self._plotter.add_mesh(
            mesh,
            scalars="colour",
            cmap=COLOUR_MAPS[self._frames.colour],
            clim=quantity.range,
            log_scale=quantity.decades > 0,
            show_scalar_bar=False,
            **self._bricks(),
            interpolate_before_map=True,
            nan_color=_RIGID,
        )
        return mesh

    def _bricks(self) -> dict:
        """How the faces of bricks look, with their edges."""
        return dict(
            show_edges=True,
            edge_color=_EDGE,
            edge_opacity=0.35,
            line_width=0.5 * self._line_width,
            ambient=0.55,
            diffuse=0.5,
        )

    def _add_base(self, first: Frame) -> pyvista.PolyData | None:
        import pyvista

        look = dict(color=_BASE, **self._bricks())
        for low, high, square in self._frames.result.grounds:
            square = max(square, float((high - low).max()) / 200)
            sides = high[:2] - low[:2]
            plane = pyvista.Plane(
                center=tuple((low + high) / 2),
                direction=(0, 0, 1),
                i_size=float(sides[0]),
                j_size=float(sides[1]),
                i_resolution=max(1, round(sides[0] / square)),
                j_resolution=max(1, round(sides[1] / square)),
            )
            self._plotter.add_mesh(plane, **look)
            if self._frames.forces:  # a plane is not seen along the level
                around = np.array([low, [high[0], low[1], low[2]], high, [low[0], high[1], low[2]]])
                self._add_lines(np.stack([around, np.roll(around, -1, axis=0)], axis=1), _EDGE, 2.0)
        surface = self._frames.scene.base
        if surface is None:
            return None
        if first.base_colour is not None:
            return self._add(surface, first, first.base_colour)
        mesh = _mesh_of(surface, first)
        self._plotter.add_mesh(mesh, **look)
        return mesh

    def image(self, frame: Frame) -> np.ndarray:
        """(height, width, 3) pixels of a frame."""
        if self._quick and self._last is not None and self._looks_like(*self._last[0], frame):
            return self._last[1]
        scene = self._frames.scene
        self._move(self._bodies, frame.points[scene.surface.nodes], frame.colour)
        if self._base is not None and scene.base is not None and self._frames.from_fields:
            self._move(self._base, frame.points[scene.base.nodes], frame.base_colour)
        for name, lines in self._lines:
            lines.points = np.asarray(getattr(frame, name), np.float32).reshape(-1, 3)
        if self._trace is not None:
            done = max(1, int(np.searchsorted(self._path_times, frame.time, side="right")))
            points = self._path.copy()
            points[done:] = points[done - 1]
            self._trace.points = points
        if self._outlines is not None:
            lifted = self._lifted(frame.points[self._edges])
            self._outlines.points = np.asarray(lifted, np.float32).reshape(-1, 3)
        if self._overlay and frame.thrust:
            self._overlay.move(frame.thrust)
        self._plotter.render()
        image = self._plotter.screenshot(None, return_img=True)
        if self._quick:
            from PIL import Image

            image = np.asarray(Image.fromarray(image).resize(self._size, Image.Resampling.BOX))
        self._last = (frame.points, frame.colour, frame.thrust), image
        return image

    def _looks_like(
        self, points: np.ndarray, colour: np.ndarray, thrust: Thrust | None, frame: Frame
    ) -> bool:
        """Whether a frame differs from what was drawn by less than is seen."""
        if self._frames.from_fields:
            return False
        forces, pixel, (_, largest) = (
            self._frames.forces,
            2 * self._camera.half_height / self._size[1],
            self._frames.colour_quantity.range,
        )
        return bool(
            np.abs(frame.points - points).max() < _UNSEEN * pixel
            and np.abs(frame.colour - colour).max() < _ALIKE * largest
            and (
                thrust is None
                or frame.thrust is None
                or forces is None
                or alike(thrust, frame.thrust, forces.scale, _UNSEEN * pixel)
            )
        )

    def _coloured(self, mesh: pyvista.PolyData) -> pyvista.DataSetAttributes:
        """Where a surface keeps its colour: stress belongs to faces, displacement to points; a tube
        has as many of the ones as of the others.
        """
        return mesh.cell_data if self._frames.colour == "stress" else mesh.point_data

    def _move(self, mesh: pyvista.PolyData, points: np.ndarray, colour: np.ndarray | None) -> None:
        mesh.points = np.asarray(points, np.float32)
        if colour is not None and self._frames.coloured:
            self._coloured(mesh)["colour"] = np.asarray(colour, np.float32)

    def close(self) -> None:
        """Give the picture's memory back."""
        self._plotter.close()

    def __enter__(self) -> Canvas:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _mesh_of(surface: Outside, frame: Frame) -> pyvista.PolyData:
    import pyvista

    return pyvista.PolyData.from_regular_faces(
        np.array(frame.points[surface.nodes], np.float32), surface.faces
    )
