"""Structures that cannot be, refused by name before anything is computed."""

from __future__ import annotations

import math
import warnings
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fecolumn.case.case import Case
from fecolumn.contact.points import GROUND
from fecolumn.contact.tolerances import ROUND_NODES
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import FACES, TETRAHEDRON_FACES
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.meeting import Meeting
from fecolumn.structures.model import JointModel, LinkModel
from fecolumn.structures.patches import Patch
from fecolumn.structures.place import footing
from fecolumn.structures.standing import Standing, joined_to

#: Contact points of one body, above which its compliance alone has more than 3000^2 numbers.
_MOST_POINTS = 1000
# Over the smaller body's size: how deep points of one body may lie in another, and how far a link's
# end may lie outside
_DEPTH, _OUTSIDE = 1e-4, 1e-6
# Share of a face's normal that points up from which on it may carry a body
LEAST_UP = 1e-3
# Over its diameter: how far a circle lies outside the polygon of fewest sides that it is drawn as
_ROUND = (1 - math.cos(math.pi / ROUND_NODES)) / 2


class CheckedContact(Protocol):
    """What its check reads of a `layout.ContactPair`."""

    @property
    def slave(self) -> tuple[str, int]:
        """As there."""

    @property
    def master(self) -> tuple[str, int] | None:
        """As there."""


class CheckedLayout(Protocol):
    """What its check reads of a `layout.Layout`; that imports this file, and not this one that."""

    @property
    def drawings(self) -> Mapping[str, Drawing]:
        """By body."""

    @property
    def contacts(self) -> Sequence[CheckedContact]:
        """As there."""


def check_points(name: str, patches: Mapping[str, Patch], file: Path | str) -> None:
    """Refuse a body with more contact points than an analysis can carry."""
    count = sum(len(patch.positions) for patch in patches.values())
    if count > _MOST_POINTS:
        most = max(patches, key=lambda one: len(patches[one].positions))
        raise InputError(
            file,
            f"bodies.{name}.element_size_m",
            None,
            f'"{name}" has {count} contact points, most of them on its {most}; at most '
            f"{_MOST_POINTS}: elements {math.sqrt(count / _MOST_POINTS):.2g} times as large have "
            "about so many; a smaller contact.interior_points, or joints.NAME.allowance_m of its "
            "joints, makes them fewer, too",
        )


def check_meetings(case: Case, meetings: list[Meeting], file: Path | str) -> None:
    """Refuse a joint that is stated twice, in one direction or in each: its points would be there
    twice, and each carry half the force.
    """
    stated: dict[frozenset[tuple[tuple[str, int] | None, int]], str] = {}
    for meeting in meetings:
        faces = frozenset(
            {(meeting.slave, meeting.slave_face), (meeting.master, meeting.master_face)}
        )
        first = stated.setdefault(faces, meeting.interface)
        if first != meeting.interface:
            names = [
                "the ground" if copy is None else f'"{case.names_of(copy[0])[copy[1]]}"'
                for copy in (meeting.slave, meeting.master)
            ]
            raise InputError(
                file,
                f"joints.{meeting.interface}",
                None,
                f"states the joint of joints.{first} again: the same faces of "
                f"{' and '.join(names)}; "
                "leave one of the two out",
            )


def check_carried(
    case: Case,
    airborne: set[int],
    joints: list[JointModel],
    links: Sequence[LinkModel],
    standing: list[Standing],
    file: Path | str,
) -> None:
    """Refuse a body that begins in the air, at rest, and has no joint with what is below it, nor is
    glued or linked to one that has; those whose contact is found have all joints. airborne: places
    of the bodies in the air.
    """
    carried = {place for place, copy in enumerate(case.copies) if copy in set(case.found)}
    carried |= {
        place
        for place, one in enumerate(standing)
        if place not in airborne or one.start is not None and one.start.moves
    }
    for joint in joints:
        up = -standing[joint.slave].model.surfaces[joint.slave_surface].normal[2]
        carried |= {joint.slave} if up > LEAST_UP else set()
        carried |= {joint.master} if up < -LEAST_UP else set()
    pairs = [(joint.slave, joint.master) for joint in joints if joint.bond is not None]
    pairs += [(link.a, link.b) for link in links if link.stiffness]
    for place in sorted(airborne - joined_to(carried, pairs)):
        raise InputError(
            file,
            "joints",
            None,
            f'nothing carries "{standing[place].name}", which has joints with what is beside it '
            "alone: it falls; state a joint with what is below it, such as "
            f'between = ["{standing[place].name}", "ground"]',
        )


