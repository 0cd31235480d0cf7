"""Rayleigh's bound of the lowest elastic frequency of a body that nothing holds: what its spectrum
is shifted by.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fecolumn.fem.body import Body

# Least shift over the largest eigenvalue of K x = w^2 M x: rounding in K moves rigid motions from 0
# by some 1e-16 of that eigenvalue
ROUNDING = 1e-12
# Eigenvalue of the scaled mass matrix, over the largest, below which fields are the same but for
# rounding
_ALIKE = 1e-10


def elastic_bound(body: Body) -> float:
    """Upper bound of the square of the lowest elastic frequency [1/s2].

    Ritz's method with the displacements of second degree in x, y and z. Pure bending, stretch and
    twist of a round bar are among them: the bound of a slender uniform bar is 720 / 500.6 = 1.44
    times the square of its bending frequency. Walls that bend in their plane's normal (the ovals of
    a thin tube of radius R and thickness t) are not; there the bound is some (R / t)^2 too large.
    """
    along = (body.X - body.center) / np.ptp(body.all_X, axis=0)
    x, y, z = along.T
    terms = np.stack([np.ones_like(x), x, y, z, x * x, y * y, z * z, y * z, z * x, x * y], axis=1)
    fields = np.einsum("nk,ij->nikj", terms, np.eye(3)).reshape(-1, 30)
    stiffness, mass = (
        body.sum(fields.T @ body.apply_many(matrix, fields))
        for matrix in (body.stiffness, body.mass)
    )
    # on a coarse mesh some of the fields are alike: only what has mass of its own counts
    scale = 1 / np.sqrt(np.diag(mass))
    values, vectors = np.linalg.eigh(scale[:, None] * mass * scale)
    kept = values > _ALIKE * values[-1]
    basis = scale[:, None] * vectors[:, kept] / np.sqrt(values[kept])
    return float(np.linalg.eigvalsh(basis.T @ stiffness @ basis)[6])


def spectral_shift(body: Body, share: float) -> float:
    """Shift s [1/s2] that makes K + s M positive definite: a share of `elastic_bound`, but above
    the rounding of K.
    """
    return max(share * elastic_bound(body), ROUNDING * body.stiffness_scale / body.mass_scale)
