"""Frictional contact of many points by an interior point: slow but hardly ever lost, where the active set of Newton cycles.

With R = (r_t, mu r_n) and U = (s_t, s_n / mu + |s_t|), s = W r + q, the laws of Coulomb and Signorini are a complementarity in the
cone of Lorentz, K = {|x_t| <= x_n}: R in K, U in K, R.U = 0 (De Saxce and Feng 1998). A primal-dual method in the scaling of Nesterov
and Todd, with Mehrotra's corrector, follows R o U = sigma e; the term |s_t| is taken from the last iterate (Acary, Armand, Nguyen and
Shpakovych 2023), or frozen, which makes the problem convex (Acary, Cadoux, Lemarechal and Malick 2011).
"""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.arrays import flat, largest, put_matrix, put_points
from fecolumn.contact.tolerances import INSIDE_END, INSIDE_WAY


@njit
def in_cones(W, q, friction):
    """Compliance (3 n, 3 n) and slip (n, 3) without forces in the units of R and U; arguments as of `friction.solve_contact`, friction (n,).

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
def approach(A, Q, friction, R, U, most, slips, frozen):
    """Go `most` iterations on towards a solution from R, U (n, 3), inside the cones, or from the middle where they are zero; both change.

    A, Q: of `in_cones`. slips: (n,) |s_t| [m] where they are `frozen`; else they are those of the last iterate.
    Returns: forces (n, 3), iterations made: fewer where it is at its end.
    """
    n = len(Q)
    length, total = max(largest(Q), 1e-300), 0.0
    for i in range(3 * n):
        for j in range(3 * n):
            total += abs(A[i, j])
    force = length * 3 * n / total
    if R[0, 2] == 0.0:
        for i in range(n):
            R[i, 2], U[i, 2] = force, length
    P, inverse, scaled, matrix = np.empty((n, 3, 3)), np.empty((n, 3, 3)), np.empty((n, 3)), np.empty((3 * n, 3 * n))
    wanted, infeasible, dR, dU = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    for iteration in range(most):
        put_points(A @ flat(R), infeasible)
        for i in range(n):
            for a in range(3):
                infeasible[i, a] += Q[i, a] - U[i, a]
            infeasible[i, 2] += slips[i] if frozen else np.hypot(U[i, 0], U[i, 1])
        gap = _product(R, R, U, U, 0.0) / n
        if gap <= INSIDE_END * length * force and largest(infeasible) <= INSIDE_END * length:
            return _unscaled(R, friction), iteration
        put_matrix(A, matrix)
        finite = 0.0
        for i in range(n):
            _scaling(R[i], U[i], P[i], inverse[i])
            for a in range(3):
                finite += P[i, a, 0] + P[i, a, 1] + P[i, a, 2]
                scaled[i, a] = P[i, a, 0] * R[i, 0] + P[i, a, 1] * R[i, 1] + P[i, a, 2] * R[i, 2]
                for b in range(3):
                    matrix[3 * i + a, 3 * i + b] += P[i, a, 0] * P[i, 0, b] + P[i, a, 1] * P[i, 1, b] + P[i, a, 2] * P[i, 2, b]
        # at the cones' very boundary, where rounding rules, there is no scaling
        if not np.isfinite(finite):
            return _unscaled(R, friction), iteration
        try:
            factor = np.linalg.cholesky(matrix)
        except Exception:
            return _unscaled(R, friction), iteration
        for i in range(n):
            for a in range(3):
                wanted[i, a] = -U[i, a]
        _direction(A, factor, wanted, infeasible, dR, dU)
        t = min(1.0, _way(R, dR), _way(U, dU))
        after = max(_product(R, dR, U, dU, t) / n, 0.0)
        centring = min(max((after / gap) ** 3, 1e-4), 1.0)
        for i in range(n):
            _corrected(P[i], inverse[i], scaled[i], dR[i], dU[i], centring * gap, wanted[i])
        _direction(A, factor, wanted, infeasible, dR, dU)
        if not np.isfinite(_product(dR, dR, dU, dU, 0.0)):
            return _unscaled(R, friction), iteration
        t = min(1.0, INSIDE_WAY * min(_way(R, dR), _way(U, dU)))
        for i in range(n):
            for a in range(3):
                R[i, a] += t * dR[i, a]
                U[i, a] += t * dU[i, a]
    return _unscaled(R, friction), most


@njit
def _scaling(r, u, P, inverse):
    """Nesterov and Todd's symmetric P (3, 3) with P r = P^-1 u, and its inverse."""
    tangential, across = np.hypot(r[0], r[1]), np.hypot(u[0], u[1])
    size_r = np.sqrt(max((r[2] - tangential) * (r[2] + tangential), 1e-300))
    size_u = np.sqrt(max((u[2] - across) * (u[2] + across), 1e-300))
    half = np.sqrt((1 + (r[0] * u[0] + r[1] * u[1] + r[2] * u[2]) / (size_r * size_u)) / 2)
    w0, w1 = (u[0] / size_u - r[0] / size_r) / (2 * half), (u[1] / size_u - r[1] / size_r) / (2 * half)
    w2, eta = (u[2] / size_u + r[2] / size_r) / (2 * half), np.sqrt(size_u / size_r)
    P[0, 0], P[1, 1], P[0, 1] = 1 + w0 * w0 / (1 + w2), 1 + w1 * w1 / (1 + w2), w0 * w1 / (1 + w2)
    P[0, 2], P[1, 2], P[2, 2] = w0, w1, w2
    P[1, 0], P[2, 0], P[2, 1] = P[0, 1], P[0, 2], P[1, 2]
    for a in range(3):
        for b in range(3):
            inverse[a, b] = P[a, b] / eta
            P[a, b] *= eta
    inverse[0, 2], inverse[1, 2] = -inverse[0, 2], -inverse[1, 2]
    inverse[2, 0], inverse[2, 1] = -inverse[2, 0], -inverse[2, 1]


