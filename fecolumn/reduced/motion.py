"""Motion of floating frames and modes under given contact forces, to the end of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.arrays import put_matrix
from fecolumn.contact.interface import RIM
from fecolumn.contact.points import CONTACT
from fecolumn.contact.record import record

#: A body's frame: center of mass [m], its velocity [m/s] and the acceleration that HHT remembers, without contact [m/s2]; spin: angular velocity in
#: the body's frame [rad/s].
FRAME = record(("center", "f8", 3), ("velocity", "f8", 3), ("acceleration", "f8", 3), ("spin", "f8", 3))
#: What belongs to no body: time [s]; static: strain energy of base, static rest of the bodies, penalty springs and pad [J]; ground: acceleration [m/s2].
WHOLE = record(("time", "f8"), ("static", "f8"), ("ground", "f8", 3))

# Rows of Motion.modal: coordinate, rate, and the acceleration that HHT remembers, without contact
COORDINATE, RATE, ACCELERATION = range(3)


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
    motion = Motion(np.zeros(bodies, FRAME), np.tile(np.eye(3), (bodies, 1, 1)), np.zeros((bodies, 3, modes)), np.zeros(points, CONTACT),
                    np.zeros(interfaces, RIM), np.zeros(1, WHOLE))
    motion.rims["angle"] = np.nan
    return motion


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


class Elastic(NamedTuple):
    """Elastic displacement at the START and at the END of a step, found where it is wanted. node: (2, N, 3) [m] of nodes, stamp: (2, N) with which they are
    up to date, now: (2,) the present stamps; point: (2, P, 3) of points, in their slaves' frames."""

    node: np.ndarray
    stamp: np.ndarray
    now: np.ndarray
    point: np.ndarray


START, END = range(2)


def no_elastic(nodes: int, points: int) -> Elastic:
    return Elastic(np.zeros((2, nodes, 3)), np.zeros((2, nodes), np.int64), np.zeros(2, np.int64), np.zeros((2, points, 3)))


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
def turn_by(rotation, vector, target):
    """target = rotation exp(vector), by Rodrigues' formula; orthonormal to rounding if `rotation` is nearly so."""
    x, y, z = vector[0], vector[1], vector[2]
    square = x * x + y * y + z * z
    angle = np.sqrt(square)
    if angle < 1e-4:
        a, b = 1 - square / 6, 0.5 - square / 24
    else:
        a, b = np.sin(angle) / angle, (1 - np.cos(angle)) / square
    e00, e01, e02 = 1 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    e10, e11, e12 = b * x * y + a * z, 1 - b * (x * x + z * z), b * y * z - a * x
    e20, e21, e22 = b * x * z - a * y, b * y * z + a * x, 1 - b * (x * x + y * y)
    for i in range(3):
        r0, r1, r2 = rotation[i, 0], rotation[i, 1], rotation[i, 2]
        target[i, 0] = r0 * e00 + r1 * e10 + r2 * e20
        target[i, 1] = r0 * e01 + r1 * e11 + r2 * e21
        target[i, 2] = r0 * e02 + r1 * e12 + r2 * e22


@njit
def orthonormal(rotation):
    """Take the rounding of many turns out of a rotation, in place: R (3 - R^T R) / 2."""
    product = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            product[i, j] = rotation[0, i] * rotation[0, j] + rotation[1, i] * rotation[1, j] + rotation[2, i] * rotation[2, j]
    for i in range(3):
        r0, r1, r2 = rotation[i, 0], rotation[i, 1], rotation[i, 2]
        for j in range(3):
            rotation[i, j] = 1.5 * rotation[i, j] - 0.5 * (r0 * product[0, j] + r1 * product[1, j] + r2 * product[2, j])


@njit(fastmath={"reassoc", "contract"})
def _node_displacement(pushes, coordinates, node, target):
    """target (3,): filtered displacement of a node by modal coordinates (m,)."""
    x = y = z = 0.0
    for k in range(len(coordinates)):
        x += pushes[node, 0, k] * coordinates[k]
        y += pushes[node, 1, k] * coordinates[k]
        z += pushes[node, 2, k] * coordinates[k]
    target[0], target[1], target[2] = x, y, z


@njit
def find_elastic(structure, points, i, motion, elastic, when):
    """Find the elastic displacement of point i in a motion at START or END of a step."""
    b = points[i].slave
    x = y = z = 0.0
    for q in range(points[i].count):
        node, w = points[i].carriers[q], points[i].weights[q]
        if elastic.stamp[when, node] != elastic.now[when]:
            elastic.stamp[when, node] = elastic.now[when]
            _node_displacement(structure.pushes, motion.modal[b, COORDINATE], node, elastic.node[when, node])
        x += w * elastic.node[when, node, 0]
        y += w * elastic.node[when, node, 1]
        z += w * elastic.node[when, node, 2]
    elastic.point[when, i, 0], elastic.point[when, i, 1], elastic.point[when, i, 2] = x, y, z


@njit
def find_places(structure, points, motion, elastic, wanted, places):
    """places (N, 3): positions at the START of the wanted nodes (mask) of the points, without their static part."""
    for i in range(len(points)):
        node, b = points[i].node, points[i].slave
        if not wanted[node]:
            continue
        if elastic.stamp[START, node] != elastic.now[START]:
            elastic.stamp[START, node] = elastic.now[START]
            _node_displacement(structure.pushes, motion.modal[b, COORDINATE], node, elastic.node[START, node])
        arms, moved = structure.bodies.arms, elastic.node[START]
        x, y, z = arms[node, 0] + moved[node, 0], arms[node, 1] + moved[node, 1], arms[node, 2] + moved[node, 2]
        for a in range(3):
            places[node, a] = motion.frames[b].center[a] + motion.rotation[b, a, 0] * x + motion.rotation[b, a, 1] * y + motion.rotation[b, a, 2] * z


