"""From where a column is looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.render.result import Result

#: Azimuth of the viewer from x to y, and elevation [deg]; None: across the largest lean
VIEWS = {"lean": (None, 10.0), "front": (-90.0, 8.0), "side": (0.0, 8.0), "iso": (-62.0, 24.0), "foot": (-62.0, 16.0), "plan": (-90.0, 90.0)}
# Free margin around what moves [-]
_MARGIN = 1.06
# Base that is shown around the foot, over its width [-]
_AROUND = 0.6
# Height that the view of the foot shows, over the foot's width [-]
_FOOT_HEIGHT = 0.9


@dataclass(frozen=True, slots=True)
class Camera:
    """A parallel projection: (3,) unit vectors to the right, upwards and towards the viewer; (3,) point in the middle [m]; half the height shown [m].
    natural: width over height [-] of what is to be seen."""

    right: np.ndarray
    up: np.ndarray
    toward: np.ndarray
    focus: np.ndarray
    half_height: float
    natural: float


def camera(result: Result, view: str, times: np.ndarray, aspect: float = 1.0) -> Camera:
    """The camera of a view that shows the column at all `times` [s], on pictures `aspect` times as wide as high."""
    azimuth, elevation = VIEWS[view]
    azimuth, elevation = np.radians(_across_lean(result, times) if azimuth is None else azimuth), np.radians(elevation)
    toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.cross(toward, right)
    shown = _shown(result, view, times)
    extents = [(shown @ axis).min() + np.array([0.0, np.ptp(shown @ axis)]) for axis in (right, up)]
    middle = [extent.mean() for extent in extents]
    half = [np.ptp(extent) / 2 for extent in extents]
    focus = right * middle[0] + up * middle[1] + toward * (shown @ toward).mean()
    return Camera(right, up, toward, focus, float(_MARGIN * max(half[1], half[0] / aspect)), float(half[0] / half[1]))


def _across_lean(result: Result, times: np.ndarray) -> float:
    """Azimuth [deg] from which the largest lean, or where it never leans the longest way, is seen at full length; from -x to x or from the front."""
    rows = slice(*np.searchsorted(result.poses.time, [times[0], times[-1] + 1e-12]))
    way = result.history["u_top"][rows, :2]
    if not len(way):
        return -90.0
    x, y = way[np.argmax(np.hypot(*way.T))]
    if np.hypot(x, y) < 1e-9 * result.solid.height:
        return -90.0
    azimuth = np.degrees(np.arctan2(y, x)) - 90.0
    return float((azimuth + 180.0) % 180.0 - 180.0)  # of the two sides the one towards -y


def _shown(result: Result, view: str, times: np.ndarray) -> np.ndarray:
    """Points (n, 3) [m] that the picture must show."""
    poses, solid = result.poses.at(times), result.solid
    body = solid.mesh.body.points
    low, high = body.min(axis=0), body.max(axis=0)
    margin = _AROUND * solid.foot_width
    around = poses.foot[:, None, :] * [1, 1, 0] + np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]]) * (solid.foot_width / 2 + margin)
    if view == "foot":
        return np.concatenate([around.reshape(-1, 3), around.reshape(-1, 3) + [0, 0, _FOOT_HEIGHT * solid.foot_width]])
    corners = np.array(np.meshgrid(*zip(low, high))).reshape(3, -1).T
    moved = poses.move(corners, slice(None)).reshape(-1, 3)
    return np.concatenate([moved, around.reshape(-1, 3)])
