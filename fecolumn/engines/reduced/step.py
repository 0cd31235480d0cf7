"""One step of a reduced structure: HHT for translation and modes, an energy-momentum rule for
rotation, contact, impact.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.arrays import put
from fecolumn.contact.ball import remove_lift
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import SLAVE, find_poses, move_grounds
from fecolumn.contact.problem import NO_ROOM, OK, list_present, near_points
from fecolumn.contact.rolling import (
    least_rim_width,
    mark_rolling,
    plan_roll,
    roll_points,
    rolling_moment,
    stay,
)
from fecolumn.contact.tolerances import CREATED
from fecolumn.contact.two_sided import mark_unused, place_overlaps
from fecolumn.contact.work import move_anchors
from fecolumn.engines.reduced.balls import roll_balls
from fecolumn.engines.reduced.elastic import ACCELERATION, COORDINATE, END, RATE, START, find_places
from fecolumn.engines.reduced.equilibrium import find_equilibrium
from fecolumn.engines.reduced.found import lay_found
from fecolumn.engines.reduced.impact_of_step import take_impact
from fecolumn.engines.reduced.ledger import book
from fecolumn.engines.reduced.rigid_loss import follow_impact
from fecolumn.engines.reduced.rotation import orthonormal, turn_by
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.projection import GroundTops
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Scheme, Structure
    from fecolumn.engines.reduced.motion import MotionState


@njit
def step(
    structure: Structure,
    base: GroundTops,
    scheme: Scheme,
    work: Work,
    start: MotionState,
    ground: Array,
    end: MotionState,
    ledger: Array,
    counts: Array,
) -> int:
    """Carry `start` to `end`, one scheme.dt later, under the accelerations (3 G,) of the grounds;
    the steps of `dynamics.stepper`.

    Returns: OK, or the code of what failed; then `start` is unharmed and `ledger` is not to
    be used.
    """
    booked, interfaces, weight = ledger.copy(), structure.interfaces, 0.0
    move_grounds(start.grounds, ground, scheme.dt, end.grounds)
    rolled = place_points_of_step(structure, scheme.dt, work, start, end, scheme.rolls)
    if lay_found(structure, scheme.dt, work, start, end) != OK:
        return NO_ROOM
    answer, contact_work = _advance_without_impact(
        structure, base, scheme, work, start, ground, end, ledger, counts
    )
    for b in range(len(start.frames)):
        weight += structure.bodies.body[b].mass
    weight *= np.sqrt(
        structure.gravity[0] ** 2 + structure.gravity[1] ** 2 + structure.gravity[2] ** 2
    )
    if answer == OK and rolled and contact_work > CREATED * weight * least_rim_width(interfaces):
        # several points of the rim carry while it rolls fast: they stay for this step. No
        # recursion: numba cannot load it from its cache
        put(booked, ledger)
        place_points_of_step(structure, scheme.dt, work, start, end, False)
        lay_found(structure, scheme.dt, work, start, end)
        answer, contact_work = _advance_without_impact(
            structure, base, scheme, work, start, ground, end, ledger, counts
        )
    if answer == OK:
        answer = take_impact(
            structure, base, scheme, work, start, end, contact_work, booked, ledger, counts
        )
        if answer == OK:
            follow_impact(structure, work, end, scheme.dt, ledger)
    return answer


@njit
def place_points_of_step(
    structure: Structure, dt: float, work: Work, start: MotionState, end: MotionState, allowed: bool
) -> bool:
    """Place the points of a step, and bring what they carry to them; end gets the state of the
    rims. Returns: whether any rim rolled.
    """
    rolled, part, halfway, poses = False, np.empty(3), work.action.halfway, work.poses
    find_poses(
        structure.interfaces, start.grounds, start.frames, start.rotation, poses[START], None
    )
    for b in range(len(start.frames)):
        for a in range(3):
            part[a] = dt / 2 * start.frames[b].spin[a]
        turn_by(start.rotation[b], part, halfway[b])
    # turned alone: where the bodies go does not matter here
    find_poses(structure.interfaces, start.grounds, start.frames, halfway, poses[END], None)
    for i in range(len(work.points)):
        work.before[i] = start.contact[i]
        if i < structure.found.point:
            # of rims, balls and raised points it is found anew
            work.points[i].lift = 0.0
    for k in range(len(structure.interfaces)):
        end.rims[k] = start.rims[k]
    mark_unused(structure.overlaps, structure.interfaces, start.frames, poses[START], end.rims)
    for k in range(len(structure.interfaces)):
        n, first = structure.interfaces[k].rim_count, structure.interfaces[k].rim_first
        if structure.interfaces[k].ball > 0.0:
            remove_lift(work.points, k)
        if n > 0 and not end.rims[k].unused:
            rolled |= _place_rim(
                structure, k, structure.rim[first : first + n], work, start, end, allowed
            )
        if structure.interfaces[k].ball > 0.0:
            roll_balls(structure, k, work, start, end)
    lay_points(structure, dt, work, start, end)
    return rolled


@njit
def lay_points(
    structure: Structure, dt: float, work: Work, start: MotionState, end: MotionState
) -> None:
    """Lay the points of joints with two sides, for a step dt [s]."""
    if len(structure.overlaps.joints) == 0:
        return
    ways = np.empty((len(start.frames), 2))
    for b in range(len(start.frames)):
        v, w = start.frames[b].velocity, start.frames[b].spin
        ways[b, 0] = dt * np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        ways[b, 1] = dt * np.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    if place_overlaps(
        structure.overlaps,
        structure.interfaces,
        structure.rim,
        structure.bodies.arms,
        ways,
        start.frames,
        work.poses[START],
        start.contact,
        end.rims,
        work.points,
        work.before,
    ):
        list_present(work.problem, work.points)
        # the operator is that of other points
        work.stick.key[1] = 0.0


@njit
def _place_rim(
    structure: Structure,
    k: int,
    rim: Array,
    work: Work,
    start: MotionState,
    end: MotionState,
    allowed: bool,
) -> bool:
    """`place_points_of_step` of the round rim of interface k: whether it rolled."""
    points, now, then = work.points, work.poses[START, k].turned, work.poses[END, k].turned
    rolls, tilt, roll = plan_roll(
        structure.interfaces[k], rim, start.rims[k], start.contact, now[SLAVE], then[SLAVE], allowed
    )
    if rolls:
        for i in rim:
            work.wanted[points[i].node] = False
        mark_rolling(roll, rim, points, start.contact, work.wanted)
        find_places(
            structure,
            points,
            rim,
            start,
            work.poses[START, k],
            work.elastic,
            work.wanted,
            work.places,
        )
        roll_points(
            roll,
            rim,
            end.rims[k],
            structure.bodies.arms,
            work.places,
            start.contact,
            points,
            work.before,
        )
    else:
        stay(roll, rim, end.rims[k], tilt, structure.bodies.arms, points)
    return rolls


@njit
def _advance_without_impact(
    structure: Structure,
    base: GroundTops,
    scheme: Scheme,
    work: Work,
    start: MotionState,
    ground: Array,
    end: MotionState,
    ledger: Array,
    counts: Array,
) -> tuple[int, float]:
    """`step` with the points where they are and without impact: OK or the code of what failed, and
    the energy that contact created.

    The contact force r acts at the end of the step and is kept out of the accelerations that HHT
    remembers; the rotation is energy-momentum conserving whatever alpha is, since HHT does not damp
    rigid motion.
    """
    dt, al, be, gravity, action = (
        scheme.dt,
        scheme.alpha,
        scheme.beta,
        structure.gravity,
        work.action,
    )
    bodies, m = len(start.frames), start.modal.shape[2]
    free_center, free_modal, advance = (
        np.empty((bodies, 3)),
        np.empty((bodies, m)),
        np.empty((bodies, 3)),
    )
    for b in range(bodies):
        held = structure.bodies.body[b].held
        for a in range(3):
            action.resistance[b, a] = 0.0
            if held >= 0:
                way = end.grounds[held].place[a] - start.grounds[held].place[a]
                free_center[b, a], advance[b, a] = start.frames[b].center[a] + way, 0.0
                end.frames[b].acceleration[a] = 0.0
                continue
            before, now = gravity[a] - start.whole[0].ground[a], gravity[a] - ground[a]
            end.frames[b].acceleration[a] = (1 + al) * now - al * before
            memory = (0.5 - be) * start.frames[b].acceleration[a] + be * end.frames[b].acceleration[
                a
            ]
            free_center[b, a] = (
                start.frames[b].center[a] + dt * start.frames[b].velocity[a] + dt**2 * memory
            )
            advance[b, a] = dt * start.frames[b].spin[a]
        for k in range(m):
            q, rate = start.modal[b, COORDINATE, k], start.modal[b, RATE, k]
            memory = (0.5 - be) * start.modal[b, ACCELERATION, k] + be * al * structure.squares[
                b, k
            ] * q
            free_modal[b, k] = q + dt * rate + dt**2 * memory
            if structure.damping[b, k] > 0.0:
                way, later = _predictor(scheme, start, b, k)
                free_modal[b, k] += (
                    structure.damping[b, k]
                    * dt
                    * (be * dt * (al * rate - (1 + al) * later) + (1 + al) * scheme.gamma * way)
                )
    for k in range(len(structure.interfaces)):
        if structure.interfaces[k].rolling > 0.0:
            _add_rolling_resistance(structure, k, work, start, dt)
    answer = find_equilibrium(
        structure,
        base,
        scheme,
        work,
        start,
        free_center,
        free_modal,
        advance,
        end.rims,
        end,
        counts,
    )
    if answer != OK:
        return answer, 0.0
    _finish(structure, scheme, work, start, ground, end)
    return OK, book(structure, scheme, work, start, end, ledger)


@njit
def _add_rolling_resistance(
    structure: Structure, k: int, work: Work, start: MotionState, dt: float
) -> None:
    """Add to the action on slave and master what resists that the rim of interface k rolls."""
    interface, pose, resistance = (
        structure.interfaces[k],
        work.poses[START, k],
        work.action.resistance,
    )
    b, m, load = interface.slave, interface.master, 0.0
    for i in range(len(work.before)):
        if work.points[i].interface == k:
            load += max(work.before[i].force[2], 0.0)
    spin, inverse, into = np.empty(3), np.empty((3, 3)), np.empty((3, 3))
    for a in range(3):
        spin[a] = start.frames[b].spin[a]
        for c in range(3):
            inverse[a, c] = structure.bodies.body[b].inverse_inertia[a, c]
            # from the master's frame into the slave's
            into[a, c] = 0.0
            if m != GROUND:
                for e in range(3):
                    into[a, c] += start.rotation[b, e, a] * start.rotation[m, e, c]
    if m != GROUND:
        other = structure.bodies.body[m].inverse_inertia
        for a in range(3):
            for c in range(3):
                spin[a] -= into[a, c] * start.frames[m].spin[c]
                for e in range(3):
                    for f in range(3):
                        inverse[a, c] += into[a, e] * other[e, f] * into[c, f]
    moment = rolling_moment(
        pose.turned[SLAVE], spin, load, interface.radius, interface.rolling, inverse, dt
    )
    for a in range(3):
        resistance[b, a] += moment[a]
        if m != GROUND:
            for c in range(3):
                resistance[m, a] -= into[c, a] * moment[c]


@njit
def _predictor(scheme: Scheme, start: MotionState, b: int, k: int) -> tuple[float, float]:
    """Coordinate and rate of a mode at the end of the step without new accelerations: as
    Stage.target and Stage.velocity.
    """
    dt, rate, before = scheme.dt, start.modal[b, RATE, k], start.modal[b, ACCELERATION, k]
    return start.modal[b, COORDINATE, k] + dt * (
        rate + dt * (0.5 - scheme.beta) * before
    ), rate + dt * (1 - scheme.gamma) * before


@njit
def _finish(
    structure: Structure,
    scheme: Scheme,
    work: Work,
    start: MotionState,
    ground: Array,
    end: MotionState,
) -> None:
    """Velocities, accelerations and anchors at the end of the step."""
    dt, al, ga, action, momentum, carried = (
        scheme.dt,
        scheme.alpha,
        scheme.gamma,
        work.action,
        np.empty(3),
        np.empty(3),
    )
    for b in range(len(start.frames)):
        body = structure.bodies.body[b]
        J, inverse, spin = body.inertia, body.inverse_inertia, start.frames[b].spin
        for a in range(3):
            acceleration = (
                (1 - ga) * start.frames[b].acceleration[a]
                + ga * end.frames[b].acceleration[a]
                + action.push[b, a] * body.inverse_mass
            )
            end.frames[b].velocity[a] = (
                end.grounds[body.held].velocity[a]
                if body.held >= 0
                else start.frames[b].velocity[a] + dt * acceleration
            )
            momentum[a] = (
                J[a, 0] * spin[0] + J[a, 1] * spin[1] + J[a, 2] * spin[2] + dt * action.moment[b, a]
            )
            carried[a] = 0.0
        # into the body's frame at the end: exp(-Th) = R1^T R0
        R0, R1 = start.rotation[b], end.rotation[b]
        for c in range(3):
            along = R0[c, 0] * momentum[0] + R0[c, 1] * momentum[1] + R0[c, 2] * momentum[2]
            for a in range(3):
                carried[a] += R1[c, a] * along
        for a in range(3):
            end.frames[b].spin[a] = (
                inverse[a, 0] * carried[0] + inverse[a, 1] * carried[1] + inverse[a, 2] * carried[2]
            )
        orthonormal(end.rotation[b])
        for k in range(start.modal.shape[2]):
            accelerated = structure.squares[b, k] * (
                al * start.modal[b, COORDINATE, k] - (1 + al) * end.modal[b, COORDINATE, k]
            )
            if structure.damping[b, k] > 0.0:
                way, rate = _predictor(scheme, start, b, k)
                rate += ga / (scheme.beta * dt) * (end.modal[b, COORDINATE, k] - way)
                accelerated += structure.damping[b, k] * (
                    al * start.modal[b, RATE, k] - (1 + al) * rate
                )
            end.modal[b, ACCELERATION, k] = accelerated
            mean = (
                (1 - ga) * start.modal[b, ACCELERATION, k] + ga * accelerated + action.modal[b, k]
            )
            end.modal[b, RATE, k] = start.modal[b, RATE, k] + dt * mean
    move_anchors(
        work.points,
        structure.interfaces,
        scheme.springs,
        near_points(work.problem),
        work.before,
        end.contact,
    )
    end.whole[0].time = start.whole[0].time + dt
    for a in range(3):
        end.whole[0].ground[a] = ground[a]
