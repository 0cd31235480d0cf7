"""What a user is told of a joint whose bodies do not touch at the start."""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn

import numpy as np

from fecolumn.case.case import Case
from fecolumn.case.joint import Joint
from fecolumn.foundation.schema import InputError
from fecolumn.structures.faces import Face
from fecolumn.structures.meeting import MEANT_TO_TOUCH, OPPOSITE, Gap, place_of
from fecolumn.structures.overlaps import common_ball

# Sine of the angle up to which faces were meant to look at one another
_ALMOST = 0.2


def refuse_joint(
    case: Case,
    name: str,
    interface: Joint,
    gaps: list[Gap],
    near: bool,
    faces: dict[str, list[Face]],
    file: Path | str,
) -> NoReturn:
    """Raise the InputError of a joint whose bodies do not touch at the start.

    The message names the two bodies, how far apart their nearest faces are or how deep the bodies
    lie in one another [m], and what to change in the case.

    Parameters
    ----------
    name, interface
        name of the joint in the case, and its keys.
    gaps
        one Gap for each pair of parallel faces that look at one another; its gap [m] is positive
        where they are apart.
    near
        whether a pair of faces nearly coincides: only its gap is told then.
    faces
        plane faces of each body of the case, by its name.
    file
        of the case, named in the message.
    """
    slave, on = interface.slave, interface.on
    way_out = f"move one by bodies.NAME.at_m, or leave out joints.{name}"
    told = f"no faces of theirs look at one another; {way_out}"
    one = min(gaps, key=lambda gap: abs(gap.gap), default=None)
    if one:
        bodies = f'"{_name(case, one.meeting.slave)}" and {_quoted(case, one.meeting.master)}'
        told = f"the nearest faces, of {bodies}, {_gap_text(one.gap)}; {way_out}"
        if one.gap > 0:
            told += f"; joints.{name}.open = true lets them begin apart"
    inclined, crossing = (
        ("", ("", 0.0)) if near else (_inclined(case, name, faces), _crossing(case, name, faces))
    )
    if one and near:
        told = f"{bodies} {_gap_text(one.gap)}: their faces must coincide at the start"
        told += (
            f"; joints.{name}.open = true lets them begin apart"
            if one.gap > 0
            else f'; move "{_name(case, one.meeting.slave)}" by {_apart(one, faces)} m, '
            f"bodies.{one.meeting.slave[0]}.at_m"
        )
    elif crossing[1]:
        told = f"{crossing[0]} overlap at the start, by {crossing[1]:.3g} m or more: "
        told += f"{inclined}; " if inclined else ""
        told += "a joint is between faces of one plane; move one by bodies.NAME.at_m"
    elif inclined:
        told = f"{inclined}; a joint is between faces of one plane"
    if not near and not crossing[1]:
        told = f'"{slave}" does not touch "{on}" at the start: {told}'
    raise InputError(file, f"joints.{name}", [slave, on], told)


def _crossing(case: Case, name: str, faces: dict[str, list[Face]]) -> tuple[str, float]:
    """Names of the bodies of a joint that lie deepest in one another, and how deep [m]; 0 where
    none do.
    """
    interface, found = case.joints[name], ("", 0.0)
    if interface.on in case.grounds:
        return found
    for one in case.copies_of(interface.slave):
        for other in case.copies_of(interface.on):
            shift = place_of(case, other) - place_of(case, one)
            way = common_ball(faces[one[0]], faces[other[0]], shift) if one != other else 0.0
            found = max(
                found,
                (f'"{_name(case, one)}" and "{_name(case, other)}"', way),
                key=lambda each: each[1],
            )
    return found


def _apart(one: Gap, faces: dict[str, list[Face]]) -> str:
    """The way [m] that takes the slave of an overlap out of its master, in words."""
    body, _ = one.meeting.slave
    way = faces[body][one.meeting.slave_face].normal * one.gap + 0.0
    return "[" + ", ".join(f"{part:.4g}" for part in way) + "]"


def _inclined(case: Case, name: str, faces: dict[str, list[Face]]) -> str:
    """Which two faces with a common edge or corner are inclined to one another by a few degrees, in
    words; "" where none are.
    """
    interface, least, told = case.joints[name], _ALMOST, ""
    if interface.on in case.grounds:
        return ""
    for one in case.copies_of(interface.slave):
        for other in case.copies_of(interface.on):
            offset = place_of(case, one) - place_of(case, other)
            for face in faces[one[0]] if one != other else ():
                mine = (face.corners + offset).reshape(-1, 3)
                for facing in faces[other[0]]:
                    sine = float(np.linalg.norm(np.cross(face.normal, facing.normal)))
                    if face.normal @ facing.normal > 0 or not OPPOSITE < sine < least:
                        continue
                    theirs = facing.corners.reshape(-1, 3)
                    apart = np.linalg.norm(mine[:, None] - theirs, axis=2).min()
                    if apart <= MEANT_TO_TOUCH * np.ptp(theirs, axis=0).max():
                        least, angle = sine, np.degrees(np.arcsin(sine))
                        told = (
                            f'the faces of "{_name(case, one)}" and "{_name(case, other)}" that '
                            f"are nearest are inclined to one another by {angle:.3g} degrees"
                        )
    return told


def _gap_text(gap: float) -> str:
    return f"leave a gap of {gap:.4g} m" if gap > 0 else f"overlap by {-gap:.4g} m"


def _name(case: Case, copy: tuple[str, int]) -> str:
    return case.names_of(copy[0])[copy[1]]


def _quoted(case: Case, copy: tuple[str, int] | None) -> str:
    return "the ground" if copy is None else f'"{_name(case, copy)}"'
