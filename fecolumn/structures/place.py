"""Where bodies are at the start: as they stand, or leaning on one another without strain, with velocity and spin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.contact.rim import Rim
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.schema import InputError
from fecolumn.structures.faces import over
from fecolumn.structures.model import GROUND, BodyModel, Joint

# Over the size of a body: places that several supports give it must agree this well
_AGREE = 1e-6
# Sine of a tilt below which there is none, and share of a foot's width within which points are equally far ahead
_UPRIGHT, _EDGE = 1e-12, 1e-9


@dataclass(frozen=True)
class Standing:
    """A part before it is moved: model, place (3,) [m] of its centre of mass upright, its start as of `case.Initial` or None."""

    name: str
    model: BodyModel
    center: np.ndarray
    start: object


@dataclass(frozen=True)
class Placed:
    """Where a part is: center (3,) [m], rotation (3, 3), velocity (3,) [m/s] of the centre of mass, spin (3,) [rad/s]."""

    center: np.ndarray
    rotation: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray


def touching(standing: list[Standing], joint: Joint) -> np.ndarray:
    """Rows among the nodes of a joint's slave surface (k,) that have the master below them as the bodies stand."""
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    if joint.master == GROUND:
        return np.arange(len(surface.nodes))
    master = standing[joint.master]
    face = master.model.surfaces[joint.master_surface]
    corners = face.plane(master.model.arms[face.nodes])[:, :2]
    points = face.plane(slave.center + slave.model.arms[surface.nodes] - master.center)[:, :2]
    return np.flatnonzero(over(points, corners[face.triangles], 1e-9 * np.ptp(corners, axis=0).max()))


def placed(standing: list[Standing], joints: list[Joint], file) -> list[Placed]:
    """Places of all parts at the start.

    A part leans by its own tilt about the point of its foot that is farthest in the direction in which it leans against what it stands on; what
    stands on it keeps its own tilt, 0 unless stated, and comes along with the point on which it then stands.

    Raises:
        InputError: a part whose supports lead it to different places.
    """
    turns = [_turn(part.start) for part in standing]
    supports = _supports(standing, joints)
    found: dict[int, Placed] = {}
    for place in _from_below(supports):
        part, centers, pivot = standing[place], [], None
        for below, joint in supports[place]:
            pivot, center = _on(standing, joint, place, below, turns, found)
            centers.append(center)
        center = np.mean(centers, axis=0) if centers else part.center
        if centers and np.abs(np.array(centers) - center).max() > _AGREE * (1 + np.ptp(part.model.arms, axis=0).max()):
            raise InputError(file, f"initial.{part.name}", None, f'"{part.name}" cannot stand on bodies that lean differently: '
                             "give all that it stands on the same tilt_rad and direction_deg")
        found[place] = Placed(center, turns[place], *_moving(part, center, pivot, turns[place], supports[place], joints, standing))
    return [found[place] for place in range(len(standing))]


def _turn(start) -> np.ndarray:
    """Rotation (3, 3) of a part that leans."""
    if start is None or not start.tilt_rad:
        return np.eye(3)
    direction = np.radians(start.direction_deg)
    return rotation_matrix(start.tilt_rad * np.array([-np.sin(direction), np.cos(direction), 0.0]))


def _supports(standing, joints) -> list[list[tuple[int, Joint]]]:
    """Of each part what it stands on, GROUND or a part, and the joint between."""
    found = [[] for _ in standing]
    for joint in joints:
        down = standing[joint.slave].model.surfaces[joint.slave_surface].normal[2]
        if down < -_EDGE:
            found[joint.slave].append((joint.master, joint))
        elif down > _EDGE and joint.master != GROUND:
            found[joint.master].append((joint.slave, joint))
    return found


def _from_below(supports) -> list[int]:
    """Places of the parts, each after all that it stands on; those in a circle come last, as they are."""
    order, left = [], list(range(len(supports)))
    while left:
        ready = [place for place in left if all(below == GROUND or below in order for below, _ in supports[place])] or left
        order += ready
        left = [place for place in left if place not in ready]
    return order


def _on(standing, joint: Joint, upper: int, below: int, turns, found) -> tuple[np.ndarray, np.ndarray]:
    """Point (3,) [m] about which a part is turned on what is below it, and where its centre (3,) of mass comes."""
    part = standing[upper]
    base = np.eye(3) if below == GROUND or below not in found else found[below].rotation
    relative = base.T @ turns[upper]
    pivot = _pivot(standing, joint, relative[:, 2] * [1.0, 1.0, 0.0])

    def carried(point):
        if below == GROUND or below not in found:
            return point
        return found[below].center + base @ (point - standing[below].center)

    return carried(pivot), carried(pivot + relative @ (part.center - pivot))


def _pivot(standing, joint: Joint, ahead: np.ndarray) -> np.ndarray:
    """Point (3,) [m] of a joint farthest in the direction `ahead`, as the bodies stand; of a round rim on its circle, of an edge its middle."""
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    arms = slave.model.arms[surface.nodes]
    points = slave.center + arms[touching(standing, joint)]
    middle = points.mean(axis=0)
    length = np.linalg.norm(ahead)
    if length < _UPRIGHT:
        return middle
    ahead = ahead / length
    rim = Rim.find(surface.plane(arms)) if joint.round else None
    if rim is not None:
        return slave.center + arms[rim.nodes].mean(axis=0) + rim.radius * ahead
    far = points @ ahead
    return points[far > far.max() - _EDGE * np.ptp(points, axis=0).max()].mean(axis=0)


def _moving(part: Standing, center, pivot, turn, supports, joints, standing) -> tuple[np.ndarray, np.ndarray]:
    """Velocity (3,) of the centre of mass and spin (3,) of a part: a spin tips it over the point that it stands on, and turns it about its foot."""
    if part.start is None:
        return np.zeros(3), np.zeros(3)
    spin, velocity = np.array(part.start.spin_rad_s), np.array(part.start.velocity_m_s)
    if not supports or not spin.any():
        return velocity, spin
    axis = pivot
    if not part.start.tilt_rad:
        joint = supports[0][1]
        pivot = _pivot(standing, joint, np.array([spin[1], -spin[0], 0.0])) + center - part.center
        axis = _pivot(standing, joint, np.zeros(3)) + center - part.center
    level = spin * [1.0, 1.0, 0.0]
    return velocity + np.cross(level, center - pivot) + np.cross(spin - level, center - axis), spin
