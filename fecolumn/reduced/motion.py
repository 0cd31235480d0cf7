"""Motion of the floating frame and the modes under given contact forces, to the end of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit

# Places in `Motion.scalars`
TIME, STATIC, RIM_ANGLE, RIM_LIFT = range(4)


class Motion(NamedTuple):
    """State of the reduced column in the table frame; arrays, so that compiled code may change them.

    center, velocity, acceleration: (3,) of the centre of mass, the acceleration that HHT remembers, without contact.
    rotation: (3, 3) column to table; spin: (3,) angular velocity in the column's frame [rad/s].
    modal, modal_rate, modal_acceleration: (m,) of the modes, the last one without contact.
    elastic: (n, 3) filtered displacement of the foot's nodes in the column's frame [m].
    forces, anchors, relative, indent: (n, 3), (n, 2), (n, 3), (n, 3) as in `dynamics.system.State`. ground: (3,) acceleration of the base.
    scalars: (8,) time [s]; strain energy of base, foot's static rest, penalty springs and pad [J]; place of the rim's lowest contact
    point [rad], nan while the foot touches with its nodes only; from RIM_LIFT on the lift of it and its neighbours [m].
    """

    center: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    rotation: np.ndarray
    spin: np.ndarray
    modal: np.ndarray
    modal_rate: np.ndarray
    modal_acceleration: np.ndarray
    elastic: np.ndarray
    forces: np.ndarray
    anchors: np.ndarray
    relative: np.ndarray
    indent: np.ndarray
    ground: np.ndarray
    scalars: np.ndarray


def at_rest(n: int, m: int) -> Motion:
    """A motion of n foot nodes and m modes with zeros everywhere but an upright rotation."""
    return Motion(*(np.zeros(3) for _ in range(3)), np.eye(3), np.zeros(3), *(np.zeros(m) for _ in range(3)), np.zeros((n, 3)),
                  np.zeros((n, 3)), np.zeros((n, 2)), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(3), np.array([0.0, 0.0, np.nan, *np.zeros(5)]))


class Sway(NamedTuple):
    """What the contact does to the column in a step, for the ledger: turn (3,) [rad] in the column's frame, moment: (3,) [N m] there,
    conjugate to the turn; modal: (m,) forces on the modes; halfway: (3, 3) rotation in the middle of the step; resistance: (3,) part of
    the moment by which a rim resists to roll."""

    turn: np.ndarray
    moment: np.ndarray
    modal: np.ndarray
    halfway: np.ndarray
    resistance: np.ndarray


@njit
def copy(source, target):
    """Copy a Motion."""
    target.center[:] = source.center
    target.velocity[:] = source.velocity
    target.acceleration[:] = source.acceleration
    target.rotation[:] = source.rotation
    target.spin[:] = source.spin
    target.modal[:] = source.modal
    target.modal_rate[:] = source.modal_rate
    target.modal_acceleration[:] = source.modal_acceleration
    target.elastic[:] = source.elastic
    target.forces[:] = source.forces
    target.anchors[:] = source.anchors
    target.relative[:] = source.relative
    target.indent[:] = source.indent
    target.ground[:] = source.ground
    target.scalars[:] = source.scalars


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
def foot_displacement(pushes, modal, target):
    """target (n, 3): filtered displacement of the foot's nodes by modal coordinates (m,)."""
    n, m = len(target), len(modal)
    for i in range(n):
        for a in range(3):
            value = 0.0
            for k in range(m):
                value += pushes[i, a, k] * modal[k]
            target[i, a] = value


