"""Rotations: mean rotation of a body, rotation vectors, tilt and twist; products of vectors."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.fem.polar import polar_of
from fecolumn.foundation.arrays import Array


def rotation_matrix(vector: ArrayLike) -> Array:
    """Rotation (3, 3) of the rotation vector (3,) [rad], by Rodrigues' formula."""
    vector = np.asarray(vector, float)
    angle = np.linalg.norm(vector)
    spin = np.array(
        [[0, -vector[2], vector[1]], [vector[2], 0, -vector[0]], [-vector[1], vector[0], 0]]
    )
    # sinc-like quotients stay exact at small angles
    a = np.sinc(angle / np.pi)
    b = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    return np.eye(3) + a * spin + b * spin @ spin


def polar_rotation(moment: Array) -> Array:
    """Rotation R (3, 3) nearest to `moment` = sum m x X^T, so that x ~ R X in the mass-weighted
    mean; (nb, 3, 3) of as many moments.
    """
    if moment.ndim == 3:
        return np.stack([polar_rotation(one) for one in moment])
    rotation = np.empty((3, 3))
    if polar_of(np.ascontiguousarray(moment, float), rotation):
        return rotation
    left, _, right = np.linalg.svd(moment)
    return left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right


def tilt_angle(rotation: Array) -> float:
    """Angle between the body's axis and the vertical [rad]."""
    return float(np.arctan2(np.hypot(rotation[0, 2], rotation[1, 2]), rotation[2, 2]))


def twist_angle(rotation: Array) -> float:
    """Rotation about the vertical left when the tilt is undone the short way [rad]."""
    return float(np.arctan2(rotation[1, 0] - rotation[0, 1], rotation[0, 0] + rotation[1, 1]))


def into_frames(values: Array, rotation: Array, rows: list[slice]) -> Array:
    """Vectors (n, 3) in the table frame as vectors in the frames of their bodies.

    Parameters
    ----------
    rotation
        (nb, 3, 3) body to table.
    rows
        of each body.
    """
    if len(rows) == 1:
        return values @ rotation[0]
    size = rows[0].stop - rows[0].start
    if all(own.stop - own.start == size for own in rows):
        # the same products, of all bodies in one call
        return (values.reshape(len(rows), size, *values.shape[1:]) @ rotation).reshape(values.shape)
    return np.concatenate([values[own] @ R for own, R in zip(rows, rotation, strict=True)])


def out_of_frames(values: Array, rotation: Array, rows: list[slice]) -> Array:
    """Vectors (n, 3) in the frames of their bodies as vectors in the table frame; arguments as of
    `into_frames`.
    """
    return into_frames(values, rotation.swapaxes(-1, -2), rows)


def vector_product(a: Array, b: Array) -> Array:
    """Products a x b (..., 3) of vectors (..., 3), as numpy.cross, which costs more for few."""
    found = np.empty(np.broadcast_shapes(a.shape, b.shape), np.result_type(a, b))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        component = found[..., k]
        np.multiply(a[..., i], b[..., j], out=component)
        component -= a[..., j] * b[..., i]
    return found