def check_layout(case: Case, layout: CheckedLayout, file: Path | str) -> None:
    """Refuse copies without a path to the ground, and those that overlap."""
    copies = case.copies
    fixed = {copy for copy in copies if getattr(case.bodies[copy[0]], "fixed", False)}
    found = set(case.found)
    held = joined_to(
        {None, *fixed, *found}, [(contact.slave, contact.master) for contact in layout.contacts]
    )
    if loose := [
        f'"{case.names_of(name)[number]}"' for name, number in copies if (name, number) not in held
    ]:
        raise InputError(
            file, "joints", None, f"no contact path to the ground from {', '.join(loose)}"
        )
    places = [np.array(case.bodies[name].places[number]) for name, number in copies]
    boxes = [
        (
            layout.drawings[name].points.min(axis=0) + place,
            layout.drawings[name].points.max(axis=0) + place,
        )
        for (name, _), place in zip(copies, places)
    ]
    lowest = min(ground.level_m for ground in case.grounds.values())
    for i, one in enumerate(copies):
        if one in found - fixed:
            _check_planes(case, one, *boxes[i], file)
        if one not in fixed and boxes[i][0][2] < lowest - _DEPTH * np.ptp(boxes[i], axis=0).max():
            raise InputError(
                file,
                f"bodies.{one[0]}",
                None,
                f'"{case.names_of(one[0])[one[1]]}" reaches {lowest - boxes[i][0][2]:.4g} m '
                f"below the ground, z = {lowest:g}",
            )
        for j in range(i):
            other = copies[j]
            if one in fixed and other in fixed:
                continue
            size = min(np.ptp(boxes[i], axis=0).min(), np.ptp(boxes[j], axis=0).min())
            if np.any(boxes[i][0] > boxes[j][1] - _DEPTH * size) or np.any(
                boxes[j][0] > boxes[i][1] - _DEPTH * size
            ):
                continue
            for (a, at_a), (b, at_b) in (
                ((one, places[i]), (other, places[j])),
                ((other, places[j]), (one, places[i])),
            ):
                if (
                    depth := deepest(layout.drawings[a[0]], layout.drawings[b[0]], at_b - at_a)
                ) > _DEPTH * size:
                    raise InputError(
                        file,
                        f"bodies.{one[0]}",
                        None,
                        f'"{case.names_of(one[0])[one[1]]}" and '
                        f'"{case.names_of(other[0])[other[1]]}" overlap at the '
                        f"start, by {depth:.3g} m or more: move one by bodies.{one[0]}.at_m "
                        "or copies_m, or make it smaller",
                    )


def _check_planes(
    case: Case, one: tuple[str, int], low: NDArray[Any], high: NDArray[Any], file: Path | str
) -> None:
    """Refuse a body whose contact is found and that begins below one of several grounds."""
    body = case.names_of(one[0])[one[1]]
    for name, ground in case.grounds.items() if len(case.grounds) > 1 else ():
        under = ground.level_m - float(low[2])
        if under > _DEPTH * (high - low).max():
            raise InputError(
                file,
                "contact.between",
                None,
                f'"{body}" begins {under:.4g} m below grounds.{name}, z = {ground.level_m:g}: '
                "beside this key each ground is a plane without end; take a fixed body for the "
                "higher one",
            )


def deepest(one: Drawing, other: Drawing, shift: NDArray[Any]) -> float:
    """How deep points [m] of a drawing lie within the elements of another that is shifted by (3,)
    [m]; 0 where none does, or there are no elements.
    """
    if other.shape is None:
        return 0.0
    points, mesh = _places_in(one) - shift, other.shape.mesh
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    points = points[np.all((points >= low) & (points <= high), axis=1)]
    if not len(points):
        return 0.0
    corners = mesh.points[mesh.cells]
    middles = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middles[:, None], axis=2).max()
    faces = corners[:, TETRAHEDRON_FACES if mesh.is_tetrahedral else FACES]
    normals = np.cross(faces[:, :, 1] - faces[:, :, 0], faces[:, :, -1] - faces[:, :, 0])
    normals /= np.linalg.norm(normals, axis=2)[..., None]
    deepest = 0.0
    for point, cells in zip(points, cKDTree(middles).query_ball_point(points, reach)):
        if cells:
            depth = np.einsum("cfi,cfi->cf", normals[cells], faces[cells, :, 0] - point).min(axis=1)
            if depth.max() > 0:
                deepest = max(deepest, _to_surface(other, point))
    return deepest


