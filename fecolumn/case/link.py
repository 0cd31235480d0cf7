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
    """A tendon, spring, strut, stop, damper or restrainer between two points; of a body with
    copies, one link for each copy. The distance of the points at the start is its length without
    force, unless it is prestressed.
    """

    SECTION: ClassVar[str] = "link"  # of its table [links.NAME]

    kind: str = required(
        doc="tendon: only pulls; spring: pulls and pushes; restrainer: pulls and pushes beyond "
        "slack_m; strut: only pushes; stop: only pushes, beyond gap_m; dashpot: viscous "
        "damper; friction: friction damper, elastic until it slips at slip_n",
        choices=("tendon", "spring", "restrainer", "strut", "stop", "dashpot", "friction"),
    )
    body: str = required(doc="body at one end")
    point_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="point [x, y, z] of that body, measured from the middle of its foot; of a prism from "
        "its at_m; of a mesh that stays where its file has it, in the coordinates of the file",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    to: str = parameter(GROUND_NAME, doc="body at the other end, or a ground")
    to_point_m: tuple[float, ...] = required(
        doc="point [x, y, z] of the other end at the start, measured from the same point of "
        "`body` as point_m, not from `to`, so that it holds for every copy",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    stiffness_n_m: float = parameter(
        0.0, doc="axial stiffness; needed for all kinds but a dashpot", unit="N/m", low=0, high=1e15
    )
    damping_n_s_m: float = parameter(
        0.0,
        doc="axial damping coefficient; with damping_exponent the force at 1 m/s; needed for a "
        "dashpot",
        unit="N s/m",
        low=0,
        high=1e15,
    )
    damping_exponent: float = parameter(
        1.0,
        doc="exponent a of the damping force c |v|^a sign(v), v the rate of elongation, as in "
        "viscous dampers with orifices",
        above=0,
        high=2,
        since="0.11",
    )
    linear_below_m_s: float = parameter(
        1e-3,
        doc="rate of elongation below which the damping force is proportional to the rate, where "
        "damping_exponent < 1: its slope at 0 would be infinite",
        unit="m/s",
        above=0,
        high=1,
        since="0.11",
    )
    prestress_n: float = parameter(
        0.0,
        doc="tension at the start; compression in a strut or stop",
        unit="N",
        low=0,
        high=1e12,
    )
    slack_m: float = parameter(
        0.0,
        doc="elongation of a tendon before it acts; of a restrainer elongation or shortening",
        unit="m",
        low=0,
        high=100,
    )
    gap_m: float = parameter(
        0.0, doc="shortening of a stop before it acts", unit="m", low=0, high=100, since="0.11"
    )
    yield_n: float | None = parameter(
        None,
        doc="force at which the link yields, in each direction in which it carries force: the "
        "force stays constant, or hardens, and a residual elongation remains; left out: it "
        "never yields",
        unit="N",
        above=0,
        high=1e12,
    )
    hardening: float = parameter(
        0.0,
        doc="stiffness after yielding, divided by that before; kinematic: the link yields back "
        "after the force has changed by 2 yield_n",
        low=0,
        high=0.99,
        since="0.11",
    )
    yield_exponent: float | None = parameter(
        None,
        doc="exponent n of the curve by which the force approaches yielding or slip (Bouc-Wen): "
        "the larger, the sharper; left out: a corner",
        low=1,
        high=50,
        since="0.11",
    )
    slip_n: float | None = parameter(
        None,
        doc="force at which a friction damper slips, in both directions; needed for it",
        unit="N",
        above=0,
        high=1e12,
        since="0.11",
    )
    breaking_n: float | None = parameter(
        None,
        doc="force at which the link breaks for good; if it yields, it breaks at the elongation "
        "at which it would reach this force without yielding; left out: it never breaks",
        unit="N",
        above=0,
        high=1e12,
    )