@njit
def find_position(points, i, motion, elastic, when, target):
    """target (3,): position of point i without its static part, its elastic displacement being known."""
    b, u = points[i].slave, elastic.point[when, i]
    x, y, z = points[i].arm[0] + u[0], points[i].arm[1] + u[1], points[i].arm[2] + u[2]
    for a in range(3):
        target[a] = motion.frames[b].center[a] + motion.rotation[b, a, 0] * x + motion.rotation[b, a, 1] * y + motion.rotation[b, a, 2] * z
    target[2] += points[i].lift


@njit
def locate_start(structure, points, i, start, elastic, before, place):
    """Elastic displacement at the START of a step of point i, which was open, and where it was, unless the step before located it; place: (3,) room."""
    find_elastic(structure, points, i, start, elastic, START)
    if before[i].located:
        return
    find_position(points, i, start, elastic, START, place)
    for a in range(3):
        before[i].relative[a] = place[a]
        if a < 2:
            before[i].anchor[a] = place[a]
    before[i].located = True


@njit
def turning(body, advance, rotation, half, spread, resistance, turn, moment, halfway):
    """Solve Th = advance/2 + J^-1 exp(-Th) (J advance/2 + half R0^T M) for the turn Th, and its moment M, in the column's frame.

    Energy-momentum conserving (Simo and Wong 1991): with M = sinc(|Th|/2) sum (Rh A) x r, Th . M is the work of the forces on the path
    of rigid arms A.

    Args:
        body: of BODY. advance: (3,) dt times the spin at the start. spread: (3, 3) sum of A r^T, r in the table frame. resistance: (3,) added to M.
        turn: first guess, and the result. moment, halfway: results; the moment in the column's frame at the start.
    """
    momentum, part, inertia, inverse = np.empty(3), np.empty(3), body.inertia, body.inverse_inertia
    for i in range(3):
        momentum[i] = 0.5 * (inertia[i, 0] * advance[0] + inertia[i, 1] * advance[1] + inertia[i, 2] * advance[2])
    for _ in range(50):
        x, y, z = turn[0], turn[1], turn[2]
        quarter = (x * x + y * y + z * z) / 4
        sinc = 1 - quarter / 6 * (1 - quarter / 20) if quarter < 1e-4 else np.sin(np.sqrt(quarter)) / np.sqrt(quarter)
        part[0], part[1], part[2] = x / 2, y / 2, z / 2
        turn_by(rotation, part, halfway)
        # arms turned into the table frame: B = Rh spread
        m0 = m1 = m2 = 0.0
        for a in range(3):
            m0 += halfway[1, a] * spread[a, 2] - halfway[2, a] * spread[a, 1]
            m1 += halfway[2, a] * spread[a, 0] - halfway[0, a] * spread[a, 2]
            m2 += halfway[0, a] * spread[a, 1] - halfway[1, a] * spread[a, 0]
        for i in range(3):
            moment[i] = sinc * (rotation[0, i] * m0 + rotation[1, i] * m1 + rotation[2, i] * m2) + resistance[i]
        b0, b1, b2 = momentum[0] + half * moment[0], momentum[1] + half * moment[1], momentum[2] + half * moment[2]
        # exp(-Th) b
        square = x * x + y * y + z * z
        if square < 1e-8:
            s, c = 1 - square / 6, 0.5 - square / 24
        else:
            angle = np.sqrt(square)
            s, c = np.sin(angle) / angle, (1 - np.cos(angle)) / square
        k0, k1, k2 = y * b2 - z * b1, z * b0 - x * b2, x * b1 - y * b0
        l0, l1, l2 = y * k2 - z * k1, z * k0 - x * k2, x * k1 - y * k0
        b0, b1, b2 = b0 - s * k0 + c * l0, b1 - s * k1 + c * l1, b2 - s * k2 + c * l2
        change = 0.0
        for i in range(3):
            new = 0.5 * advance[i] + inverse[i, 0] * b0 + inverse[i, 1] * b1 + inverse[i, 2] * b2
            change = max(change, abs(new - turn[i]))
            turn[i] = new
        if change <= 1e-17 + 2e-16 * (abs(turn[0]) + abs(turn[1]) + abs(turn[2])):
            break


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
    for i in listed:
        if points[i].slave == b and contact[i].force[2] > 0.0:
            _add_modal(structure.pushes, points[i], rotation, contact[i].force[0], contact[i].force[1], contact[i].force[2], target)


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
def find_velocity(structure, points, i, motion, elastic, when, target):
    """target (3,): velocity of point i in a motion, its elastic displacement being known."""
    b, u = points[i].slave, elastic.point[when, i]
    R, w, moved = motion.rotation[b], motion.frames[b].spin, np.empty(3)
    v0 = v1 = v2 = 0.0
    for q in range(points[i].count):
        _node_displacement(structure.pushes, motion.modal[b, RATE], points[i].carriers[q], moved)
        v0 += points[i].weights[q] * moved[0]
        v1 += points[i].weights[q] * moved[1]
        v2 += points[i].weights[q] * moved[2]
    x, y, z = points[i].arm[0] + u[0], points[i].arm[1] + u[1], points[i].arm[2] + u[2]
    v0, v1, v2 = v0 + w[1] * z - w[2] * y, v1 + w[2] * x - w[0] * z, v2 + w[0] * y - w[1] * x
    for a in range(3):
        target[a] = motion.frames[b].velocity[a] + R[a, 0] * v0 + R[a, 1] * v1 + R[a, 2] * v2


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
