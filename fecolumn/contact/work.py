"""What contact does in a step: where its points stick from then on, and the energy that it
takes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.pad import any_pad, dashpot_work
from fecolumn.contact.tolerances import STUCK
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.pad import Springs


@njit
def book_impulses(
    gained: float, own: float, contact: float, other: float
) -> tuple[float, float, float]:
    """Terms of the ledger [J] after the impulses of a step were replaced: own, contact, other.

    gained: kinetic energy [J] that the new impulses add. own: term of what happened, impact or
    friction; contact, other: terms that contact and the other of the two had before. Energy that
    the new impulses take comes first from what contact had made, then goes to their own term.
    Energy that they give back was taken by the impulses they replace. It is set against the own
    term first, then contact, then the other term. So neither impact nor friction ever shows a gain.
    """
    made = min(max(contact, 0.0), max(-gained, 0.0))
    own, contact = own + gained + made, contact - made
    back, least = max(own, 0.0), max(contact, 0.0)
    contact += back
    given = min(max(contact - least, 0.0), back, max(-other, 0.0))
    return own - back, contact - given, other + given


@njit
def move_anchors(
    points: Array, interfaces: Array, springs: Springs, listed: Array, before: Array, after: Array
) -> None:
    """Where the listed points (k,) stick from now on: a slipping spring of contact law or pad keeps
    its elastic part.
    """
    for i in listed:
        x = (
            after[i].relative[0]
            + springs.own[i, 0] * after[i].force[0]
            + springs.kept[i] * before[i].indentation[0]
        )
        y = (
            after[i].relative[1]
            + springs.own[i, 1] * after[i].force[1]
            + springs.kept[i] * before[i].indentation[1]
        )
        stuck = (
            after[i].force[2] > 0
            and np.hypot(x - before[i].anchor[0], y - before[i].anchor[1])
            <= STUCK * interfaces[points[i].interface].width
        )
        after[i].anchor[0] = before[i].anchor[0] if stuck else x
        after[i].anchor[1] = before[i].anchor[1] if stuck else y


@njit
def losses(
    points: Array,
    interfaces: Array,
    springs: Springs,
    listed: Array,
    before: Array,
    after: Array,
    contact: float,
) -> tuple[float, float, float]:
    """Energy [J] that friction and landings of the listed points (k,) add in a step, both below 0,
    and that dashpots and yielding of pads take; contact: that all of contact adds.
    """
    friction, landed = 0.0, 0.0
    for i in listed:
        if after[i].force[2] > 0:
            friction += after[i].force[0] * (after[i].anchor[0] - before[i].anchor[0]) + after[
                i
            ].force[1] * (after[i].anchor[1] - before[i].anchor[1])
            if before[i].force[2] <= 0 and not interfaces[points[i].interface].on_pad:
                # a point of a rim that rolls may be pushed out: no landing
                landed += min(
                    after[i].force[2] * (after[i].relative[2] - before[i].relative[2]), 0.0
                )
    # the gap of a point that goes along a rim or an outline is not the way of a body alone:
    # landings take no more than contact does beside friction
    landed = max(landed, min(contact - friction, 0.0))
    taken = dashpot_work(points, springs, before, after) if any_pad(interfaces) else 0.0
    return friction, landed, taken
