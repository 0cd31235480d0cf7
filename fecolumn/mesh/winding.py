"""Which way the corners of plane faces go round."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def counterclockwise(points: NDArray[Any], faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Faces (m, 4) or (m, 3), numbers of points (n, 2), with the corners of each counterclockwise.

    The first corner of those that are turned becomes the last.
    """
    # the diagonals of a quadrilateral, two sides of a triangle
    first, second = (
        points[faces[:, end]] - points[faces[:, start]] for start, end in ((0, 2), (1, -1))
    )
    clockwise = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] < 0
    turned: NDArray[np.int64] = np.where(clockwise[:, None], faces[:, ::-1], faces)
    return turned
