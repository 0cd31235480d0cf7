"""How the bodies of a case meet: their meshes, the faces that touch, the contact points on
these.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case.bodies import Block, Cylinder, Plate, Storeys, Tube
from fecolumn.case.case import Case
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bodies import Drawing, drawing
from fecolumn.structures.check import check_meetings
from fecolumn.structures.edges import Edge, borders_of, edge_patch, edges_of
from fecolumn.structures.faces import Face
from fecolumn.structures.feet import ball_of, lifted
from fecolumn.structures.hulls import HULL, hull_patch
from fecolumn.structures.meeting import Meeting, place_of
from fecolumn.structures.meetings import meetings_of, zones_of
from fecolumn.structures.patches import Patch, master_patch, slave_patch
from fecolumn.structures.shape import Spot
from fecolumn.structures.size import refuse_too_large


@dataclass(frozen=True)
class ContactPair:
    """A surface of a copy on one of another, or on the ground: slave, master: (body, number of the
    copy), None of the ground.

    pair, outlines, gap, border: as of `model.JointModel`, place among the contacts and sides [m] in
    the drawings of the bodies, of plain lists.
    """

    interface: str
    slave: tuple[str, int]
    slave_surface: str
    master: tuple[str, int] | None
    master_surface: str | None
    pair: int = -1
    outlines: tuple[list[list[list[float]]], ...] = ()
    gap: float = 0.0
    border: list[list[list[float]]] = dataclasses.field(default_factory=list)


@dataclass(frozen=True)
class Layout:
    """drawings: by body. patches: of each body by the names of its surfaces. contacts: in the order
    of the interfaces.
    """

    drawings: dict[str, Drawing]
    patches: dict[str, dict[str, Patch]]
    contacts: tuple[ContactPair, ...]


def layout_of(case: Case, file: Path | str) -> Layout:
    """Mesh the bodies of a case, plates finely where others meet them, and find their contacts.

    Raises
    ------
    InputError
        bodies that do not touch as the interfaces say, or cannot be meshed.
    """
    refuse_too_large(case, file)
    drawings = {name: drawing(case, name, file) for name in case.bodies}
    meetings = meetings_of(case, {name: one.faces for name, one in drawings.items()}, file)
    spots = _spots(case, drawings, meetings)
    if spots:
        refuse_too_large(case, file, spots)
        drawings |= {name: drawing(case, name, file, places) for name, places in spots.items()}
        meetings = meetings_of(case, {name: one.faces for name, one in drawings.items()}, file)
    check_meetings(case, meetings, file)
    for meeting in meetings:
        if (
            meeting.master
            and ball_of(case.bodies[meeting.master[0]])
            and _surface_name(drawings[meeting.master[0]].faces, meeting.master_face, "slave")
            == "foot"
        ):
            raise InputError(
                file,
                f"joints.{meeting.interface}.between",
                list(case.joints[meeting.interface].between),
                f'must meet "{meeting.master[0]}" by another face than its foot, which is not '
                "flat and not the smaller of the two",
            )
    patches: dict[str, dict[str, Patch]] = {name: {} for name in case.bodies}
    contacts: list[ContactPair] = []
    # the points of a pad are those of one face, however the other one lies below it
    without_pads = [one for one in meetings if case.joints[one.interface].stiffness_n_m3 is None]
    edges = edges_of(case, drawings, without_pads)
    for body in case.bodies:
        patches[body] = _touching(case, body, drawings[body], meetings, edges)
    for body in case.bodies:
        patches[body] |= _touched(case, body, drawings, patches, meetings, edges)
    for body in dict.fromkeys(name for name, _ in case.found):
        patches[body][HULL] = hull_patch(drawings[body])
    borders = borders_of(drawings, meetings, edges)
    for place, meeting in enumerate(meetings):
        slave = _surface_name(drawings[meeting.slave[0]].faces, meeting.slave_face, "slave")
        master = meeting.master and _surface_name(
            drawings[meeting.master[0]].faces, meeting.master_face, "master"
        )
        contacts.append(
            ContactPair(
                meeting.interface,
                meeting.slave,
                slave,
                meeting.master,
                master,
                gap=meeting.gap,
                border=borders.get(place, []),
            )
        )
    for edge in edges:
        slave = _surface_name(drawings[edge.lower[0]].faces, edge.lower_face, "edge")
        pair = next(
            k
            for k, one in enumerate(meetings)
            if (one.slave, one.slave_face, one.master, one.master_face)
            == (edge.upper, edge.upper_face, edge.lower, edge.lower_face)
        )
        contacts.append(
            ContactPair(
                edge.interface,
                edge.lower,
                slave,
                edge.upper,
                _surface_name(drawings[edge.upper[0]].faces, edge.upper_face, "master"),
                pair,
                edge.outlines,
                meetings[pair].gap,
            )
        )
    return Layout(drawings, patches, tuple(contacts))


def _spots(
    case: Case, drawings: dict[str, Drawing], meetings: list[Meeting]
) -> dict[str, list[Spot]]:
    """Where other bodies meet plates: (low x, high x, low y, high y, size) [m] in the drawing,
    twice the nodes' distance where those are midway, too.
    """
    found: dict[str, list[Spot]] = {}
    for meeting in meetings:
        for own, other in ((meeting.master, meeting.slave), (meeting.slave, meeting.master)):
            if (
                own is None
                or other is None
                or not isinstance(case.bodies[own[0]], (Plate, Storeys))
            ):
                continue
            face = drawings[other[0]].faces[
                meeting.slave_face if other is meeting.slave else meeting.master_face
            ]
            if not face.is_level:  # it meets a side of the plate, whose nodes stay as they are
                continue
            corners = face.corners.reshape(-1, 3) + place_of(case, other) - place_of(case, own)
            low, high = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
            side = (high - low).min()
            stated = case.joints[meeting.interface].allowance_m
            allowance = side / 4 if stated is None else stated
            size = (
                side / 4 if drawings[own[0]].is_rigid or drawings[own[0]].order == 1 else side / 2
            )
            found.setdefault(own[0], []).append(
                (
                    low[0] - allowance,
                    high[0] + allowance,
                    low[1] - allowance,
                    high[1] + allowance,
                    size,
                )
            )
    return found


def _touching(
    case: Case, body: str, one: Drawing, meetings: list[Meeting], edges: list[Edge]
) -> dict[str, Patch]:
    """Contact points of a body as slave by the names of its surfaces, all copies together."""
    slaves: dict[int, int] = {}
    found: dict[str, Patch] = {}
    for meeting in meetings:
        interface = case.joints[meeting.interface]
        if meeting.slave[0] == body:
            interior = (
                case.interior_points
                if interface.interior_points is None
                else interface.interior_points
            )
            slaves[meeting.slave_face] = max(interior, slaves.get(meeting.slave_face, 0))
    for face, interior in slaves.items():
        drawn, name = one.faces[face], _surface_name(one.faces, face, "slave")
        if name == "foot" and isinstance(one.body, (Tube, Cylinder, Block)):
            drawn = dataclasses.replace(drawn, corners=lifted(one.body, drawn.corners))
        found[name] = slave_patch(drawn, one.order, interior)
    for face in sorted({edge.lower_face for edge in edges if edge.lower[0] == body}):
        points = [
            edge.points for edge in edges if edge.lower[0] == body and edge.lower_face == face
        ]
        found[_surface_name(one.faces, face, "edge")] = edge_patch(
            one.faces[face], one.order, np.concatenate(points)
        )
    return found


def _touched(
    case: Case,
    body: str,
    drawings: dict[str, Drawing],
    touching: dict[str, dict[str, Patch]],
    meetings: list[Meeting],
    edges: list[Edge],
) -> dict[str, Patch]:
    """Nodes of a body as master by the names of its surfaces, all copies together: those near which
    points of its slaves may come.
    """
    zones: dict[int, set[tuple[float, ...]]] = {}
    one = drawings[body]
    for meeting in meetings:
        if meeting.master and meeting.master[0] == body:
            faces = drawings[meeting.slave[0]].faces
            points = touching[meeting.slave[0]][
                _surface_name(faces, meeting.slave_face, "slave")
            ].positions
            zones.setdefault(meeting.master_face, set()).update(
                zones_of(
                    case, meeting, faces[meeting.slave_face], points, one.faces[meeting.master_face]
                )
            )
    for edge in edges:
        if edge.upper[0] == body:
            zones.setdefault(edge.upper_face, set()).update(edge.zones)
    return {
        _surface_name(one.faces, face, "master"): master_patch(
            one.faces[face], one.order, sorted(each)
        )
        for face, each in zones.items()
    }


def _surface_name(faces: list[Face], number: int, role: str) -> str:
    """Name of a face: "foot", "head" or "face 3"; of a master with ", master", of the edge of one
    with ", edge", as its nodes are others.
    """
    level = [k for k, face in enumerate(faces) if face.is_level]
    bottom = min(
        (k for k in level if faces[k].normal[2] < 0), key=lambda k: -faces[k].offset, default=None
    )
    top = max(
        (k for k in level if faces[k].normal[2] > 0), key=lambda k: faces[k].offset, default=None
    )
    name = "foot" if number == bottom else "head" if number == top else f"face {number + 1}"
    return name if role == "slave" else f"{name}, {role}"
