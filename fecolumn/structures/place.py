"""Where bodies are at the start: as they stand, or leaning on one another without strain, with
velocity and spin.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import Initial
from fecolumn.contact.ball import from_center
from fecolumn.contact.interface import interface_of
from fecolumn.contact.points import GROUND
from fecolumn.contact.rim import Rim
from fecolumn.contact.tolerances import SAME_OUTLINE
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.schema import InputError
from fecolumn.structures.model import JointModel
from fecolumn.structures.outlines import corners_of_overlap, inwards
from fecolumn.structures.standing import Standing, Supports, from_below, supports_of, touching

# Over the size of a body: places that several supports give it must agree this well
_AGREE = 1e-6
# Sine of a tilt below which there is none, and share of a foot's width within which points are
# equally far ahead
_UPRIGHT, _EDGE = 1e-12, 1e-9


@dataclass(frozen=True)
class Placement:
    """Where a part is: center (3,) [m], rotation (3, 3), velocity (3,) [m/s] of the centre of mass,
    spin (3,) [rad/s].
    """

    center: NDArray[Any]
    rotation: NDArray[Any]
    velocity: NDArray[Any]
    spin: NDArray[Any]


def placed(
    standing: Sequence[Standing],
    joints: Sequence[JointModel],
    file: Path | str,
    only: Collection[int] | None = None,
) -> list[Placement]:
    """Places of all parts at the start.

    A part leans by its own tilt about the point of its foot that is farthest in the direction in
    which it leans against what it stands on; what stands on it keeps its own tilt, 0 unless stated,
    and comes along with the point on which it then stands. only: those that lean and what stands on
    them, where the others are known to be upright.

    Raises
    ------
    InputError
        a part whose supports lead it to different places.
    """
    turns = [_turn(part.start) for part in standing]
    supports = supports_of(standing, joints)
    found: dict[int, Placement] = {}
    for place in from_below(supports):
        part, centers = standing[place], []
        if only is not None and place not in only:
            still = np.zeros(3)
            found[place] = Placement(part.center, turns[place], still, still)
            continue
        pivot: NDArray[Any] | None = None
        for below, between in supports[place]:
            pivot, center = _on(standing, between, place, below, turns, found)
            centers.append(center)
        center = np.mean(centers, axis=0) if centers else part.center
        size = np.ptp(part.model.arms, axis=0).max()
        if centers and np.abs(np.array(centers) - center).max() > _AGREE * size:
            if not _are_upright(supports[place], standing, found):
                raise InputError(
                    file,
                    f"initial.{part.name}",
                    None,
                    f'"{part.name}" cannot stand on bodies that lean differently: '
                    "give all that it stands on the same tilt_rad and direction_deg",
                )
            pivot, center = _on_farthest(standing, supports[place], place, turns, found)
        found[place] = Placement(
            center,
            turns[place],
            *_moving(part, center, pivot, supports[place], standing),
        )
    return [found[place] for place in range(len(standing))]


def _turn(start: Initial | None) -> NDArray[Any]:
    """Rotation (3, 3) of a part that leans."""
    if start is None or not start.tilt_rad:
        return np.eye(3)
    direction = np.radians(start.direction_deg)
    return rotation_matrix(start.tilt_rad * np.array([-np.sin(direction), np.cos(direction), 0.0]))


def _on(
    standing: Sequence[Standing],
    joints: list[JointModel],
    upper: int,
    below: int,
    turns: list[NDArray[Any]],
    found: dict[int, Placement],
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Point (3,) [m] about which a part is turned on what is below it, and where its centre (3,) of
    mass comes.
    """
    part = standing[upper]
    base = np.eye(3) if below == GROUND or below not in found else found[below].rotation
    relative = base.T @ turns[upper]
    pivot, joint = _pivot(standing, joints, relative[:, 2] * [1.0, 1.0, 0.0])

    def carried(point: NDArray[Any]) -> NDArray[Any]:
        if below == GROUND or below not in found:
            return point
        there: NDArray[Any] = found[below].center + base @ (point - standing[below].center)
        return there

    touched, offset = _rolled(standing, joint, pivot, relative)
    return carried(touched), carried(touched + relative @ (part.center - pivot - offset))


