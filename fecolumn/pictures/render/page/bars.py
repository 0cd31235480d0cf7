"""What the page draws as bars between two places: tendons and other links, columns of buildings, and
the resultants of joints as arrows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.engines.scene.scene import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.page.parts import shifts_of
from fecolumn.pictures.render.result import Result
from fecolumn.pictures.render.thrust import JointForces

# Mean over so long [s] of forces, so that an impact is its impulse over this time
_MEAN_S = 0.04


@dataclass(frozen=True, slots=True)
class Bar:
    """A bar.

    Attributes
    ----------
    name
        of the link; "" of a column.
    ends
        (t, 2, 3) [m] in the frame of the ground; both the same where it has broken.
    tension
        (t,) [N]; None of one that has no colour.
    """

    name: str
    ends: np.ndarray
    tension: np.ndarray | None = None


def links_of(result: Result, times: np.ndarray) -> list[Bar]:
    """The links of a structure at `times` (t,) [s]."""
    poses = [one.at(times) for one in result.poses]
    rows = np.minimum(np.searchsorted(result.time, times - 1e-9), len(result.time) - 1)

    def at(body: int, arm: np.ndarray) -> np.ndarray:
        if body == GROUND:
            return np.broadcast_to(arm, (len(times), 3))
        return poses[body].foot + poses[body].rotation @ arm

    found = []
    for one in result.scene.links:
        ends = np.stack([at(one.a, one.arm_a), at(one.b, one.arm_b)], axis=1)
        broken = result.history[f"link/{one.name}/broken"][rows] > 0
        ends[broken, 1] = ends[broken, 0]
        found.append(Bar(one.name, ends, result.history[f"link/{one.name}/tension"][rows]))
    return found


def struts_of(result: Result, times: np.ndarray) -> list[Bar]:
    """The columns of buildings, from the slab or a floor to the floor above."""
    found = []
    for number, piece in enumerate(result.scene.bodies):
        if not len(piece.struts):
            continue
        pose, shifts = result.poses[number].at(times), shifts_of(result, number, times)
        firm = len(piece.points) - piece.carried
        for strut in piece.struts:
            ends = pose.move(piece.upright[strut], slice(None))
            for side, point in enumerate(strut):
                level = 0 if point < firm else 1 + (point - firm) // 8
                ends[:, side] += shifts[level]
            found.append(Bar("", ends))
    return found


@dataclass(frozen=True, slots=True)
class Arrows:
    """The resultants of joints.

    Attributes
    ----------
    tips
        (t, n, 3) [m] centres of pressure, in the frame of the ground.
    forces
        (t, n, 3) [N] on the body that is pushed upwards; 0 where a joint carries nothing.
    scale
        length of an arrow [m] of one newton.
    largest
        a usual largest force [N].
    """

    tips: np.ndarray
    forces: np.ndarray
    scale: float
    largest: float


def arrows_of(result: Result, times: np.ndarray) -> Arrows | None:
    """The resultants at `times` (t,) [s]; None of a history without them."""
    rows = float(np.median(np.diff(result.time)))
    try:
        forces = JointForces(result, max(_MEAN_S, 4 * rows))
    except InputError:
        return None
    found = [forces.carried(time) for time in times]
    resultants = np.array([one for one, _ in found])
    upwards = np.where(resultants[..., 2:] < 0, -1.0, 1.0)
    tips = np.array([center for _, center in found])
    return Arrows(tips, upwards * resultants, forces.scale, forces.largest)
