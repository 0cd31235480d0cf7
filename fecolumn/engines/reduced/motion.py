"""Motion of floating frames and modes under given contact forces, to the end of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.arrays import put_matrix
from fecolumn.contact.interface import rims_at_rest
from fecolumn.contact.meetings import Meetings, meetings_for
from fecolumn.contact.points import CONTACT
from fecolumn.contact.pose import grounds_at
from fecolumn.contact.record import record
from fecolumn.contact.tolerances import FOUND_SLOTS
from fecolumn.engines.dynamics.links import TIE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

#: A body's frame: center of mass [m], its velocity [m/s] and the acceleration that HHT remembers,
#: without contact [m/s2]; spin: angular velocity in the body's frame [rad/s].
FRAME = record(
    ("center", "f8", 3), ("velocity", "f8", 3), ("acceleration", "f8", 3), ("spin", "f8", 3)
)
#: What belongs to no body: time [s]; static: strain energy of base, static rest of the bodies,
#: penalty springs and pad [J]; ground: acceleration [m/s2].
WHOLE = record(("time", "f8"), ("static", "f8"), ("ground", "f8", 3))


class MotionState(NamedTuple):
    """State of a structure in the table frame; arrays, so that compiled code may change them.

    frames: (nb,) of FRAME; rotation: (nb, 3, 3) body to table; modal: (nb, 3, m) of unit modal
    mass; contact: (P,) of CONTACT; rims: (ni,) of RIM; ties: (nl,) of TIE; whole: (1,) of WHOLE;
    grounds: (G,) of GROUND_STATE; meetings: bodies whose contact is found, see `reduced.found`.
    """

    frames: Array
    rotation: Array
    modal: Array
    contact: Array
    rims: Array
    ties: Array
    whole: Array
    grounds: Array
    meetings: Meetings

    @property
    def time(self) -> float:
        """Time [s]."""
        return float(self.whole["time"][0])

    @property
    def forces(self) -> Array:
        """Contact forces (P, 3) on the slaves [N], in the frames of their interfaces."""
        return self.contact["force"]


def at_rest(
    points: int,
    modes: int,
    bodies: int = 1,
    interfaces: int = 1,
    links: int = 0,
    levels: Array | tuple[float, ...] = (0.0,),
    meetings: int = 0,
) -> MotionState:
    """Zeros everywhere but for upright rotations, and the levels of the grounds [m]; so many rows
    of meetings without a pair.
    """
    return MotionState(
        np.zeros(bodies, FRAME),
        np.tile(np.eye(3), (bodies, 1, 1)),
        np.zeros((bodies, 3, modes)),
        np.zeros(points, CONTACT),
        rims_at_rest(interfaces),
        np.zeros(links, TIE),
        np.zeros(1, WHOLE),
        grounds_at(levels),
        meetings_for(meetings, FOUND_SLOTS),
    )


class Action(NamedTuple):
    """What contact and links do to the bodies in a step, for the ledger: turn: (nb, 3) [rad] in a
    body's frame, moment: (nb, 3) [N m] there, conjugate to the turn; push: (nb, 3) force [N];
    modal: (nb, m) forces on the modes; halfway: (nb, 3, 3) rotation in the middle of the step;
    resistance: (nb, 3) part of the moment by which a rim resists to roll; frames: (ni, 3, 3) of the
    interfaces in the middle of the step; total: (ni, 3) sums of the forces on their slaves [N],
    spread: (ni, 2, 3, 3) of the arms of slave and master times these forces [N m], in their frames;
    pulls: (nl, 3) forces of the links on their ends a [N].
    """

    turn: Array
    moment: Array
    push: Array
    modal: Array
    halfway: Array
    resistance: Array
    frames: Array
    total: Array
    spread: Array
    pulls: Array


def no_action(modes: int, bodies: int = 1, interfaces: int = 1, links: int = 0) -> Action:
    """Room for what acts on so many bodies, of which nothing acts."""
    return Action(  # type: ignore[call-arg]  # of unknown number
        *(np.zeros((bodies, 3)) for _ in range(3)),
        np.zeros((bodies, modes)),
        np.zeros((bodies, 3, 3)),
        np.zeros((bodies, 3)),
        np.tile(np.eye(3), (interfaces, 1, 1)),
        np.zeros((interfaces, 3)),
        np.zeros((interfaces, 2, 3, 3)),
        np.zeros((links, 3)),
    )


@njit
def copy(source: MotionState, target: MotionState) -> None:
    """Copy a MotionState."""
    for b in range(len(source.frames)):
        target.frames[b] = source.frames[b]
    for i in range(len(source.contact)):
        target.contact[i] = source.contact[i]
    for k in range(len(source.rims)):
        target.rims[k] = source.rims[k]
    for n in range(len(source.ties)):
        target.ties[n] = source.ties[n]
    target.whole[0] = source.whole[0]
    copy_grounds(source, target)
    copy_meetings(source.meetings, target.meetings)
    for b in range(len(source.frames)):
        put_matrix(source.rotation[b], target.rotation[b])
        put_matrix(source.modal[b], target.modal[b])


@njit
def copy_meetings(source: Meetings, target: Meetings) -> None:
    """Copy rows and places of Meetings."""
    for r in range(len(source.rows)):
        target.rows[r] = source.rows[r]
        for s in range(source.places.shape[1]):
            target.places[r, s] = source.places[r, s]


@njit
def copy_grounds(source: MotionState, target: MotionState) -> None:
    """Copy the grounds of a MotionState."""
    for g in range(len(source.grounds)):
        target.grounds[g] = source.grounds[g]
