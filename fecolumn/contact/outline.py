"""Points that come back over an outline of a moving master and are below its surface then.

Points that carry lie below the surface by what they give alone. A point that comes over an outline
no deeper than they are takes part as they do.

A deeper one that is nearer to the master's outline than to its surface is beside the master, not on
it. Contact would push it up and create energy. It stays open, SUNK, in that step; each step asks
again.

Any other deeper one is lifted to the surface by `lift`, where it carries and lands as any point
does. The lift is undone slowly, so that bodies that overlap come apart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.bodies import GOES_ON
from fecolumn.contact.displacement import static_displacement
from fecolumn.contact.points import SUNK
from fecolumn.contact.tolerances import EDGE_REACH, GIVES_MORE, OPEN, STAYS_DEEP
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.projection import GroundTops


@njit
def was_beyond(contact: Record, rim_before: Record, rim: Record) -> bool:
    """Whether a point comes from beyond an outline, open, by CONTACT and RIM at the start of the
    step and RIM in it.

    Those of a rim that rolls in this step are brought where the rim is lowest, wherever that is.
    """
    rolls = rim.angle == rim.angle and rim.angle != rim_before.angle
    return contact.beyond and not contact.force[2] > 0 and not rolls


@njit
def raise_or_leave(
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    interfaces: Array,
    poses: Array,
    before: Array,
    listed: Array,
    loaded: int,
    places: Array,
    displaced: Array,
) -> None:
    """Of the points listed[loaded:], which come back over an outline, those that stay below the
    surface although the loaded points, listed[:loaded], press it down, by more than these give:
    mark as SUNK those at the master's side, and raise the others to the surface. How deep they are:
    `raised` in before.

    Parameters
    ----------
    poses
        (ni,) of POSE and before: (n,) of CONTACT at the start of the step.
    places
        (n, 3) positions there, relative to the surface [m].
    displaced
        (n, 3), room.
    """
    static_displacement(bodies, base, points, poses, before, listed, displaced)
    for i in listed[loaded:]:
        interface = interfaces[points[i].interface]
        depth, give = -places[i, 2] - displaced[i, 2], OPEN * interface.width
        for j in listed[:loaded]:
            if _of_same_bodies(points[i], points[j]):
                give = max(give, -GIVES_MORE * (places[j, 2] + displaced[j, 2]))
        if depth <= give:
            continue
        before[i].raised = depth
        aside = _to_outline(bodies.facets, interface, places[i, 0], places[i, 1])
        if depth > aside + EDGE_REACH * interface.width:
            points[i].beyond = SUNK
            continue
        # above the surface, as one that is found there has landed when it carries
        before[i].raised += 2 * OPEN * interface.width
        points[i].lift += before[i].raised


@njit
def lower_raised(point: Record, now: Record, height: float, width: float) -> None:
    """Undo a part of the lift of a point in this step, and apply what is left of it.

    Parameters
    ----------
    point, now
        of POINT, and of CONTACT at the start of the step.
    height
        of the point over the surface [m] there, without being raised: needed where it is open.
    width
        of the interface [m].
    """
    deep = now.raised if now.force[2] > 0 else min(now.raised, -height)
    left = STAYS_DEEP * deep if deep > OPEN * width else 0.0
    now.relative[2] += left - now.raised
    point.lift += left
    now.raised = left


@njit
def _of_same_bodies(one: Record, other: Record) -> bool:
    """Whether two points are between the same two bodies."""
    same = one.slave == other.slave and one.master == other.master
    return same or one.slave == other.master and one.master == other.slave


@njit
def _to_outline(facets: Array, interface: Record, x: float, y: float) -> float:
    """Way [m] from a place in the frame of an interface to the outline of its master's surface;
    infinite where none is known.
    """
    least, first = np.inf, interface.facet_first
    for f in range(first, first + interface.facet_count):
        facet = facets[f]
        for q in range(3):
            if facet.neighbours[q] >= 0 or facet.neighbours[q] == GOES_ON:
                continue
            x0, y0 = facet.corners[(q + 1) % 3, 0], facet.corners[(q + 1) % 3, 1]
            u, v = facet.corners[(q + 2) % 3, 0] - x0, facet.corners[(q + 2) % 3, 1] - y0
            along = min(max(((x - x0) * u + (y - y0) * v) / (u * u + v * v), 0.0), 1.0)
            least = min(least, np.hypot(x - x0 - along * u, y - y0 - along * v))
    return least
