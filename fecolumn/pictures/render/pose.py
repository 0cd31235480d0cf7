"""Rigid motion of bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.fem.rotation import polar_rotation


def nearest_rigid(points: np.ndarray, moved: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation R (3, 3) and shift s (3,) [m] of the rigid motion x -> R x + s that brings points
    (n, 3) nearest to where they `moved` (n, 3), in the least squares.
    """
    middle, place = points.mean(axis=0), moved.mean(axis=0)
    rotation = polar_rotation((moved - place).T @ (points - middle))
    return rotation, place - rotation @ middle


@dataclass(frozen=True, slots=True)
class Poses:
    """Where a rigid body is.

    Attributes
    ----------
    time
        (n,) [s].
    rotation
        (n, 3, 3), x - place = R (X - origin).
    foot
        (n, 3) [m] place of a point of the body in the table's frame.
    origin
        (3,) [m] the same at rest.
    """

    time: np.ndarray
    rotation: np.ndarray
    foot: np.ndarray
    origin: np.ndarray

    def move(self, points: np.ndarray, k: int | slice | np.ndarray) -> np.ndarray:
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
