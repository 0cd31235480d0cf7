"""Path of the pressure's centre from the rigid motion of a body, where none was written."""

from __future__ import annotations

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.mesh.mass import MassProperties
from fecolumn.pictures.render.pose import Poses

# Share of the weight [-] below which the base's push says nothing of where it acts: the column is
# in flight
_LIGHT = 0.05


def pressure_centre(
    poses: Poses,
    ground: np.ndarray,
    mass: MassProperties,
    times: np.ndarray,
    interval: float,
    level: float = 0.0,
) -> np.ndarray:
    """Centre (k, 2) [m] of the contact pressure in the mean over `interval` [s] around each of
    `times`; nan in flight.

    Over an interval the base gives the column the change of its momentum, and that of its angular
    momentum about its centre of mass; what impacts give is part of both. With J the impulse, c the
    centre of mass, p the pressure's centre in the plane z = level [m]: (p - c) x J = change of L.

    Parameters
    ----------
    poses
        at the n rows of the history, at least three.
    ground
        (n, 3) [m/s2] acceleration of the base.
    mass
        of the column, its centre in the reference configuration.
    """
    from scipy.integrate import cumulative_trapezoid
    from scipy.spatial.transform import Rotation

    time, last = poses.time, len(poses.time) - 1
    first = np.clip(np.searchsorted(time, times - interval / 2), 1, last - 1)
    end = np.clip(np.searchsorted(time, times + interval / 2), 1, last - 1)
    shaken = cumulative_trapezoid(ground, time, axis=0, initial=0.0)

    def momentum(k: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of rows k: momentum per mass (., 3) and angular momentum (., 3), from the rows before and
        after.
        """
        span = (time[k + 1] - time[k - 1])[:, None]
        where = [poses.move(mass.centre[None], k + side)[:, 0] for side in (-1, 1)]
        spin = (
            Rotation.from_matrix(poses.rotation[k + 1])
            * Rotation.from_matrix(poses.rotation[k - 1]).inv()
        ).as_rotvec() / span
        turned = poses.rotation[k] @ mass.inertia @ poses.rotation[k].swapaxes(1, 2)
        return (where[1] - where[0]) / span, np.einsum("kij,kj->ki", turned, spin)

    (slow, before), (fast, after) = momentum(first), momentum(end)
    lasted = time[end] - time[first]
    impulse = mass.mass * (
        fast - slow + shaken[end] - shaken[first] + lasted[:, None] * [0.0, 0.0, GRAVITY]
    )
    turning = after - before
    middle = poses.move(mass.centre[None], (first + end) // 2)[:, 0] - [0.0, 0.0, level]
    pushed = impulse[:, 2] > _LIGHT * mass.mass * GRAVITY * lasted
    push = np.where(pushed, impulse[:, 2], np.nan)
    x = middle[:, 0] - (middle[:, 2] * impulse[:, 0] + turning[:, 1]) / push
    y = middle[:, 1] - (middle[:, 2] * impulse[:, 1] - turning[:, 0]) / push
    return np.column_stack([x, y])
