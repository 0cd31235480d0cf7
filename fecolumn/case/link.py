"""Keys of a link."""

from __future__ import annotations

from typing import ClassVar

from fecolumn.case.ground import GROUND_NAME
from fecolumn.foundation.schema import Section, parameter, required
from fecolumn.foundation.section_class import section_class

#: Kinds of links that pull, and that push.
PULLING = ("tendon", "spring", "restrainer", "friction")
PUSHING = ("spring", "restrainer", "friction", "strut", "stop")


@section_class()
class Link(Section):
    """A tendon, spring, strut, stop, damper or restrainer between two points; of a body with copies
    one at each. Its length is the points' distance.
    """

    SECTION: ClassVar[str] = "link"  # of its table [links.NAME]

    kind: str = required(
        doc="tendon: only pulls; spring: pulls and pushes; restrainer: pulls and pushes beyond "
        "slack_m; strut: only pushes; stop: only pushes, beyond gap_m; dashpot: damps; friction: "
        "a friction damper, elastic until it slips at slip_n",
        choices=("tendon", "spring", "restrainer", "strut", "stop", "dashpot", "friction"),
    )
    body: str = required(doc="body at one end")
    point_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="point [x, y, z] of that body, from the middle of its foot; of a prism from its at_m, "
        "of a mesh that stays as drawn as its file has it",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    to: str = parameter(GROUND_NAME, doc="body at the other end, or a ground")
    to_point_m: tuple[float, ...] = required(
        doc="point [x, y, z] of the other end at the start, from the middle of the foot of "
        "`body`, not of `to`, as point_m: it then holds for each copy",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    stiffness_n_m: float = parameter(
        0.0, doc="axial stiffness; all but a dashpot need it", unit="N/m", low=0, high=1e15
    )
    damping_n_s_m: float = parameter(
        0.0,
        doc="axial damping; with damping_exponent the force at 1 m/s; a dashpot needs it",
        unit="N s/m",
        low=0,
        high=1e15,
    )
    damping_exponent: float = parameter(
        1.0,
        doc="power of the rate of elongation to which the damping force is proportional: "
        "c |v|^a sign(v), as of viscous dampers with orifices",
        above=0,
        high=2,
        since="0.11",
    )
    linear_below_m_s: float = parameter(
        1e-3,
        doc="rate below which a damping force of damping_exponent < 1 is proportional to the rate, "
        "as its slope would have no bound",
        unit="m/s",
        above=0,
        high=1,
        since="0.11",
    )
    prestress_n: float = parameter(
        0.0,
        doc="tension at the start, of a strut or stop compression",
        unit="N",
        low=0,
        high=1e12,
    )
    slack_m: float = parameter(
        0.0,
        doc="elongation, of a restrainer to each side, before it acts",
        unit="m",
        low=0,
        high=100,
    )
    gap_m: float = parameter(
        0.0, doc="shortening of a stop before it acts", unit="m", low=0, high=100, since="0.11"
    )
    yield_n: float | None = parameter(
        None,
        doc="force at which it yields, both ways as far as it pulls and pushes: it stays at that "
        "force, or hardens, and keeps what has yielded as residual elongation; left out: never",
        unit="N",
        above=0,
        high=1e12,
    )
    hardening: float = parameter(
        0.0,
        doc="stiffness after yielding over that before; kinematic: it yields back after 2 yield_n",
        low=0,
        high=0.99,
        since="0.11",
    )
    yield_exponent: float | None = parameter(
        None,
        doc="exponent n of the curve along which it comes to yield or slip (Bouc-Wen): the larger "
        "the sharper; left out: a corner",
        low=1,
        high=50,
        since="0.11",
    )
    slip_n: float | None = parameter(
        None,
        doc="force at which a friction damper slips, both ways",
        unit="N",
        above=0,
        high=1e12,
        since="0.11",
    )
    breaking_n: float | None = parameter(
        None,
        doc="force at which it breaks for good, of one that yields at the elongation at "
        "which it would have that force had it not; left out: never",
        unit="N",
        above=0,
        high=1e12,
    )