def _are_upright(
    supports: Supports, standing: Sequence[Standing], found: dict[int, Placement]
) -> bool:
    """Whether all that a part stands on is in its place, but for rounding, and does not lean."""
    return all(
        below == GROUND
        or below in found
        and np.array_equal(found[below].rotation, np.eye(3))
        and np.abs(found[below].center - standing[below].center).max()
        <= _AGREE * np.ptp(standing[below].model.arms, axis=0).max()
        for below, _ in supports
    )


def _on_farthest(
    standing: Sequence[Standing],
    supports: Supports,
    upper: int,
    turns: list[NDArray[Any]],
    found: dict[int, Placement],
) -> tuple[NDArray[Any], NDArray[Any]]:
    """As `_on`, of a part that leans on several upright bodies: about the farthest of all."""
    ahead = turns[upper][:, 2] * [1.0, 1.0, 0.0]
    _, farthest = _pivot(standing, _joints_of(supports), ahead)
    below = next(one for one, between in supports if any(farthest is joint for joint in between))
    return _on(standing, [farthest], upper, below, turns, found)


def _joints_of(supports: Supports) -> list[JointModel]:
    return [joint for _, between in supports for joint in between]


def _rolled(
    standing: Sequence[Standing], joint: JointModel, pivot: NDArray[Any], turn: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Where a slave that is turned by (3, 3) touches (3,) [m], and its way (3,) there from the
    pivot, in its own frame: a ball about the pivot has rolled there.
    """
    if joint.ball is None:
        return pivot, np.zeros(3)
    normal = -standing[joint.slave].model.surfaces[joint.slave_surface].normal
    interface, offset, lean = (
        interface_of(np.zeros((1, 3))),
        np.zeros(3),
        turn[:, 2] - normal * (turn[:, 2] @ normal),
    )
    interface["ball"], interface["edge"] = joint.ball.radius, joint.ball.edge
    plain = interpreted(from_center)
    plain(interface[0], turn.T @ normal, offset)
    across = float(np.linalg.norm(offset - normal * (offset @ normal)))
    length = np.linalg.norm(lean)
    way = (
        joint.ball.radius * math.asin(min(across / joint.ball.radius, 1.0)) * lean / length
        if length > _UPRIGHT
        else np.zeros(3)
    )
    return pivot - joint.ball.radius * normal + way, offset


def _pivot(
    standing: Sequence[Standing], joints: list[JointModel], ahead: NDArray[Any]
) -> tuple[NDArray[Any], JointModel]:
    """Point (3,) [m] of joints farthest in the direction `ahead`, as the bodies stand, and its
    joint; of a round rim on its circle, of an edge its middle.

    Of a foot that touches with balls it is the centre of one.
    """
    length = np.linalg.norm(ahead)
    if length >= _UPRIGHT:
        ahead = ahead / length
    leans = bool(length >= _UPRIGHT)
    farthest = [
        _end_of_region(standing, joint, ahead)
        if leans and joint.outlines
        else _farthest(standing, joint, ahead, leans)
        for joint in joints
    ]
    reached = [
        point @ ahead if leans and joint.outlines or len(touching(standing, joint)) else -math.inf
        for point, joint in zip(farthest, joints)
    ]
    first = int(np.argmax(np.array(reached) + 0.0)) if length >= _UPRIGHT else 0
    return farthest[first], joints[first]


def _farthest(
    standing: Sequence[Standing], joint: JointModel, ahead: NDArray[Any], leans: bool
) -> NDArray[Any]:
    """As `_pivot`, of one joint; ahead: unit vector (3,) where it leans."""
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    arms = slave.model.arms[surface.nodes]
    rows = touching(standing, joint)
    points = slave.center + arms[rows]
    found: NDArray[Any]
    if not len(points):
        found = slave.center + arms.mean(axis=0)
        return found
    if not leans:
        found = points.mean(axis=0)
        return found
    rim = Rim.find(surface.plane(arms)) if joint.round else None
    if rim is not None and np.isin(rim.nodes, rows).all():
        found = slave.center + arms[rim.nodes].mean(axis=0) + rim.radius * ahead
        return found
    far = points @ ahead
    found = points[far >= far.max() - _EDGE * np.ptp(points, axis=0).max()].mean(axis=0)
    return found


def _region(
    standing: Sequence[Standing], joint: JointModel
) -> tuple[list[Rim | None], list[NDArray[Any]], float, NDArray[Any]]:
    """Of a joint with two sides, with the roles exchanged: the circles of its outlines or None,
    these as sides (m, 2, 2) [m] in the plane of the slave's face, the height of that, and the
    corners (n, 2) [m] of the region in which they overlap.
    """
    face = standing[joint.slave].model.surfaces[joint.slave_surface].axes
    outlines = [
        (sides + standing[place].center) @ face
        for place, sides in zip((joint.slave, joint.master), joint.outlines)
    ]
    circles, height = [Rim.find(sides[:, 0]) for sides in outlines], outlines[0][0, 0, 2]
    outlines = [sides[..., :2] for sides in outlines]
    slack = SAME_OUTLINE * np.ptp(outlines[0], axis=(0, 1)).max()
    return circles, outlines, height, corners_of_overlap(outlines[0], outlines[1], slack)


def footing(standing: Sequence[Standing], joint: JointModel) -> NDArray[Any]:
    """Places (n, 3) [m] where the bodies of a joint touch at the start: nodes of the slave on the
    master, and of a joint with two sides corners of the region in which both faces overlap.
    """
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    nodes: NDArray[Any] = slave.center + slave.model.arms[surface.nodes[touching(standing, joint)]]
    if not joint.outlines:
        return nodes
    _, outlines, height, corners = _region(standing, joint)
    corners = np.column_stack([corners, np.full(len(corners), height)]) @ surface.axes.T
    known = np.concatenate([nodes, np.full((1, 3), np.inf)])
    apart = np.linalg.norm(corners[:, None] - known, axis=2).min(axis=1)
    return np.concatenate([nodes, corners[apart > _AGREE * np.ptp(outlines[0], axis=(0, 1)).max()]])


def _end_of_region(
    standing: Sequence[Standing], joint: JointModel, ahead: NDArray[Any]
) -> NDArray[Any]:
    """Point (3,) [m] farthest in the direction `ahead` of the region in which the faces of a joint
    with two sides overlap, of an edge its middle; joint: with the roles exchanged.

    Of a circle it is a point of that, not of the polygon of its nodes, unless the circles cross
    there.
    """
    face = standing[joint.slave].model.surfaces[joint.slave_surface].axes
    along = ahead @ face[:, :2]
    along = along / np.linalg.norm(along)
    circles, outlines, height, region = _region(standing, joint)
    size = np.ptp(outlines[0], axis=(0, 1)).max()
    found = region @ along
    edge = region[found >= found.max() - _EDGE * size]
    across = edge @ [-along[1], along[0]]
    best = (edge[across.argmin()] + edge[across.argmax()]) / 2
    for own, circle, other, other_circle in zip(outlines, circles, outlines[::-1], circles[::-1]):
        if circle is None:
            continue
        point = own[:, 0].mean(axis=0) + circle.radius * along
        if other_circle is not None:
            inside = np.linalg.norm(point - other[:, 0].mean(axis=0)) <= other_circle.radius * (
                1 + SAME_OUTLINE
            )
        else:
            inside = inwards(point[None], other)[0] >= 0
        if inside:
            best = point
    place: NDArray[Any] = face @ np.append(best, height)
    return place


def _moving(
    part: Standing,
    center: NDArray[Any],
    pivot: NDArray[Any] | None,
    supports: Supports,
    standing: Sequence[Standing],
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Velocity (3,) of the centre of mass and spin (3,) of a part: a spin tips it over the point
    ahead on which it stands, and turns it about its foot, of several the middle.
    """
    if part.start is None:
        return np.zeros(3), np.zeros(3)
    spin, velocity = np.array(part.start.spin_rad_s), np.array(part.start.velocity_m_s)
    if pivot is None or not spin.any():
        return velocity, spin
    axis = pivot
    if not part.start.tilt_rad:

        def touched(joints: list[JointModel], ahead: NDArray[Any]) -> NDArray[Any]:
            point, joint = _pivot(standing, joints, ahead)
            where: NDArray[Any] = _rolled(standing, joint, point, np.eye(3))[0]
            where = where + center - part.center
            return where

        pivot = touched(_joints_of(supports), np.array([spin[1], -spin[0], 0.0]))
        feet = [touched(between, np.zeros(3)) for _, between in supports]
        axis = feet[0] if len(feet) == 1 else np.mean(feet, axis=0)
    level = spin * [1.0, 1.0, 0.0]
    return velocity + np.cross(level, center - pivot) + np.cross(spin - level, center - axis), spin
