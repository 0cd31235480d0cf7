"""Ties: points of one part held to the faces of another whose mesh does not match."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NoReturn

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import PART_NAMES, BrickMesh, boundary_faces

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_NEWTON_STEPS = 30


@dataclass(frozen=True, slots=True)
class Tie:
    """Slave points that move with the master quadrilaterals below or above them.

    Attributes
    ----------
    slave_part, master_part
        parts of the body mesh.
    slave_nodes
        (n_slaves,) point numbers of the body mesh.
    master_quads
        (n_quads, 4) point numbers of the body mesh.
    """

    slave_part: int
    master_part: int
    slave_nodes: np.ndarray
    master_quads: np.ndarray

    def masters(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Where each slave sits: u_slave = sum of weights times u_master.

        Parameters
        ----------
        points
            (n_points, 3) points of the body mesh [m].

        Returns
        -------
        nodes: (n_slaves, 4) master point numbers; weights: (n_slaves, 4), rows sum to one;
        distance: (n_slaves,) of the slave from the master surface [m].
        """
        quad, xi, _, distance = project_to_quads(
            points[self.slave_nodes], points[self.master_quads]
        )
        return self.master_quads[quad], shape_functions(xi), distance


def tie(
    mesh: BrickMesh,
    slave_part: int,
    master_part: int,
    z: float,
    flat: float,
    reach: float,
    names: str,
) -> Tie:
    """Tie of two parts that meet in a horizontal plane.

    Parameters
    ----------
    mesh
        body mesh.
    slave_part, master_part
        the part held and the part that holds.
    z
        height of the plane [m].
    flat
        largest distance of a tied face's corner from the plane [m].
    reach
        largest distance of a slave from the master surface [m].
    names
        the case keys that decide whether the parts meet, for the message.

    Raises
    ------
    InputError
        no faces in the plane, or a slave farther from the master surface than `reach`.
    """

    def refuse(what: str) -> NoReturn:
        raise InputError(
            "mesh",
            names,
            None,
            f"{PART_NAMES[slave_part]} cannot be tied to {PART_NAMES[master_part]}: {what}",
        )

    slaves, masters = (boundary_faces(mesh, part, z, flat) for part in (slave_part, master_part))
    for part, quads in ((slave_part, slaves), (master_part, masters)):
        if not len(quads):
            refuse(f"{PART_NAMES[part]} has no faces within {flat:.3g} m of z = {z:.6g} m")
    found = Tie(slave_part, master_part, np.unique(slaves), masters)
    _, _, distance = found.masters(mesh.points)
    if distance.max() > reach:
        refuse(
            f"a point lies {distance.max():.3g} m off the surface, more than the "
            f"{reach:.3g} m that may be adjusted"
        )
    return found


def adjust(mesh: BrickMesh, ties: Iterable[Tie]) -> BrickMesh:
    """Mesh with every slave moved onto its master surface (Abaqus: ADJUST=YES).

    A slave that stays off the surface it moves with (the arc off its chord) makes the tie resist
    rigid rotation.
    """
    points = mesh.points.copy()
    for one in ties:
        nodes, weights, _ = one.masters(points)
        points[one.slave_nodes] = np.einsum("na,nai->ni", weights, points[nodes])
    return replace(mesh, points=points)


def shape_functions(xi: np.ndarray) -> np.ndarray:
    """(n, 4) bilinear shape functions at `xi` (n, 2) in [-1, 1]^2."""
    return np.prod(1 + xi[:, None, :] * _CORNERS, axis=2) / 4


