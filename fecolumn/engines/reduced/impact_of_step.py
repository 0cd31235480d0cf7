"""The impact at the end of a step: velocities anew, and what it does to the energies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.impact import Collision, TouchingBodies, find_impact
from fecolumn.contact.impact_event import (
    LANDS,
    NOTHING,
    impact_event,
    landing_moment,
    mark_landing,
    mark_turning,
    touched,
)
from fecolumn.contact.pad import without_pads
from fecolumn.contact.points import GROUND
from fecolumn.contact.problem import N_IMPACTS, OK, near_points
from fecolumn.contact.work import book_impulses
from fecolumn.engines.reduced.elastic import END, START, find_elastic, find_velocity
from fecolumn.engines.reduced.follow import push_bodies
from fecolumn.engines.reduced.ledger import (
    BASE_WORK,
    CONTACT_WORK,
    FRICTION_WORK,
    IMPACT_WORK,
    kinetic,
)
from fecolumn.engines.reduced.rigid_loss import begin_impact
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.projection import GroundTops
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Scheme, Structure
    from fecolumn.engines.reduced.motion import MotionState


@njit
def take_impact(
    structure: Structure,
    base: GroundTops,
    scheme: Scheme,
    work: Work,
    start: MotionState,
    end: MotionState,
    contact_work: float,
    booked: Array,
    ledger: Array,
    counts: Array,
) -> int:
    """Take the velocities of `end` anew where a point lands or slip ends: OK, or the code of what
    failed; booked: the ledger at the start of the step.
    """
    interfaces, points, before, elastic = (
        structure.interfaces,
        work.points,
        work.before,
        work.elastic,
    )
    # the springs of a pad bring a landing foot to rest in their own time: there is no impact
    listed = without_pads(interfaces, points, near_points(work.problem))
    lands = mark_landing(interfaces, points, listed, before, end.contact, work.landing) > 0
    if mark_turning(points, listed, before, end.contact, work.turning) == 0 and not lands:
        return OK
    for i in listed:
        if work.turning[i] or lands and (before[i].force[2] > 0 or end.contact[i].force[2] > 0):
            _find_velocities(structure, work, i, start, end)
    happens = impact_event(
        interfaces,
        points,
        listed,
        before,
        end.contact,
        scheme.dt,
        work.early,
        work.late,
        work.landing,
        work.turning,
    )
    if happens == NOTHING:
        return OK
    arms, union, moment = (
        np.zeros((len(points), 3)),
        touched(listed, before, end.contact, work.landing),
        np.nan,
    )
    for i in union:
        _find_velocities(structure, work, i, start, end)
        for a in range(3):
            arms[i, a] = points[i].arm[a] + elastic.point[END, i, a]
    if happens == LANDS:
        moment = landing_moment(union, before, end.contact, work.early, work.landing, scheme.dt)
        begin_impact(structure, work, start, end, scheme.dt, moment, union, booked, ledger)
    collision = Collision(
        union,
        arms,
        work.poses[END],
        before,
        end.contact,
        work.early,
        work.late,
        work.landing,
        work.turning,
        scheme.dt,
        moment,
    )
    answer, pushed, impulses = find_impact(
        TouchingBodies(structure.bodies, base, points, interfaces, scheme.springs),
        collision,
        contact_work,
        counts,
    )
    if answer != OK or not pushed:
        return answer
    energy, brought = kinetic(structure, end), 0.0
    push_bodies(structure, scheme, points, arms, work.poses[END], impulses, end)
    for i in listed:
        brought += _work_of_moving_grounds(structure, points[i], work.poses[END], impulses[i], end)
    ledger[BASE_WORK] += brought
    own, other = (IMPACT_WORK, FRICTION_WORK) if happens == LANDS else (FRICTION_WORK, IMPACT_WORK)
    terms = book_impulses(
        kinetic(structure, end) - energy - brought,
        ledger[own] - booked[own],
        ledger[CONTACT_WORK] - booked[CONTACT_WORK],
        ledger[other] - booked[other],
    )
    ledger[own], ledger[CONTACT_WORK], ledger[other] = (
        booked[own] + terms[0],
        booked[CONTACT_WORK] + terms[1],
        booked[other] + terms[2],
    )
    counts[N_IMPACTS] += happens == LANDS
    return OK


@njit
def _work_of_moving_grounds(
    structure: Structure, point: Record, poses: Array, impulse: Array, end: MotionState
) -> float:
    """Energy [J] that an impulse (3,) at a point brings from grounds that move relative to the
    first one: those on which its slave stands, or which hold one of its bodies.
    """
    total, frame = 0.0, poses[point.interface].frame
    for side in range(2):
        b, sign = (point.master, 1.0) if side else (point.slave, -1.0)
        g = point.ground if b == GROUND else structure.bodies.body[b].held
        if g < 0:
            continue
        for a in range(3):
            along = frame[a, 0] * impulse[0] + frame[a, 1] * impulse[1] + frame[a, 2] * impulse[2]
            total += sign * along * end.grounds[g].velocity[a]
    return total


@njit
def _find_velocities(
    structure: Structure, work: Work, i: int, start: MotionState, end: MotionState
) -> None:
    """Velocities of point i at both ends of a step."""
    find_elastic(structure, work.points, i, start, work.elastic, START)
    find_velocity(
        structure, work.points, i, start, work.poses[START], work.elastic, START, work.early[i]
    )
    find_velocity(structure, work.points, i, end, work.poses[END], work.elastic, END, work.late[i])