@njit
def turning(inertia, inverse, advance, rotation, half, spread, resistance, turn, moment, halfway):
    """Solve Th = advance/2 + J^-1 exp(-Th) (J advance/2 + half R0^T M) for the turn Th, and its moment M, in the column's frame.

    Energy-momentum conserving (Simo and Wong 1991): with M = sinc(|Th|/2) sum (Rh A) x r, Th . M is the work of the forces on the path
    of rigid arms A.

    Args:
        advance: (3,) dt times the spin at the start. spread: (3, 3) sum of A r^T, r in the table frame. resistance: (3,) added to M.
        turn: first guess, and the result. moment, halfway: results; the moment in the column's frame at the start.
    """
    momentum = np.empty(3)
    for i in range(3):
        momentum[i] = 0.5 * (inertia[i, 0] * advance[0] + inertia[i, 1] * advance[1] + inertia[i, 2] * advance[2])
    for _ in range(50):
        x, y, z = turn[0], turn[1], turn[2]
        quarter = (x * x + y * y + z * z) / 4
        sinc = 1 - quarter / 6 * (1 - quarter / 20) if quarter < 1e-4 else np.sin(np.sqrt(quarter)) / np.sqrt(quarter)
        turn_by(rotation, turn / 2, halfway)
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
def follow(column, scheme, points, start, free_center, free_modal, advance, forces, end, sway):
    """Carry the column to the end of the step under contact forces (n, 3) at the points.

    end.elastic is used as a guess and updated; end gets center, rotation, modal, elastic; sway the conjugates.
    """
    m, total, spread, arm = len(free_modal), np.zeros(3), np.zeros((3, 3)), np.empty(3)
    for i in range(len(forces)):
        r0, r1, r2 = forces[i, 0], forces[i, 1], forces[i, 2]
        if r2 == 0.0 and r0 == 0.0 and r1 == 0.0:
            continue
        for a in range(3):
            arm[a] = points.arms[i, a]
        for q in range(points.count[i]):
            carrier, w = points.carriers[i, q], points.weights[i, q] / 2
            for a in range(3):
                arm[a] += w * (start.elastic[carrier, a] + end.elastic[carrier, a])
        for a in range(3):
            spread[a, 0] += arm[a] * r0
            spread[a, 1] += arm[a] * r1
            spread[a, 2] += arm[a] * r2
            total[a] += forces[i, a]
    for a in range(3):
        end.center[a] = free_center[a] + scheme.half * total[a] / column.mass
    turning(column.inertia, column.inverse, advance, start.rotation, scheme.half, spread, sway.resistance, sway.turn, sway.moment,
            sway.halfway)
    turn_by(start.rotation, sway.turn, end.rotation)
    modal_forces(column, points, sway.halfway, forces, sway.modal)
    for k in range(m):
        end.modal[k] = scheme.shrink[k] * (free_modal[k] + scheme.half * sway.modal[k])
    foot_displacement(column.pushes, end.modal, end.elastic)


@njit
def total_force(forces):
    """Sum (3,) of forces (n, 3), of which most are zero."""
    total = np.zeros(3)
    for i in range(len(forces)):
        if forces[i, 2] > 0:
            for a in range(3):
                total[a] += forces[i, a]
    return total


@njit
def modal_forces(column, points, rotation, forces, target):
    """target (m,): what forces (n, 3) at the points, the column turned by `rotation`, do on the modes."""
    m = len(target)
    target[:] = 0.0
    if m == 0:
        return
    for i in range(len(forces)):
        r0, r1, r2 = forces[i, 0], forces[i, 1], forces[i, 2]
        if r0 == 0.0 and r1 == 0.0 and r2 == 0.0:
            continue
        for a in range(3):
            along = rotation[0, a] * r0 + rotation[1, a] * r1 + rotation[2, a] * r2
            for q in range(points.count[i]):
                share, push = points.weights[i, q] * along, column.pushes[points.carriers[i, q], a]
                for k in range(m):
                    target[k] += share * push[k]


@njit
def point_positions(points, motion, target):
    """target (n, 3): positions of the points without their static part; points.elastic gets that of the points."""
    c, R = motion.center, motion.rotation
    for i in range(len(target)):
        if points.count[i] == 1:
            u0, u1, u2 = motion.elastic[i, 0], motion.elastic[i, 1], motion.elastic[i, 2]
        else:
            u0 = u1 = u2 = 0.0
            for q in range(points.count[i]):
                w, carrier = points.weights[i, q], points.carriers[i, q]
                u0 += w * motion.elastic[carrier, 0]
                u1 += w * motion.elastic[carrier, 1]
                u2 += w * motion.elastic[carrier, 2]
        x, y, z = points.arms[i, 0] + u0, points.arms[i, 1] + u1, points.arms[i, 2] + u2
        for a in range(3):
            target[i, a] = c[a] + R[a, 0] * x + R[a, 1] * y + R[a, 2] * z
        target[i, 2] += points.lift[i]


@njit
def point_velocities(column, points, motion, wanted, target):
    """target (n, 3): velocities of the wanted points (mask)."""
    v, R, w = motion.velocity, motion.rotation, motion.spin
    arm, own = np.empty(3), np.empty(3)
    for i in range(len(target)):
        if not wanted[i]:
            continue
        arm[:] = points.arms[i]
        own[:] = 0.0
        for q in range(points.count[i]):
            carrier, weight = points.carriers[i, q], points.weights[i, q]
            for a in range(3):
                push, moved = column.pushes[carrier, a], 0.0
                for k in range(len(motion.modal)):
                    moved += push[k] * motion.modal_rate[k]
                arm[a] += weight * motion.elastic[carrier, a]
                own[a] += weight * moved
        x = own[0] + w[1] * arm[2] - w[2] * arm[1]
        y = own[1] + w[2] * arm[0] - w[0] * arm[2]
        z = own[2] + w[0] * arm[1] - w[1] * arm[0]
        for a in range(3):
            target[i, a] = v[a] + R[a, 0] * x + R[a, 1] * y + R[a, 2] * z
