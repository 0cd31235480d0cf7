"""Bodies that slide over an edge of a face on which their joint has no contact points, looked for
while an analysis runs.

A joint is given the edge of the larger face, its other side, where the smaller face may come to it
by sliding as far as `joints.NAME.allowance_m` (`structures.edges`). A body that slides farther and
passes the edge would pivot on its own last contact point instead. Joints with a pad are left out:
what lies beyond the edge carries nothing there. So are those in whose stead contact is found.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.structures.model import JointModel, StructureModel, Surface
from fecolumn.structures.outlines import inwards

# Height of a point above the face, over the face's size, up to which it counts as lying on it, and
# how far beyond its edge it counts as over it: more than elastic faces give, less than can be seen
_LIES = 1e-4
# Depth below the face, over its size, down to which a point is of a body that lies on it, not of
# one that has fallen off
_BELOW = 0.1


class _Face(NamedTuple):
    """What a joint without an edge lies on.

    name: of the joint. slave, master: places of the bodies. points: (k, 3) [m] of the slave that
    begin over the master's face, from its centre of mass. surface: of the master. border: (e, 2, 2)
    [m] sides of the outline of its face, holes left out. size: [m] of the slave's face. place: (3,)
    [m] of the slave's middle in the master's frame, turn: (3, 3) of the slave in it, at the start.
    way: [m] by which a point may move before any comes to the border.
    """

    name: str
    slave: int
    master: int
    points: NDArray[Any]
    surface: Surface
    border: NDArray[Any]
    size: float
    place: NDArray[Any]
    turn: NDArray[Any]
    way: float


class UnpreparedEdges:
    """Edges of faces that the joints of a structure have no contact points for."""

    def __init__(self, structure: StructureModel) -> None:
        faces = (
            _face(structure, joint)
            for place, joint in enumerate(structure.joints)
            if len(joint.border)
            and joint.ball is None
            and joint.pad is None
            and place not in structure.replaced
        )
        self._faces = [face for face in faces if face is not None]

    def passed(self, centers: NDArray[Any], rotations: NDArray[Any]) -> tuple[str, ...]:
        """Names of the joints whose slave lies across such an edge; centers: (nb, 3) [m] of mass,
        rotations: (nb, 3, 3) of all bodies.
        """
        return tuple(face.name for face in self._faces if _passes(face, centers, rotations))

    def time(
        self, centers: NDArray[Any], rotations: NDArray[Any], speeds: NDArray[Any], longest: float
    ) -> float:
        """Time [s], at most `longest`, in which bodies whose points move by `speeds` (nb,) [m/s] at
        most, and gain no more than in a fall, come to no edge.
        """
        for face in self._faces:
            speed = float(speeds[face.slave] + speeds[face.master])
            away = face.way - _moved(face, centers, rotations)
            if away < (speed + GRAVITY * longest) * longest:
                within, height = _within(face, centers, rotations)
                lies = height - _LIES * face.size, -_BELOW * face.size - height
                away = max(float(np.max([within, *lies], axis=0).min()), 0.0)
                fall = np.sqrt(speed**2 + 4 * GRAVITY * away) - speed
                longest = min(longest, float(fall) / (2 * GRAVITY))
        return longest


def _face(structure: StructureModel, joint: JointModel) -> _Face | None:
    """The face that a joint lies on, None where nothing lies on it."""
    slave, master = structure.parts[joint.slave], structure.parts[joint.master]
    own = slave.model.surfaces[joint.slave_surface]
    assert joint.master_surface is not None  # the ground has no border
    surface = master.model.surfaces[joint.master_surface]
    border = surface.plane(joint.border)[..., :2]
    points = slave.model.arms[own.nodes]
    turn = master.rotation.T @ slave.rotation
    places = (slave.center - master.center) @ master.rotation + points @ turn.T
    within = inwards(surface.plane(places)[:, :2], border)
    on = within >= 0
    if not on.any():
        return None
    return _Face(
        joint.name,
        joint.slave,
        joint.master,
        points[on],
        surface,
        border,
        float(np.ptp(points, axis=0).max()),
        places[on].mean(axis=0),
        turn,
        float(within[on].min()),
    )


def _moved(face: _Face, centers: NDArray[Any], rotations: NDArray[Any]) -> float:
    """How far [m] any point of the slave has moved over the face at most."""
    frame = rotations[face.master]
    turn = frame.T @ rotations[face.slave]
    shift = (centers[face.slave] - centers[face.master]) @ frame
    moved = shift + face.points.mean(axis=0) @ turn.T - face.place
    return float(np.linalg.norm(moved) + face.size * np.linalg.norm(turn - face.turn))


def _within(
    face: _Face, centers: NDArray[Any], rotations: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """How far (k,) [m] the slave's points are within the border, and their heights [m] above the
    face.
    """
    frame = rotations[face.master]
    shift = (centers[face.slave] - centers[face.master]) @ frame
    places = face.surface.plane(shift + face.points @ rotations[face.slave].T @ frame)
    return inwards(places[:, :2], face.border), places[:, 2]


def _passes(face: _Face, centers: NDArray[Any], rotations: NDArray[Any]) -> bool:
    """Whether the slave has a point on the face and one beyond its border, not above it."""
    if _moved(face, centers, rotations) < face.way:
        return False
    within, height = _within(face, centers, rotations)
    low = (height < _LIES * face.size) & (height > -_BELOW * face.size)
    return bool((low & (within >= 0)).any() and (low & (within < -_LIES * face.size)).any())
