"""Carry bodies and modes to the end of a step under given contact forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.arrays import put
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import MASTER, SLAVE
from fecolumn.engines.dynamics.links import pull_links
from fecolumn.engines.reduced.elastic import ACCELERATION, COORDINATE, END, RATE, START
from fecolumn.engines.reduced.motion import Action, MotionState
from fecolumn.engines.reduced.rotation import Turning, turn_by, turning
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.engines.reduced.elastic import Elastic


# Times that the motion under present forces is found anew, at most, the change, over a turn of 1 or
# the largest force of a link, at which it is found, and that at which it is not: the forces of
# links tight enough for `links_of_model.STIFFEST` change by less after as many sweeps
SWEEPS, SETTLED, UNSETTLED = 30, 1e-14, 1e-6


@njit
def begin_frames(
    structure: Any,
    start: MotionState,
    free_center: Array,
    advance: Array,
    end: MotionState,
    action: Action,
) -> None:
    """First guess of what `follow` finds of frames that move and of links: bodies that are free."""
    moving, part = len(structure.links) > 0, np.empty(3)
    for k in range(len(structure.interfaces)):
        moving |= structure.interfaces[k].master != GROUND and not end.rims[k].apart
    if not moving:
        return
    for b in range(len(start.frames)):
        for a in range(3):
            part[a], end.frames[b].center[a] = advance[b, a] / 2, free_center[b, a]
        turn_by(start.rotation[b], part, action.halfway[b])
        turn_by(start.rotation[b], advance[b], end.rotation[b])


@njit
def _turn_frames(structure: Any, action: Action) -> float:
    """Find the frames of the interfaces that carry, in the middle of the step; the largest change.

    Nothing depends on the frame of one that carries nothing.
    """
    change = 0.0
    for k in range(len(structure.interfaces)):
        b, axes = structure.interfaces[k].master, structure.interfaces[k].axes
        if b == GROUND or not action.total[k, 2] > 0.0:
            continue
        R = action.halfway[b]
        for a in range(3):
            for c in range(3):
                value = R[a, 0] * axes[0, c] + R[a, 1] * axes[1, c] + R[a, 2] * axes[2, c]
                change = max(change, abs(value - action.frames[k, a, c]))
                action.frames[k, a, c] = value
    return change


@njit
def follow(
    structure: Any,
    scheme: Any,
    points: Array,
    listed: Array,
    start: MotionState,
    free_center: Array,
    free_modal: Array,
    advance: Array,
    elastic: Elastic,
    end: MotionState,
    action: Action,
) -> bool:
    """Carry the bodies to the end of the step under the forces of `end` at the listed points (k,),
    which has all that carry, and of the links.

    Forces act along the frames that the interfaces have in the middle of the step, and links along
    their mean direction, which are found along with the motion. Returns: whether they were, and the
    turn of each body.

    The elastic displacement of points that carry is the last one known at the END, a guess; end
    gets center, rotation and modal coordinates, action the conjugates.

    Parameters
    ----------
    free_center
        (nb, 3), free_modal: (nb, m): the end of the step without contact.
    advance
        (nb, 3) dt times the spins at the start.
    """
    change, linked = 0.0, len(structure.links) > 0
    _sum_forces(points, listed, end.contact, elastic, action)
    for sweep in range(SWEEPS):
        change = _turn_frames(structure, action)
        if linked:
            change = max(change, pull_links(structure, start, end, scheme.dt, action.pulls))
        if sweep > 0 and change <= SETTLED:
            break
        if not _carry_bodies(structure, scheme, start, free_center, advance, end, action):
            return False
        if linked and free_modal.shape[1] > 0:
            _carry_modes(structure, scheme, points, listed, start, free_modal, end, action)
    _carry_modes(structure, scheme, points, listed, start, free_modal, end, action)
    elastic.now[END] += 1
    # false of what is not a number, too
    return change <= UNSETTLED


@njit
def _sum_forces(
    points: Array, listed: Array, contact: Array, elastic: Elastic, action: Action
) -> None:
    """Sums of the forces of `contact` at the listed points (k,), interface by interface, in whose
    frames they are: they turn with these.
    """
    action.total[:] = 0.0
    action.spread[:] = 0.0
    for i in listed:
        if contact[i].force[2] <= 0.0:
            continue
        k, force = points[i].interface, contact[i].force
        total, spread = action.total[k], action.spread[k]
        for a in range(3):
            total[a] += force[a]
            arm = points[i].arm[a] + (elastic.point[START, i, a] + elastic.point[END, i, a]) / 2
            for c in range(3):
                spread[SLAVE, a, c] += arm * force[c]
        if points[i].master != GROUND:
            for a in range(3):
                seat = (elastic.seat[START, i, a] + elastic.seat[END, i, a]) / 2
                for c in range(3):
                    spread[MASTER, a, c] -= seat * force[c]


@njit
def _carry_bodies(
    structure: Any,
    scheme: Any,
    start: MotionState,
    free_center: Array,
    advance: Array,
    end: MotionState,
    action: Action,
) -> bool:
    """`follow`, with frames and links where they are, without modes; whether each turn was
    found.
    """
    bodies, arm = structure.bodies.body, np.empty(3)
    spread = np.zeros((len(bodies), 3, 3))
    for b in range(len(bodies)):
        for a in range(3):
            action.push[b, a] = 0.0
    for k in range(len(structure.interfaces)):
        Q, total = action.frames[k], action.total[k]
        if not total[2] > 0.0:
            continue
        for side in range(2):
            b, sign = (
                structure.interfaces[k].master if side else structure.interfaces[k].slave,
                -1.0 if side else 1.0,
            )
            if b == GROUND:
                continue
            for c in range(3):
                action.push[b, c] += sign * (
                    Q[c, 0] * total[0] + Q[c, 1] * total[1] + Q[c, 2] * total[2]
                )
                for a in range(3):
                    along = action.spread[k, side, a]
                    spread[b, a, c] += Q[c, 0] * along[0] + Q[c, 1] * along[1] + Q[c, 2] * along[2]
    for n in range(len(structure.links)):
        for side in range(2):
            b = structure.links[n].b if side else structure.links[n].a
            if b == GROUND:
                continue
            ends = structure.links[n].arm_b if side else structure.links[n].arm_a
            for a in range(3):
                arm[a] = ends[a]
                for k in range(structure.ends.shape[3]):
                    q = (start.modal[b, COORDINATE, k] + end.modal[b, COORDINATE, k]) / 2
                    arm[a] += structure.ends[n, side, a, k] * q
            for c in range(3):
                value = -action.pulls[n, c] if side else action.pulls[n, c]
                for a in range(3):
                    spread[b, a, c] += arm[a] * value
                action.push[b, c] += value
    for b in range(len(bodies)):
        for a in range(3):
            end.frames[b].center[a] = (
                free_center[b, a] + scheme.half * action.push[b, a] * bodies[b].inverse_mass
            )
        if not turning(
            Turning(
                bodies[b],
                advance[b],
                start.rotation[b],
                scheme.half,
                spread[b],
                action.resistance[b],
                action.moment[b],
                action.halfway[b],
            ),
            action.turn[b],
        ):
            return False
        turn_by(start.rotation[b], action.turn[b], end.rotation[b])
    return True


@njit
def _carry_modes(
    structure: Any,
    scheme: Any,
    points: Array,
    listed: Array,
    start: MotionState,
    free_modal: Array,
    end: MotionState,
    action: Action,
) -> None:
    """`follow`, of the modes."""
    _push_modes(structure, points, listed, end.contact, action)
    _pull_modes(structure, start, end, action)
    for b in range(len(start.frames)):
        for k in range(free_modal.shape[1]):
            end.modal[b, COORDINATE, k] = scheme.shrink[b, k] * (
                free_modal[b, k] + scheme.half * action.modal[b, k]
            )


@njit
def _pull_modes(structure: Any, start: MotionState, end: MotionState, action: Action) -> None:
    """Add what the links do on the modes: with the mean of the rotations at both ends of the step,
    with which their work is exactly that of the forces along their ways.
    """
    if action.modal.shape[1] == 0:
        return
    for n in range(len(structure.links)):
        for side in range(2):
            b = structure.links[n].b if side else structure.links[n].a
            if b == GROUND:
                continue
            for a in range(3):
                along = 0.0
                for c in range(3):
                    mean = (start.rotation[b, c, a] + end.rotation[b, c, a]) / 2
                    along += mean * action.pulls[n, c]
                if side:
                    along = -along
                for k in range(action.modal.shape[1]):
                    action.modal[b, k] += along * structure.ends[n, side, a, k]


@njit
def _push_modes(
    structure: Any, points: Array, listed: Array, contact: Array, action: Action
) -> None:
    """Find what the forces of `contact` at the listed points (k,) do on the modes of the bodies,
    turned as they are in the middle of the step.
    """
    target = action.modal
    target[:] = 0.0
    if target.shape[1] == 0:
        return
    few, turned = 2 * len(listed) <= len(points), np.empty((len(structure.interfaces), 2, 3, 3))
    for k in range(len(structure.interfaces)):
        for side in range(2):
            b, sign = (
                structure.interfaces[k].master if side else structure.interfaces[k].slave,
                -1.0 if side else 1.0,
            )
            if b != GROUND:
                R, Q = action.halfway[b], action.frames[k]
                for a in range(3):
                    for c in range(3):
                        turned[k, side, a, c] = sign * (
                            R[0, a] * Q[0, c] + R[1, a] * Q[1, c] + R[2, a] * Q[2, c]
                        )
    nodal, along = np.zeros((0 if few else len(structure.bodies.pushes), 3)), np.empty(3)
    for i in listed:
        force = contact[i].force
        if force[2] <= 0.0:
            continue
        for side in range(2):
            b, T = points[i].master if side else points[i].slave, turned[points[i].interface, side]
            if b == GROUND:
                continue
            for a in range(3):
                along[a] = T[a, 0] * force[0] + T[a, 1] * force[1] + T[a, 2] * force[2]
            if few:
                _add_modal(
                    structure.bodies.pushes,
                    points[i],
                    side == 0,
                    along[0],
                    along[1],
                    along[2],
                    target[b],
                )
                continue
            # of whole feet: forces on their nodes first, then one product a body
            for q in range(3 if side else points[i].count):
                node, w = (
                    points[i].below[q] if side else points[i].carriers[q],
                    points[i].shares[q] if side else points[i].weights[q],
                )
                for a in range(3):
                    nodal[node, a] += w * along[a]
    if few:
        return
    loads, flat = (
        nodal.reshape(3 * len(nodal)),
        structure.bodies.pushes.reshape(3 * len(structure.bodies.pushes), target.shape[1]),
    )
    for b in range(len(target)):
        first, count = structure.bodies.body[b].first, structure.bodies.body[b].count
        put(
            loads[3 * first : 3 * (first + count)] @ flat[3 * first : 3 * (first + count)],
            target[b],
        )


@njit
def _add_modal(
    pushes: Array, point: Record, on: bool, x: float, y: float, z: float, target: Array
) -> None:
    """Add to target (m,) what the force (x, y, z) at a point of POINT, in the body's frame, does on
    the modes of its slave, `on`, or of its master.
    """
    for q in range(point.count if on else 3):
        node, share = (
            (point.carriers[q], point.weights[q]) if on else (point.below[q], point.shares[q])
        )
        first, second, third = pushes[node, 0], pushes[node, 1], pushes[node, 2]
        for k in range(len(target)):
            target[k] += share * (x * first[k] + y * second[k] + z * third[k])


@njit
def push_bodies(
    structure: Any,
    scheme: Any,
    points: Array,
    arms: Array,
    poses: Array,
    impulses: Array,
    motion: MotionState,
) -> None:
    """Velocity jump by impulses (P, 3) [N s] on the slaves at the points with `arms` (P, 3) [m], in
    the frames of their interfaces, and by the opposite on the masters.
    """
    jump, arm, pushed = np.empty(motion.modal.shape[2]), np.empty(3), np.empty(3)
    for b in range(len(motion.frames)):
        body, R, moment = structure.bodies.body[b], motion.rotation[b], np.zeros(3)
        jump[:] = 0.0
        for i in range(len(points)):
            p0, p1, p2, on = impulses[i, 0], impulses[i, 1], impulses[i, 2], points[i].slave == b
            if not (on or points[i].master == b) or p0 == 0.0 and p1 == 0.0 and p2 == 0.0:
                continue
            if points[i].master != GROUND:
                Q = poses[points[i].interface].frame
                for a in range(3):
                    pushed[a] = Q[a, 0] * p0 + Q[a, 1] * p1 + Q[a, 2] * p2
                p0, p1, p2 = pushed[0], pushed[1], pushed[2]
            if not on:
                p0, p1, p2 = -p0, -p1, -p2
            motion.frames[b].velocity[0] += p0 * body.inverse_mass
            motion.frames[b].velocity[1] += p1 * body.inverse_mass
            motion.frames[b].velocity[2] += p2 * body.inverse_mass
            for a in range(3):
                arm[a] = arms[i, a] if on else points[i].seat[a]
            b0, b1, b2 = (
                R[0, 0] * p0 + R[1, 0] * p1 + R[2, 0] * p2,
                R[0, 1] * p0 + R[1, 1] * p1 + R[2, 1] * p2,
                R[0, 2] * p0 + R[1, 2] * p1 + R[2, 2] * p2,
            )
            moment[0] += arm[1] * b2 - arm[2] * b1
            moment[1] += arm[2] * b0 - arm[0] * b2
            moment[2] += arm[0] * b1 - arm[1] * b0
            if len(jump) == 0:
                continue
            _add_modal(structure.bodies.pushes, points[i], on, b0, b1, b2, jump)
        J = body.inverse_inertia
        for a in range(3):
            motion.frames[b].spin[a] += (
                J[a, 0] * moment[0] + J[a, 1] * moment[1] + J[a, 2] * moment[2]
            )
        for k in range(len(jump)):
            motion.modal[b, RATE, k] += jump[k]
            # the damping that HHT remembers is that of the new rates
            motion.modal[b, ACCELERATION, k] -= (
                (1 + scheme.alpha) * structure.damping[b, k] * jump[k]
            )
