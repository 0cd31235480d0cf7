"""The joints of a structure in plan, each in a small picture: pressure at its contact points, and
the centre of it.
"""

from __future__ import annotations

import numpy as np

from fecolumn.post.style import BLACK, BLUE
from fecolumn.render.foot_plan import PRESSURE_MAP
from fecolumn.render.panel import PLAN, PLAN_BAR

# As many are drawn, those that tilt most, so many in a row at most; height of a row's title [-] of
# the picture's
_MOST, _ABREAST, _TITLE = 12, 4, 0.026
# What a face takes of its place, diameter of a point over that of the area for which it stands, and
# least diameter over the place [-]
_FACE, _POINT, _LEAST = 0.82, 0.85, 0.04
_OPEN = "#e4e7e9"


class JointPlans:
    """Part of the movie's picture.

    All joints are in one pair of axes, each in its place to its own scale: so few artists are drawn
    in no time.

    Attributes
    ----------
    artists
        (axes, artist) that are drawn anew for each frame.

    Parameters
    ----------
    frames
        StructureFrames.
    """

    def __init__(self, frames, figure):
        from matplotlib import colormaps
        from matplotlib.collections import EllipseCollection, LineCollection

        contacts, history = frames.result.solid.contacts, frames.result.history
        joints = frames.result.solid.structure.joints
        tilts = {
            k: history[f"interface/{joint.name}/tilt"].max()
            for k, joint in enumerate(joints)
            if joint.pair < 0
        }
        self._kept = sorted(sorted(tilts, key=lambda k: (-tilts[k], k))[:_MOST])
        self._quantity, self._places = frames.pressure_quantity, {}
        left, bottom, width, height = PLAN
        bottom, height = bottom - 0.045, height + 0.055
        size = width * figure.get_figwidth(), height * figure.get_figheight()
        axes = figure.add_axes([left, bottom, width, height], xlim=(0, size[0]), ylim=(0, size[1]))
        axes.set_axis_off()
        self._find_places(axes, contacts, size, _TITLE * figure.get_figheight())
        points = [self._in_place(k, contacts[k].plan) for k in self._kept]
        diameters = np.concatenate(
            [
                np.maximum(
                    _POINT * 2 * np.sqrt(contacts[k].areas / np.pi) * self._places[k][2],
                    _LEAST * self._places[k][3],
                )
                for k in self._kept
            ]
        )
        self._circles = EllipseCollection(
            diameters,
            diameters,
            0.0,
            offsets=np.concatenate(points),
            units="xy",
            offset_transform=axes.transData,
            norm=self._quantity.norm(),
            cmap=colormaps[PRESSURE_MAP].with_extremes(bad=_OPEN),
            linewidths=0.0,
            animated=True,
        )
        outlines = LineCollection(
            np.concatenate([self._in_place(k, contacts[k].outline) for k in self._kept]),
            colors=BLACK,
            linewidths=0.6,
            animated=True,
        )
        for artist in (self._circles, outlines):
            axes.add_collection(artist, autolim=False)
        (self._centres,) = axes.plot(
            [],
            [],
            "o",
            color=BLUE,
            markersize=3.5,
            markeredgecolor="white",
            markeredgewidth=0.5,
            animated=True,
        )
        self.artists = [(axes, self._circles), (axes, outlines), (axes, self._centres)]
        figure.colorbar(
            self._circles,
            cax=figure.add_axes(PLAN_BAR),
            orientation="horizontal",
            label=self._quantity.label,
        )

    def _find_places(self, axes, contacts, size, title: float) -> None:
        """Middle of each joint's face in its plan [m], middle of its place [in], scale [in/m] and
        size of the place [in]; and write the titles.
        """
        of_each = [contacts[k].interface for k in self._kept]
        abreast = min(max(2, *map(of_each.count, of_each)), _ABREAST)
        rows = list(_rows(contacts, self._kept, abreast))
        tall, wide = size[1] / max(len(rows), 2), size[0] / abreast
        room = min(tall - title, wide)
        for number, (words, row) in enumerate(rows):
            top = size[1] - number * tall
            axes.text(0, top, words, va="top", fontsize=7.5)
            for column, k in enumerate(row):
                corners = contacts[k].outline.reshape(-1, 2)
                low, high = corners.min(axis=0), corners.max(axis=0)
                self._places[k] = (
                    (low + high) / 2,
                    np.array([column * wide + room / 2, top - title - room / 2]),
                    _FACE * room / (high - low).max(),
                    room,
                )

    def _in_place(self, k: int, plan: np.ndarray) -> np.ndarray:
        """Points (..., 2) [m] in the plan of joint k where they are drawn [in]."""
        middle, place, scale, _ = self._places[k]
        return place + scale * (plan - middle)

    def show(self, frame) -> None:
        """Set the artists to a StructureFrame; points without pressure are grey."""
        pressure = np.concatenate([frame.pressures[k] for k in self._kept]) / self._quantity.scale
        self._circles.set_array(
            np.ma.masked_where(
                pressure <= 0, np.maximum(pressure, self._quantity.range[0] / self._quantity.scale)
            )
        )
        self._centres.set_data(
            *np.array([self._in_place(k, frame.centres[k]) for k in self._kept]).T
        )


def _rows(contacts, kept: list[int], abreast: int):
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
