"""What keys of a link say together."""

from __future__ import annotations

import dataclasses
import math

from fecolumn.case.checked import Refuse
from fecolumn.case.link import Link

# What a kind of links cannot do without, stiffness_n_m unless told, with its unit
_NEEDED = {"dashpot": "damping_n_s_m", "friction": "slip_n"}
_UNITS = {"damping_n_s_m": "N s/m", "stiffness_n_m": "N/m", "slip_n": "N"}
# Kinds of which a key says something, and what to state of others
_ELASTIC = ("tendon", "spring", "restrainer", "strut", "stop")
_SLIPPING = (*_ELASTIC, "friction")
_ONLY = {
    "stiffness_n_m": (_SLIPPING, ""),
    "prestress_n": (_SLIPPING, ""),
    "slack_m": (("tendon", "restrainer"), "; a restrainer or a tendon has slack"),
    "gap_m": (("stop",), "; a stop has a gap, a restrainer slack_m"),
    "yield_n": (_ELASTIC, "; a friction damper has slip_n"),
    "slip_n": (("friction",), "; it may have yield_n"),
    "hardening": (_ELASTIC, "; a spring beside it hardens"),
    "yield_exponent": (_SLIPPING, ""),
    "breaking_n": (_SLIPPING, ""),
}
_SLOW = next(one for one in dataclasses.fields(Link) if one.name == "linear_below_m_s").default


def _told(kind: str) -> str:
    return "friction damper" if kind == "friction" else kind


def check_link(key: str, link: Link, refuse: Refuse) -> None:
    """Refuse a link without what its kind needs, or with what says nothing of it."""
    for name in ("point_m", "to_point_m"):
        if len(value := getattr(link, name)) != 3:
            refuse(f"{key}.{name}", list(value), "must be three numbers: x, y, z")
    needed = _NEEDED.get(link.kind, "stiffness_n_m")
    if not (value := getattr(link, needed)):
        told = f"must be greater than 0 {_UNITS[needed]} of a {_told(link.kind)}"
        refuse(f"{key}.{needed}", value, told)
    for name, (kinds, instead) in _ONLY.items():
        if (value := getattr(link, name)) and link.kind not in kinds:
            more = "" if link.kind == "dashpot" else instead
            refuse(f"{key}.{name}", value, f"says nothing of a {_told(link.kind)}{more}")
    if link.kind == "friction" and not link.stiffness_n_m:
        refuse(
            f"{key}.stiffness_n_m",
            link.stiffness_n_m,
            "must be greater than 0 N/m of a friction damper: what gives before it slips, such as "
            "its brace",
        )
    limit, value = ("slip_n", link.slip_n) if link.slip_n else ("yield_n", link.yield_n)
    for name in ("hardening", "yield_exponent"):
        if value is None and (said := getattr(link, name)):
            refuse(f"{key}.{name}", said, "says nothing without yield_n")
    if not link.damping_n_s_m and link.damping_exponent != 1:
        refuse(
            f"{key}.damping_exponent", link.damping_exponent, "says nothing without damping_n_s_m"
        )
    if link.damping_exponent >= 1 and link.linear_below_m_s != _SLOW:
        refuse(
            f"{key}.linear_below_m_s",
            link.linear_below_m_s,
            "says nothing without a damping_exponent below 1",
        )
    if link.prestress_n and (link.slack_m or link.gap_m):
        gap = "slack_m" if link.slack_m else "gap_m"
        refuse(
            f"{key}.prestress_n",
            link.prestress_n,
            f"must be 0 where {gap} is not: a slack link carries nothing",
        )
    if value is not None and link.prestress_n > value:
        refuse(f"{key}.prestress_n", link.prestress_n, f"must be at most {limit} = {value:g} N")
    if link.breaking_n is not None and link.breaking_n < max(link.prestress_n, value or 0.0):
        refuse(f"{key}.breaking_n", link.breaking_n, f"must be at least prestress_n and {limit}")
    if (
        link.kind != "restrainer"
        and math.dist(link.point_m, link.to_point_m) == 0
        and not (link.kind == "tendon" and link.slack_m)
    ):
        refuse(
            f"{key}.to_point_m",
            list(link.to_point_m),
            f"must be another point than point_m: a {_told(link.kind)} of no length has no "
            "direction",
        )
