"""Where the contact points are at the end of a step, while its motion is found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fecolumn.contact.points import GROUND, UNPREPARED
from fecolumn.contact.pose import SLAVE, find_poses
from fecolumn.contact.problem import STICKS_STILL, present_points
from fecolumn.contact.tolerances import CLOSE
from fecolumn.engines.reduced.elastic import (
    COORDINATE,
    END,
    START,
    find_all_elastic,
    find_elastic,
    find_on_master,
    find_position,
    locate_start,
    modal_strain,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.engines.reduced.model import Structure
    from fecolumn.engines.reduced.motion import MotionState


class Positions(NamedTuple):
    """Positions of P points at the END of a step, and what tells which of them may matter.

    place: (P, 3) [m], in the frames of their interfaces, of points too high to matter the height
    alone. frames: (2, ni, 3, 4) of the slaves, how each is turned towards the frame of its
    interface and where its centre of mass [m] is there; reach: (2, nb) by how much a mode's energy
    lets a node move: both when all points were placed in this step, and now. above: (P,) how high a
    point was then above the height from which it matters [m]; -inf for one that does, or did since.
    most: (2,) largest arm of a point [m], largest share of a reach in such a height. low: (P,) room
    for a list of points.
    """

    place: Array
    frames: Array
    reach: Array
    above: Array
    most: Array
    low: Array


_ALL, _NOW = 0, 1
_ARM, _SHARE = 0, 1


def no_positions(points: int, interfaces: int, bodies: int) -> Positions:
    """Room for so many points, interfaces and bodies."""
    return Positions(
        np.zeros((points, 3)),
        np.zeros((2, interfaces, 3, 4)),
        np.zeros((2, bodies)),
        np.zeros(points),
        np.zeros(2),
        np.zeros(points, np.int64),
    )


@njit
def find_positions(
    structure: Structure, work: Any, start: MotionState, end: MotionState, first: bool
) -> tuple[bool, Array]:
    """Find the positions of the points at the END of the step.

    Of points too high to matter the height alone is found, without elastic displacement, and once:
    the motion is found by iterations in which bodies move so little that most of these points stay
    too high.

    Parameters
    ----------
    first
        whether it is the first time in this step.

    Returns: whether all points are over surfaces that are known, and the points (k,) that were
    placed; all others are too high to matter.
    """
    interfaces, points, elastic, poses, positions = (
        structure.interfaces,
        work.points,
        work.elastic,
        work.poses[END],
        work.positions,
    )
    all_of_them, known = work.problem.flags[STICKS_STILL], True
    most = all_of_them or 2 * work.problem.count[0] > work.problem.count[2]
    when = _ALL if first else _NOW
    reach, frames = positions.reach[when], positions.frames[when]
    find_poses(interfaces, end.grounds, end.frames, end.rotation, poses, end.rims)
    for b in range(len(end.frames)):
        # no node moves farther than the modes' energy allows
        reach[b] = np.sqrt(2 * modal_strain(structure.squares[b], end.modal[b, COORDINATE]))
        if most and end.modal.shape[2] > 0:
            find_all_elastic(structure, b, end, elastic, END)
    for k in range(len(interfaces)):
        if not end.rims[k].apart:
            _find_slave(interfaces[k], poses[k], end, frames[k])
    listed, arm, most_share = present_points(work.problem), 0.0, 0.0
    if not first and not all_of_them:
        listed = _list_low(positions, listed, _most_moved(positions, end.rims))
    for i in listed:
        point = points[i]
        k, x, y, z = point.interface, point.arm[0], point.arm[1], point.arm[2]
        height = frames[k, 2, 3] + frames[k, 2, 0] * x + frames[k, 2, 1] * y + frames[k, 2, 2] * z
        height += point.lift
        # a point of the rim moves with nodes near to its own, which may reach farther, but not
        # twice as far
        share = 2 * structure.reach[point.node]
        low = CLOSE * interfaces[k].width + reach[point.slave] * share
        if point.master != GROUND:
            low += reach[point.master] * interfaces[k].reach
            share += interfaces[k].reach
        if first:
            positions.above[i] = -np.inf
            arm, most_share = max(arm, x * x + y * y + z * z), max(most_share, share)
        if (
            height > low
            and not all_of_them
            and not (work.before[i].force[2] > 0 or end.contact[i].force[2] > 0)
        ):
            positions.place[i, 2] = height
            if first:
                positions.above[i] = height - low
            continue
        if work.before[i].force[2] <= 0:
            locate_start(
                structure, points, i, start, work.poses[START], elastic, work.before, work.places[0]
            )
        find_elastic(structure, points, i, end, elastic, END)
        find_position(points, i, end, elastic, END, positions.place[i])
        if point.master != GROUND:
            find_on_master(structure, points, i, end, poses, elastic, END, positions.place[i])
            known &= points[i].beyond != UNPREPARED
    if first:
        positions.most[_ARM], positions.most[_SHARE] = np.sqrt(arm), most_share
    return known, listed


@njit
def _find_slave(interface: Record, pose: Record, motion: MotionState, frame: Array) -> None:
    """Fill frame (3, 4): how the slave is turned towards the frame of an interface, and where its
    centre of mass is in it [m].
    """
    center = motion.frames[interface.slave].center
    for a in range(3):
        frame[a, 3] = 0.0
        for c in range(3):
            frame[a, c] = pose.turned[SLAVE][a, c]
            frame[a, 3] += pose.frame[c, a] * (center[c] - pose.origin[c])


@njit
def _most_moved(positions: Positions, rims: Array) -> float:
    """By how much [m] a point may have come down since all were placed, at most."""
    moved, grown = 0.0, 0.0
    for k in range(positions.frames.shape[1]):
        if rims[k].apart:
            continue
        turn, way = 0.0, 0.0
        for a in range(3):
            for c in range(3):
                turn += (positions.frames[_NOW, k, a, c] - positions.frames[_ALL, k, a, c]) ** 2
            way += (positions.frames[_NOW, k, a, 3] - positions.frames[_ALL, k, a, 3]) ** 2
        moved = max(moved, np.sqrt(way) + np.sqrt(turn) * positions.most[_ARM])
    for b in range(positions.reach.shape[1]):
        grown = max(grown, positions.reach[_NOW, b] - positions.reach[_ALL, b])
    return moved + grown * positions.most[_SHARE]


@njit
def _list_low(positions: Positions, present: Array, moved: float) -> Array:
    """Those of the present points (k,) that may matter after they came down by `moved` [m], or that
    did in an earlier iteration of the step: these may carry.
    """
    count = 0
    for i in present:
        if not positions.above[i] > moved:
            positions.above[i] = -np.inf
            positions.low[count] = i
            count += 1
    return positions.low[:count]
