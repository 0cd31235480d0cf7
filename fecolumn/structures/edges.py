"""Edges of what a body stands on, below the middle of its face: a slab that overhangs a block, a drum on a smaller one.

The contact points of an interface are nodes of its slave. Where the master's outline runs below the slave's face, the slave pivots on it, between its own nodes. The nodes of the
outline are then contact points, too, of an interface with the roles exchanged, made here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.contact.tolerances import EDGE
from fecolumn.structures.faces import Face, apart, over, triangles_of
from fecolumn.structures.feet import ball_of, foot_of
from fecolumn.structures.meetings import Meeting, allowance_of, place_of
from fecolumn.structures.patches import Patch, node_patch, whole_face

# Angle [rad] between two sides of an outline that are one edge
_STRAIGHT = 1e-3


@dataclass(frozen=True)
class Edge:
    """Outline of a face of `lower` below a face of `upper`, copies as of Meeting; points: (k, 3) [m] nodes of it in the drawing of lower.

    zones: of the upper face in which they are and may come, as of `meetings.zones_of`. avoided: (k, 3) [m] the points in the drawing of upper, where this needs none of its own.
    """

    interface: str
    lower: tuple[str, int]
    lower_face: int
    upper: tuple[str, int]
    upper_face: int
    points: np.ndarray
    zones: list[tuple[float, ...]]
    avoided: np.ndarray


def edges_of(case, drawings, meetings: list[Meeting]) -> list[Edge]:
    """Edges of all masters that run below the faces of their slaves, but where the case has an interface with the roles exchanged."""
    stated = {(meeting.master, meeting.master_face, meeting.slave, meeting.slave_face) for meeting in meetings}
    wanted = (meeting for meeting in meetings if meeting.master and (meeting.slave, meeting.slave_face, meeting.master, meeting.master_face) not in stated)
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
    triangles, sides = triangles_of(face.corners @ axes), face.outline @ axes
    size = np.ptp(triangles, axis=(0, 1)).max()
    # as far beyond its outline a face still holds a point
    margin, whole, allowance = EDGE * size, whole_face(other, lower.order), allowance_of(case.interfaces[meeting.interface], face)
    nodes = whole.positions[whole.outlines]
    points, ends = (nodes + shift) @ axes, (other.outline + shift) @ axes
    apart, on = _distance(points, sides), over(points, triangles, margin)
    inside = on & (apart > margin)
    middles = ends.mean(axis=1)
    leads_inside = over(middles, triangles, margin) & (_distance(middles, sides) > margin)
    if not leads_inside.any():
        return None
    # where the master's outline comes below the face, and what the slave may slide over; not where both outlines are one
    comes = cKDTree(ends[leads_inside].reshape(-1, 2)).query(points)[0] < margin
    kept = inside | on & comes | ~on & (apart < allowance)
    kept &= cKDTree(_corners(sides)).query(points)[0] > margin
    if not kept.any():
        return None
    zones = [(*place, *place, allowance) for place in points[kept].tolist()]
    return Edge(meeting.interface, meeting.master, meeting.master_face, meeting.slave, meeting.slave_face, nodes[kept], zones, nodes[kept] + shift)


def _corners(sides: np.ndarray) -> np.ndarray:
    """Corners (n, 2) [m] of outlines with sides (m, 2, 2), each from its start to its end along them: where two sides do not go straight on."""
    place, other = cKDTree(sides[:, 0]).query(sides[:, 1])[1], np.arange(len(sides))
    along = np.diff(sides, axis=1)[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    straight = np.einsum("na,na->n", along[other], along[place]) > math.cos(_STRAIGHT)
    return sides[~straight, 1]


def _distance(points: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Distance (n,) [m] of points (n, 2) from the nearest of sides (m, 2, 2)."""
    return apart(points[:, None], sides).min(axis=1)
