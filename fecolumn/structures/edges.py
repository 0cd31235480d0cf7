"""The other side of a joint: the edge of what a body stands on, over which the body may come to
stand or to slide.

The contact points of an interface are nodes of its slave. Where the master's outline bounds the
region in which both faces overlap, the slave pivots on that edge: the points are then places of the
master, of an interface with the roles exchanged, made here. Of convex faces, holes apart, the
points are laid on the outline of that region at every step (`contact.two_sided`). Of others the
nodes of the outline that run below the slave's face are points.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, cKDTree

from fecolumn.contact.tolerances import EDGE, ROUND_NODES
from fecolumn.structures.faces import SAME_PLANE, Face, apart, over, triangles_of
from fecolumn.structures.feet import ball_of, foot_of
from fecolumn.structures.meetings import Meeting, allowance_of, place_of
from fecolumn.structures.patches import Patch, node_patch, whole_face

# Angle [rad] between two sides of an outline that are one edge
_STRAIGHT = 1e-3


@dataclass(frozen=True)
class Edge:
    """Outline of a face of `lower` below a face of `upper`, copies as of Meeting; points: (k, 3)
    [m] nodes of it in the drawing of lower.

    zones: of the upper face in which they are and may come, as of `meetings.zones_of`. avoided: (k,
    3) [m] the points in the drawing of upper, where this needs none of its own. corners: of convex
    faces, lists of the corners (n, 3) [m] of the outlines of the lower and of the upper face in
    their drawings, counter-clockwise seen from outside; else ().
    """

    interface: str
    lower: tuple[str, int]
    lower_face: int
    upper: tuple[str, int]
    upper_face: int
    points: np.ndarray
    zones: list[tuple[float, ...]]
    avoided: np.ndarray
    corners: tuple[list, ...] = ()


def edges_of(case, drawings, meetings: list[Meeting]) -> list[Edge]:
    """Edges of all masters that run below the faces of their slaves, but where the case has an
    interface with the roles exchanged.
    """
    stated = {
        (meeting.master, meeting.master_face, meeting.slave, meeting.slave_face)
        for meeting in meetings
    }
    wanted = (
        meeting
        for meeting in meetings
        if meeting.master
        and (meeting.slave, meeting.slave_face, meeting.master, meeting.master_face) not in stated
    )
    return [edge for edge in (_edge(case, drawings, meeting) for meeting in wanted) if edge]


def edge_patch(face: Face, order: int, points: np.ndarray) -> Patch:
    """Contact points of a face at nodes (k, 3) [m] of its outlines."""
    whole = whole_face(face, order)
    return node_patch(whole, np.unique(cKDTree(whole.positions).query(points)[1]))


def _edge(case, drawings, meeting: Meeting) -> Edge | None:
    upper, lower = drawings[meeting.slave[0]], drawings[meeting.master[0]]
    face, other = upper.faces[meeting.slave_face], lower.faces[meeting.master_face]
    if ball_of(upper.body) and face is foot_of(upper.faces):
        return None
    shift, axes = place_of(case, meeting.master) - place_of(case, meeting.slave), face.axes[:, :2]
    outlines = convex_outline(other), convex_outline(face)
    if all(outline is not None for outline in outlines):
        return _of_convex(case, meeting, other, face, outlines, lower.order, shift)
    triangles, sides = triangles_of(face.corners @ axes), face.outline @ axes
    size = np.ptp(triangles, axis=(0, 1)).max()
    # as far beyond its outline a face still holds a point
    margin, whole, allowance = (
        EDGE * size,
        whole_face(other, lower.order),
        allowance_of(case.interfaces[meeting.interface], face),
    )
    nodes = whole.positions[whole.outlines]
    points, ends = (nodes + shift) @ axes, (other.outline + shift) @ axes
    apart, on = _distance(points, sides), over(points, triangles, margin)
    inside = on & (apart > margin)
    middles = ends.mean(axis=1)
    leads_inside = over(middles, triangles, margin) & (_distance(middles, sides) > margin)
    if not leads_inside.any():
        return None
    # where the master's outline comes below the face, and what the slave may slide over; not where
    # both outlines are one
    comes = cKDTree(ends[leads_inside].reshape(-1, 2)).query(points)[0] < margin
    kept = inside | on & comes | ~on & (apart < allowance)
    kept &= cKDTree(_corners(sides)).query(points)[0] > margin
    if not kept.any():
        return None
    if not over(_corners(sides), triangles_of((other.corners + shift) @ axes), margin).all():
        bodies = " and ".join(
            f'"{case.names_of(name)[number]}"' for name, number in (meeting.slave, meeting.master)
        )
        warnings.warn(
            f"interfaces.{meeting.interface}: outlines of {bodies} cross, and one of "
            "them is not convex: their nodes carry, not the places where they cross, "
            "so that a body may lift too early, by 12 % of a plus on a plus turned by "
            "45 degrees; parts that are convex, or smaller elements, are nearer",
            stacklevel=2,
        )
    zones = [(*place, *place, allowance) for place in points[kept].tolist()]
    return Edge(
        meeting.interface,
        meeting.master,
        meeting.master_face,
        meeting.slave,
        meeting.slave_face,
        nodes[kept],
        zones,
        nodes[kept] + shift,
    )


def _of_convex(
    case, meeting: Meeting, other: Face, face: Face, outlines, order: int, shift: np.ndarray
) -> Edge | None:
    """As `_edge`, of convex faces: all nodes of the master's outline that the slave may reach, none
    where it cannot.
    """
    axes, allowance = other.axes, allowance_of(case.interfaces[meeting.interface], face)
    sides = np.stack([outlines[0], np.roll(outlines[0], -1, axis=0)], axis=1) @ axes[:, :2]
    along = sides[:, 1] - sides[:, 0]
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    reached = (outlines[1] - shift) @ axes[:, :2]
    inside = -np.einsum("cia,ia->ci", reached[:, None] - sides[None, :, 0], normals).max(axis=1)
    if inside.min() > allowance:
        return None
    whole = whole_face(other, order)
    nodes = whole.positions[whole.outlines]
    size = np.ptp(nodes, axis=0).max()
    on = _distance(nodes @ axes[:, :2], sides) < EDGE * size
    if len(outlines[0]) < ROUND_NODES:
        # of a circle all nodes carry; of a polygon those that the slave's outline may come to, and
        # the corners
        region = triangles_of(face.corners @ axes[:, :2] - shift @ axes[:, :2])
        on &= over(nodes @ axes[:, :2], region, 2 * allowance) | (
            cKDTree(outlines[0]).query(nodes)[0] < EDGE * size
        )
    zones = [(*start, *end, allowance) for start, end in (face.outline @ face.axes[:, :2]).tolist()]
    return Edge(
        meeting.interface,
        meeting.master,
        meeting.master_face,
        meeting.slave,
        meeting.slave_face,
        nodes[on],
        zones,
        np.zeros((0, 3)),
        tuple(outline.tolist() for outline in outlines),
    )


def convex_outline(face: Face) -> np.ndarray | None:
    """Corners (n, 3) [m] of the outer outline of a face, counter-clockwise seen from outside; None
    where it is not convex.
    """
    axes, sides = face.axes, face.outline
    plane = sides @ axes[:, :2]
    size = np.ptp(plane, axis=(0, 1)).max()
    hull = plane.reshape(-1, 2)[ConvexHull(plane.reshape(-1, 2)).vertices]
    before, after = hull - np.roll(hull, 1, axis=0), np.roll(hull, -1, axis=0) - hull
    turn = (
        (before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        / np.linalg.norm(before, axis=1)
        / np.linalg.norm(after, axis=1)
    )
    hull = hull[turn > _STRAIGHT]
    around = np.stack([hull, np.roll(hull, -1, axis=0)], axis=1)
    ends = np.stack([plane[:, 0], plane.mean(axis=1), plane[:, 1]], axis=1)
    on = (apart(ends[:, :, None], around[None, None]).min(axis=2) < SAME_PLANE * size).all(axis=1)
    covered = np.linalg.norm(plane[on, 1] - plane[on, 0], axis=1).sum()
    if abs(covered - np.linalg.norm(around[:, 1] - around[:, 0], axis=1).sum()) > 1e-3 * size:
        return None
    return hull @ axes[:, :2].T + face.offset * face.normal


def _corners(sides: np.ndarray) -> np.ndarray:
    """Corners (n, 2) [m] of outlines with sides (m, 2, 2), each from its start to its end along
    them: where two sides do not go straight on.
    """
    place, other = cKDTree(sides[:, 0]).query(sides[:, 1])[1], np.arange(len(sides))
    along = np.diff(sides, axis=1)[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    straight = np.einsum("na,na->n", along[other], along[place]) > math.cos(_STRAIGHT)
    return sides[~straight, 1]


def _distance(points: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Distance (n,) [m] of points (n, 2) from the nearest of sides (m, 2, 2)."""
    return apart(points[:, None], sides).min(axis=1)
