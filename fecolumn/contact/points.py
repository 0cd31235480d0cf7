"""Contact points: where they are on their two bodies in a step, and what they carry from one step
to the next.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.record import record
from fecolumn.contact.tolerances import OPEN
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.pad import Pad

#: What a point carries from step to step: force of the master on the slave [N]; anchor: horizontal
#: position at which it sticks [m]; relative: its position on the slave relative to the master's
#: surface, the third the gap [m], `located`: whether that was found, else the point is somewhere
#: above; indentation of a pad below it, and by how much that has settled [m]; beyond: whether it
#: was elsewhere than over the master's surface when it was last looked at; raised: depth [m] below
#: the surface at which it came back over an outline: where it is over the surface it is lifted by
#: as much, see `contact.outline`. Of a joint with two sides: present: whether it took part; arm:
#: (3,) [m] where it was on the slave, of a point of a rim how far it was moved off the rim.
CONTACT = record(
    ("force", "f8", 3),
    ("located", "?"),
    ("beyond", "?"),
    ("present", "?"),
    ("raised", "f8"),
    ("relative", "f8", 3),
    ("anchor", "f8", 2),
    ("indentation", "f8", 3),
    ("settled", "f8"),
    ("arm", "f8", 3),
)

#: A point in a step. slave, master: bodies, -1 for a ground; interface: to which it belongs;
#: ground: on which it stands where its master is one. node: row of the slave's node in whose place
#: it is; friction: coefficient; law: compliance of the contact law [m/N], springs: stiffness of a
#: pad [N/m], each in x, y, z; bears: force at which the pad yields [N], 0 where it never does.
#: carriers, weights: the slave's nodes that carry it, `count` of them; arm: from the slave's centre
#: of mass in its frame [m]; lift: height given to it [m], rolls: whether it belongs to a contact
#: that rolls on in this step, see `contact.rolling`. below, shares: the master's nodes below it, or
#: slots of the base's compliance; facet: where on a moving master it was found last; beyond: OVER
#: the master's surface in this step or where else; seat: its place there, from the master's centre
#: of mass in its frame [m]. uneven: compliance [m/N] that a point between nodes lacks, see
#: `compliance.even_out`. idle: whether it takes no part in this step, see `contact.two_sided`.
POINT = record(
    ("slave", "i8"),
    ("master", "i8"),
    ("interface", "i8"),
    ("node", "i8"),
    ("beyond", "i8"),
    ("arm", "f8", 3),
    ("lift", "f8"),
    ("idle", "?"),
    ("rolls", "?"),
    ("ground", "i8"),
    ("friction", "f8"),
    ("law", "f8", 3),
    ("springs", "f8", 3),
    ("bears", "f8"),
    ("count", "i8"),
    ("carriers", "i8", 4),
    ("weights", "f8", 4),
    ("below", "i8", 4),
    ("shares", "f8", 4),
    ("facet", "i8"),
    ("seat", "f8", 3),
    ("uneven", "f8", (3, 3)),
)

#: In the place of a body: the master of what stands on the ground, and the end of a link there.
GROUND = -1
#: The facet of a point on a ground that is a plane without end and does not give.
FLAT_GROUND = -1

#: Where a point is on a moving master: over its surface, beyond an outline, where the surface goes
#: on but its nodes are not among those of the contact, or below the surface, under which it came
#: from beyond an outline.
OVER, BEYOND, UNPREPARED, SUNK = range(4)


def node_points(
    arms: Array,
    friction: float,
    law: Array | None = None,
    pad: Pad | None = None,
    slave: int = 0,
    master: int = GROUND,
    first: int = 0,
    interface: int = 0,
) -> Array:
    """Points (n,) of POINT on the slave's nodes with arms (n, 3) [m], in rows from `first` on; law:
    (n, 3), pad: Pad below them.
    """
    points = np.zeros(len(arms), POINT)
    points["slave"], points["master"], points["interface"], points["friction"], points["arm"] = (
        slave,
        master,
        interface,
        friction,
        arms,
    )
    points["node"] = first + np.arange(len(arms))
    points["count"], points["weights"][:, 0], points["carriers"] = 1, 1.0, points["node"][:, None]
    if law is not None:
        points["law"] = law
    if pad is not None:
        points["springs"] = pad.stiffness
        if pad.bears is not None:
            points["bears"] = pad.bears
    return points


def may_touch(points: Array, interfaces: Array, relative: Array) -> Array:
    """Mask (n,) of the points (n,) of POINT that may touch where bodies begin: neither idle nor
    below a surface beyond whose edge they are; relative: (n, 3) [m].
    """
    return ~points["idle"] & (relative[:, 2] > -OPEN * interfaces["width"][points["interface"]])
