"""How far bodies lie in one another, by their plane faces."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from fecolumn.structures.faces import SAME_PLANE, Face


def depth_along(faces: list[Face], normal: NDArray[Any]) -> float:
    """Extent [m] of a body along a normal."""
    ends = [face.corners @ normal for face in faces]
    extent: float = max(one.max() for one in ends) - min(one.min() for one in ends)
    return extent


def common_ball(faces: list[Face], others: list[Face], shift: NDArray[Any]) -> float:
    """Diameter [m] of the largest ball in two convex bodies, the other one shifted by (3,) [m]: a
    linear programme in its centre and radius. 0 where there is none, or a body is not convex.
    """
    normals, offsets, sizes = [], [], []
    for own, way in ((faces, np.zeros(3)), (others, shift)):
        planes, ends = np.array([face.normal for face in own]), [face.offset for face in own]
        corners = np.concatenate([face.corners.reshape(-1, 3) for face in own])
        sizes.append(np.ptp(corners, axis=0).max())
        if (planes @ corners.T - np.array(ends)[:, None]).max() > SAME_PLANE * sizes[-1]:
            return 0.0
        normals.append(planes)
        offsets.append(ends + planes @ way)
    found = linprog(
        [0.0, 0.0, 0.0, -1.0],
        A_ub=np.column_stack([np.concatenate(normals), np.ones(sum(map(len, normals)))]),
        b_ub=np.concatenate(offsets),
        bounds=[(None, None)] * 3 + [(0, None)],
    )
    radius = float(found.x[3]) if found.success else 0.0
    return 2 * radius if radius > SAME_PLANE * min(sizes) else 0.0
