"""The faces of joints in plan: pressure on them, or their gaps, and the centre of the pressure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.figures.style import BLACK, BLUE
from fecolumn.pictures.render.frame import Frame

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fecolumn.engines.scene.scene import JointFace
    from fecolumn.pictures.render.frames import Frames

#: Places in the picture, as shares of its width and height: left, bottom, width, height; and of the
#: scale of colours
PLAN, PLAN_BAR = (0.82, 0.235, 0.165, 0.295), (0.82, 0.105, 0.165, 0.018)
#: Colour map of the pressure, and of the gap
PRESSURE_MAP, GAP_MAP = "YlOrRd", "Greys"
# Share of the movie [-] of which the way of the pressure's centre is drawn thick
_TRAIL = 0.06
# Of several joints as many are drawn, those that move most, so many in a row at most; height of a
# row's title [-] of the picture's, and what a face takes of its place [-]
_MOST, _ABREAST, _TITLE, _FACE = 12, 4, 0.026, 0.82


class Plans:
    """Part of the movie's picture.

    The foot of a body alone is drawn where it is on the ground, with the way of the pressure's
    centre. Several joints are in one pair of axes, each in its place to its own scale: so few
    artists are drawn in no time.

    Attributes
    ----------
    artists
        (axes, artist) that are drawn anew for each frame.
    """

    def __init__(self, frames: Frames, figure: Figure) -> None:
        from matplotlib.collections import PolyCollection

        self._frames, self._contacts = frames, frames.scene.contacts
        self._alone = frames.centres is not None
        self._places: dict[int, tuple[np.ndarray, np.ndarray, float]] = {}
        samples = [
            frames.frame(k) for k in np.unique(np.linspace(0, len(frames) - 1, 24).astype(int))
        ]
        self._kept = self._chosen()
        self._shading = frames.pressure_quantity or Quantity.of(
            "gap", "m", max(one.pressures[k].max() for one in samples for k in self._kept)
        )
        axes = self._alone_axes(figure) if self._alone else self._many_axes(figure)
        self._faces = PolyCollection(
            [],
            cmap=PRESSURE_MAP if frames.pressure_quantity else GAP_MAP,
            norm=self._shading.norm(),
            edgecolors="#70757a",
            linewidths=0.15,
            animated=True,
        )
        axes.add_collection(self._faces, autolim=False)
        self.artists = [(axes, self._faces)]
        if self._alone:
            self._way = frames.pressure_path()
            (self._centres,) = axes.plot(
                [], [], color=BLUE, linewidth=0.4, alpha=0.5, animated=True
            )
            (self._last_centres,) = axes.plot([], [], color=BLUE, linewidth=1.1, animated=True)
            self.artists += [(axes, self._centres), (axes, self._last_centres)]
        else:
            self._add_outlines(axes)
        (self._centre,) = axes.plot(
            [],
            [],
            "o",
            color=BLUE,
            markersize=4.5 if self._alone else 3.5,
            markeredgecolor="white",
            markeredgewidth=0.6,
            animated=True,
            label="pressure's centre",
        )
        self.artists.append((axes, self._centre))
        if self._alone:
            axes.legend(
                handles=[self._centre],
                loc="lower right",
                bbox_to_anchor=(1.03, 0.99),
                borderaxespad=0,
                framealpha=0,
                handlelength=0.8,
                handletextpad=0.3,
            )
        figure.colorbar(
            self._faces,
            cax=figure.add_axes(PLAN_BAR),
            orientation="horizontal",
            label=self._shading.label,
        )

    def _chosen(self) -> list[int]:
        """Numbers of the contacts that are drawn."""
        shown, poses = self._frames.scene.shown, self._frames.result.poses
        leans = {k: 1 - poses[self._contacts[k].piece].rotation[:, 2, 2].min() for k in shown}
        return sorted(sorted(shown, key=lambda k: (-leans[k], k))[:_MOST])

    def _alone_axes(self, figure: Figure) -> Axes:
        axes, frames = figure.add_axes(PLAN), self._frames
        points = frames.scene.points[self._contacts[0].points]
        poses = frames.result.poses[0].at(frames.times)
        reach = poses.move(points[:: max(1, len(points) // 100)], slice(None))[..., :2]
        quantity = Quantity.of("", "m", np.abs(reach).max())
        self._scale, self._trail = quantity.scale, _TRAIL * (frames.times[-1] - frames.times[0])
        square(axes, reach.reshape(-1, 2) / quantity.scale, 1.12)
        axes.set(xlabel=f"$x$ [{quantity.unit}]")
        axes.set_ylabel(f"$y$ [{quantity.unit}]", labelpad=1)
        axes.set_title("foot in plan", loc="left")
        return axes

    def _many_axes(self, figure: Figure) -> Axes:
        left, bottom, width, height = PLAN
        bottom, height = bottom - 0.045, height + 0.055
        size = width * figure.get_figwidth(), height * figure.get_figheight()
        axes = figure.add_axes([left, bottom, width, height], xlim=(0, size[0]), ylim=(0, size[1]))
        axes.set_axis_off()
        self._find_places(axes, size, _TITLE * figure.get_figheight())
        return axes

    def _find_places(self, axes: Axes, size: tuple[float, float], title: float) -> None:
        """Middle of each joint's face in its plan [m], middle of its place [in], and scale [in/m];
        and write the titles.
        """
        of_each = [self._contacts[k].interface for k in self._kept]
        abreast = min(max(2, *map(of_each.count, of_each)), _ABREAST)
        rows = list(_rows(self._contacts, self._kept, abreast))
        tall, wide = size[1] / max(len(rows), 2), size[0] / abreast
        room = min(tall - title, wide)
        for number, (words, row) in enumerate(rows):
            top = size[1] - number * tall
            axes.text(0, top, words, va="top", fontsize=7.5)
            for column, k in enumerate(row):
                corners = self._at_rest(k, self._contacts[k].points)
                low, high = corners.min(axis=0), corners.max(axis=0)
                self._places[k] = (
                    (low + high) / 2,
                    np.array([column * wide + room / 2, top - title - room / 2]),
                    _FACE * room / (high - low).max(),
                )

    def _at_rest(self, k: int, points: np.ndarray) -> np.ndarray:
        """Points of the scene in the plan of contact k [m]."""
        return self._contacts[k].plan(self._frames.scene.points[points])

    def _add_outlines(self, axes: Axes) -> None:
        from matplotlib.collections import LineCollection

        ends = [self._drawn(k, self._at_rest(k, self._contacts[k].outline)) for k in self._kept]
        outlines = LineCollection(np.concatenate(ends), colors=BLACK, linewidths=0.6, animated=True)
        axes.add_collection(outlines, autolim=False)
        self.artists.append((axes, outlines))

    def _drawn(self, k: int, plan: np.ndarray) -> np.ndarray:
        """Points (..., 2) [m] in the plan of joint k where they are drawn."""
        if self._alone:
            return plan / self._scale
        middle, place, scale = self._places[k]
        return place + scale * (plan - middle)

    def show(self, frame: Frame) -> None:
        """Set the artists to a frame."""
        plans = [
            self._drawn(k, self._frames.plan(self._contacts[k], frame.faces[k])) for k in self._kept
        ]
        self._faces.set_verts([face for plan in plans for face in plan])
        self._faces.set_array(
            np.concatenate([frame.pressures[k] for k in self._kept]) / self._shading.scale
        )
        if self._alone:
            times, centres = self._way
            last, now = np.searchsorted(times, [frame.time - self._trail, frame.time + 1e-12])
            self._centres.set_data(*centres[:now].T / self._scale)
            self._last_centres.set_data(*centres[last:now].T / self._scale)
        self._centre.set_data(*np.array([self._drawn(k, frame.centres[k]) for k in self._kept]).T)


def square(axes: Axes, points: np.ndarray, wider: float) -> None:
    """Equal scales, and a square that holds points (n, 2) with some room."""
    low, high = points.min(axis=0), points.max(axis=0)
    half = wider / 2 * max(float((high - low).max()), 1e-9)
    (x, y) = (low + high) / 2
    axes.set(xlim=(x - half, x + half), ylim=(y - half, y + half), aspect="equal")


def _rows(
    contacts: Sequence[JointFace], kept: list[int], abreast: int
) -> Iterator[tuple[str, list[int]]]:
    """(title, numbers of contacts) of each row: joints of one interface, `abreast` at most; the
    title names the interface and its slaves.
    """
    for interface in dict.fromkeys(contacts[k].interface for k in kept):
        own = [k for k in kept if contacts[k].interface == interface]
        for first in range(0, len(own), abreast):
            row = own[first : first + abreast]
            names = [contacts[k].slave.rpartition(" ") for k in row]
            same = len({name for name, _, _ in names}) == 1 and names[0][0]
            slaves = (
                f"{names[0][0]} {', '.join(number for *_, number in names)}"
                if same
                else ", ".join(contacts[k].slave for k in row)
            )
            yield f"{interface}: {slaves}", row
