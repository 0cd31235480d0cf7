"""The foot of a column in plan: pressure on it, or the gap under it, and the way of the pressure's
centre.
"""

from __future__ import annotations

import numpy as np

from fecolumn.post.style import BLUE
from fecolumn.render.frames import Frame, Frames
from fecolumn.render.panel import PLAN, PLAN_BAR, square
from fecolumn.render.quantity import Quantity

#: Colour map of the pressure, and of the gap
PRESSURE_MAP, GAP_MAP = "YlOrRd", "Greys"
# Share of the movie [-] of which the way of the pressure's centre is drawn thick
_TRAIL = 0.06


class FootPlan:
    """Part of the movie's picture.

    Attributes
    ----------
    artists
        (axes, artist) that are drawn anew for each frame.
    """

    def __init__(self, frames: Frames, figure):
        from matplotlib.collections import PolyCollection

        axes = figure.add_axes(PLAN)
        solid, poses = frames.result.solid, frames.result.poses.at(frames.times)
        corners = solid.mesh.body.points[np.unique(solid.foot_faces)]
        reach = poses.move(corners[:: max(1, len(corners) // 100)], slice(None))[..., :2]
        quantity = Quantity.of("", "m", np.abs(reach).max())
        self._scale, self._trail = quantity.scale, _TRAIL * (frames.times[-1] - frames.times[0])
        square(axes, reach.reshape(-1, 2) / quantity.scale, 1.12)
        axes.set(xlabel=f"$x$ [{quantity.unit}]")
        axes.set_ylabel(f"$y$ [{quantity.unit}]", labelpad=1)
        axes.set_title("foot in plan", loc="left")
        self._shading = frames.pressure_quantity or Quantity.of(
            "gap", "m", np.ptp(poses.move(corners, slice(None))[..., 2])
        )
        self._faces = PolyCollection(
            [],
            cmap=PRESSURE_MAP if frames.pressure_quantity else GAP_MAP,
            norm=self._shading.norm(),
            edgecolors="#70757a",
            linewidths=0.15,
            animated=True,
        )
        axes.add_collection(self._faces)
        self._way = frames.pressure_path()
        (self._centres,) = axes.plot([], [], color=BLUE, linewidth=0.4, alpha=0.5, animated=True)
        (self._last_centres,) = axes.plot([], [], color=BLUE, linewidth=1.1, animated=True)
        (self._centre,) = axes.plot(
            [],
            [],
            "o",
            color=BLUE,
            markersize=4.5,
            markeredgecolor="white",
            markeredgewidth=0.6,
            animated=True,
            label="pressure's centre",
        )
        axes.legend(
            handles=[self._centre],
            loc="lower right",
            bbox_to_anchor=(1.03, 0.99),
            borderaxespad=0,
            framealpha=0,
            handlelength=0.8,
            handletextpad=0.3,
        )
        self.artists = [
            (axes, self._faces),
            (axes, self._centres),
            (axes, self._last_centres),
            (axes, self._centre),
        ]
        figure.colorbar(
            self._faces,
            cax=figure.add_axes(PLAN_BAR),
            orientation="horizontal",
            label=self._shading.label,
        )

    def show(self, frame: Frame) -> None:
        """Set the artists to a frame."""
        self._faces.set_verts(frame.foot[..., :2] / self._scale)
        self._faces.set_array(
            (frame.foot[..., 2].mean(axis=1) if frame.pressure is None else frame.pressure)
            / self._shading.scale
        )
        times, centres = self._way
        last, now = np.searchsorted(times, [frame.time - self._trail, frame.time + 1e-12])
        self._centres.set_data(*centres[:now].T / self._scale)
        self._last_centres.set_data(*centres[last:now].T / self._scale)
        self._centre.set_data(*(frame.centre[:, None] / self._scale))
