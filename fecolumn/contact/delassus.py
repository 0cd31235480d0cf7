"""The contact compliance W: displacement of contact points relative to the base from unit contact forces."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit


@njit
def turned(compliance, active, rotation):
    """Compliance (3 n, 3 n) of the active points turned into the table frame.

    Args:
        compliance: (N, N, 3, 3) of all points in the body frame, symmetric.
        active: (n,) points.
        rotation: (3, 3) body frame to table frame.
    """
    n = len(active)
    W = np.empty((3 * n, 3 * n))
    half = np.empty((3, 3))
    for i in range(n):
        for j in range(i, n):
            source = compliance[active[i], active[j]]
            for a in range(3):
                for b in range(3):
                    half[a, b] = rotation[a, 0] * source[0, b] + rotation[a, 1] * source[1, b] + rotation[a, 2] * source[2, b]
            for a in range(3):
                for b in range(3):
                    value = half[a, 0] * rotation[b, 0] + half[a, 1] * rotation[b, 1] + half[a, 2] * rotation[b, 2]
                    W[3 * i + a, 3 * j + b] = value
                    W[3 * j + b, 3 * i + a] = value
    return W


@njit
def below(compliance, slots, weights):
    """Compliance (3 n, 3 n) of the base under n points.

    Args:
        compliance: (m, m, 3, 3) of the base's top nodes.
        slots, weights: (n, 4) top nodes around each point.
    """
    n = len(slots)
    W = np.zeros((3 * n, 3 * n))
    for i in range(n):
        for j in range(i, n):
            for p in range(4):
                for q in range(4):
                    w = weights[i, p] * weights[j, q]
                    if w != 0.0:
                        base = compliance[slots[i, p], slots[j, q]]
                        for a in range(3):
                            for b in range(3):
                                W[3 * i + a, 3 * j + b] += w * base[a, b]
            if j > i:
                for a in range(3):
                    for b in range(3):
                        W[3 * j + b, 3 * i + a] = W[3 * i + a, 3 * j + b]
    return W
