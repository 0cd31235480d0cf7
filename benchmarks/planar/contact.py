"""Corners of polygons against faces of other ones: where they are, and how fast a corner moves
across and along the face.

A corner has the coordinates s along the face from its first corner, and g across it, outwards of
the body of the face: its gap. Both are functions of the places alone, so that their change over a
step is what the corner really moves, turns of both bodies included.
"""

from __future__ import annotations

import numpy as np
from numba import njit

#: What is as close as this to the end of a face is still on it [m]: far below any length, far above
#: rounding
EDGE = 1e-9
#: Corners nearer than what a relative velocity of so many m/s covers in a step take part in it;
#: deeper than this [m] none does: it came from beside the face
NEAR, DEEPEST = 10.0, 0.05


@njit(cache=True)
def locate(place, pair, shape):
    """(s, g) [m] of a corner; place: (nb, 3), pair: (2,), shape: (7,) as of `bodies.Structure`."""
    b, f = pair[0], pair[1]
    cb, sb, cf, sf = (
        np.cos(place[b, 2]),
        np.sin(place[b, 2]),
        np.cos(place[f, 2]),
        np.sin(place[f, 2]),
    )
    x = place[b, 0] - place[f, 0] + cb * shape[0] - sb * shape[1]
    z = place[b, 1] - place[f, 1] + sb * shape[0] + cb * shape[1]
    # in the frame of the face's body
    x, z = cf * x + sf * z - shape[2], cf * z - sf * x - shape[3]
    return x * shape[4] + z * shape[5], x * shape[5] - z * shape[4]


@njit(cache=True)
def near(place, pairs, shape, reach, found):
    """Put the numbers of the corners that are on a face and nearer than `reach` [m] into `found`;
    their count.
    """
    count = 0
    for c in range(len(pairs)):
        s, g = locate(place, pairs[c], shape[c])
        if -EDGE <= s <= shape[c, 6] + EDGE and -DEEPEST < g < reach:
            found[count] = c
            count += 1
    return count


@njit(cache=True)
def jacobian(place, pair, shape, rows):
    """rows (2, 2, 3): gradients of g (first) and s by the places of the corner's body and of the
    face's body.
    """
    b, f = pair[0], pair[1]
    cb, sb, cf, sf = (
        np.cos(place[b, 2]),
        np.sin(place[b, 2]),
        np.cos(place[f, 2]),
        np.sin(place[f, 2]),
    )
    arm_x, arm_z = cb * shape[0] - sb * shape[1], sb * shape[0] + cb * shape[1]
    from_x, from_z = place[b, 0] + arm_x - place[f, 0], place[b, 1] + arm_z - place[f, 1]
    along_x, along_z = cf * shape[4] - sf * shape[5], sf * shape[4] + cf * shape[5]
    for i in range(2):
        x, z = (along_z, -along_x) if i == 0 else (along_x, along_z)
        rows[i, 0, 0], rows[i, 0, 1], rows[i, 0, 2] = x, z, arm_x * z - arm_z * x
        rows[i, 1, 0], rows[i, 1, 1], rows[i, 1, 2] = -x, -z, -(from_x * z - from_z * x)
