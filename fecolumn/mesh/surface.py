"""Lagrange nodes, basis and tributary areas on the faces of bricks of any order, and of
tetrahedra.
"""

from __future__ import annotations

import numpy as np

from fecolumn.mesh.tie import shape_functions


def face_points(quads: np.ndarray, order: int) -> np.ndarray:
    """Positions (n_quads, (order + 1)^2, 3) of the Lagrange nodes of faces with corners (n_quads,
    4, 3).

    Of triangles (n, 3, 3), order 2: (n, 6, 3), the corners and the middles of the sides that follow
    them.
    """
    if quads.shape[1] == 3:
        return np.concatenate([quads, (quads + np.roll(quads, -1, axis=1)) / 2], axis=1)
    line = np.linspace(-1, 1, order + 1)
    xi = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.einsum("ka,nai->nki", shape_functions(xi), quads)


def face_basis(xi: np.ndarray, order: int) -> np.ndarray:
    """Lagrange basis (n, (order + 1)^2) at local coordinates xi (n, 2), in the order of
    `face_points`.
    """
    line = np.linspace(-1, 1, order + 1)
    values = np.ones((len(xi), 2, order + 1))
    for k in range(order + 1):
        for other in np.delete(line, k):
            values[:, :, k] *= (xi - other) / (line[k] - other)
    return np.einsum("ni,nj->nij", values[:, 0], values[:, 1]).reshape(len(xi), -1)


def nodal_areas(quads: np.ndarray, nodes: np.ndarray, n_nodes: int, order: int) -> np.ndarray:
    """Tributary area (n_nodes,) [m2]: integral of each node's basis function over the faces.

    Parameters
    ----------
    quads
        (n_quads, 4, 3) corners [m], in one horizontal plane.
    nodes
        (n_quads, (order + 1)^2) node of each face point.

    The quadratic basis of a triangle's corner has no area at all: there the areas are those of the
    linear basis on its four quarters.
    """
    if quads.shape[1] == 3:
        areas = np.zeros(n_nodes)
        whole = (
            np.linalg.norm(np.cross(quads[:, 1] - quads[:, 0], quads[:, 2] - quads[:, 0]), axis=1)
            / 2
        )
        np.add.at(areas, nodes, whole[:, None] * np.repeat([1 / 12, 1 / 4], 3))
        return areas
    points, weights = np.polynomial.legendre.leggauss(3)
    areas = np.zeros(n_nodes)
    for s, ws in zip(points, weights):
        for t, wt in zip(points, weights):
            along_s = np.einsum(
                "a,nai->ni", np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) / 4, quads
            )
            along_t = np.einsum(
                "a,nai->ni", np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) / 4, quads
            )
            jacobian = np.linalg.norm(np.cross(along_s, along_t), axis=1)
            basis = face_basis(np.array([[s, t]]), order)[0]
            np.add.at(areas, nodes, ws * wt * jacobian[:, None] * basis)
    return areas
