"""Which faces of which bodies touch at the start: found by geometry, copies each with each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.joint import Joint
from fecolumn.foundation.schema import InputError
from fecolumn.structures.faces import SAME_PLANE, Face, any_over, triangles_of
from fecolumn.structures.feet import ball_of
from fecolumn.structures.overlaps import common_ball, depth_along
from fecolumn.structures.patches import plane_box

# Over the slave's width: what faces a body across a smaller gap was meant to touch it
_NEAR = 0.05
# Over the area of a face: two faces are equal
_SAME_AREA = 1e-6
# Sine of the angle up to which faces were meant to look at one another
_ALMOST = 0.2
# Over the lesser depth of two bodies: faces farther behind one another look away
_BEHIND = 0.5
# Cosine from which faces look at one another
_OPPOSITE = 1e-5
# Shares of an element face's corners in a point of it that no regular grid has
_OFF_MIDDLE = np.array([0.41, 0.29, 0.17, 0.13])


@dataclass(frozen=True)
class Meeting:
    """A face of a slave on a face of a master.

    interface: name of it. slave, master: body and number of its copy, master None for the ground.
    slave_face, master_face: places of the faces in the lists of their bodies, master_face -1 of the
    ground. gap: between the faces [m], 0 where they touch.
    """

    interface: str
    slave: tuple[str, int]
    slave_face: int
    master: tuple[str, int] | None
    master_face: int
    gap: float = 0.0


@dataclass(frozen=True)
class _Gap:
    """A meeting of faces that look at one another across a gap, below 0 where they overlap [m];
    width: of the slave's face [m], to which a gap is related.
    """

    meeting: Meeting
    gap: float
    width: float

    @property
    def sides(self) -> list[tuple[tuple[str, int] | None, int]]:
        """Copy and face of both bodies, of the slave alone on the ground."""
        one = self.meeting
        found: list[tuple[tuple[str, int] | None, int]]
        found = [(one.slave, one.slave_face), (one.master, one.master_face)]
        return found if one.master else found[:1]


def meetings_of(case: Case, faces: dict[str, list[Face]], file: Path | str) -> list[Meeting]:
    """Meetings of all interfaces of a case, in its order. Beside one that names all voussoirs of an
    arch, one that names two single bodies stands for what these meet in.

    Raises
    ------
    InputError
        an interface whose bodies have no faces that touch or look at one another, or overlap; or
        for all of whose meetings others stand.
    """
    found = {name: _of_interface(case, name, faces, file) for name in case.joints}
    of_arches = [name for name, one in case.joints.items() if _is_arch(case, one.slave, one.on)]
    single = {
        frozenset((one.slave, one.master))
        for name in found
        if name not in of_arches
        for one in found[name]
    }
    for name in of_arches:
        found[name] = [
            one for one in found[name] if frozenset((one.slave, one.master)) not in single
        ]
        if not found[name]:
            told = "must be left out: others name what its bodies meet in, two by two"
            raise InputError(file, f"joints.{name}", None, told)
    return [meeting for meetings in found.values() for meeting in meetings]


def _is_arch(case: Case, *names: str) -> bool:
    """Whether one of the names stands for all voussoirs of an arch."""
    return any(name not in case.grounds and not _is_body(case, name) for name in names)


def _is_body(case: Case, name: str) -> bool:
    """Whether a name is that of a body or of one of its copies."""
    return name in case.bodies or name.rpartition(" ")[0] in case.bodies


def _of_interface(
    case: Case, name: str, faces: dict[str, list[Face]], file: Path | str
) -> list[Meeting]:
    interface = case.joints[name]
    slaves = case.copies_of(interface.slave)
    ground = case.grounds.get(interface.on)
    masters: Sequence[tuple[str, int] | None] = (
        case.copies_of(interface.on) if ground is None else (None,)
    )
    found: list[Meeting] = []
    gaps: list[_Gap] = []
    for slave in slaves:
        for master in masters:
            if master == slave:
                continue
            meetings, apart = _of_pair(
                case, name, slave, master, faces, master in slaves and slave in masters
            )
            found += meetings
            gaps += apart if not meetings else []
    touching: set[tuple[tuple[str, int] | None, int]] = {
        (one.slave, one.slave_face) for one in found
    }
    touching |= {(one.master, one.master_face) for one in found if one.master}
    gaps = [one for one in gaps if not touching & set(one.sides)]
    if interface.open or not found and interface.open is None:
        across = _across_gaps(gaps)
        met = {frozenset((one.slave, one.master)) for one in across}
        gaps = [one for one in gaps if one.gap < 0]
        gaps = [
            one for one in gaps if frozenset((one.meeting.slave, one.meeting.master)) not in met
        ]
        found += across
    near = [one for one in gaps if abs(one.gap) <= _NEAR * one.width]
    if near or not found:
        _refuse(case, name, interface, near or gaps, bool(near), faces, file)
    return found


def _across_gaps(gaps: list[_Gap]) -> list[Meeting]:
    """Meetings of faces that look at one another across a gap: of each face with the nearest one,
    where that has none nearer, either.
    """
    least: dict[tuple[tuple[str, int] | None, int], float] = {}
    gaps = [one for one in gaps if one.gap > 0]
    for one in gaps:
        for side in one.sides:
            least[side] = min(least.get(side, np.inf), one.gap)
    return [
        one.meeting
        for one in gaps
        if all(one.gap <= least[side] * (1 + SAME_PLANE) for side in one.sides)
    ]


def _refuse(
    case: Case,
    name: str,
    interface: Joint,
    gaps: list[_Gap],
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
        one _Gap for each pair of parallel faces that look at one another; its gap [m] is positive
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


def _apart(one: _Gap, faces: dict[str, list[Face]]) -> str:
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
                    if face.normal @ facing.normal > 0 or not _OPPOSITE < sine < least:
                        continue
                    theirs = facing.corners.reshape(-1, 3)
                    apart = np.linalg.norm(mine[:, None] - theirs, axis=2).min()
                    if apart <= _NEAR * np.ptp(theirs, axis=0).max():
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


def place_of(case: Case, copy: tuple[str, int]) -> NDArray[Any]:
    """Place (3,) [m] of a copy: where the origin of its drawing is at the start."""
    return np.array(case.bodies[copy[0]].places[copy[1]])


def allowance_of(case: Case, meeting: Meeting, face: Face) -> float:
    """How far [m] the slave of a meeting, with this face, may slide."""
    stated, box = case.joints[meeting.interface].allowance_m, plane_box(face)
    if stated is not None:
        return stated
    sides = box[1] - box[0], box[3] - box[2]
    return max(sides) if meeting.gap else min(sides) / 4


def zones_of(
    case: Case, meeting: Meeting, slave: Face, points: NDArray[Any], master: Face
) -> list[tuple[float, ...]]:
    """Zones (start 1, start 2, end 1, end 2, way) [m] of the master's face, along its tangents in
    its drawing, in which points of the slave stand and may come: as far as it may slide around each
    side of its outlines, along which a rim's points roll, and around each of its contact points (k,
    3) [m].
    """
    assert meeting.master is not None
    allowance, shift = (
        allowance_of(case, meeting, slave),
        place_of(case, meeting.slave) - place_of(case, meeting.master),
    )
    spans = (
        np.concatenate([slave.outline, np.stack([points, points], axis=1)]) + shift
    ) @ master.axes[:, :2]
    return [(*start, *end, allowance) for start, end in spans.tolist()]


def _of_pair(
    case: Case,
    name: str,
    slave: tuple[str, int],
    master: tuple[str, int] | None,
    faces: dict[str, list[Face]],
    twice: bool,
) -> tuple[list[Meeting], list[_Gap]]:
    """Meetings of two copies; and of those faces that look at one another elsewhere.

    twice: the two are looked at the other way round, too, so that of two faces one way is left out.
    """
    found: list[Meeting] = []
    gaps: list[_Gap] = []
    place = place_of(case, slave)
    normals = np.array([face.normal for face in faces[master[0]]] if master else []).reshape(-1, 3)
    for number, face in enumerate(faces[slave[0]]):
        box = plane_box(face)
        width = min(box[1] - box[0], box[3] - box[2])
        if master is None:
            if face.normal[2] < -1 + _OPPOSITE:
                gap = place[2] - face.offset - case.grounds[case.joints[name].on].level_m
                meeting = Meeting(name, slave, number, None, -1)
                if abs(gap) <= SAME_PLANE * width:
                    found.append(meeting)
                else:
                    gaps.append(_Gap(replace(meeting, gap=gap), gap, width))
            continue
        offset = place - place_of(case, master)
        if twice and not _is_upper(face, slave, master):
            continue
        away = np.linalg.norm(face.normal + normals, axis=1)
        for other_number in np.flatnonzero(away <= _OPPOSITE).tolist():
            other = faces[master[0]][other_number]
            gap = -(face.offset + face.normal @ offset) - other.offset
            corners = (face.corners + offset) @ other.axes[:, :2]
            if not _overlap(face, corners, other):
                continue
            depths = [depth_along(faces[body], face.normal) for body in (slave[0], master[0])]
            if -gap > _BEHIND * min(depths):
                continue
            meeting = _meeting(case, name, (slave, number, face), (master, other_number, other))
            if abs(gap) <= SAME_PLANE * width:
                found.append(meeting)
            else:
                gaps.append(_Gap(replace(meeting, gap=gap), gap, width))
    return found, gaps


def _meeting(
    case: Case,
    name: str,
    one: tuple[tuple[str, int], int, Face],
    other: tuple[tuple[str, int], int, Face],
) -> Meeting:
    """The meeting of two faces, each (copy, number, Face): the slave is the smaller one, of equal
    ones the upper.

    Which body an interface names first decides nothing, so that the same structure moves alike
    however it is written.
    """
    (copy, number, face), (other_copy, other_number, other_face) = one, other
    larger = face.area - other_face.area
    if abs(larger) <= _SAME_AREA * face.area:
        larger = face.normal[2] if abs(face.normal[2]) > _OPPOSITE else copy > other_copy
    if _is_ball(case, copy, face) or _is_ball(case, other_copy, other_face):
        larger = _is_ball(case, other_copy, other_face)
    if larger > 0:
        return Meeting(name, other_copy, other_number, copy, number)
    return Meeting(name, copy, number, other_copy, other_number)


def _is_ball(case: Case, copy: tuple[str, int], face: Face) -> bool:
    """Whether a face is a foot that touches with balls: only a slave can."""
    return ball_of(case.bodies[copy[0]]) is not None and bool(face.normal[2] < -1 + 1e-9)


def _is_upper(face: Face, slave: tuple[str, int], master: tuple[str, int]) -> bool:
    """Of two copies of one body the upper one is the slave; of two side by side the first."""
    up = face.normal[2]
    return bool(up < -_OPPOSITE or abs(up) <= _OPPOSITE and slave < master)


def _overlap(face: Face, corners: NDArray[Any], other: Face) -> bool:
    """Whether a face, its corners (n, 4 or 3, 2) [m] in the plane of another, lies over part of
    that, more than an edge.
    """
    plane = other.corners @ other.axes[:, :2]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    other_low, other_high = plane.min(axis=(0, 1)), plane.max(axis=(0, 1))
    edge = -SAME_PLANE * min((high - low).min(), (other_high - other_low).min())
    if np.any(low - edge > other_high) or np.any(high + edge < other_low):
        return False

    def tried(quads: NDArray[Any]) -> NDArray[Any]:
        # besides a point off the middle: corners and middles may all lie on edges of the other's
        # elements
        shares = _OFF_MIDDLE[: quads.shape[1]] / _OFF_MIDDLE[: quads.shape[1]].sum()
        return np.concatenate(
            [quads.reshape(-1, 2), quads.mean(axis=1), np.einsum("k,nka->na", shares, quads)]
        )

    mine, theirs = (triangles_of(quads) for quads in (corners, plane))
    return any_over(tried(corners), theirs, edge) or any_over(tried(plane), mine, edge)
