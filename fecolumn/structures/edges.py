"""The other side of a joint: the edge of what a body stands on, over which the body may come to
stand or to slide.

The contact points of an interface are nodes of its slave. Where the master's outline bounds the
region in which both faces overlap, the slave pivots on that edge: the points are then places of the
master, of an interface with the roles exchanged, made here. They are laid on the outline of that
region at every step (`contact.two_sided`). Holes of faces are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fecolumn.case.case import Case
from fecolumn.contact.tolerances import EDGE_REACH, ROUND_NODES
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.faces import Face, apart, over, triangles_of
from fecolumn.structures.feet import ball_of, foot_of
from fecolumn.structures.meeting import Meeting, place_of
from fecolumn.structures.meetings import allowance_of
from fecolumn.structures.outlines import convex_outline, crossings, inwards, outline_of
from fecolumn.structures.patches import Patch, node_patch, whole_face


@dataclass(frozen=True)
class Edge:
    """Outline of a face of `lower` below a face of `upper`, copies as of Meeting; points: (k, 3)
    [m] nodes of it in the drawing of lower.

    zones: of the upper face in which they are and may come, as of `meetings.zones_of`. outlines:
    lists of the ends (n, 2, 3) [m] of the sides of the outlines of the lower and of the upper face
    in their drawings, counter-clockwise seen from outside.
    """

    interface: str
    lower: tuple[str, int]
    lower_face: int
    upper: tuple[str, int]
    upper_face: int
    points: NDArray[Any]
    zones: list[tuple[float, ...]]
    outlines: tuple[list[list[list[float]]], list[list[list[float]]]]


def edges_of(case: Case, drawings: dict[str, Drawing], meetings: list[Meeting]) -> list[Edge]:
    """Edges of all masters that run below the faces of their slaves, but where the case has an
    interface with the roles exchanged.
    """
    return [edge for edge in (_edge(case, drawings, one) for one in _one_sided(meetings)) if edge]


def borders_of(
    drawings: dict[str, Drawing], meetings: list[Meeting], edges: list[Edge]
) -> dict[int, list[list[list[float]]]]:
    """`JointModel.border` in the drawing of the master, by places of the meetings that have one."""
    prepared = {(one.upper, one.upper_face, one.lower, one.lower_face) for one in edges}
    one_sided = {_roles(one) for one in _one_sided(meetings)} - prepared
    return {
        place: outline_of(drawings[one.master[0]].faces[one.master_face]).tolist()
        for place, one in enumerate(meetings)
        if one.master and _roles(one) in one_sided
    }


def _one_sided(meetings: list[Meeting]) -> list[Meeting]:
    """Meetings of two bodies but those that the case has with the roles exchanged, too."""
    stated = {
        (meeting.master, meeting.master_face, meeting.slave, meeting.slave_face)
        for meeting in meetings
    }
    return [one for one in meetings if one.master and _roles(one) not in stated]


def _roles(meeting: Meeting) -> tuple[Any, ...]:
    """Who lies with which face on whose."""
    return (meeting.slave, meeting.slave_face, meeting.master, meeting.master_face)


def edge_patch(face: Face, order: int, points: NDArray[Any]) -> Patch:
    """Contact points of a face at nodes (k, 3) [m] of its outlines."""
    whole = whole_face(face, order)
    return node_patch(whole, np.unique(cKDTree(whole.positions).query(points)[1]))


def _edge(case: Case, drawings: dict[str, Drawing], meeting: Meeting) -> Edge | None:
    """All nodes of the master's outline that the slave may reach, None where it cannot."""
    assert meeting.master is not None
    upper, lower = drawings[meeting.slave[0]], drawings[meeting.master[0]]
    face, other = upper.faces[meeting.slave_face], lower.faces[meeting.master_face]
    if ball_of(upper.body) and face is foot_of(upper.faces):
        return None
    shift = place_of(case, meeting.master) - place_of(case, meeting.slave)
    outlines, plane = (outline_of(other), outline_of(face)), other.axes[:, :2]
    allowance = allowance_of(case, meeting, face)
    sides, reached = outlines[0] @ plane, (outlines[1] - shift) @ plane
    # a joint that begins open has two sides in any case: it takes no part while it is apart
    if (
        not meeting.gap
        and inwards(reached[:, 0], sides).min() > allowance
        and inwards(sides[:, 0], reached).max() < -allowance
        and not len(crossings(sides, reached))
    ):
        return None
    whole = whole_face(other, lower.order)
    nodes = whole.positions[whole.outlines]
    size = np.ptp(nodes, axis=0).max()
    on = _distance(nodes @ plane, sides) < EDGE_REACH * size
    if len(sides) < ROUND_NODES or convex_outline(other) is None:
        # of a circle all nodes carry; of a polygon those that the slave's outline may come to, and
        # the corners
        region = triangles_of(face.corners @ plane - shift @ plane)
        on &= over(nodes @ plane, region, 2 * allowance) | (
            cKDTree(outlines[0][:, 0]).query(nodes)[0] < EDGE_REACH * size
        )
    # where the outlines of either face lie over the slave's, and as far as they may slide
    lines = np.concatenate([face.outline, outlines[0] + shift]) @ face.axes[:, :2]
    zones = [(*start, *end, allowance) for start, end in lines.tolist()]
    return Edge(
        meeting.interface,
        meeting.master,
        meeting.master_face,
        meeting.slave,
        meeting.slave_face,
        nodes[on],
        zones,
        (outlines[0].tolist(), outlines[1].tolist()),
    )


def _distance(points: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """Distance (n,) [m] of points (n, 2) from the nearest of sides (m, 2, 2)."""
    distances: NDArray[Any] = apart(points[:, None], sides).min(axis=1)
    return distances
