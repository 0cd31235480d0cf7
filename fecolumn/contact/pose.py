"""Where an interface is and how its bodies are turned towards it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.contact.arrays import put_matrix
from fecolumn.contact.points import GROUND
from fecolumn.contact.record import record
from fecolumn.foundation._compiled import interpreted, njit
from fecolumn.foundation.arrays import Array, Record

#: The frame of an interface, of its master's surface: frame: (3, 3) its axes in the table frame,
#: two tangents and the normal; origin: (3,) in the table frame [m]; turned: (2, 3, 3) of slave and
#: master to this frame; foot: (3,) middle of the slave's foot in it [m]. That of a ground is the
#: table frame, moved along with it.
POSE = record(
    ("frame", "f8", (3, 3)), ("origin", "f8", 3), ("turned", "f8", (2, 3, 3)), ("foot", "f8", 3)
)

#: Of a body's frame no more than its centre of mass [m].
PLACE = record(("center", "f8", 3))

#: A ground in the table frame, which moves with the first one: place: (3,) of its frame, which has
#: its height above z = 0, moved: how far it has moved, both [m]; velocity [m/s]; acceleration: of
#: the ground motion [m/s2].
GROUND_STATE = record(
    ("place", "f8", 3), ("moved", "f8", 3), ("velocity", "f8", 3), ("acceleration", "f8", 3)
)

#: Sides of an interface.
SLAVE, MASTER = range(2)


def grounds_at(levels: ArrayLike) -> Array:
    """(G,) of GROUND_STATE at heights (G,) [m], at rest."""
    grounds = np.zeros(np.size(levels), GROUND_STATE)
    grounds["place"][:, 2] = levels
    return grounds


@njit
def move_grounds(before: Array, accelerations: Array, dt: float, after: Array) -> None:
    """Carry grounds (G,) of GROUND_STATE to the end of a step, relative to the first one, which
    stays.

    accelerations: (3 G,) of each at the end [m/s2], to which they change evenly in the step.
    """
    for g in range(len(before)):
        after[g] = before[g]
        for a in range(3):
            after[g].acceleration[a] = accelerations[3 * g + a]
            if g > 0:
                first = before[g].acceleration[a] - before[0].acceleration[a]
                last = after[g].acceleration[a] - accelerations[a]
                way = dt * before[g].velocity[a] + dt**2 * (first / 3 + last / 6)
                after[g].place[a] += way
                after[g].moved[a] += way
                after[g].velocity[a] += dt * (first + last) / 2


@njit
def find_poses(
    interfaces: Array,
    grounds: Array,
    frames: Array,
    rotation: Array,
    poses: Array,
    rims: Array | None,
) -> None:
    """Find poses (ni,) of POSE where the bodies have `frames` (nb,), of PLACE or with more fields,
    and are turned by `rotation` (nb, 3, 3); grounds: (G,) of GROUND_STATE. rims: (ni,) of RIM, None
    for all interfaces, else those whose faces are apart in the step are left out.
    """
    place = np.empty(3)
    for k in range(len(interfaces)):
        if rims is not None:
            if rims[k].apart:
                continue
        interface, pose, slave, b = (
            interfaces[k],
            poses[k],
            interfaces[k].slave,
            interfaces[k].master,
        )
        frame, turned, axes, R = pose.frame, pose.turned, interface.axes, rotation[slave]
        for a in range(3):
            place[a] = (
                frames[slave].center[a]
                + R[a, 0] * interface.foot[0]
                + R[a, 1] * interface.foot[1]
                + R[a, 2] * interface.foot[2]
            )
        if b == GROUND:
            put_matrix(R, turned[SLAVE])
            ground = grounds[interface.ground]
            for a in range(3):
                pose.origin[a], pose.foot[a] = ground.place[a], place[a] - ground.place[a]
                for c in range(3):
                    frame[a, c] = turned[MASTER, a, c] = 1.0 if a == c else 0.0
            continue
        M, start = rotation[b], interface.origin
        for a in range(3):
            pose.origin[a] = (
                frames[b].center[a] + M[a, 0] * start[0] + M[a, 1] * start[1] + M[a, 2] * start[2]
            )
            for c in range(3):
                frame[a, c] = M[a, 0] * axes[0, c] + M[a, 1] * axes[1, c] + M[a, 2] * axes[2, c]
                turned[MASTER, a, c] = axes[c, a]
        for a in range(3):
            pose.foot[a] = 0.0
            for c in range(3):
                turned[SLAVE, a, c] = (
                    frame[0, a] * R[0, c] + frame[1, a] * R[1, c] + frame[2, a] * R[2, c]
                )
                pose.foot[a] += frame[c, a] * (place[c] - pose.origin[c])


def frames_at(centers: Array) -> Array:
    """Frames (nb,) of PLACE of bodies with centres of mass (nb, 3) [m]."""
    frames = np.zeros(len(centers), PLACE)
    frames["center"] = centers
    return frames


def poses_of(interfaces: Array, centers: Array, rotations: Array, grounds: Array) -> Array:
    """(ni,) of POSE of bodies with centres of mass (nb, 3) turned by (nb, 3, 3); grounds: (G,) of
    GROUND_STATE.
    """
    poses = np.zeros(len(interfaces), POSE)
    interpreted(find_poses)(interfaces, grounds, frames_at(centers), rotations, poses, None)
    return poses


@njit(inline="always")
def into_frame(pose: Record, place: Array) -> None:
    """A position (3,) in the table frame as one in that of an interface, in place."""
    x, y, z, Q = (
        place[0] - pose.origin[0],
        place[1] - pose.origin[1],
        place[2] - pose.origin[2],
        pose.frame,
    )
    for a in range(3):
        place[a] = Q[0, a] * x + Q[1, a] * y + Q[2, a] * z


@njit
def turns(poses: Array) -> Array:
    """Rotations (ni, 2, 3, 3) of slave and master of all poses (ni,), as one array: loops over
    points read it faster than the records.
    """
    result = np.empty((len(poses), 2, 3, 3))
    for k in range(len(poses)):
        for side in range(2):
            for a in range(3):
                for c in range(3):
                    result[k, side, a, c] = poses[k].turned[side, a, c]
    return result
