"""Motion of floating frames and modes under given contact forces, to the end of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.arrays import put, put_matrix
from fecolumn.contact.interface import rims_at_rest
from fecolumn.contact.points import CONTACT
from fecolumn.contact.record import record
from fecolumn.reduced.elastic import ACCELERATION, COORDINATE, END, RATE, START
from fecolumn.reduced.rotation import turn_by, turning

#: A body's frame: center of mass [m], its velocity [m/s] and the acceleration that HHT remembers, without contact [m/s2]; spin: angular velocity in
#: the body's frame [rad/s].
FRAME = record(("center", "f8", 3), ("velocity", "f8", 3), ("acceleration", "f8", 3), ("spin", "f8", 3))
#: What belongs to no body: time [s]; static: strain energy of base, static rest of the bodies, penalty springs and pad [J]; ground: acceleration [m/s2].
WHOLE = record(("time", "f8"), ("static", "f8"), ("ground", "f8", 3))

class Motion(NamedTuple):
    """State of a structure in the table frame; arrays, so that compiled code may change them.

    frames: (nb,) of FRAME; rotation: (nb, 3, 3) body to table; modal: (nb, 3, m) of unit modal mass; contact: (P,) of CONTACT; rims: (ni,) of RIM;
    whole: (1,) of WHOLE.
    """

    frames: np.ndarray
    rotation: np.ndarray
    modal: np.ndarray
    contact: np.ndarray
    rims: np.ndarray
    whole: np.ndarray

    @property
    def time(self) -> float:
        """[s]"""
        return float(self.whole["time"][0])

    @property
    def forces(self) -> np.ndarray:
        """Contact forces (P, 3) on the bodies [N]."""
        return self.contact["force"]


def at_rest(points: int, modes: int, bodies: int = 1, interfaces: int = 1) -> Motion:
    """Zeros everywhere but for upright rotations."""
    return Motion(np.zeros(bodies, FRAME), np.tile(np.eye(3), (bodies, 1, 1)), np.zeros((bodies, 3, modes)), np.zeros(points, CONTACT),
                  rims_at_rest(interfaces), np.zeros(1, WHOLE))


class Action(NamedTuple):
    """What contact does to the bodies in a step, for the ledger: turn: (nb, 3) [rad] in a body's frame, moment: (nb, 3) [N m] there, conjugate to
    the turn; push: (nb, 3) force [N]; modal: (nb, m) forces on the modes; halfway: (nb, 3, 3) rotation in the middle of the step; resistance: (nb, 3) part of
    the moment by which a rim resists to roll."""

    turn: np.ndarray
    moment: np.ndarray
    push: np.ndarray
    modal: np.ndarray
    halfway: np.ndarray
    resistance: np.ndarray


def no_action(modes: int, bodies: int = 1) -> Action:
    return Action(*(np.zeros((bodies, 3)) for _ in range(3)), np.zeros((bodies, modes)), np.zeros((bodies, 3, 3)), np.zeros((bodies, 3)))


@njit
def copy(source, target):
    """Copy a Motion."""
    for b in range(len(source.frames)):
        target.frames[b] = source.frames[b]
    for i in range(len(source.contact)):
        target.contact[i] = source.contact[i]
    for k in range(len(source.rims)):
        target.rims[k] = source.rims[k]
    target.whole[0] = source.whole[0]
    for b in range(len(source.frames)):
        put_matrix(source.rotation[b], target.rotation[b])
        put_matrix(source.modal[b], target.modal[b])


@njit
def follow(structure, scheme, points, listed, start, free_center, free_modal, advance, elastic, end, action):
    """Carry the bodies to the end of the step under the forces of `end` at the listed points (k,), which has all that carry.

    The elastic displacement of points that carry is the last one known at the END, a guess; end gets center, rotation and modal
    coordinates, action the conjugates.

    Args:
        free_center: (nb, 3), free_modal: (nb, m): the end of the step without contact. advance: (nb, 3) dt times the spins at the start.
    """
    bodies = structure.bodies.body
    for b in range(len(bodies)):
        spread, arm = np.zeros((3, 3)), np.empty(3)
        for a in range(3):
            action.push[b, a] = 0.0
        for i in listed:
            if points[i].slave != b or end.contact[i].force[2] <= 0.0:
                continue
            for a in range(3):
                arm[a] = points[i].arm[a] + (elastic.point[START, i, a] + elastic.point[END, i, a]) / 2
            for a in range(3):
                for c in range(3):
                    spread[a, c] += arm[a] * end.contact[i].force[c]
                action.push[b, a] += end.contact[i].force[a]
        for a in range(3):
            end.frames[b].center[a] = free_center[b, a] + scheme.half * action.push[b, a] / bodies[b].mass
        turning(bodies[b], advance[b], start.rotation[b], scheme.half, spread, action.resistance[b], action.turn[b], action.moment[b], action.halfway[b])
        turn_by(start.rotation[b], action.turn[b], end.rotation[b])
        modal_forces(structure, points, listed, b, action.halfway[b], end.contact, action.modal[b])
        for k in range(free_modal.shape[1]):
            end.modal[b, COORDINATE, k] = scheme.shrink[b, k] * (free_modal[b, k] + scheme.half * action.modal[b, k])
    elastic.now[END] += 1


@njit
def modal_forces(structure, points, listed, b, rotation, contact, target):
    """target (m,): what the forces of `contact` at the listed points (k,) do on the modes of body b turned by `rotation`."""
    target[:] = 0.0
    if len(target) == 0:
        return
    if 2 * len(listed) <= len(points):
        for i in listed:
            if points[i].slave == b and contact[i].force[2] > 0.0:
                _add_modal(structure.pushes, points[i], rotation, contact[i].force[0], contact[i].force[1], contact[i].force[2], target)
        return
    # of a whole foot: forces on its nodes first, then one product
    first, count = structure.bodies.body[b].first, structure.bodies.body[b].count
    nodal, flat = np.zeros(3 * count), structure.pushes.reshape(3 * len(structure.pushes), len(target))
    for i in listed:
        r0, r1, r2 = contact[i].force[0], contact[i].force[1], contact[i].force[2]
        if points[i].slave == b and r2 > 0.0:
            for a in range(3):
                along = rotation[0, a] * r0 + rotation[1, a] * r1 + rotation[2, a] * r2
                for q in range(points[i].count):
                    nodal[3 * (points[i].carriers[q] - first) + a] += points[i].weights[q] * along
    put(nodal @ flat[3 * first:3 * (first + count)], target)


@njit
def _add_modal(pushes, point, rotation, x, y, z, target):
    """Add to target (m,) what the force (x, y, z) at a point of POINT does on the modes."""
    for a in range(3):
        along = rotation[0, a] * x + rotation[1, a] * y + rotation[2, a] * z
        for q in range(point.count):
            share, push = point.weights[q] * along, pushes[point.carriers[q], a]
            for k in range(len(target)):
                target[k] += share * push[k]


@njit
def push_bodies(structure, scheme, points, arms, impulses, motion):
    """Velocity jump by impulses (P, 3) [N s] at the points with `arms` (P, 3) [m]."""
    jump = np.empty(motion.modal.shape[2])
    for b in range(len(motion.frames)):
        body, R, moment = structure.bodies.body[b], motion.rotation[b], np.zeros(3)
        jump[:] = 0.0
        for i in range(len(points)):
            p0, p1, p2 = impulses[i, 0], impulses[i, 1], impulses[i, 2]
            if points[i].slave != b or p0 == 0.0 and p1 == 0.0 and p2 == 0.0:
                continue
            for a in range(3):
                motion.frames[b].velocity[a] += impulses[i, a] / body.mass
            b0, b1, b2 = (R[0, 0] * p0 + R[1, 0] * p1 + R[2, 0] * p2, R[0, 1] * p0 + R[1, 1] * p1 + R[2, 1] * p2,
                          R[0, 2] * p0 + R[1, 2] * p1 + R[2, 2] * p2)
            moment[0] += arms[i, 1] * b2 - arms[i, 2] * b1
            moment[1] += arms[i, 2] * b0 - arms[i, 0] * b2
            moment[2] += arms[i, 0] * b1 - arms[i, 1] * b0
            _add_modal(structure.pushes, points[i], R, p0, p1, p2, jump)
        J = body.inverse_inertia
        for a in range(3):
            motion.frames[b].spin[a] += J[a, 0] * moment[0] + J[a, 1] * moment[1] + J[a, 2] * moment[2]
        for k in range(len(jump)):
            motion.modal[b, RATE, k] += jump[k]
            # the damping that HHT remembers is that of the new rates
            motion.modal[b, ACCELERATION, k] -= (1 + scheme.alpha) * structure.damping[b, k] * jump[k]