def _places_in(drawing: Drawing) -> NDArray[Any]:
    """Points (n, 3) [m] of a drawing: its own, and of its elements the middles and five places on
    each face, for coarse bodies may cross without a node of one in the other.
    """
    if drawing.shape is None:
        return drawing.points
    mesh = drawing.shape.mesh
    faces = mesh.points[mesh.cells][:, TETRAHEDRON_FACES if mesh.is_tetrahedral else FACES]
    middles = faces.mean(axis=2)
    return np.concatenate(
        [
            drawing.points,
            mesh.points[mesh.cells].mean(axis=1),
            middles.reshape(-1, 3),
            ((faces + middles[:, :, None]) / 2).reshape(-1, 3),
        ]
    )


def _to_surface(drawing: Drawing, point: NDArray[Any]) -> float:
    """Distance [m] of a point inside a body from the nearest plane of its faces."""
    return min((abs(face.normal @ point - face.offset) for face in drawing.faces), default=0.0)


def check_joints(joints: list[JointModel], standing: list[Standing], file: Path | str) -> None:
    """Refuse slaves that hardly have a place at which they stand on their master."""
    count: Counter[frozenset[int]] = Counter()
    for joint in joints:
        count[frozenset((joint.slave, joint.master))] += len(footing(standing, joint))
    for joint in joints:
        if count[frozenset((joint.slave, joint.master))] < (1 if joint.on_dome else 3):
            raise InputError(
                file,
                f"joints.{joint.name.partition(':')[0]}",
                None,
                f'fewer than three nodes of "{standing[joint.slave].name}" lie on '
                f'"{standing[joint.master].name}": make its elements smaller',
            )


def tell_of_gaps(
    joints: list[JointModel], standing: list[Standing], grounds: Sequence[str], file: Path | str
) -> None:
    """Warn of joints that begin open, once for all pairs of a joint; grounds: their names."""
    pairs: dict[str, list[JointModel]] = {}
    for joint in joints:
        if joint.gap and joint.pair < 0:
            pairs.setdefault(joint.name.partition(":")[0], []).append(joint)
    for name, apart in pairs.items():
        widest = max(joint.gap for joint in apart)
        first = apart[0]
        below = grounds[first.ground] if first.master == GROUND else standing[first.master].name
        told = f'"{standing[first.slave].name}" and "{below}" begin {first.gap:.4g} m apart'
        if len(apart) > 1:
            told += f", and {len(apart) - 1} more pairs; {widest:.4g} m at most"
        warnings.warn(f"{file}: joints.{name}: {told}", stacklevel=2)


def check_links(case: Case, extents: dict[str, list[list[float]]], file: Path | str) -> None:
    """Refuse links to nowhere; extents: lowest and highest place (3,) [m] of each body by name, as
    it is drawn.
    """
    for name, link in case.links.items():
        body, numbers = case.meant_by(link.body)
        for number in numbers:
            origin = np.array(case.bodies[body].places[number])
            ends = [("point_m", body, number, origin + link.point_m)]
            if link.to not in case.grounds:  # there anywhere: the ground may have a mast or a wall
                other, (other_number,) = case.meant_by(link.to)
                ends.append(("to_point_m", other, other_number, origin + link.to_point_m))
            for end, of, copy, place in ends:
                low, high = np.array(extents[of])
                arm = place - case.bodies[of].places[copy]
                outside = np.linalg.norm(np.maximum(np.maximum(low - arm, arm - high), 0.0))
                round_by = _ROUND * getattr(case.bodies[of], "outer_diameter_m", 0.0)
                if outside > _OUTSIDE * np.linalg.norm(high - low) + round_by:
                    told = f'must be a point of "{case.names_of(of)[copy]}": it lies '
                    told += f"{outside:.3g} m outside"
                    if end == "to_point_m":
                        told += f', counted from the foot of "{case.names_of(body)[number]}" as '
                        told += "point_m is"
                    raise InputError(file, f"links.{name}.{end}", list(getattr(link, end)), told)
