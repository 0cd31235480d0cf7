"""How far the faces of a joint are apart, from the poses of its bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.engines.scene.scene import JointFace
from fecolumn.pictures.render.pose import Poses

if TYPE_CHECKING:
    from fecolumn.engines.scene.scene import Scene


def moved_from_master(
    contact: JointFace,
    places: np.ndarray,
    rest: np.ndarray,
    poses: tuple[Poses, ...],
    k: int | slice | np.ndarray,
) -> np.ndarray:
    """Displacement (..., n, 3) [m] relative to the master of points of the slave that are at
    `places` (..., n, 3) [m] and were at `rest` (n, 3) [m].

    Parameters
    ----------
    poses
        of each body, of which `k`, a number or several, is that of the places.
    """
    if contact.master == GROUND:
        return places - rest
    master = poses[contact.master]
    return (places - master.foot[k][..., None, :]) @ master.rotation[k] + master.origin - rest


def gaps(contact: JointFace, moved: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Gap (..., n) [m] between slave and master at points displaced by (..., n, 3) [m] from `rest`
    (n, 3) [m].
    """
    return (contact.origin - rest - moved) @ contact.axes[:, 2]


def motion(
    scene: Scene, contact: JointFace, poses: tuple[Poses, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Uplift (n,) [m] of the point of the edge that is lifted most, and slide (n, 2) [m] of the
    face's middle, at n poses.
    """
    corners = scene.points[np.unique(contact.outline if len(contact.outline) else contact.points)]
    rest = np.vstack([corners, corners.mean(axis=0)])
    uplift, slide = np.zeros(len(poses[0].time)), np.zeros((len(poses[0].time), 2))
    # some by some: all corners at all times fill gigabytes
    for own in np.array_split(np.arange(len(uplift)), max(1, len(uplift) * len(rest) // 10**6)):
        places = poses[contact.piece].move(rest, own)
        moved = moved_from_master(contact, places, rest, poses, own)
        uplift[own] = np.maximum((-moved @ contact.axes[:, 2]).max(axis=1), 0.0)
        slide[own] = moved[:, -1] @ contact.axes[:, :2]
    return uplift, slide
