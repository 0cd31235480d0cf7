"""An elastic layer without edges on a rigid ground: how the nodes of its top move under a force on
one of them.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from fecolumn.foundation.arrays import Array

# Images of the force in a periodic layer are so many thicknesses away: what they do there is below
# 1e-6 of the force's own
CLEAR = 10.0
# Cells of the periodic layer along a side, at most: a minute of work
MOST_CELLS = 2048


def layer_response(size: float, depths: Array, material: Any, reach: int) -> Array:
    """Displacements (2 reach + 1, 2 reach + 1, 3, 3) [m/N] of the top's nodes around one that
    carries a unit force.

    The layer is made of 8-node bricks, size x size in plan, everywhere the same, so that the
    response depends on the distance of two nodes only. A wave exp(i (p j + q k)) of the nodes j, k
    keeps its shape through the layer: its displacements are those of a column of 3 x 3 blocks,
    eliminated from the bottom, which is held, to the top. Periodic in the plan, so that the waves
    are those of a Fourier transform.

    Parameters
    ----------
    size
        of a brick in plan [m].
    depths
        (n,) levels of the nodes from 0 at the top, falling [m].
    material
        with youngs_modulus_pa and poissons_ratio.
    reach
        number of nodes to each side.

    Returns
    -------
    response[reach + j, reach + k, a, b]: along axis a at j, k nodes from the force along axis
        b.

    Raises
    ------
    ValueError
        the layer is too thick for bricks of this size; the message says how thick it may be.
    """
    n = 2 * reach + 1 + int(np.ceil(CLEAR * -depths[-1] / size))
    if n > MOST_CELLS:
        raise ValueError(
            f"must be at most {(MOST_CELLS - 2 * reach - 1) * size / CLEAR:.3g} m where "
            f"its bricks are {size:g} m wide"
        )
    # even, so that the half of the waves is mirrored on the other
    n += n % 2
    waves = 2 * np.pi * np.arange(n // 2 + 1) / n
    top = np.empty((len(waves), len(waves), 3, 3), complex)
    layers = [
        _by_offset(brick_stiffness(size, size, high - low, material))
        for high, low in zip(depths[:-1], depths[1:])
    ]
    for row, wave in enumerate(waves):
        # what the top of the lowest brick bears; then level by level up
        carried = _of_waves(layers[-1], wave, waves)[0, 0]
        for blocks in reversed(layers[:-1]):
            (above, down), (up, below) = _of_waves(blocks, wave, waves)
            carried = above - down @ np.linalg.solve(below + carried, up)
        top[row] = np.linalg.inv(carried)
    mirror = np.array([-1.0, 1.0, 1.0])
    other = top[-2:0:-1] * np.outer(mirror, mirror)
    response = np.fft.irfft2(np.concatenate([top, other]), s=(n, n), axes=(0, 1))
    return np.roll(response, (reach, reach), axis=(0, 1))[: 2 * reach + 1, : 2 * reach + 1]


def brick_stiffness(dx: float, dy: float, dz: float, material: Any) -> Array:
    """Stiffness (2, 2, 2, 3, 2, 2, 2, 3) [N/m] of an 8-node brick, corners by their place along x,
    y, z: exact for 2 x 2 x 2 points.
    """
    E, nu = material.youngs_modulus_pa, material.poissons_ratio
    shear, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    size = np.array([dx, dy, dz])
    stiffness = np.zeros((2, 2, 2, 3, 2, 2, 2, 3))
    for point in itertools.product((0.5 - np.sqrt(1 / 12), 0.5 + np.sqrt(1 / 12)), repeat=3):
        shapes = [np.array([1 - s, s]) for s in point]
        gradient = np.empty((2, 2, 2, 3))
        for axis in range(3):
            factors = [
                np.array([-1.0, 1.0]) / size[a] if a == axis else shapes[a] for a in range(3)
            ]
            gradient[..., axis] = np.einsum("i,j,k->ijk", *factors)
        g = gradient.reshape(8, 3)
        # sigma : epsilon = lame div u div v + shear (grad u + grad u^T) : grad v
        local = lame * np.einsum("pa,qb->paqb", g, g) + shear * (
            np.einsum("pb,qa->paqb", g, g) + np.einsum("pc,qc,ab->paqb", g, g, np.eye(3))
        )
        stiffness += local.reshape(stiffness.shape) * size.prod() / 8
    return stiffness


def _by_offset(stiffness: Array) -> Array:
    """Blocks (3, 3, 2, 2, 3, 3) of a brick summed by how far its corners are apart in plan, -1 to
    1; then upper and lower level.
    """
    blocks = np.zeros((3, 3, 2, 2, 3, 3))
    for px, py, pz, qx, qy, qz in itertools.product(range(2), repeat=6):
        blocks[1 + qx - px, 1 + qy - py, 1 - pz, 1 - qz] += stiffness[px, py, pz, :, qx, qy, qz, :]
    return blocks


def _of_waves(blocks: Array, p: float, q: Array) -> Array:
    """Blocks (2, 2, len(q), 3, 3) of the waves p along x and q along y."""
    along, across = np.exp(1j * p * np.arange(-1, 2)), np.exp(1j * np.outer(q, np.arange(-1, 2)))
    return np.einsum("j,wk,jkmnab->mnwab", along, across, blocks)
