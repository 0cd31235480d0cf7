"""What moves as a rigid whole on the page: bodies, and the floors of buildings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.pictures.render.pose import Poses
from fecolumn.pictures.render.result import Result
from fecolumn.pictures.render.sharp_edges import sharp_edges

#: Triangles of all bodies that a page holds; finer surfaces are made coarser
MOST_TRIANGLES = 120_000
# Edges of elements that are drawn: they show how a round body turns about its axis
_MOST_EDGES = 20_000


@dataclass(frozen=True, slots=True)
class RigidPart:
    """A rigid whole.

    Attributes
    ----------
    name, kind
        of the body, such as "column 2" and "column".
    body
        its number; the floors of a building follow its slab.
    points
        (n, 3) [m] from `rest`.
    triangles
        (k, 3) of these, counter-clockwise seen from outside.
    edges, lines
        (m, 2) of these at which the form turns, and the other edges of elements.
    rest
        (3,) [m] its place at rest.
    place
        (t, 3) [m] at each time, in the frame of the ground.
    turn
        (t, 4) quaternions x, y, z, w.
    """

    name: str
    kind: str
    body: int
    points: np.ndarray
    triangles: np.ndarray
    edges: np.ndarray
    lines: np.ndarray
    rest: np.ndarray
    place: np.ndarray
    turn: np.ndarray


def parts_of(result: Result, times: np.ndarray) -> list[RigidPart]:
    """The parts of all bodies and their places at `times` (t,) [s]."""
    scene, found = result.scene, []
    budget = MOST_TRIANGLES / max(1, sum(2 * len(piece.faces) for piece in scene.bodies))
    lined = sum(2 * len(piece.faces) for piece in scene.bodies) <= _MOST_EDGES
    for number, piece in enumerate(scene.bodies):
        pose = result.poses[number].at(times)
        turn = _quaternions(pose)
        firm = len(piece.points) - piece.carried
        surface = piece.upright, piece.faces, pose.origin
        whole = np.all(piece.faces < firm, axis=1)
        shifts = _shifts(result, number, times)
        for k, shift in enumerate(shifts):
            # the slab comes first, then each floor by the eight points of its box
            low = firm + 8 * (k - 1)
            own = (
                whole if k == 0 else np.all((piece.faces >= low) & (piece.faces < low + 8), axis=1)
            )
            shape = _shape(*surface, own, budget, lined)
            place = pose.foot + shift
            found.append(
                RigidPart(piece.name, piece.kind, number, *shape, pose.origin, place, turn)
            )
    return found


def _shifts(result: Result, number: int, times: np.ndarray) -> list[np.ndarray]:
    """Displacement (t, 3) [m] beyond the pose of a body, of a building's slab and of each floor."""
    floors = result.scene_history.floors.get(number)
    if floors is None:
        return [np.zeros((len(times), 3))]
    rows = np.minimum(np.searchsorted(result.time, times - 1e-9), len(result.time) - 1)
    return list(np.swapaxes(floors[rows], 0, 1))


def _quaternions(pose: Poses) -> np.ndarray:
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(pose.rotation).as_quat()


def _shape(
    points: np.ndarray,
    faces: np.ndarray,
    origin: np.ndarray,
    own: np.ndarray,
    budget: float,
    lined: bool,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points from `origin`, triangles, sharp edges and other edges of the faces `own`."""
    nodes, corners = np.unique(faces[own], return_inverse=True)
    faces, points = corners.reshape(-1, faces.shape[1]), points[nodes] - origin
    edges = sharp_edges(points, faces)
    lines = np.zeros((0, 2), int)
    if lined:
        every = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
        every = np.unique(np.sort(every[every[:, 0] != every[:, 1]], axis=1), axis=0)
        sharp = {tuple(edge) for edge in edges}
        lines = np.array([edge for edge in every if tuple(edge) not in sharp]).reshape(-1, 2)
    triangles = faces[:, :3]
    if faces.shape[1] == 4:
        triangles = np.concatenate([triangles, faces[:, [0, 2, 3]]])
    corner = triangles[:, 0] == triangles[:, 1], triangles[:, 1] == triangles[:, 2]
    triangles = triangles[~(corner[0] | corner[1] | (triangles[:, 0] == triangles[:, 2]))]
    if budget >= 1:
        return points, triangles, edges, lines
    return _coarser(points, triangles, edges, budget)


def _coarser(
    points: np.ndarray, triangles: np.ndarray, edges: np.ndarray, budget: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A surface of fewer triangles, with the edges of the fine one."""
    import pyvista

    fine = pyvista.PolyData.from_regular_faces(np.asarray(points, np.float32), triangles)
    coarse = fine.decimate(1 - budget, volume_preservation=True)
    ends, numbers = np.unique(edges, return_inverse=True)
    count = coarse.n_points
    return (
        np.concatenate([coarse.points, points[ends]]),
        coarse.regular_faces,
        numbers.reshape(-1, 2) + count,
        np.zeros((0, 2), int),
    )
