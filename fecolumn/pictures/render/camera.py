"""From where a column is looked at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fecolumn.pictures.render.result import Result


#: Azimuth of the viewer from x to y, and elevation [deg]; None: across the largest lean
VIEWS = {
    "lean": (None, 10.0),
    "front": (-90.0, 8.0),
    "side": (0.0, 8.0),
    "iso": (-62.0, 24.0),
    "foot": (-62.0, 16.0),
    "plan": (-90.0, 90.0),
}
#: Views that may be taken from the level.
_LEVEL = ("lean", "front", "side")
# Free margin around what moves [-]
_MARGIN = 1.06


@dataclass(frozen=True, slots=True)
class Camera:
    """A parallel projection: (3,) unit vectors to the right, upwards and towards the viewer; (3,)
    point in the middle [m]; half the height shown [m]. natural: width over height [-] of what is to
    be seen.
    """

    right: np.ndarray
    up: np.ndarray
    toward: np.ndarray
    focus: np.ndarray
    half_height: float
    natural: float


def camera(
    result: Result, view: str, times: np.ndarray, aspect: float = 1.0, below: float = 0.0
) -> Camera:
    """The camera of a view that shows the column, or the structure, at all `times` [s], on pictures
    `aspect` times as wide as high.

    Parameters
    ----------
    result
        Result.
    below
        room [m] for arrows below all else; where there is some, the views _LEVEL look along the
        level, so that what is in the middle of a wall is seen over its face where it is.
    """
    azimuth, elevation = VIEWS[view]
    if below and view in _LEVEL:
        elevation = 0.0
    azimuth, elevation = (
        np.radians(_across_lean(result, times) if azimuth is None else azimuth),
        np.radians(elevation),
    )
    toward = np.array(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.cross(toward, right)
    shown = result.shown(view, times)
    if below:
        shown = np.concatenate([shown, shown - [0.0, 0.0, below]])
    extents = [(shown @ axis).min() + np.array([0.0, np.ptp(shown @ axis)]) for axis in (right, up)]
    middle = [extent.mean() for extent in extents]
    half = [np.ptp(extent) / 2 for extent in extents]
    focus = right * middle[0] + up * middle[1] + toward * (shown @ toward).mean()
    return Camera(
        right,
        up,
        toward,
        focus,
        float(_MARGIN * max(half[1], half[0] / aspect)),
        float(half[0] / half[1]),
    )


def _across_lean(result: Result, times: np.ndarray) -> float:
    """Azimuth [deg] from which the largest lean, or where it never leans the longest way, is seen
    at full length; from -x to x or from the front.
    """
    rows = slice(*np.searchsorted(result.time, [times[0], times[-1] + 1e-12]))
    way = result.u_top[rows, :2]
    if not len(way):
        return -90.0
    x, y = way[np.argmax(np.hypot(*way.T))]
    if np.hypot(x, y) < 1e-9 * result.height:
        return -90.0
    azimuth = np.degrees(np.arctan2(y, x)) - 90.0
    return float((azimuth + 180.0) % 180.0 - 180.0)  # of the two sides the one towards -y