def project_to_quads(
    points: np.ndarray, quads: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Closest points on a set of bilinear quadrilaterals.

    A quadrilateral lies within its own half-diagonal of its centre, so the nearest one is among
    those whose centre is within (nearest centre + largest half-diagonal); these are all tried.

    Parameters
    ----------
    points
        (n_points, 3) [m].
    quads
        (n_quads, 4, 3) corners in order around [m].

    Returns
    -------
    quad: (n_points,) nearest quadrilateral; xi: (n_points, 2) in [-1, 1]^2;
    projected: (n_points, 3) closest point [m]; distance: (n_points,) [m].
    """
    points, quads = np.asarray(points, dtype=float), np.asarray(quads, dtype=float)
    centres = quads.mean(axis=1)
    half_diagonal = np.linalg.norm(quads - centres[:, None], axis=2).max()
    tree = cKDTree(centres)
    reach = tree.query(points)[0] + half_diagonal * (1 + 1e-9)
    near = tree.query_ball_point(points, reach, return_sorted=True)
    count = np.array([len(found) for found in near])
    quad = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
    point = np.repeat(np.arange(len(points)), count)

    xi, squared = _closest_on_quad(points[point], quads[quad])
    rank = np.lexsort((quad, squared, point))
    best = rank[np.concatenate([[0], np.cumsum(count)[:-1]])]
    projected = np.einsum("na,nai->ni", shape_functions(xi[best]), quads[quad[best]])
    return quad[best], xi[best], projected, np.linalg.norm(points - projected, axis=1)


def _closest_on_quad(points: np.ndarray, quads: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Local coordinates (n, 2) and squared distance (n,) of the closest point on one bilinear
    quadrilateral each.

    Either the foot of a normal inside (Newton from the centre) or the closest point of one of the
    four straight edges.
    """
    inside = _foot_of_normal(points, quads)
    candidates = [np.clip(inside, -1, 1)]
    for start in range(4):
        end = (start + 1) % 4
        edge = quads[:, end] - quads[:, start]
        along = np.einsum("ni,ni->n", points - quads[:, start], edge) / np.maximum(
            np.einsum("ni,ni->n", edge, edge), 1e-300
        )
        along = np.clip(along, 0, 1)[:, None]
        candidates.append((1 - along) * _CORNERS[start] + along * _CORNERS[end])
    squared = [
        np.sum((np.einsum("na,nai->ni", shape_functions(xi), quads) - points) ** 2, axis=1)
        for xi in candidates
    ]
    best = np.argmin(squared, axis=0)
    each = np.arange(len(points))
    return np.stack(candidates)[best, each], np.stack(squared)[best, each]


def _foot_of_normal(points: np.ndarray, quads: np.ndarray) -> np.ndarray:
    """Newton's solution (n, 2) of (x(xi) - p) . x_xi = 0; values outside the square mark a foot
    outside.
    """
    # x = c0 + c1 xi + c2 eta + c3 xi eta
    signs = np.stack([np.ones(4), _CORNERS[:, 0], _CORNERS[:, 1], _CORNERS.prod(axis=1)])
    c0, c1, c2, c3 = np.einsum("ka,nai->kni", signs / 4, quads)
    xi = np.zeros((len(points), 2))
    for _ in range(_NEWTON_STEPS):
        s, t = xi[:, :1], xi[:, 1:]
        off = c0 + s * c1 + t * c2 + s * t * c3 - points
        along_s, along_t = c1 + t * c3, c2 + s * c3
        residual_s, residual_t = (off * along_s).sum(1), (off * along_t).sum(1)
        a, b, d = (along_s**2).sum(1), (along_s * along_t + off * c3).sum(1), (along_t**2).sum(1)
        # Off a warped quadrilateral the full Hessian may be indefinite; Gauss-Newton's never is.
        b = np.where(a * d - b * b > 1e-12 * a * d, b, (along_s * along_t).sum(1))
        determinant = np.maximum(a * d - b * b, 1e-300)
        step = (
            np.stack([d * residual_s - b * residual_t, a * residual_t - b * residual_s], axis=1)
            / determinant[:, None]
        )
        xi = np.clip(xi - step, -3, 3)
        if np.abs(step).max(initial=0) < 1e-15:
            break
    return xi
