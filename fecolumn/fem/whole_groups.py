"""Modes of one frequency, such as bending along x and along y of a round column: which of them an
eigenvalue solver finds is decided by rounding, so that they are kept together or not at all.
"""

from __future__ import annotations

import numpy as np

from fecolumn.foundation.arrays import Array

#: Difference of two frequencies, over them, below which they are one: those of a mesh that is
#: symmetric differ by 1e-16 to 1e-13, of one that Gmsh has made symmetric to its own tolerance by
#: 1e-6 to 1e-5, those of bodies that are the same along two axes in their size alone by 3e-4 and
#: more.
SAME_FREQUENCY = 1e-4


def with_group(frequencies: Array, count: int) -> int:
    """Number of modes that the `count` lowest are with all of the last one's frequency, of rising
    frequencies (m,); m at most.
    """
    if not 0 < count < len(frequencies):
        return min(count, len(frequencies))
    last = frequencies[count - 1] * (1 + SAME_FREQUENCY)
    return int(np.searchsorted(frequencies, last, side="right"))
