"""Contact points of plane faces: those of a slave, which touch, and those of a master, which are
touched.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fecolumn.contact.footprint import footprint
from fecolumn.contact.rim import Rim
from fecolumn.mesh.bricks import outline_edges
from fecolumn.mesh.surface import face_points, nodal_areas
from fecolumn.mesh.winding import counterclockwise
from fecolumn.structures.faces import Face, apart_from_side
from fecolumn.structures.model import Surface

# Over the size of a face: nodes within it are one
_SAME_NODE = 1e-8


@dataclass(frozen=True)
class Patch:
    """Nodes of a face that take part in contact, in the drawing of the body.

    part: of the mesh, None where the nodes are of no face. positions: (k, 3) [m]; origin: (3,) [m]
    a point of the plane; axes, areas, outlines, triangles, region: as of `model.Surface`.
    """

    part: int | None
    positions: NDArray[Any]
    origin: NDArray[Any]
    axes: NDArray[Any]
    areas: NDArray[Any]
    outlines: NDArray[Any]
    triangles: NDArray[Any]
    region: NDArray[Any]

    def surface(self, nodes: NDArray[Any], center: NDArray[Any]) -> Surface:
        """The patch as surface of a model whose rows `nodes` (k,) are its positions, about its
        centre of mass (3,) [m].
        """
        return Surface(
            np.asarray(nodes, np.int64),
            self.origin - center,
            self.axes,
            self.areas,
            self.outlines,
            self.triangles,
            self.region,
        )


def slave_patch(face: Face, order: int, interior: int) -> Patch:
    """Contact points of a slave: all nodes on the outlines of its face, and about `interior`
    inside; see `contact.footprint`.
    """
    whole = whole_face(face, order)
    places = (whole.positions - whole.origin) @ whole.axes
    nodes, areas = footprint(
        np.arange(len(whole.positions)), places, whole.areas, whole.outlines, interior
    )
    region = places[whole.triangles, :2]
    rim = Rim.find(places)
    if rim is not None:
        # as large as the circles of which the outlines are polygons
        middle = places[rim.nodes, :2].mean(axis=0)
        region = middle + (region - middle) * math.sqrt(rim.sector / math.sin(rim.sector))
    return replace(node_patch(whole, nodes), areas=areas, region=region)


def node_patch(whole: Patch, nodes: NDArray[Any]) -> Patch:
    """Some nodes (k,) of a face, as contact points of a slave."""
    return replace(
        whole,
        positions=whole.positions[nodes],
        areas=whole.areas[nodes],
        outlines=whole.outlines[nodes],
        triangles=np.zeros((0, 3), np.int64),
    )


def master_patch(face: Face, order: int, zones: Iterable[tuple[float, ...]]) -> Patch:
    """Nodes of a master's face in and around `zones` as of `meetings.zones_of`, along its tangents
    in the drawing.
    """
    whole = whole_face(face, order)
    plane = whole.positions @ whole.axes[:, :2]
    corners = plane[whole.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    wanted, edge = (
        np.zeros(len(whole.triangles), bool),
        1e-3 * (high - low).max(),
    )  # elements that only meet a zone's edge lie outside
    for *ends, way in zones:
        side, way = np.reshape(ends, (2, 2)), max(way - edge, edge)
        near = np.flatnonzero(
            ~wanted
            & (high > side.min(axis=0) - way).all(axis=1)
            & (low < side.max(axis=0) + way).all(axis=1)
        )
        wanted[near] = apart_from_side(corners[near], side) < way
    kept, triangles = np.unique(whole.triangles[wanted], return_inverse=True)
    return Patch(
        face.part,
        whole.positions[kept],
        whole.origin,
        whole.axes,
        whole.areas[kept],
        whole.outlines[kept],
        triangles.reshape(-1, 3),
        whole.region,
    )


def face_weights(face: Face, order: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Positions (k, 3) [m] of a face's nodes and their shares (k,) in a mean over it."""
    whole = whole_face(face, order)
    return whole.positions, whole.areas / whole.areas.sum()


def whole_face(face: Face, order: int) -> Patch:
    """All nodes of a face, row by row in an order that only their places decide."""
    axes = face.axes
    points = face_points(face.corners, order)
    size = np.ptp(points.reshape(-1, 3), axis=0).max()
    positions, index = _unique(points.reshape(-1, 3), axes, size)
    index = index.reshape(len(points), -1)
    areas = nodal_areas(face.corners, index, len(positions), order)
    edges = outline_edges(face.cells)
    number, place = np.unique(face.cells, return_index=True)
    ends = face.corners.reshape(-1, 3)[place][np.searchsorted(number, edges)]
    line = np.concatenate(
        [ends[:, 0] + t * (ends[:, 1] - ends[:, 0]) for t in np.arange(order) / order]
    )
    outlines = np.zeros(len(positions), bool)
    outlines[cKDTree(positions).query(line)[1]] = True
    origin = axes[:, 2] * face.offset
    return Patch(
        face.part,
        positions,
        origin,
        axes,
        areas,
        outlines,
        _triangles(index, order, positions @ axes[:, :2]),
        np.zeros((0, 3, 2)),
    )


def _unique(
    points: NDArray[Any], axes: NDArray[Any], size: float
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Different points by rising place along the tangents, and which of them each point (n, 3)
    is.
    """
    rounded = np.round(points @ axes / (_SAME_NODE * size))
    first, index = np.unique(rounded, axis=0, return_index=True, return_inverse=True)[1:]
    index = index.ravel()
    close = cKDTree(points[first]).query_pairs(_SAME_NODE * size, output_type="ndarray")
    if not len(close):
        return points[first], index
    stands_for = np.arange(len(first))
    for one, other in np.sort(close, axis=1):
        stands_for[other] = stands_for[one]
    kept, renumbered = np.unique(stands_for, return_inverse=True)
    return points[first[kept]], renumbered[index]


def _triangles(index: NDArray[Any], order: int, plane: NDArray[Any]) -> NDArray[Any]:
    """Triangles (t, 3) of nodes from the nodes (n, m) of each face as of `face_points`,
    counter-clockwise in the plane (k, 2).
    """
    if index.shape[1] == 3:
        found = index
    elif index.shape[1] == 6:  # corners, and the middles of the sides that follow them
        found = np.concatenate(
            [index[:, list(corners)] for corners in ((0, 3, 5), (1, 4, 3), (2, 5, 4), (3, 4, 5))]
        )
    else:
        grid = index.reshape(-1, order + 1, order + 1)
        a, b, c, d = (
            grid[:, i : i + order, j : j + order].reshape(-1)
            for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))
        )
        found = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return counterclockwise(plane, found)