@njit
def _corrected(P, inverse, scaled, dr, du, target, wanted):
    """wanted (3,) = P x with scaled o x = target e - scaled o scaled - (P dr) o (P^-1 du)."""
    l0, l1, l2 = scaled[0], scaled[1], scaled[2]
    a0 = P[0, 0] * dr[0] + P[0, 1] * dr[1] + P[0, 2] * dr[2]
    a1 = P[1, 0] * dr[0] + P[1, 1] * dr[1] + P[1, 2] * dr[2]
    a2 = P[2, 0] * dr[0] + P[2, 1] * dr[1] + P[2, 2] * dr[2]
    b0 = inverse[0, 0] * du[0] + inverse[0, 1] * du[1] + inverse[0, 2] * du[2]
    b1 = inverse[1, 0] * du[0] + inverse[1, 1] * du[1] + inverse[1, 2] * du[2]
    b2 = inverse[2, 0] * du[0] + inverse[2, 1] * du[1] + inverse[2, 2] * du[2]
    c0, c1 = -2 * l2 * l0 - a2 * b0 - b2 * a0, -2 * l2 * l1 - a2 * b1 - b2 * a1
    c2 = target - l0 * l0 - l1 * l1 - l2 * l2 - a0 * b0 - a1 * b1 - a2 * b2
    x2 = (l2 * c2 - l0 * c0 - l1 * c1) / (l2 * l2 - l0 * l0 - l1 * l1)
    x0, x1 = (c0 - x2 * l0) / l2, (c1 - x2 * l1) / l2
    for a in range(3):
        wanted[a] = P[a, 0] * x0 + P[a, 1] * x1 + P[a, 2] * x2


@njit
def _way(x, d):
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
def _unscaled(R, friction):
    """Forces (n, 3) from R."""
    forces = np.empty((len(R), 3))
    for i in range(len(R)):
        forces[i, 0], forces[i, 1], forces[i, 2] = R[i, 0], R[i, 1], R[i, 2] / (friction[i] if friction[i] > 0.0 else 1.0)
    return forces


@njit
def _product(R, dR, U, dU, t):
    """(R + t dR) . (U + t dU)"""
    total = 0.0
    for i in range(len(R)):
        for a in range(3):
            total += (R[i, a] + t * dR[i, a]) * (U[i, a] + t * dU[i, a])
    return total


@njit(fastmath={"reassoc", "contract"})
def _direction(A, factor, wanted, infeasible, dR, dU):
    """dR (n, 3) of factor factor^T dR = wanted - infeasible, and dU = A dR + infeasible."""
    m, n = 3 * len(wanted), len(wanted)
    x = np.empty(m)
    for i in range(m):
        row, value = factor[i], 0.0
        for j in range(i):
            value += row[j] * x[j]
        x[i] = (wanted[i // 3, i % 3] - infeasible[i // 3, i % 3] - value) / row[i]
    for i in range(m - 1, -1, -1):
        row = factor[i]
        x[i] /= row[i]
        value = x[i]
        for j in range(i):
            x[j] -= row[j] * value
    put_points(x, dR)
    put_points(A @ x, dU)
    for i in range(n):
        for a in range(3):
            dU[i, a] += infeasible[i, a]
