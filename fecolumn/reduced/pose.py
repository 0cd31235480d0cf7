"""Frames of the interfaces of a structure in a motion."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import interpreted, njit
from fecolumn.contact.arrays import put_matrix
from fecolumn.contact.points import BASE
from fecolumn.contact.pose import MASTER, POSE, SLAVE


@njit
def find_poses(interfaces, frames, rotation, poses):
    """Find poses (ni,) of POSE where the bodies have `frames` (nb,) of FRAME and are turned by `rotation` (nb, 3, 3)."""
    place = np.empty(3)
    for k in range(len(interfaces)):
        interface, pose, slave, b = interfaces[k], poses[k], interfaces[k].slave, interfaces[k].master
        frame, turned, axes, R = pose.frame, pose.turned, interface.axes, rotation[slave]
        for a in range(3):
            place[a] = frames[slave].center[a] + R[a, 0] * interface.foot[0] + R[a, 1] * interface.foot[1] + R[a, 2] * interface.foot[2]
        if b == BASE:
            put_matrix(R, turned[SLAVE])
            for a in range(3):
                pose.origin[a], pose.foot[a] = 0.0, place[a]
                for c in range(3):
                    frame[a, c] = turned[MASTER, a, c] = 1.0 if a == c else 0.0
            continue
        M, start = rotation[b], interface.origin
        for a in range(3):
            pose.origin[a] = frames[b].center[a] + M[a, 0] * start[0] + M[a, 1] * start[1] + M[a, 2] * start[2]
            for c in range(3):
                frame[a, c] = M[a, 0] * axes[0, c] + M[a, 1] * axes[1, c] + M[a, 2] * axes[2, c]
                turned[MASTER, a, c] = axes[c, a]
        for a in range(3):
            pose.foot[a] = 0.0
            for c in range(3):
                turned[SLAVE, a, c] = frame[0, a] * R[0, c] + frame[1, a] * R[1, c] + frame[2, a] * R[2, c]
                pose.foot[a] += frame[c, a] * (place[c] - pose.origin[c])


def frames_at(centers: np.ndarray) -> np.ndarray:
    """Frames (nb,) of bodies with centres of mass (nb, 3), as far as places depend on them."""
    frames = np.zeros(len(centers), [("center", "f8", 3)]).view(np.recarray)
    frames["center"] = centers
    return frames


def poses_of(interfaces: np.ndarray, centers: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """(ni,) of POSE of bodies with centres of mass (nb, 3) turned by (nb, 3, 3)."""
    poses = np.zeros(len(interfaces), POSE)
    interpreted(find_poses)(interfaces, frames_at(centers), rotations, poses)
    return poses
