"""Rigid motion of a column from its history: displacements of top and foot, tilt and twist give
place and rotation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.fem.rotation import polar_rotation

# of the direction of the tilt, where top and foot do not stand one above the other; each divides
# the error by the tilt at least
_ITERATIONS = 20


def nearest_rigid(points: np.ndarray, moved: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation R (3, 3) and shift s (3,) [m] of the rigid motion x -> R x + s that brings points
    (n, 3) nearest to where they `moved` (n, 3), in the least squares.
    """
    middle, place = points.mean(axis=0), moved.mean(axis=0)
    rotation = polar_rotation((moved - place).T @ (points - middle))
    return rotation, place - rotation @ middle


@dataclass(frozen=True, slots=True)
class Poses:
    """Where a rigid column is.

    Attributes
    ----------
    time
        (n,) [s].
    rotation
        (n, 3, 3), x - foot = R (X - origin).
    foot
        (n, 3) [m] position of the foot's centre in the table's frame.
    origin
        (3,) [m] the same at rest.
    """

    time: np.ndarray
    rotation: np.ndarray
    foot: np.ndarray
    origin: np.ndarray

    def move(self, points: np.ndarray, k) -> np.ndarray:
        """Positions (..., n_points, 3) [m] of points (n_points, 3) of the reference configuration
        at pose `k`, a number or several.
        """
        return self.foot[k][..., None, :] + (points - self.origin) @ np.swapaxes(
            self.rotation[k], -1, -2
        )

    def at(self, times: np.ndarray) -> Poses:
        """Poses at `times` (k,) [s], between those known along a straight line and by a steady
        rotation.
        """
        from scipy.spatial.transform import Rotation

        times = np.clip(times, self.time[0], self.time[-1])
        after = np.clip(
            np.searchsorted(self.time, times), min(1, len(self.time) - 1), len(self.time) - 1
        )
        before = np.maximum(after - 1, 0)
        share = (times - self.time[before]) / np.where(
            after > before, self.time[after] - self.time[before], 1.0
        )
        first = Rotation.from_matrix(self.rotation[before])
        turn = (first.inv() * Rotation.from_matrix(self.rotation[after])).as_rotvec()
        rotation = (first * Rotation.from_rotvec(share[:, None] * turn)).as_matrix()
        foot = self.foot[before] + share[:, None] * (self.foot[after] - self.foot[before])
        return Poses(times, rotation.reshape(-1, 3, 3), foot, self.origin)


def poses(history: dict[str, np.ndarray], foot: np.ndarray, top: np.ndarray) -> Poses:
    """Poses at the rows of a history.

    The column turns by its twist about the vertical, then leans by its tilt; it leans to where its
    top has gone, seen from its foot. What bends or shortens it is not told from that: over its
    height, it is a share of about 1e-5 of a stocky column's and 1e-3 of a slender one's.

    Parameters
    ----------
    history
        `time` (n,) [s], `u_top` (n, 3) [m], `slide` (n, 2) [m], `tilt` and `twist` (n,) [rad], as
        of `dynamics.history`.
    foot, top
        (3,) [m] centres of foot and top at rest.
    """
    tilt, twist = np.asarray(history["tilt"]), np.asarray(history["twist"])
    slide, u_top = np.asarray(history["slide"])[:, :2], np.asarray(history["u_top"])
    axis = top - foot
    turned = np.column_stack(
        [
            np.cos(twist) * axis[0] - np.sin(twist) * axis[1],
            np.sin(twist) * axis[0] + np.cos(twist) * axis[1],
            np.full(len(tilt), axis[2]),
        ]
    )
    way = u_top[:, :2] - slide + axis[:2]  # from foot to top, in plan
    across, toward = np.zeros_like(turned), way - turned[:, :2] * np.cos(tilt)[:, None]
    for _ in range(_ITERATIONS):
        length = np.hypot(*toward.T)
        lean = (
            np.where(length[:, None] > 0, toward, [1.0, 0.0])
            / np.where(length > 0, length, 1.0)[:, None]
        )
        across[:, 0], across[:, 1] = -lean[:, 1], lean[:, 0]
        kept = across * (across * turned).sum(axis=1)[:, None] * (1 - np.cos(tilt))[:, None]
        following = way - turned[:, :2] * np.cos(tilt)[:, None] - kept[:, :2]
        if np.allclose(following, toward, rtol=0, atol=1e-15 * np.linalg.norm(axis)):
            break
        toward = following
    rotation = _turn(across, tilt) @ _turn(np.tile([0.0, 0.0, 1.0], (len(tilt), 1)), twist)
    raised = u_top[:, 2] + axis[2] - (rotation @ axis)[:, 2]
    return Poses(
        np.asarray(history["time"]),
        rotation,
        foot + np.column_stack([slide, raised]),
        np.asarray(foot),
    )


def _turn(axes: np.ndarray, angles: np.ndarray) -> np.ndarray:
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(axes * angles[:, None]).as_matrix()
