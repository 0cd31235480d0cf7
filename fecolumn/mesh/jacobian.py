"""Shape of the bricks: Jacobians at their corners."""

from __future__ import annotations

import numpy as np

from fecolumn.mesh.bricks import BrickMesh

# Neighbours of each corner of the VTK hexahedron in right-handed order.
_NEIGHBOURS = np.array(
    [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]]
)


def corner_jacobians(mesh: BrickMesh) -> np.ndarray:
    """(n_cells, 8) Jacobian determinant at the corners, mapped from [-1, 1]^3 [m3]; a folded brick
    has one <= 0.

    (n_cells, 1) of tetrahedra: six times their volume.
    """
    if mesh.is_tetrahedral:
        return np.linalg.det(_spokes(mesh))[:, None]
    return np.linalg.det(_corner_edges(mesh)) / 8


def scaled_jacobian(mesh: BrickMesh) -> np.ndarray:
    """(n_cells,) smallest corner Jacobian over the product of the three edge lengths; 1 for a
    cuboid [-].

    The corner part of the Verdict library's metric (Stimpson et al. 2007, section 6.13). Of a
    tetrahedron, sqrt(2) times it: 1 where it is regular (section 5.10 there).
    """
    if mesh.is_tetrahedral:
        a, b, c = _spokes(mesh).transpose(1, 0, 2)
        ab, bc, ca = (np.linalg.norm(one - two, axis=1) for one, two in ((a, b), (b, c), (c, a)))
        a, b, c = (np.linalg.norm(one, axis=1) for one in (a, b, c))
        largest = np.max([a * b * c, a * ab * ca, b * ab * bc, c * bc * ca], axis=0)
        return np.sqrt(2) * corner_jacobians(mesh)[:, 0] / np.maximum(largest, 1e-300)
    edges = _corner_edges(mesh)
    lengths = np.linalg.norm(edges, axis=3).prod(axis=2)
    return (np.linalg.det(edges) / np.maximum(lengths, 1e-300)).min(axis=1)


def _corner_edges(mesh: BrickMesh) -> np.ndarray:
    corners = mesh.points[mesh.cells]
    return corners[:, _NEIGHBOURS] - corners[:, :, None]


def _spokes(mesh: BrickMesh) -> np.ndarray:
    """(n_cells, 3, 3) edges of tetrahedra from their first corner."""
    corners = mesh.points[mesh.cells]
    return corners[:, 1:] - corners[:, :1]
