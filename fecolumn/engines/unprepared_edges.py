"""Bodies that slide over an edge of a face on which their joint has no contact points, looked for
while an analysis runs.

A joint is given the edge of the larger face, its other side, where the smaller face may come to it
by sliding as far as `joints.NAME.allowance_m` (`structures.edges`). A body that slides farther and
passes the edge would pivot on its own last contact point instead.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fecolumn.contact.points import GROUND
from fecolumn.structures.faces import apart, over
from fecolumn.structures.model import JointModel, StructureModel, Surface

# Height of a point above the face, over the face's size, up to which it counts as lying on it: more
# than elastic faces give, less than what can be seen
_LIES = 1e-4
# Depth below the face, over its size, down to which a point is of a body that lies on it, not of
# one that has fallen off
_BELOW = 0.1


class _Face(NamedTuple):
    """What a joint without an edge lies on.

    name: of the joint. slave, master: places of the bodies. points: (k, 3) [m] of the slave from
    its centre of mass. surface: of the master. triangles: (t, 3, 2) [m] that are prepared of it.
    sides: (e, 2, 2) [m] around these; edge: (e,) mask of those on the outlines of the face. size:
    [m] of the slave's face. place: (3,) [m] of the slave's middle in the master's frame, turn:
    (3, 3) of the slave in it, at the start. way: [m] by which a point may move before any comes to
    an edge.
    """

    name: str
    slave: int
    master: int
    points: NDArray[Any]
    surface: Surface
    triangles: NDArray[Any]
    sides: NDArray[Any]
    edge: NDArray[Any]
    size: float
    place: NDArray[Any]
    turn: NDArray[Any]
    way: float


class UnpreparedEdges:
    """Edges of faces that the joints of a structure have no contact points for."""

    def __init__(self, structure: StructureModel) -> None:
        prepared = {joint.pair for joint in structure.joints}
        faces = (
            _face(structure, joint)
            for place, joint in enumerate(structure.joints)
            if joint.master != GROUND
            and joint.pair < 0
            and place not in prepared
            and joint.ball is None
        )
        self._faces = [face for face in faces if face is not None]

    def passed(self, centers: NDArray[Any], rotations: NDArray[Any]) -> tuple[str, ...]:
        """Names of the joints whose slave lies across such an edge; centers: (nb, 3) [m] of mass,
        rotations: (nb, 3, 3) of all bodies.
        """
        return tuple(face.name for face in self._faces if _passes(face, centers, rotations))


def _face(structure: StructureModel, joint: JointModel) -> _Face | None:
    """The face that a joint lies on, None where what is prepared of it reaches no edge."""
    slave, master = structure.parts[joint.slave], structure.parts[joint.master]
    own = slave.model.surfaces[joint.slave_surface]
    assert joint.master_surface is not None  # the ground has none
    other = master.model.surfaces[joint.master_surface]
    corners = other.plane(master.model.arms[other.nodes])[:, :2]
    sides = np.sort(other.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    sides, times = np.unique(sides, axis=0, return_counts=True)
    sides = sides[times == 1]
    edge = other.outlines[sides].all(axis=1)
    if not edge.any():
        return None
    points = slave.model.arms[own.nodes]
    turn = master.rotation.T @ slave.rotation
    places = (slave.center - master.center) @ master.rotation + points @ turn.T
    away = apart(other.plane(places)[:, None, :2], corners[sides[edge]]).min()
    return _Face(
        joint.name,
        joint.slave,
        joint.master,
        points,
        other,
        corners[other.triangles],
        corners[sides],
        edge,
        float(np.ptp(points, axis=0).max()),
        places.mean(axis=0),
        turn,
        float(away),
    )


def _passes(face: _Face, centers: NDArray[Any], rotations: NDArray[Any]) -> bool:
    """Whether the slave has a point on the face and one beyond an edge of it, not above it."""
    frame = rotations[face.master]
    turn = frame.T @ rotations[face.slave]
    shift = (centers[face.slave] - centers[face.master]) @ frame
    moved = shift + face.points.mean(axis=0) @ turn.T - face.place
    if np.linalg.norm(moved) + face.size * np.linalg.norm(turn - face.turn) < face.way:
        return False
    places = face.surface.plane(shift + face.points @ turn.T)
    low = (places[:, 2] < _LIES * face.size) & (places[:, 2] > -_BELOW * face.size)
    on = over(places[:, :2], face.triangles, 0.0)
    if not (low & on).any() or not (low & ~on).any():
        return False
    away = apart(places[low & ~on, None, :2], face.sides)
    # beyond the face, not only beyond what is prepared of it
    nearest = away.argmin(axis=1)
    return bool((face.edge[nearest] & (away.min(axis=1) > _LIES * face.size)).any())
