"""How bodies that move in few ways answer what the points between them give by their motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.coupling import columns_used
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.coupling import Coupling


@njit
def curvature(coupling: Coupling, acts: Array, slopes: Array) -> Array:
    """Matrix (m, m): 1 + V^T S V, the bodies in their order of elimination.

    Parameters
    ----------
    coupling
        by levers, which are V.
    acts
        (n,) whether a point plays a part.
    slopes
        (n, 3, 3) of S, by how much less force a point gives for a motion of its own.
    """
    bodies, blocks, levers = coupling.bodies, coupling.blocks, coupling.levers
    rows, columns, n, i = blocks.first[-1], columns_used(coupling), len(levers), 0
    width, matrix, block = (
        levers.shape[2] // 2,
        np.zeros((rows, rows)),
        np.empty((columns, columns)),
    )
    for j in range(rows):
        matrix[j, j] = 1.0
    while i < n:
        # the points between the same two bodies
        slave, master, some = bodies[i, 0], bodies[i, 1], False
        block[:] = 0.0
        while i < n and bodies[i, 0] == slave and bodies[i, 1] == master:
            if acts[i]:
                _add_point(levers[i], slopes[i], block)
                some = True
            i += 1
        if not some:
            continue
        for side in range(2):
            b = master if side else slave
            if b < 0:
                continue
            top = blocks.first[blocks.of[b]]
            for other in range(2):
                c = master if other else slave
                if c < 0:
                    continue
                first = blocks.first[blocks.of[c]]
                for u in range(width):
                    for v in range(width):
                        matrix[top + u, first + v] += block[width * side + u, width * other + v]
    return matrix


@njit(fastmath={"contract"})
def _add_point(levers: Array, slope: Array, block: Array) -> None:
    """Add the levers (3, 2 w), transposed, times a slope (3, 3) times the levers to a block (c, c)
    of their first c columns.
    """
    first, second, third = levers[0], levers[1], levers[2]
    s00, s01, s02 = slope[0, 0], slope[0, 1], slope[0, 2]
    s10, s11, s12 = slope[1, 0], slope[1, 1], slope[1, 2]
    s20, s21, s22 = slope[2, 0], slope[2, 1], slope[2, 2]
    for u in range(len(block)):
        x, y, z, line = first[u], second[u], third[u], block[u]
        # of the row of the levers, transposed, times the slope
        a, b, c = (
            x * s00 + y * s10 + z * s20,
            x * s01 + y * s11 + z * s21,
            x * s02 + y * s12 + z * s22,
        )
        for v in range(len(block)):
            line[v] += a * first[v] + b * second[v] + c * third[v]


@njit
def rows_of_motion(coupling: Coupling, motion: Array) -> Array:
    """(m,) of a motion (nb, w) of the bodies in their order of elimination."""
    blocks, width = coupling.blocks, motion.shape[1]
    found = np.empty(blocks.first[-1])
    for b in range(len(motion)):
        if blocks.of[b] >= 0:
            for c in range(width):
                found[blocks.first[blocks.of[b]] + c] = motion[b, c]
    return found


@njit
def motion_of_rows(coupling: Coupling, values: Array) -> Array:
    """Motion (nb, w) of the bodies of its rows, as of `rows_of_motion`."""
    blocks, width = coupling.blocks, coupling.levers.shape[2] // 2
    motion = np.zeros((len(blocks.of), width))
    for b in range(len(motion)):
        if blocks.of[b] >= 0:
            for c in range(width):
                motion[b, c] = values[blocks.first[blocks.of[b]] + c]
    return motion
