"""The movie's picture: the column in three dimensions, and beside it what the history says, up to the frame's time."""

from __future__ import annotations

import numpy as np

from fecolumn.post.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, new_figure, styled
from fecolumn.render.frames import Frame, Frames
from fecolumn.render.quantity import Quantity
from fecolumn.render.scene import COLOUR_MAPS
from fecolumn.render.strips import Strip, strips_of

# Places of the parts in the picture, as shares of its width and height: left, bottom, width, height
_SCENE = (0.005, 0.105, 0.40, 0.84)
_BAR = (0.07, 0.075, 0.26, 0.018)
_STRIPS = (0.475, 0.085, 0.27, 0.855)
_TOP = (0.82, 0.645, 0.165, 0.295)
_FOOT = (0.82, 0.235, 0.165, 0.295)
_FOOT_BAR = (0.82, 0.105, 0.165, 0.018)
# Height of the picture [in] in which the fonts of post.style have their size
_HEIGHT_IN = 5.4
#: Colour map of the pressure, and of the gap
PRESSURE_MAP, GAP_MAP = "YlOrRd", "Greys"
# Share of the movie [-] of which the way of the pressure's centre is drawn thick
_TRAIL = 0.06
_VEIL = dict(facecolor="white", alpha=0.68, linewidth=0)


