"""The share of the rigid loss that impacts take: energy that leaves the rigid motion at impacts,
over that which a plastic impact of rigid bodies would take.

An impact begins with the step in which a point lands. For bodies that do not deform it is over at
the end of it, and its points are those that carry. Elastic faces meet point by point, and give back
a part of what they store: their impact goes on while points that the rigid motion has brought
together still approach, and for three times as long while they part. The rigid loss is that of a
plastic impact (Moreau 1988), with friction, of all points which the rigid motion has brought
together, from the velocities before the first landing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.coupling import coupling_by_levers, put_root
from fecolumn.contact.impact import plastic_impact
from fecolumn.contact.points import GROUND, OVER
from fecolumn.contact.pose import find_poses
from fecolumn.contact.problem import present_points
from fecolumn.contact.tolerances import APPROACH_LEFT, IMPACT_LASTS, LANDS_TOO, LOSS_COUNTS
from fecolumn.engines.dynamics.links import strain_of_links
from fecolumn.engines.reduced.elastic import END
from fecolumn.engines.reduced.ledger import (
    APPROACH_SPEED,
    BASE_WORK,
    BEGAN,
    ENDS,
    FRICTION_WORK,
    IMPACT_LOSS,
    LEFT,
    LINKS_WORK,
    RIGID_LOSS,
    ROLLING_WORK,
    RUBBED,
    RUBBED_BEFORE,
    TAKEN,
    rigid_kinetic,
    weight_energy,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.coupling import Coupling
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Structure
    from fecolumn.engines.reduced.motion import MotionState


def loss_share(ledger: Array, interfaces: Array) -> float | None:
    """What impacts have taken over what those of rigid bodies would have; None where none counts,
    they give back by a coefficient of restitution, or friction took more while they lasted than
    they should: bodies slide where they land.
    """
    if ledger[RIGID_LOSS] == 0 or interfaces["restitution"].any():
        return None
    if ledger[RUBBED] > ledger[RIGID_LOSS]:
        return None
    return float(ledger[TAKEN] / ledger[RIGID_LOSS])


@njit
def rigid_energy(structure: Structure, motion: MotionState, ledger: Array) -> float:
    """Energy [J] of the rigid motion, and of weight and links, less what base, rolling and links
    have brought: its decrease is what contact, friction and vibration have taken.
    """
    origin = np.zeros((len(motion.frames), 3))
    return (
        rigid_kinetic(structure, motion)
        + weight_energy(structure, origin, motion)
        + strain_of_links(structure.links, motion.ties)
        - ledger[BASE_WORK]
        - ledger[ROLLING_WORK]
        - ledger[LINKS_WORK]
    )


@njit
def find_together(structure: Structure, work: Work, end: MotionState) -> Array:
    """Points (k,) that the rigid motion has brought together at the end of a step: those that
    carry, and those no higher than the give of those that do.
    """
    points, poses, before, give = work.points, work.poses[END], work.before, 0.0
    listed, count, place = present_points(work.problem), 0, np.empty(3)
    height, together = np.empty(len(listed)), np.empty(len(listed), np.int64)
    find_poses(structure.interfaces, end.grounds, end.frames, end.rotation, poses, None)
    for j in range(len(listed)):
        point, pose = points[listed[j]], poses[points[listed[j]].interface]
        _place_of(point, end, place)
        height[j] = point.lift
        for a in range(3):
            height[j] += pose.frame[a, 2] * (place[a] - pose.origin[a])
        if (
            end.contact[listed[j]].force[2] > 0
            and not structure.interfaces[points[listed[j]].interface].on_pad
        ):
            give = max(give, -height[j])
    for j in range(len(listed)):
        i = listed[j]
        near = (
            points[i].beyond == OVER
            and not structure.interfaces[points[i].interface].on_pad
            and height[j] <= LANDS_TOO * structure.interfaces[points[i].interface].width + give
        )
        touches = before[i].force[2] > 0 or end.contact[i].force[2] > 0
        if near or touches and not structure.interfaces[points[i].interface].on_pad:
            together[count] = i
            count += 1
    return together[:count]


@njit
def _place_of(point: Record, motion: MotionState, place: Array) -> None:
    """Place (3,): where a point of POINT is in the table frame [m], of bodies that do not
    deform.
    """
    R = motion.rotation[point.slave]
    for a in range(3):
        place[a] = (
            motion.frames[point.slave].center[a]
            + R[a, 0] * point.arm[0]
            + R[a, 1] * point.arm[1]
            + R[a, 2] * point.arm[2]
        )


@njit
def _velocities_by_motion(points: Array, poses: Array, listed: Array, end: MotionState) -> Array:
    """Matrix (3 k, 6 nb): velocities of the listed points (k,), slave relative to master in the
    frames of their interfaces, by velocities and spins of the bodies.
    """
    J, place, arm = np.zeros((3 * len(listed), 6 * len(end.frames))), np.empty(3), np.empty(3)
    for j in range(len(listed)):
        point, Q = points[listed[j]], poses[points[listed[j]].interface].frame
        _place_of(point, end, place)
        for side in range(2):
            b, sign = point.master if side else point.slave, -1.0 if side else 1.0
            if b == GROUND:
                continue
            R = end.rotation[b]
            for a in range(3):
                arm[a] = place[a] - end.frames[b].center[a]
            for c in range(3):
                for a in range(3):
                    J[3 * j + c, 6 * b + a] = sign * Q[a, c]
                # (w x arm) . q = w . (arm x q), w in the body's frame
                x, y, z = (
                    arm[1] * Q[2, c] - arm[2] * Q[1, c],
                    arm[2] * Q[0, c] - arm[0] * Q[2, c],
                    arm[0] * Q[1, c] - arm[1] * Q[0, c],
                )
                for a in range(3):
                    J[3 * j + c, 6 * b + 3 + a] = sign * (R[0, a] * x + R[1, a] * y + R[2, a] * z)
    return J


@njit
def _velocities(J: Array, points: Array, listed: Array, motion: MotionState) -> Array:
    """(3 k,) velocities of the listed points (k,), slave relative to master; J: of
    `_velocities_by_motion`.
    """
    found = J @ _velocities_of(motion)
    for j in range(len(listed)):
        if points[listed[j]].master == GROUND:
            for a in range(3):
                found[3 * j + a] -= motion.grounds[points[listed[j]].ground].velocity[a]
    return found


@njit
def _velocities_of(motion: MotionState) -> Array:
    """(6 nb,) velocities and spins of the bodies."""
    values = np.empty(6 * len(motion.frames))
    for b in range(len(motion.frames)):
        for a in range(3):
            values[6 * b + a], values[6 * b + 3 + a] = (
                motion.frames[b].velocity[a],
                motion.frames[b].spin[a],
            )
    return values


@njit
def _mobility(structure: Structure, points: Array, listed: Array, J: Array) -> Coupling:
    """Coupling by mobility of the listed points (k,); J: of `_velocities_by_motion`."""
    k = len(listed)
    levers, sides, root = np.zeros((k, 3, 12)), np.full((k, 2), -1), np.empty((3, 3))
    for b in range(len(structure.bodies.body)):
        body = structure.bodies.body[b]
        if body.inverse_mass == 0.0:
            continue
        put_root(body.inverse_inertia, root)
        for j in range(k):
            for side in range(2):
                if b != (points[listed[j]].master if side else points[listed[j]].slave):
                    continue
                sides[j, side] = b
                for a in range(3):
                    row = J[3 * j + a, 6 * b : 6 * b + 6]
                    for c in range(3):
                        levers[j, a, 6 * side + c] = np.sqrt(body.inverse_mass) * row[c]
                        for e in range(3):
                            levers[j, a, 6 * side + 3 + c] += root[e, c] * row[3 + e]
    return coupling_by_levers(np.zeros((k, 3)), levers, sides)


@njit
def begin_impact(
    structure: Structure,
    work: Work,
    start: MotionState,
    end: MotionState,
    dt: float,
    moment: float,
    touched: Array,
    booked: Array,
    ledger: Array,
) -> None:
    """Book the rigid loss of the impact that begins in a step, or goes on in it; `end` has the
    velocities before the impact.

    moment: fraction of the step at which points land. touched: (k,) points that carry at the start
    or at the end of the step. booked: the ledger at the start of the step.
    """
    stiff = True
    for b in range(len(structure.bodies.body)):
        stiff &= structure.bodies.body[b].stiff
    listed = touched if stiff else find_together(structure, work, end)
    k = len(listed)
    J = _velocities_by_motion(work.points, work.poses[END], listed, end)
    friction, held, given = np.empty(k), np.empty(k, np.bool_), np.empty(3 * k)
    for j in range(k):
        i = listed[j]
        friction[j], held[j] = work.points[i].friction, work.before[i].force[2] > 0
        for a in range(3):
            given[3 * j + a] = dt * end.contact[i].force[a]
    loss, speed = plastic_impact(
        _mobility(structure, work.points, listed, J),
        friction,
        held,
        _velocities(J, work.points, listed, start),
        _velocities(J, work.points, listed, end),
        given,
        moment,
        ledger[APPROACH_SPEED],
    )
    if ledger[APPROACH_SPEED] > 0.0:
        ledger[IMPACT_LOSS], ledger[APPROACH_SPEED] = (
            max(ledger[IMPACT_LOSS], loss),
            max(ledger[APPROACH_SPEED], speed),
        )
        return
    if loss <= APPROACH_LEFT * ledger[IMPACT_LOSS]:
        # a point that rattles while the impact ends
        return
    _book(structure, start, booked, ledger)
    ledger[IMPACT_LOSS], ledger[APPROACH_SPEED], ledger[LEFT], ledger[BEGAN] = (
        loss,
        speed,
        rigid_energy(structure, start, booked),
        start.whole[0].time,
    )
    ledger[RUBBED_BEFORE] = booked[FRICTION_WORK]


@njit
def follow_impact(
    structure: Structure, work: Work, end: MotionState, dt: float, ledger: Array
) -> None:
    """Whether the impact that goes on is over at the end of a step; then its loss is booked."""
    now = end.whole[0].time
    if ledger[APPROACH_SPEED] > 0.0:
        listed, approach = find_together(structure, work, end), 0.0
        if len(listed):
            J = _velocities_by_motion(work.points, work.poses[END], listed, end)
            velocity = _velocities(J, work.points, listed, end)
            for j in range(len(listed)):
                approach = max(approach, -velocity[3 * j + 2])
        if approach <= APPROACH_LEFT * ledger[APPROACH_SPEED]:
            ledger[APPROACH_SPEED], ledger[ENDS] = (
                0.0,
                ledger[BEGAN] + IMPACT_LASTS * (now - ledger[BEGAN]),
            )
    elif ledger[IMPACT_LOSS] > 0.0 and now > ledger[ENDS] - dt / 2:
        _book(structure, end, ledger, ledger)


@njit
def _book(structure: Structure, motion: MotionState, booked: Array, ledger: Array) -> None:
    """Book the impact that is over, if its rigid loss counts; motion: after it, booked: the ledger
    then.
    """
    weight, width, g = np.inf, np.inf, structure.gravity
    for b in range(len(motion.frames)):
        if structure.bodies.body[b].held >= 0:
            continue
        weight = min(
            weight, structure.bodies.body[b].mass * np.sqrt(g[0] ** 2 + g[1] ** 2 + g[2] ** 2)
        )
    for k in range(len(structure.interfaces)):
        width = min(width, structure.interfaces[k].width)
    if ledger[IMPACT_LOSS] > LOSS_COUNTS * weight * width:
        ledger[RIGID_LOSS] += ledger[IMPACT_LOSS]
        ledger[TAKEN] += ledger[LEFT] - rigid_energy(structure, motion, booked)
        ledger[RUBBED] += ledger[RUBBED_BEFORE] - booked[FRICTION_WORK]
    ledger[IMPACT_LOSS] = 0.0
