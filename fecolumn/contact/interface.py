"""An interface: the foot of one body on another, its laws and the shape of its rim."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.record import record
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.pad import Pad
    from fecolumn.contact.rim import Rim

#: An interface: slave, master and ground as of POINT; width of the foot [m], to which tolerances of
#: length are related; restitution, see `contact.restitution`; rolling: coefficient of the rim's
#: resistance, see `contact.rolling`; on_pad: whether a pad lies between, relaxation of it [s];
#: rim_first, rim_count: places of its rim among those of all interfaces, none where it is not
#: round; rim_angle of the rim's first point, sector between two [rad], radius [m]. Of the master's
#: surface in its own frame: origin (3,) from its centre of mass [m], axes (3, 3), whose columns are
#: two tangents and the outward normal; facet_first, facet_count: its triangles; convex: see
#: `joints.is_convex`. foot: (3,) middle of the slave's nodes from its centre of mass [m]; reach:
#: how far modes of the energy 1/2 J move a node of the master's surface at most [m/sqrt(J)]; bulge:
#: how far a round surface reaches beyond the polygon of its nodes [m]. ball: radius of the balls
#: with which the foot touches, see `contact.ball`, 0 of a flat one; edge: (2,) [m] where a dome
#: ends, its radius and 0 of a circle, half sides of a rectangle, (0, 0) of a foot that is no dome.
INTERFACE = record(
    ("slave", "i8"),
    ("master", "i8"),
    ("ground", "i8"),
    ("width", "f8"),
    ("restitution", "f8"),
    ("rolling", "f8"),
    ("on_pad", "?"),
    ("relaxation", "f8"),
    ("rim_first", "i8"),
    ("rim_count", "i8"),
    ("rim_angle", "f8"),
    ("sector", "f8"),
    ("radius", "f8"),
    ("origin", "f8", 3),
    ("axes", "f8", (3, 3)),
    ("facet_first", "i8"),
    ("facet_count", "i8"),
    ("convex", "?"),
    ("foot", "f8", 3),
    ("reach", "f8"),
    ("bulge", "f8"),
    ("ball", "f8"),
    ("edge", "f8", 2),
)

#: What a rolling rim carries from step to step: angle of its lowest contact point [rad], nan while
#: the foot touches with its nodes only; lift: height of it and its neighbours above the rim [m]. Of
#: a foot that touches with balls: normal: (3,) of the master in the slave's frame for which its
#: points were placed, 0 before they were; raised: height that they were given [m]. Of a joint with
#: two sides: placed: whether its points were laid before; plain: whether they were the nodes of the
#: slave; unused: whether no point of this interface takes part, as its slave is the master of a
#: joint whose outline is not met; apart: whether none does, as the faces are too far apart.
RIM = record(
    ("angle", "f8"),
    ("lift", "f8", 5),
    ("normal", "f8", 3),
    ("raised", "f8"),
    ("placed", "?"),
    ("plain", "?"),
    ("unused", "?"),
    ("apart", "?"),
)


def interface_of(
    reference: Array,
    rim: Rim | None = None,
    restitution: float = 0.0,
    rolling: float = 0.0,
    pad: Pad | None = None,
    slave: int = 0,
    master: int = -1,
) -> Array:
    """One interface (1,) of INTERFACE below a foot with nodes at (n, 3) [m]; rim: Rim or None, pad:
    Pad or None.
    """
    interface = np.zeros(1, INTERFACE)
    interface["slave"], interface["axes"], interface["foot"] = (
        slave,
        np.eye(3),
        reference.mean(axis=0),
    )
    interface["master"], interface["width"], interface["restitution"], interface["sector"] = (
        master,
        np.ptp(reference[:, 0]),
        restitution,
        1.0,
    )
    if pad is not None:
        interface["on_pad"], interface["relaxation"] = True, pad.relaxation
    if rim is not None:
        interface["rim_count"], interface["rim_angle"], interface["sector"], interface["radius"] = (
            len(rim.nodes),
            rim.first,
            rim.sector,
            rim.radius,
        )
        interface["rolling"] = rolling
    return interface


def rims_at_rest(count: int = 1) -> Array:
    """(count,) of RIM that touch with their nodes only."""
    rims = np.zeros(count, RIM)
    rims["angle"] = np.nan
    return rims
