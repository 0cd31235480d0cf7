"""The resultants of joints as arrows on bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.result import Result
from fecolumn.pictures.render.thrust import JointForces

# Mean over so long [s] of forces, so that an impact is its impulse over this time
_MEAN_S = 0.04


@dataclass(frozen=True, slots=True)
class Arrows:
    """The resultants of n joints.

    Attributes
    ----------
    bodies
        (n,) numbers of the slaves.
    tips
        (n, t, 3) [m] centres of pressure from the slave's place, in its own axes.
    forces
        (n, t, 3) [N] on the body that is pushed upwards; 0 where a joint carries nothing.
    scale
        length of an arrow [m] of one newton.
    largest
        a usual largest force [N].
    mean
        time [s] over which forces are a mean.
    """

    bodies: tuple[int, ...]
    tips: np.ndarray
    forces: np.ndarray
    scale: float
    largest: float
    mean: float


def arrows_of(result: Result, times: np.ndarray) -> Arrows | None:
    """The resultants at `times` (t,) [s]; None of a history without them."""
    mean = max(_MEAN_S, 4 * float(np.median(np.diff(result.time))))
    try:
        forces = JointForces(result, mean)
    except InputError:
        return None
    found = [forces.carried(time) for time in times]
    resultants = np.array([one for one, _ in found]).swapaxes(0, 1)
    centers = np.array([center for _, center in found]).swapaxes(0, 1)
    bodies = tuple(result.scene.contacts[k].piece for k in result.scene.shown)
    poses = [result.poses[body].at(times) for body in bodies]
    tips = [
        np.einsum("tji,tj->ti", pose.rotation, center - pose.foot)
        for pose, center in zip(poses, centers)
    ]
    upwards = np.where(resultants[..., 2:] < 0, -1.0, 1.0)
    carried = upwards * resultants
    return Arrows(bodies, np.array(tips), carried, forces.scale, forces.largest, mean)
