"""Frictional contact of many points by an interior point: slow but hardly ever lost, where the
active set of Newton cycles.

With R = (r_t, mu r_n) and U = (s_t, s_n / mu + |s_t|), s = W r + q, the laws of Coulomb and
Signorini are a complementarity in the cone of Lorentz, K = {|x_t| <= x_n}: R in K, U in K, R.U = 0
(De Saxce and Feng 1998). A primal-dual method in the scaling of Nesterov and Todd follows R o U =
sigma e by Newton steps, in which |s_t| counts as what it is, a function of U; with |s_t| of the
last iterate (Acary, Armand, Nguyen and Shpakovych 2023) it would creep. With |s_t| frozen the
problem is convex (Acary, Cadoux, Lemarechal and Malick 2011).
"""

from __future__ import annotations

import numpy as np

from fecolumn.contact.arrays import flat, largest, put_matrix, put_points
from fecolumn.contact.tolerances import (
    INSIDE_CENTRED,
    INSIDE_END,
    INSIDE_JAMMED,
    INSIDE_SMOOTH,
    INSIDE_WAY,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


@njit
def in_cones(W: Array, q: Array, friction: Array) -> tuple[Array, Array]:
    """Compliance (3 n, 3 n) and slip (n, 3) without forces in the units of R and U; arguments as of
    `friction.solve_contact`, friction (n,).

    A point without friction keeps its normal alone: with R_t = U_t = 0 its cone is the half-line.
    """
    n = len(q)
    A, Q = np.empty((3 * n, 3 * n)), np.empty((n, 3))
    put_matrix(W, A)
    put_matrix(q, Q)
    for i in range(n):
        mu, k = friction[i], 3 * i + 2
        if mu == 0.0:
            for t in range(3 * i, k):
                A[t, :], A[:, t], Q[i, t - 3 * i] = 0.0, 0.0, 0.0
                A[t, t] = W[t, t]
            continue
        for j in range(3 * n):
            A[k, j] /= mu
        for j in range(3 * n):
            A[j, k] /= mu
        Q[i, 2] /= mu
    return A, Q


@njit
def approach(
    A: Array, Q: Array, friction: Array, R: Array, U: Array, most: int, slips: Array
) -> tuple[Array, int]:
    """Go `most` iterations on towards a solution from R, U (n, 3), inside the cones, or from the
    middle where they are zero; both change.

    A, Q: of `in_cones`. slips: (n,) |s_t| [m] where they are frozen; (0,) where they are to be
    those of U. Returns: forces (n, 3), iterations made: fewer where it is at its end, or gets no
    farther.
    """
    n, frozen = len(Q), len(slips) > 0
    length, total = max(largest(Q), 1e-300), 0.0
    for i in range(3 * n):
        for j in range(3 * n):
            total += abs(A[i, j])
    force = length * 3 * n / total
    if R[0, 2] == 0.0:
        for i in range(n):
            R[i, 2], U[i, 2] = force, length
    matrix, right, block = np.empty((3 * n, 3 * n)), np.empty((3 * n, 2)), np.empty((3, 3))
    infeasible, slope, ways, changes = (
        np.empty((n, 3)),
        np.zeros((n, 2)),
        np.empty((2, n, 3)),
        np.empty((2, n, 3)),
    )
    for iteration in range(most):
        gap = _product(R, R, U, U, 0.0) / n
        smoothing = INSIDE_SMOOTH * gap / force
        put_points(A @ flat(R), infeasible)
        for i in range(n):
            for a in range(3):
                infeasible[i, a] += Q[i, a] - U[i, a]
            if frozen:
                infeasible[i, 2] += slips[i]
            else:
                size = np.sqrt(U[i, 0] ** 2 + U[i, 1] ** 2 + smoothing**2)
                infeasible[i, 2] += size - smoothing
                slope[i, 0], slope[i, 1] = U[i, 0] / size, U[i, 1] / size
        if gap <= INSIDE_END * length * force and largest(infeasible) <= INSIDE_END * length:
            return _unscaled(R, friction), iteration
        put_matrix(A, matrix)
        finite = 0.0
        for i in range(n):
            # dU = G (A dR + infeasible) and P^2 dR + dU = wanted, G = 1 + e_n slope^T; its inverse
            # takes `slope` times two rows from the third
            _scaling(R[i], U[i], block)
            square, x, y = R[i, 2] ** 2 - R[i, 0] ** 2 - R[i, 1] ** 2, slope[i, 0], slope[i, 1]
            for b in range(3):
                matrix[3 * i, 3 * i + b] += block[0, b]
                matrix[3 * i + 1, 3 * i + b] += block[1, b]
                matrix[3 * i + 2, 3 * i + b] += block[2, b] - x * block[0, b] - y * block[1, b]
                finite += block[0, b] + block[1, b] + block[2, b]
                right[3 * i + b, 0] = -U[i, b] - infeasible[i, b]
                # what leads to R o U = gap e, apart from the first
                right[3 * i + b, 1] = gap * (R[i, b] if b == 2 else -R[i, b]) / square
            right[3 * i + 2, 0] += x * U[i, 0] + y * U[i, 1]
            right[3 * i + 2, 1] -= x * right[3 * i, 1] + y * right[3 * i + 1, 1]
        # at the cones' very boundary, where rounding rules, there is no scaling
        if not np.isfinite(finite):
            return _unscaled(R, friction), iteration
        try:
            found = np.linalg.solve(matrix, right)
        except Exception:
            return _unscaled(R, friction), iteration
        moved = A @ found
        for k in range(2):
            for i in range(n):
                for a in range(3):
                    ways[k, i, a] = found[3 * i + a, k]
                    changes[k, i, a] = moved[3 * i + a, k] + (infeasible[i, a] if k == 0 else 0.0)
                changes[k, i, 2] += slope[i, 0] * changes[k, i, 0] + slope[i, 1] * changes[k, i, 1]
        t = min(1.0, _way(R, ways[0]), _way(U, changes[0]))
        after = max(_product(R, ways[0], U, changes[0], t) / n, 0.0)
        centring = min(max((after / gap) ** 1.5, INSIDE_CENTRED), 1.0)
        for i in range(n):
            for a in range(3):
                ways[0, i, a] += centring * ways[1, i, a]
                changes[0, i, a] += centring * changes[1, i, a]
        if not np.isfinite(_product(ways[0], ways[0], changes[0], changes[0], 0.0)):
            return _unscaled(R, friction), iteration
        t = min(1.0, INSIDE_WAY * min(_way(R, ways[0]), _way(U, changes[0])))
        for i in range(n):
            for a in range(3):
                R[i, a] += t * ways[0, i, a]
                U[i, a] += t * changes[0, i, a]
        if t < INSIDE_JAMMED:
            return _unscaled(R, friction), iteration
    return _unscaled(R, friction), most


@njit
def _scaling(r: Array, u: Array, square: Array) -> None:
    """P^2 (3, 3) of Nesterov and Todd's symmetric P with P r = P^-1 u."""
    tangential, across = np.hypot(r[0], r[1]), np.hypot(u[0], u[1])
    size_r = np.sqrt(max((r[2] - tangential) * (r[2] + tangential), 1e-300))
    size_u = np.sqrt(max((u[2] - across) * (u[2] + across), 1e-300))
    half = np.sqrt((1 + (r[0] * u[0] + r[1] * u[1] + r[2] * u[2]) / (size_r * size_u)) / 2)
    w0, w1 = (
        (u[0] / size_u - r[0] / size_r) / (2 * half),
        (u[1] / size_u - r[1] / size_r) / (2 * half),
    )
    w2, share = (u[2] / size_u + r[2] / size_r) / (2 * half), size_u / size_r
    square[0, 0], square[1, 1] = share * (1 + 2 * w0 * w0), share * (1 + 2 * w1 * w1)
    square[0, 1] = square[1, 0] = share * 2 * w0 * w1
    square[0, 2] = square[2, 0] = share * 2 * w0 * w2
    square[1, 2] = square[2, 1] = share * 2 * w1 * w2
    square[2, 2] = share * (2 * w2 * w2 - 1)


@njit
def _way(x: Array, d: Array) -> float:
    """Largest t for which x + t d (n, 3) lies in the cones."""
    least = np.inf
    for i in range(len(x)):
        a = d[i, 2] * d[i, 2] - d[i, 0] * d[i, 0] - d[i, 1] * d[i, 1]
        b = x[i, 2] * d[i, 2] - x[i, 0] * d[i, 0] - x[i, 1] * d[i, 1]
        c = x[i, 2] * x[i, 2] - x[i, 0] * x[i, 0] - x[i, 1] * x[i, 1]
        square = b * b - a * c
        if square >= 0:
            if b < 0:
                least = min(least, c / (np.sqrt(square) - b))
            elif a < 0:
                least = min(least, (-b - np.sqrt(square)) / a)
        if d[i, 2] < 0:
            least = min(least, -x[i, 2] / d[i, 2])
    return least


@njit
def _unscaled(R: Array, friction: Array) -> Array:
    """Forces (n, 3) from R."""
    forces = np.empty((len(R), 3))
    for i in range(len(R)):
        forces[i, 0], forces[i, 1], forces[i, 2] = (
            R[i, 0],
            R[i, 1],
            R[i, 2] / (friction[i] if friction[i] > 0.0 else 1.0),
        )
    return forces


@njit
def _product(R: Array, dR: Array, U: Array, dU: Array, t: float) -> float:
    """Sum of (R + t dR) (U + t dU)."""
    total = 0.0
    for i in range(len(R)):
        for a in range(3):
            total += (R[i, a] + t * dR[i, a]) * (U[i, a] + t * dU[i, a])
    return total
