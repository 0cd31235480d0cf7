"""Edges of bodies that show their form, without those of their elements."""

from __future__ import annotations

import numpy as np

# Turn from face to face [deg] from which on an edge shows: facets of a round turn by less
_SHARP = 30.0


def sharp_edges(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Edges (n, 2), numbers of points (n_points, 3), at which the outer faces (n_faces, 3 or 4) of
    bodies turn, or that belong to one face alone.
    """
    corners = points[faces]
    # of a quadrilateral, and of a triangle that names its last corner twice
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    owners = np.repeat(np.arange(len(faces)), faces.shape[1])
    real = edges[:, 0] != edges[:, 1]
    edges, place = np.unique(np.sort(edges[real], axis=1), axis=0, return_inverse=True)
    # an edge between two faces in a plane has twice their normal
    total = np.zeros((len(edges), 3))
    np.add.at(total, place.ravel(), normals[owners[real]])
    flat = 2 * np.cos(np.radians(_SHARP) / 2)
    return edges[np.linalg.norm(total, axis=1) < flat]