class Panel:
    """Makes pictures of frames; everything that stays is drawn once.

    Args:
        frames: Frames. size: (width, height) [pixels], width at least 1.4 times the height. speed: seconds of motion in a second of the movie.
    """

    def __init__(self, frames: Frames, size: tuple[int, int], speed: float = 1.0):
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        self.frames, self.size = frames, size
        dpi = size[1] / _HEIGHT_IN
        with styled():
            figure = new_figure(size[0] / dpi, _HEIGHT_IN)
            figure.set_layout_engine("none")
            figure.set_dpi(dpi)
            self._canvas = FigureCanvasAgg(figure)
            self._moving: list = []
            self._place_strips(figure)
            self._place_top(figure)
            self._place_foot(figure)
            self._place_words(figure, speed)
            self._canvas.draw()
            self._still = self._canvas.copy_from_bbox(figure.bbox)
        left, bottom, width, height = (round(share * size[k % 2]) for k, share in enumerate(_SCENE))
        self._corner = size[1] - bottom - height, left
        #: (width, height) [pixels] of the scene's image.
        self.scene_size = width, height

    def _place_strips(self, figure) -> None:
        strips = strips_of(self.frames.result, self.frames.times)
        left, bottom, width, height = _STRIPS
        gap = 0.048
        each = (height - (len(strips) - 1) * gap) / len(strips)
        self._cursors = []
        for row, strip in enumerate(strips):
            axes = figure.add_axes([left, bottom + (len(strips) - 1 - row) * (each + gap), width, each])
            draw_strip(axes, strip, last=row == len(strips) - 1)
            veil = axes.axvspan(0, 1, zorder=3, animated=True, **_VEIL)
            cursor = axes.axvline(0, color=BLACK, linewidth=0.8, zorder=4, animated=True)
            self._cursors.append((axes, veil, cursor))
        self._end = strips[0].time[-1]

    def _place_top(self, figure) -> None:
        """Plan view of the way of the top."""
        axes, history = figure.add_axes(_TOP), self.frames.result.history
        quantity = Quantity.of("", "m", np.abs(history["u_top"][:, :2]).max())
        self._way = history["u_top"][:, :2] / quantity.scale
        axes.plot(*self._way.T, color=GREY, linewidth=0.4, alpha=0.5)
        _square(axes, self._way, 1.1)
        axes.set(xlabel=f"$u_x$ [{quantity.unit}]")
        axes.set_ylabel(f"$u_y$ [{quantity.unit}]", labelpad=1)
        axes.set_title("top in plan", loc="left")
        self._trace, = axes.plot([], [], color=VERMILION, linewidth=0.9, animated=True)
        self._top, = axes.plot([], [], "o", color=VERMILION, markersize=4, animated=True)
        self._moving += [(axes, self._trace), (axes, self._top)]

    def _place_foot(self, figure) -> None:
        """Plan view of the foot: pressure on it, or the gap under it; and the way of the pressure's centre."""
        from matplotlib.collections import PolyCollection

        frames, axes = self.frames, figure.add_axes(_FOOT)
        solid, poses = frames.result.solid, frames.result.poses.at(frames.times)
        corners = solid.mesh.body.points[np.unique(solid.foot_faces)]
        reach = poses.move(corners[:: max(1, len(corners) // 100)], slice(None))[..., :2]
        quantity = Quantity.of("", "m", np.abs(reach).max())
        self._foot_scale = quantity.scale
        _square(axes, reach.reshape(-1, 2) / quantity.scale, 1.12)
        axes.set(xlabel=f"$x$ [{quantity.unit}]")
        axes.set_ylabel(f"$y$ [{quantity.unit}]", labelpad=1)
        axes.set_title("foot in plan", loc="left")
        self._shading = frames.pressure_quantity or Quantity.of("gap", "m", np.ptp(poses.move(corners, slice(None))[..., 2]))
        self._faces = PolyCollection([], cmap=PRESSURE_MAP if frames.pressure_quantity else GAP_MAP, norm=self._shading.norm(), edgecolors="#70757a", linewidths=0.15, animated=True)
        axes.add_collection(self._faces)
        self._way_of_centre = frames.pressure_path()
        self._centres, = axes.plot([], [], color=BLUE, linewidth=0.4, alpha=0.5, animated=True)
        self._last_centres, = axes.plot([], [], color=BLUE, linewidth=1.1, animated=True)
        self._centre, = axes.plot([], [], "o", color=BLUE, markersize=4.5, markeredgecolor="white", markeredgewidth=0.6, animated=True, label="pressure's centre")
        axes.legend(handles=[self._centre], loc="lower right", bbox_to_anchor=(1.03, 0.99), borderaxespad=0, framealpha=0, handlelength=0.8, handletextpad=0.3)
        self._moving += [(axes, self._faces), (axes, self._centres), (axes, self._last_centres), (axes, self._centre)]
        figure.colorbar(self._faces, cax=figure.add_axes(_FOOT_BAR), orientation="horizontal", label=self._shading.label)

    def _place_words(self, figure, speed: float) -> None:
        from matplotlib.cm import ScalarMappable

        frames = self.frames
        bar, quantity = figure.add_axes(_BAR), frames.colour_quantity
        figure.colorbar(ScalarMappable(quantity.norm(), COLOUR_MAPS[frames.colour]), cax=bar, orientation="horizontal", label=quantity.label)
        told = [f"speed × {speed:g}"] if speed != 1 else []
        told += [f"elastic deformation × {frames.exaggeration:g}"] if frames.exaggeration != 1 else []
        figure.text(0.395, 0.955, ", ".join(told), ha="right", va="bottom")
        self._stamp = figure.text(0.02, 0.955, "", fontsize=11, va="bottom", animated=True)

    def picture(self, frame: Frame, scene: np.ndarray) -> np.ndarray:
        """(height, width, 3) pixels of a frame, with the image that `Scene` made of it."""
        with styled():  # numbers of the time stamp are set now
            return self._picture(frame, scene)

    def _picture(self, frame: Frame, scene: np.ndarray) -> np.ndarray:
        self._canvas.restore_region(self._still)
        renderer = self._canvas.get_renderer()
        history = self.frames.result.history
        for axes, veil, cursor in self._cursors:
            cursor.set_xdata([frame.time, frame.time])
            veil.set_xy([(frame.time, 0), (frame.time, 1), (self._end, 1), (self._end, 0), (frame.time, 0)])
            axes.draw_artist(veil)
            axes.draw_artist(cursor)
        rows = slice(*np.searchsorted(history["time"], [self.frames.times[0], frame.time + 1e-12]))
        way = self._way[rows] if rows.stop > rows.start else self._way[:1]
        self._trace.set_data(*way.T)
        self._top.set_data(*way[-1:].T)
        self._faces.set_verts(frame.foot[..., :2] / self._foot_scale)
        self._faces.set_array((frame.foot[..., 2].mean(axis=1) if frame.pressure is None else frame.pressure) / self._shading.scale)
        times, centres = self._way_of_centre
        last, now = np.searchsorted(times, [frame.time - _TRAIL * (self._end - self.frames.times[0]), frame.time + 1e-12])
        self._centres.set_data(*centres[:now].T / self._foot_scale)
        self._last_centres.set_data(*centres[last:now].T / self._foot_scale)
        self._centre.set_data(*(frame.centre[:, None] / self._foot_scale))
        for axes, artist in self._moving:
            axes.draw_artist(artist)
        self._stamp.set_text(f"$t$ = {frame.time:.{self._digits}f} s")
        self._stamp.draw(renderer)
        picture = np.asarray(self._canvas.buffer_rgba())[..., :3].copy()
        top, left = self._corner
        picture[top:top + scene.shape[0], left:left + scene.shape[1]] = scene
        return picture

    @property
    def _digits(self) -> int:
        times = self.frames.times
        return 2 if len(times) < 2 or times[1] - times[0] > 9e-3 else 3


def _square(axes, points: np.ndarray, wider: float) -> None:
    """Equal scales, and a square that holds points (n, 2) with some room."""
    low, high = points.min(axis=0), points.max(axis=0)
    half = wider / 2 * max(float((high - low).max()), 1e-9)
    (x, y) = (low + high) / 2
    axes.set(xlim=(x - half, x + half), ylim=(y - half, y + half), aspect="equal")


def draw_strip(axes, strip: Strip, last: bool) -> None:
    """Lines of a strip over time, with their names above it; the axis of time has its label below the last one."""
    for (values, name), (colour, dash) in zip(strip.lines, ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (ORANGE, ":"))):
        axes.plot(strip.time, values, color=colour, linestyle=dash, linewidth=0.8, label=name)
    axes.set_xlim(strip.time[0], strip.time[-1])
    axes.set_ylabel(strip.label, labelpad=2)
    axes.margins(y=0.08)
    axes.locator_params(axis="y", nbins=5)
    axes.set_title(strip.title, loc="left", pad=3)
    if len(strip.lines) > 1:
        axes.legend(loc="lower right", bbox_to_anchor=(1.01, 0.97), ncol=len(strip.lines), borderaxespad=0, framealpha=0, columnspacing=0.9)
    if last:
        axes.set_xlabel("time [s]")
    else:
        axes.tick_params(labelbottom=False)
