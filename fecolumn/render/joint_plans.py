"""The joints of a structure in plan, each in a small picture: pressure at its contact points, and the centre of it."""

from __future__ import annotations

import numpy as np

from fecolumn.post.style import BLACK, BLUE
from fecolumn.render.foot_plan import PRESSURE_MAP
from fecolumn.render.panel import PLAN, PLAN_BAR

# As many are drawn, those that tilt most, so many in a row; height of a row's title [-] of the picture's
_MOST, _ABREAST, _TITLE = 12, 4, 0.026
# Free room around a face, and the smallest radius of a point, over the face's width; diameter of a point over that of its area [-]
_ROOM, _LEAST, _SHARE = 0.12, 0.02, 0.85
_OPEN = "#e4e7e9"


class JointPlans:
    """Part of the movie's picture.

    Attributes:
        artists: (axes, artist) that are drawn anew for each frame.

    Args:
        frames: StructureFrames.
    """

    def __init__(self, frames, figure):
        from matplotlib.cm import ScalarMappable

        contacts, history = frames.result.solid.contacts, frames.result.history
        tilts = [history[f"interface/{joint.name}/tilt"].max() for joint in frames.result.solid.structure.joints]
        self._kept = sorted(sorted(range(len(contacts)), key=lambda k: (-tilts[k], k))[:_MOST])
        self._quantity, self._points, self._outlines, self._centres = frames.pressure_quantity, [], [], []
        of_each = [contacts[k].interface for k in self._kept]
        abreast = min(max(2, *(of_each.count(interface) for interface in of_each)), _ABREAST)
        rows = list(_rows(contacts, self._kept, abreast))
        left, bottom, width, height = PLAN
        bottom, height = bottom - 0.045, height + 0.055
        each = height / max(len(rows), 2)
        for number, (title, row) in enumerate(rows):
            top = bottom + height - number * each
            figure.text(left, top, title, va="top", fontsize=7.5)
            for column, k in enumerate(row):
                axes = figure.add_axes([left + column * width / abreast, top - 0.97 * each, 0.96 * width / abreast, 0.97 * each - _TITLE])
                self._place(axes, contacts[k])
        self.artists = [(artist.axes, artist) for artist in (*self._points, *self._outlines, *self._centres)]
        figure.colorbar(ScalarMappable(self._quantity.norm(), PRESSURE_MAP), cax=figure.add_axes(PLAN_BAR), orientation="horizontal", label=self._quantity.label)

    def _place(self, axes, contact) -> None:
        """Outline, contact points and centre of a joint."""
        from matplotlib.collections import LineCollection

        axes.set_axis_off()
        corners = contact.outline.reshape(-1, 2)
        low, high = corners.min(axis=0), corners.max(axis=0)
        size = float((high - low).max())
        middle, half = (low + high) / 2, (0.5 + _ROOM) * size
        axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half), aspect="equal")
        self._points.append(self._circles(axes, contact, size))
        self._outlines.append(axes.add_collection(LineCollection(contact.outline, colors=BLACK, linewidths=0.6, animated=True)))
        self._centres.append(axes.plot([], [], "o", color=BLUE, markersize=3.5, markeredgecolor="white", markeredgewidth=0.5, animated=True)[0])

    def _circles(self, axes, contact, size: float):
        """A circle at each contact point, as large as the area for which it stands."""
        from matplotlib import colormaps
        from matplotlib.collections import EllipseCollection

        diameters = np.maximum(_SHARE * 2 * np.sqrt(contact.areas / np.pi), 2 * _LEAST * size)
        circles = EllipseCollection(diameters, diameters, 0.0, offsets=contact.plan, units="xy", offset_transform=axes.transData, cmap=colormaps[PRESSURE_MAP].with_extremes(bad=_OPEN),
                                    norm=self._quantity.norm(), linewidths=0.0, animated=True)
        axes.add_collection(circles)
        return circles

    def show(self, frame) -> None:
        """Set the artists to a StructureFrame; points without pressure are grey."""
        for k, circles, centre in zip(self._kept, self._points, self._centres):
            pressure = frame.pressures[k] / self._quantity.scale
            circles.set_array(np.ma.masked_where(pressure <= 0, np.maximum(pressure, self._quantity.range[0] / self._quantity.scale)))
            centre.set_data(*frame.centres[k][:, None])


def _rows(contacts, kept: list[int], abreast: int):
    """(title, numbers of contacts) of each row: joints of one interface, `abreast` at most; the title names the interface and its slaves."""
    for interface in dict.fromkeys(contacts[k].interface for k in kept):
        own = [k for k in kept if contacts[k].interface == interface]
        for first in range(0, len(own), abreast):
            row = own[first:first + abreast]
            names = [contacts[k].slave.rpartition(" ") for k in row]
            same = len({name for name, _, _ in names}) == 1 and names[0][0]
            slaves = f"{names[0][0]} {', '.join(number for *_, number in names)}" if same else ", ".join(contacts[k].slave for k in row)
            yield f"{interface}: {slaves}", row
