"""The impact at the end of a step in which a point lands or slip ends."""

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
from fecolumn.contact.problem import N_IMPACT_CONTACT, OK
from fecolumn.contact.work import book_impulses
from fecolumn.engines.dynamics.booking import StepMade
from fecolumn.engines.dynamics.cuts import StepFailed, Stop
from fecolumn.foundation._compiled import interpreted

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.energy import Ledger
    from fecolumn.engines.dynamics.record import Record
    from fecolumn.engines.dynamics.system import System


def collide(
    system: System,
    made: StepMade,
    contact_work: float,
    booked: dict,
    ledger: Ledger,
    record: Record,
) -> None:
    """Take the velocities at the end of a step anew where a point lands or slip ends.

    Parameters
    ----------
    contact_work
        of `booking.book_step` [J].
    booked
        works of the ledger at the start of the step.
    record
        counts impacts and iterations.

    Raises
    ------
    StepFailed
        no impulses were found that obey the laws of impact and friction.
    """
    interface, bodies = system.interface, system.bodies
    start, before, after, hht = made.start, made.before, made.after, made.hht
    R = after.rotation
    landing, turning = np.zeros(interface.size, bool), np.zeros(interface.size, bool)
    # the springs of a pad bring a landing foot to rest in their own time: there is no impact
    on_pad = interface.interfaces["on_pad"][interface.points["interface"][interface.near]]
    listed = interface.near[~on_pad]
    lands = mark_landing(
        interface.interfaces, interface.points, listed, before, after.contact, landing
    )
    if not mark_turning(interface.points, listed, before, after.contact, turning) and not lands:
        return
    # velocities at either end are found with the rotation of that end: with another one, a
    # rotation would look like a strain and be removed by the filter of the foot
    poses = interface.poses(after.x, R)
    early, late = (
        interface.velocities(
            start.v, start.rotation, interface.poses(start.x, start.rotation), True
        ),
        interface.velocities(after.v, R, poses),
    )
    happens = impact_event(
        interface.interfaces,
        interface.points,
        listed,
        before,
        after.contact,
        hht.dt,
        early,
        late,
        landing,
        turning,
    )
    if happens == NOTHING:
        return
    union, moment = interpreted(touched)(listed, before, after.contact, landing), np.nan
    if happens == LANDS:
        moment = interpreted(landing_moment)(union, before, after.contact, early, landing, hht.dt)
    answer, pushed, impulses = find_impact(
        TouchingBodies(
            interface.bodies,
            interface.surface,
            interface.points,
            interface.interfaces,
            made.springs,
        ),
        Collision(
            union,
            interface.points["arm"].copy(),
            poses,
            before,
            after.contact,
            early,
            late,
            landing,
            turning,
            hht.dt,
            float(moment),
        ),
        contact_work,
        interface.counts,
    )
    record.impact_iterations += interface.spent(N_IMPACT_CONTACT)
    if answer != OK:
        raise StepFailed(Stop.CONTACT, f"{Stop.CONTACT.value}: the impulses of an impact")
    if not pushed:
        return
    jump = interface.acceleration(impulses, R, False)
    brought = interface.brought(impulses)
    gained = bodies.dot(after.v + jump / 2, bodies.momentum(jump)) - brought
    ledger.add(base_work=brought)
    names = (
        ("impact", "contact", "friction") if happens == LANDS else ("friction", "contact", "impact")
    )
    terms = interpreted(book_impulses)(
        gained, *(ledger.work[name] - booked[name] for name in names)
    )
    ledger.work.update({name: booked[name] + float(term) for name, term in zip(names, terms)})
    after.v = after.v + jump
    if system.damping:
        after.a = after.a - hht.stiffness_factor * system.damping.acceleration(jump, R)
    record.impacts += happens == LANDS
