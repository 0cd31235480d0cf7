"""The foot at rest on its bed: the contact problem of a whole foot by an inverse that serves as long as the foot stays in its place.

While the column stands, its foot stays where it is but for micrometres, so that the compliance of all its points is constant up to
1e-4 of itself. Its inverse gives the forces of a wholly sticking foot by one product; points that slip or open are a small problem
in their own slips, r = r_stuck + W^-1 s. Exact motion is checked by the iteration around it, see `equilibrium`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.friction import solve_in_place
from fecolumn.reduced.compliance import add_below, assemble

# The place of a foot: rotation [rad], and horizontal way over the foot's width, within which its bed is taken as the same
TURN, WAY = 1e-4, 5e-5
# On a pad, where nearly all of the compliance is that of its springs and the base the same everywhere, any way and this rotation [rad]
SOFT_TURN = 5e-3


class Bed(NamedTuple):
    """Compliance W of all points and its inverse, the static part without what the points give alone, all (3 n, 3 n); rho, rho_all: (n,)
    stiffness of a point alone and with all others, for the laws [N/m]; center: (3,), rotation: (3, 3), key: (3,) in which it holds: rim angle, half of the scheme, 1 where it is made."""

    W: np.ndarray
    inverse: np.ndarray
    static: np.ndarray
    rho: np.ndarray
    rho_all: np.ndarray
    center: np.ndarray
    rotation: np.ndarray
    key: np.ndarray


def no_bed(n: int) -> Bed:
    return Bed(*(np.zeros((3 * n, 3 * n)) for _ in range(3)), np.zeros(n), np.zeros(n), np.zeros(3), np.eye(3), np.zeros(3))


@njit
def fits(bed, column, points, half, center, rotation):
    """Whether the foot is in the place of its bed."""
    if bed.key[2] == 0.0 or bed.key[1] != half:
        return False
    angle = points.angle[0]
    if not (bed.key[0] == angle or np.isnan(bed.key[0]) and np.isnan(angle)):
        return False
    # the foot is a column's height below the centre
    for a in range(0 if column.soft else 2):
        moved = center[a] - bed.center[a] + (rotation[a, 2] - bed.rotation[a, 2]) * points.arms[0, 2]
        if abs(moved) > WAY * column.width:
            return False
    for a in range(3):
        for b in range(3):
            if abs(rotation[a, b] - bed.rotation[a, b]) > (SOFT_TURN if column.soft else TURN):
                return False
    return True


@njit
def make(bed, column, plate, scheme, points, footing, center, rotation):
    """Make the bed of a foot of which all points stand on a known base."""
    n = len(bed.rho)
    everyone = np.arange(n)
    assemble(column, points, points.arms, everyone, rotation, 0.0, column.static, bed.static)
    add_below(scheme.own, plate, footing, everyone, bed.static, 1.0)
    assemble(column, points, points.arms, everyone, rotation, scheme.half, scheme.elastic, bed.W)
    add_below(scheme.own, plate, footing, everyone, bed.W, 1.0)
    bed.inverse[:] = np.linalg.inv(bed.W)
    for i in range(n):
        bed.rho[i] = 3 / (bed.W[3 * i, 3 * i] + bed.W[3 * i + 1, 3 * i + 1] + bed.W[3 * i + 2, 3 * i + 2])
        bed.rho_all[i] = 3 / np.abs(bed.W[3 * i:3 * i + 3]).sum()
        for a in range(3):
            bed.static[3 * i + a, 3 * i + a] -= scheme.own[i, a]
            for j in range(3 * n):
                mean = (bed.inverse[3 * i + a, j] + bed.inverse[j, 3 * i + a]) / 2
                bed.inverse[3 * i + a, j] = mean
                bed.inverse[j, 3 * i + a] = mean
    bed.center[:] = center
    bed.rotation[:] = rotation
    bed.key[0], bed.key[1], bed.key[2] = points.angle[0], scheme.half, 1.0


@njit
def solve(bed, mu, given, active, forces, tolerance, usable, most=15):
    """Contact forces by semismooth Newton on the slips of the points that do not stick; as `friction.newton_step`.

    Args:
        given: (n, 3) slips and gaps [m] under the forces (n, 3), which are replaced where the residual is `usable`. active: (n,) mask; the others are open.
    Returns: residual of the laws [m], and Newton steps.
    """
    n = len(given)
    stuck = forces.ravel() - bed.inverse @ given.ravel()
    r, s = forces.ravel().copy(), given.ravel().copy()
    best, least = r.copy(), np.inf
    unknown, point, opened = np.empty(3 * n, np.int64), np.empty(3 * n, np.int64), np.empty(n, np.bool_)
    for newton in range(most):
        count = 0
        turn = np.zeros((n, 5))
        for i in range(n):
            rho = bed.rho_all[i]
            normal = r[3 * i + 2] - rho * s[3 * i + 2]
            opened[i] = not active[i] or normal <= 0
            if opened[i]:
                for a in range(3):
                    unknown[count], point[count] = 3 * i + a, -1
                    count += 1
                continue
            t0, t1 = r[3 * i] - rho * s[3 * i], r[3 * i + 1] - rho * s[3 * i + 1]
            length = np.hypot(t0, t1)
            if length <= mu * normal:
                continue
            t0, t1 = t0 / length, t1 / length
            share = min(mu * max(r[3 * i + 2], 0.0) / length, 1.0)
            turn[i, 0], turn[i, 1], turn[i, 2] = share * (1 - t0 * t0), -share * t0 * t1, share * (1 - t1 * t1)
            turn[i, 3], turn[i, 4] = t0, t1
            for a in range(2):
                unknown[count], point[count] = 3 * i + a, i
                count += 1
        if count > 3 * n // 2:
            return np.inf, newton
        matrix, right = np.empty((count, count)), np.empty(count)
        u = 0
        while u < count:
            row, i = unknown[u], point[u]
            if i < 0:
                right[u] = -stuck[row]
                for v in range(count):
                    matrix[u, v] = bed.inverse[row, unknown[v]]
                u += 1
                continue
            a, b, d, x, y = turn[i, 0], turn[i, 1], turn[i, 2], mu * turn[i, 3], mu * turn[i, 4]
            right[u] = -(1 - a) * stuck[row] + b * stuck[row + 1] + x * stuck[row + 2]
            right[u + 1] = b * stuck[row] - (1 - d) * stuck[row + 1] + y * stuck[row + 2]
            for v in range(count):
                k0, k1, k2 = bed.inverse[row, unknown[v]], bed.inverse[row + 1, unknown[v]], bed.inverse[row + 2, unknown[v]]
                matrix[u, v] = (1 - a) * k0 - b * k1 - x * k2
                matrix[u + 1, v] = -b * k0 + (1 - d) * k1 - y * k2
            rho = bed.rho_all[i]
            matrix[u, u] += rho * a
            matrix[u, u + 1] += rho * b
            matrix[u + 1, u] += rho * b
            matrix[u + 1, u + 1] += rho * d
            u += 2
        if count and not solve_in_place(matrix, right):
            return np.inf, newton
        r[:] = stuck
        s[:] = 0.0
        for v in range(count):
            value, line = right[v], bed.inverse[unknown[v]]
            s[unknown[v]] = value
            for j in range(3 * n):
                r[j] += value * line[j]
        worst = 0.0
        for i in range(n):
            rho = bed.rho[i]
            if opened[i]:
                # zero but for rounding
                r[3 * i] = r[3 * i + 1] = r[3 * i + 2] = 0.0
                if not active[i]:
                    continue
            normal = max(0.0, r[3 * i + 2] - rho * s[3 * i + 2])
            t0, t1 = r[3 * i] - rho * s[3 * i], r[3 * i + 1] - rho * s[3 * i + 1]
            length = np.hypot(t0, t1)
            if length > mu * normal:
                t0, t1 = t0 * mu * normal / length, t1 * mu * normal / length
            worst = max(worst, np.sqrt((r[3 * i] - t0) ** 2 + (r[3 * i + 1] - t1) ** 2 + (r[3 * i + 2] - normal) ** 2) / rho)
        if worst < least:
            least = worst
            best[:] = r
        if worst <= tolerance:
            break
    if least <= usable:
        for i in range(n):
            for a in range(3):
                forces[i, a] = best[3 * i + a]
    return least, newton + 1

