"""Points that come back over an outline of a moving master and are below its surface then.

They are at the side of the master: were they let in, contact would push them up and make energy.
They stay open, SUNK, until they are above the surface.
"""

from __future__ import annotations

from fecolumn.contact.displacement import static_displacement
from fecolumn.contact.points import SUNK
from fecolumn.contact.tolerances import OPEN
from fecolumn.foundation._compiled import njit


@njit
def was_beyond(contact, rim_before, rim):
    """Whether a point comes from beyond an outline, open, by CONTACT and RIM at the start of the
    step and RIM in it.

    Those of a rim that rolls in this step are brought where the rim is lowest, wherever that is.
    """
    rolls = rim.angle == rim.angle and rim.angle != rim_before.angle
    return contact.beyond and not contact.force[2] > 0 and not rolls


@njit
def mark_sunk(bodies, base, points, interfaces, poses, before, listed, loaded, heights, displaced):
    """Mark as SUNK the points listed[loaded:] that stay below the surface although the loaded
    points, listed[:loaded], press it down.

    Parameters
    ----------
    poses
        (ni,) of POSE and before: (n,) of CONTACT at the start of the step.
    heights
        (n, 3) positions [m] there, the third of them.
    displaced
        (n, 3), room.
    """
    static_displacement(bodies, base, points, poses, before, listed, displaced)
    for i in listed[loaded:]:
        if heights[i, 2] + displaced[i, 2] < -OPEN * interfaces[points[i].interface].width:
            points[i].beyond = SUNK
