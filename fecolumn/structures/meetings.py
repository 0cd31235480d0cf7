"""Which faces of which bodies touch at the start: found by geometry, copies each with each."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.foundation.schema import InputError
from fecolumn.structures.faces import SAME_PLANE, Face, any_over, triangles_of
from fecolumn.structures.feet import ball_of
from fecolumn.structures.meeting import MEANT_TO_TOUCH, OPPOSITE, Gap, Meeting, place_of
from fecolumn.structures.not_touching import refuse_joint
from fecolumn.structures.outlines import cross_product
from fecolumn.structures.overlaps import depth_along
from fecolumn.structures.spring_areas import overlap_of

# Over the area of a face: two faces are equal
_SAME_AREA = 1e-6
# Over the lesser depth of two bodies: faces farther behind one another look away
_BEHIND = 0.5
# Shares of an element face's corners in a point of it that no regular grid has
_OFF_MIDDLE = np.array([0.41, 0.29, 0.17, 0.13])


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
        every = found[name]
        found[name] = [one for one in every if frozenset((one.slave, one.master)) not in single]
        if every and not found[name]:
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
    both = set(slaves) & set(masters)
    found: list[Meeting] = []
    gaps: list[Gap] = []
    held = False
    # only where no faces touch does it matter which look at one another from afar
    for only_near in (True, False):
        if found or only_near and interface.open:
            continue
        gaps = []
        for slave, master in _pairs(case, slaves, masters, faces, only_near):
            if master == slave:
                continue
            twice = slave in both and master in both
            meetings, apart = _of_pair(case, name, slave, master, faces, twice)
            if _are_held(case, slave, master):
                held |= bool(meetings)
                continue
            found += meetings
            gaps += apart if not meetings else []
    if held and not found and not gaps and not interface.open:
        return []  # all that meets or looks at one another there is fixed
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
    near = [one for one in gaps if abs(one.gap) <= MEANT_TO_TOUCH * one.width]
    if near or not found:
        refuse_joint(case, name, interface, near or gaps, bool(near), faces, file)
    return found


def _pairs(
    case: Case,
    slaves: Sequence[tuple[str, int]],
    masters: Sequence[tuple[str, int] | None],
    faces: dict[str, list[Face]],
    only_near: bool,
) -> Iterator[tuple[tuple[str, int], tuple[str, int] | None]]:
    """Each slave with each master; with only_near those with faces that may touch or were meant to:
    their boxes along the axes are no farther apart.
    """
    if not only_near or None in masters:
        yield from itertools.product(slaves, masters)
        return
    low, high = _boxes(case, masters, faces)
    for slave, own_low, own_high in zip(slaves, *_boxes(case, slaves, faces)):
        margin = MEANT_TO_TOUCH * (own_high - own_low).max()
        near = (low <= own_high + margin).all(axis=1) & (high >= own_low - margin).all(axis=1)
        for place in np.flatnonzero(near).tolist():
            yield slave, masters[place]


def _boxes(
    case: Case, copies: Sequence[Any], faces: dict[str, list[Face]]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Least and largest places (n, 3) [m] of the faces of copies; of no face inf and -inf."""
    spans = {}
    for body in {body for body, _ in copies}:
        corners = [np.zeros((0, 3)), *(one.corners.reshape(-1, 3) for one in faces[body])]
        points = np.concatenate(corners)
        spans[body] = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
    low, high = (
        np.array([spans[copy[0]][side] + place_of(case, copy) for copy in copies])
        for side in range(2)
    )
    return low, high


def _are_held(case: Case, slave: tuple[str, int], master: tuple[str, int] | None) -> bool:
    """Whether both are fixed, or one is and the other is the ground: they cannot move apart."""
    return all(
        one is None or getattr(case.bodies[one[0]], "fixed", False) for one in (slave, master)
    )


def _across_gaps(gaps: list[Gap]) -> list[Meeting]:
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


def allowance_of(case: Case, meeting: Meeting, face: Face) -> float:
    """How far [m] the slave of a meeting, with this face, may slide."""
    stated = case.joints[meeting.interface].allowance_m
    if stated is not None:
        return stated
    sides = np.ptp(face.box, axis=0)
    return float(sides.max() if meeting.gap else sides.min() / 4)


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
) -> tuple[list[Meeting], list[Gap]]:
    """Meetings of two copies; and of those faces that look at one another elsewhere.

    twice: the two are looked at the other way round, too, so that of two faces one way is left out.
    """
    found: list[Meeting] = []
    gaps: list[Gap] = []
    place = place_of(case, slave)
    normals = np.array([face.normal for face in faces[master[0]]] if master else []).reshape(-1, 3)
    for number, face in enumerate(faces[slave[0]]):
        width = float(np.ptp(face.box, axis=0).min())
        if master is None:
            if face.normal[2] < -1 + OPPOSITE:
                gap = place[2] - face.offset - case.grounds[case.joints[name].on].level_m
                meeting = Meeting(name, slave, number, None, -1)
                if abs(gap) <= SAME_PLANE * width:
                    found.append(meeting)
                else:
                    gaps.append(Gap(replace(meeting, gap=gap), gap, width))
            continue
        offset = place - place_of(case, master)
        if twice and not _is_upper(face, slave, master):
            continue
        away = np.linalg.norm(face.normal + normals, axis=1)
        for other_number in np.flatnonzero(away <= OPPOSITE).tolist():
            other = faces[master[0]][other_number]
            gap = -(face.offset + face.normal @ offset) - other.offset
            corners = (face.corners + offset) @ other.axes[:, :2]
            if not _overlap(corners, other):
                continue
            depths = [depth_along(faces[body], face.normal) for body in (slave[0], master[0])]
            if -gap > _BEHIND * min(depths):
                continue
            meeting = _meeting(case, name, (slave, number, face), (master, other_number, other))
            if abs(gap) <= SAME_PLANE * width:
                found.append(meeting)
            else:
                gaps.append(Gap(replace(meeting, gap=gap), gap, width))
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
        larger = face.normal[2] if abs(face.normal[2]) > OPPOSITE else copy > other_copy
    if _is_ball(case, copy, face) or _is_ball(case, other_copy, other_face):
        larger = _is_ball(case, other_copy, other_face)
    if larger > 0:
        return Meeting(name, other_copy, other_number, copy, number)
    return Meeting(name, copy, number, other_copy, other_number)


def _is_ball(case: Case, copy: tuple[str, int], face: Face) -> bool:
    """Whether a face is a foot that touches with balls: only a slave can."""
    return ball_of(case.bodies[copy[0]]) is not None and face.is_level and face.normal[2] < 0


def _is_upper(face: Face, slave: tuple[str, int], master: tuple[str, int]) -> bool:
    """Of two copies of one body the upper one is the slave; of two side by side the first."""
    up = face.normal[2]
    return bool(up < -OPPOSITE or abs(up) <= OPPOSITE and slave < master)


def _overlap(corners: NDArray[Any], other: Face) -> bool:
    """Whether a face, by its corners (n, 4 or 3, 2) [m] in the plane of another, lies over part of
    that, more than an edge.
    """
    plane = other.plane
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    other_low, other_high = other.box
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
    if any_over(tried(corners), theirs, edge) or any_over(tried(plane), mine, edge):
        return True
    # long elements may cross where neither has such a point
    sides = cross_product(*np.moveaxis(np.diff(overlap_of(mine, theirs), axis=1), 1, 0))
    length = max((high - low).max(), (other_high - other_low).max())
    return bool(np.abs(sides).sum() / 2 > -edge * length)
