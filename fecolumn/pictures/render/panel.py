"""The movie's picture: the scene in three dimensions, and beside it what the history says, up to
the frame's time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rcParams
from matplotlib.font_manager import FontProperties

from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    VERMILION,
    new_figure,
    styled,
)
from fecolumn.pictures.render.canvas import COLOUR_MAPS
from fecolumn.pictures.render.frame import Frame, Strip
from fecolumn.pictures.render.overlay import draw_legend
from fecolumn.pictures.render.plans import Plans, square
from fecolumn.pictures.render.strips import strips_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fecolumn.pictures.render.frames import Frames

# Places of the parts in the picture, as shares of its width and height: left, bottom, width, height
_SCENE = (0.005, 0.105, 0.40, 0.84)
# Letters that title and legend of a strip have room for, at the size of letters of legends, and
# those whose room the line beside a name takes
_LETTERS, _HANDLE = 44, 4
# What the legend of forces takes of the scene, from below [-]
_LEGEND = 0.05
_BAR = (0.07, 0.075, 0.26, 0.018)
_STRIPS = (0.475, 0.085, 0.27, 0.855)
_TOP = (0.82, 0.645, 0.165, 0.295)
# Height of the picture [in] in which the fonts of figures.style have their size
_HEIGHT_IN = 5.4
_VEIL = dict(facecolor="white", alpha=0.68, linewidth=0)


class Panel:
    """Makes pictures of frames; everything that stays is drawn once.

    Parameters
    ----------
    frames
        of the movie.
    size
        (width, height) [pixels], width at least 1.4 times the height.
    speed
        seconds of motion in a second of the movie.
    """

    def __init__(self, frames: Frames, size: tuple[int, int], speed: float = 1.0) -> None:
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
            self._plan = Plans(frames, figure)
            self._moving += self._plan.artists
            self._place_words(figure, speed)
            self._draw_still()
        left, bottom, width, height = (
            round(share * size[k % 2]) for k, share in enumerate(self._scene)
        )
        self._corner = size[1] - bottom - height, left
        #: (width, height) [pixels] of the scene's image.
        self.scene_size = width, height

    @property
    def _scene(self) -> tuple[float, float, float, float]:
        """Place of the scene in the picture."""
        left, bottom, width, height = _SCENE
        below = _LEGEND if self.frames.forces else 0.0
        return left, bottom + below, width, height - below

    def _draw_still(self) -> None:
        """Draw all that stays."""
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self._canvas.figure.bbox)

    def place_legend(self, legend: float) -> None:
        """Say what is drawn of forces; legend: force [N] whose arrow is as long as the scene is
        high, 0 where none are drawn.
        """
        if not legend:
            return
        left, bottom, width, height = self._scene
        with styled():
            axes = self._canvas.figure.add_axes([left, bottom - _LEGEND, width, _LEGEND])
            draw_legend(axes, self.frames, legend / (height * _HEIGHT_IN))
            self._draw_still()

    def _place_strips(self, figure: Figure) -> None:
        from matplotlib.patches import Rectangle

        strips = strips_of(self.frames.result, self.frames.times)
        left, bottom, width, height = _STRIPS
        gap = 0.048
        each = (height - (len(strips) - 1) * gap) / len(strips)
        self._cursors = []
        for row, strip in enumerate(strips):
            axes = figure.add_axes(
                [left, bottom + (len(strips) - 1 - row) * (each + gap), width, each]
            )
            draw_strip(axes, strip, last=row == len(strips) - 1)
            # of what `axvspan` draws the kind depends on matplotlib's version
            veil = axes.add_artist(
                Rectangle(
                    (0, 0),
                    1,
                    1,
                    transform=axes.get_xaxis_transform(),
                    zorder=3,
                    animated=True,
                    **_VEIL,
                )
            )
            cursor = axes.axvline(0, color=BLACK, linewidth=0.8, zorder=4, animated=True)
            self._cursors.append((axes, veil, cursor))
        self._end = strips[0].time[-1]

    def _place_top(self, figure: Figure) -> None:
        """Plan view of the way of the top."""
        axes, top = figure.add_axes(_TOP), self.frames.result.u_top[:, :2]
        quantity = Quantity.of("", "m", np.abs(top).max())
        self._top_path = top / quantity.scale
        axes.plot(*self._top_path.T, color=GREY, linewidth=0.4, alpha=0.5)
        square(axes, self._top_path, 1.1)
        axes.set(xlabel=f"$u_x$ [{quantity.unit}]")
        axes.set_ylabel(f"$u_y$ [{quantity.unit}]", labelpad=1)
        axes.set_title(self.frames.result.top_title, loc="left")
        (self._trace,) = axes.plot([], [], color=VERMILION, linewidth=0.9, animated=True)
        (self._top,) = axes.plot([], [], "o", color=VERMILION, markersize=4, animated=True)
        self._moving += [(axes, self._trace), (axes, self._top)]

    def _place_words(self, figure: Figure, speed: float) -> None:
        from matplotlib.cm import ScalarMappable

        frames = self.frames
        if frames.coloured:
            quantity = frames.colour_quantity
            figure.colorbar(
                ScalarMappable(quantity.norm(), COLOUR_MAPS[frames.colour]),
                cax=figure.add_axes(_BAR),
                orientation="horizontal",
                label=quantity.label,
            )
        captions = [f"speed × {speed:g}"] if speed != 1 else []
        captions += (
            [f"elastic deformation × {frames.exaggeration:g}"] if frames.exaggeration != 1 else []
        )
        figure.text(0.395, 0.955, ", ".join(captions), ha="right", va="bottom")
        self._stamp = figure.text(0.02, 0.955, "", fontsize=11, va="bottom", animated=True)

    def picture(self, frame: Frame, scene: np.ndarray) -> np.ndarray:
        """(height, width, 3) pixels of a frame, with the image that `Canvas` made of it."""
        with styled():  # numbers of the time stamp are set now
            return self._picture(frame, scene)

    def _picture(self, frame: Frame, scene: np.ndarray) -> np.ndarray:
        self._canvas.restore_region(self._still)
        renderer = self._canvas.get_renderer()
        for axes, veil, cursor in self._cursors:
            cursor.set_xdata([frame.time, frame.time])
            veil.set(x=frame.time, width=self._end - frame.time)
            axes.draw_artist(veil)
            axes.draw_artist(cursor)
        first, last = np.searchsorted(
            self.frames.result.time, [self.frames.times[0] - 1e-9, frame.time + 1e-9]
        )
        way = self._top_path[min(first, last - 1) : last]
        self._trace.set_data(*way.T)
        self._top.set_data(*way[-1:].T)
        self._plan.show(frame)
        for axes, artist in self._moving:
            axes.draw_artist(artist)
        self._stamp.set_text(f"$t$ = {frame.time:.{self._digits}f} s")
        self._stamp.draw(renderer)
        picture = np.asarray(self._canvas.buffer_rgba())[..., :3].copy()
        top, left = self._corner
        picture[top : top + scene.shape[0], left : left + scene.shape[1]] = scene
        return picture

    @property
    def _digits(self) -> int:
        times = self.frames.times
        return 2 if len(times) < 2 or times[1] - times[0] > 9e-3 else 3


def draw_strip(axes: Axes, strip: Strip, last: bool) -> None:
    """Lines of a strip over time, with their names above it; the axis of time has its label below
    the last one.
    """
    for (values, name), (colour, dash) in zip(
        strip.lines, ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (ORANGE, ":"))
    ):
        axes.plot(strip.time, values, color=colour, linestyle=dash, linewidth=0.8, label=name)
    axes.set_xlim(strip.time[0], strip.time[-1])
    axes.set_ylabel(strip.label, labelpad=2)
    axes.margins(y=0.08)
    axes.locator_params(axis="y", nbins=5)
    axes.set_title(strip.title, loc="left", pad=3)
    if len(strip.lines) > 1:
        letters = len(strip.title) + sum(len(name) + _HANDLE for _, name in strip.lines)
        size = FontProperties(size=rcParams["legend.fontsize"]).get_size_in_points() * min(
            1.0, _LETTERS / letters
        )
        axes.legend(
            loc="lower right",
            bbox_to_anchor=(1.01, 0.97),
            ncol=len(strip.lines),
            borderaxespad=0,
            framealpha=0,
            columnspacing=0.9,
            handlelength=1.4,
            handletextpad=0.5,
            fontsize=size,
        )
    if last:
        axes.set_xlabel("time [s]")
    else:
        axes.tick_params(labelbottom=False)
