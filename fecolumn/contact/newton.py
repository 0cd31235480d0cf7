"""Semismooth Newton on the laws of contact (Alart and Curnier 1991)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put
from fecolumn.contact.blocks import FEW_UNKNOWNS, eliminate, solve_columns
from fecolumn.contact.coulomb import violation
from fecolumn.contact.coupling import motion_by, moved_by, slips_by_whole, slips_under
from fecolumn.contact.curvature import curvature, motion_of_rows, rows_of_motion
from fecolumn.contact.tolerances import SINGULAR
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.blocks import Blocks
    from fecolumn.contact.coupling import Coupling


# Of a point, by its trial force; _PRESSES: without friction
_OPEN, _PRESSES, _STICKS, _SLIPS = range(4)


class NewtonLimits(NamedTuple):
    """How Newton steps are made, and when they end.

    tolerance: residual [m] at which the laws are obeyed. rho: (n,) stiffness [N/m] by which stick
    and slip are told, rho_alone: (n,) by which the residual is measured. give: as of `newton_step`
    [m/N]. most: steps at most; patience: those without a better residual after which it ends.
    """

    tolerance: float
    rho: Array
    rho_alone: Array
    give: float
    most: int
    patience: int


@njit
def newton_steps(
    coupling: Coupling, q: Array, friction: Array, start: Array, limits: NewtonLimits
) -> tuple[Array, float, int]:
    """Newton steps until the tolerance is met, or the residual falls no more, or without give W
    proves singular: best forces, residual, steps made.
    """
    forces, least, stalled, made = start, np.inf, 0, 0
    best, W = start, coupling.whole
    while True:
        relative = slips_by_whole(W, q, forces) if len(W) else slips_under(coupling, q, forces)
        residual = violation(relative, forces, friction, limits.rho_alone)
        stalled += 1
        if residual < least:
            best, least, stalled = forces, residual, 0
        if (
            residual <= limits.tolerance
            or stalled > limits.patience
            or made == limits.most
            or limits.give == 0.0
            and not residual <= SINGULAR * least
        ):
            break
        forces, regular = newton_step(
            coupling, q, forces, relative, friction, limits.rho, limits.give
        )
        if not regular:
            break
        made += 1
    return best.copy(), least, made


@njit
def newton_step(
    coupling: Coupling,
    q: Array,
    forces: Array,
    relative: Array,
    friction: Array,
    rho: Array,
    give: float,
) -> tuple[Array, bool]:
    """Forces after one semismooth Newton step on the equations of Alart and Curnier (1991); False
    where it is singular.

    relative: (n, 3) slips and gaps under the forces.

    give: compliance [m/N] of each point against a change of its force, in this step alone: 0, or
    little where W leaves open which of many points carry. The laws are not softened by it: where
    the forces change no more, it plays no part.

    With d the direction of the trial force and e across it, a slipping point has r_t = mu r_n d + y
    e. Linearised in r_t, r_n and the slip s_t, its equations leave (1 - c) y + rho c e.s_t = 0, c =
    mu r_n / |trial|: two unknowns, three for a sticking point.
    """
    if len(coupling.whole):
        return _by_whole(coupling, q, forces, relative, friction, rho, give)
    return _by_levers(coupling, forces, relative, friction, rho, give)


@njit
def _trial(force: Array, relative: Array, mu: float, rho: float) -> tuple[int, float, float, float]:
    """What the trial force of a point says: its state, and where it slips direction (x, y) of the
    trial force and share c of it.
    """
    t0, t1, normal = (
        force[0] - rho * relative[0],
        force[1] - rho * relative[1],
        force[2] - rho * relative[2],
    )
    if not normal > 0:
        return _OPEN, 0.0, 0.0, 0.0
    if mu == 0.0:
        return _PRESSES, 0.0, 0.0, 0.0
    length = np.sqrt(t0 * t0 + t1 * t1)
    if length <= mu * normal:
        return _STICKS, 0.0, 0.0, 0.0
    return _SLIPS, t0 / length, t1 / length, min(mu * max(force[2], 0.0) / length, 1.0)


@njit
def _by_whole(
    coupling: Coupling,
    q: Array,
    forces: Array,
    relative: Array,
    friction: Array,
    rho: Array,
    give: float,
) -> tuple[Array, bool]:
    """`newton_step` by the whole matrix."""
    n = len(q)
    # unknown u multiplies basis[u] (3,) of the force on point[u], its equation is the slip or gap
    # along test[u]
    point, basis, test = np.empty(3 * n, np.int64), np.zeros((3 * n, 3)), np.zeros((3 * n, 3))
    stiffening, count = np.zeros(3 * n), 0
    for j in range(n):
        i = coupling.blocks.order[j]
        mu = friction[i]
        state, x, y, share = _trial(forces[i], relative[i], mu, rho[i])
        if state == _OPEN:
            continue
        if state == _PRESSES:
            point[count], basis[count, 2], test[count, 2] = i, 1.0, 1.0
            count += 1
            continue
        if state == _STICKS:
            for a in range(3):
                point[count] = i
                basis[count, a] = test[count, a] = 1.0
                count += 1
            continue
        point[count] = point[count + 1] = i
        basis[count, 0], basis[count, 1], basis[count, 2] = mu * x, mu * y, 1.0
        test[count, 2] = 1.0
        basis[count + 1, 0], basis[count + 1, 1] = -y, x
        # scaled to the size of the other equations
        test[count + 1, 0], test[count + 1, 1] = -share * y, share * x
        stiffening[count + 1] = (1 - share) / rho[i]
        count += 2
    updated = np.zeros((n, 3))
    if count == 0:
        return updated, True
    point, basis, test, stiffening = (
        point[:count],
        basis[:count],
        test[:count],
        stiffening[:count],
    )
    solved, regular = _solve_whole(
        coupling.whole, coupling.blocks, q, forces, give, point, basis, test, stiffening
    )
    if regular:
        for u in range(count):
            for a in range(3):
                updated[point[u], a] += solved[u] * basis[u, a]
    return updated, regular


@njit
def _solve_whole(
    W: Array,
    blocks: Blocks,
    q: Array,
    forces: Array,
    give: float,
    point: Array,
    basis: Array,
    test: Array,
    stiffening: Array,
) -> tuple[Array, bool]:
    """Unknowns (count,) of a Newton step by the whole matrix, and whether it is regular."""
    g, count = len(blocks.coupled), len(point)
    # rows and columns of the blocks
    begin = np.zeros(g + 1, np.int64)
    for u in range(count):
        begin[blocks.of[point[u]] + 1] += 1
    for k in range(g):
        begin[k + 1] += begin[k]
    # how many from one on are of its point, the first of a point beside them
    unknowns = np.ones(count, np.int64)
    for u in range(count - 2, -1, -1):
        if point[u] == point[u + 1]:
            unknowns[u] += unknowns[u + 1]
    mixed, matrix, right = np.empty(3 * len(q)), np.empty((count, count)), np.empty(count)
    for u in range(count):
        row, x, y, z = 3 * point[u], test[u, 0], test[u, 1], test[u, 2]
        right[u] = 0.0
        for a in range(3):
            right[u] -= test[u, a] * (q[point[u], a] - give * forces[point[u], a])
        first, second, third = W[row], W[row + 1], W[row + 2]
        # most equations are along an axis
        along = 0 if x == 1.0 else 1 if y == 1.0 else 2 if z == 1.0 else -1
        line = mixed if along < 0 else W[row + along]
        for k in range(g):
            if begin[k] == begin[k + 1] or not blocks.coupled[blocks.of[point[u]], k]:
                continue
            v = begin[k]
            while v < begin[k + 1]:
                column = 3 * point[v]
                if along < 0:
                    for j in range(column, column + 3):
                        mixed[j] = x * first[j] + y * second[j] + z * third[j]
                if unknowns[v] == 3:  # it sticks: along the axes
                    for a in range(3):
                        matrix[u, v + a] = line[column + a]
                elif unknowns[v] == 2:
                    for c in range(v, v + 2):
                        matrix[u, c] = (
                            basis[c, 0] * line[column]
                            + basis[c, 1] * line[column + 1]
                            + basis[c, 2] * line[column + 2]
                        )
                else:  # without friction: along the normal
                    matrix[u, v] = line[column + 2]
                v += unknowns[v]
        # the unknowns of a point are beside each other
        for v in range(max(u - 2, 0), min(u + 3, count)):
            if point[v] == point[u]:
                matrix[u, v] += give * (x * basis[v, 0] + y * basis[v, 1] + z * basis[v, 2])
        matrix[u, u] += stiffening[u]
    regular = (
        solve_in_place(matrix, right) if g == 1 else eliminate(matrix, right, begin, blocks.coupled)
    )
    return right, regular


@njit
def _by_levers(
    coupling: Coupling,
    forces: Array,
    relative: Array,
    friction: Array,
    rho: Array,
    give: float,
) -> tuple[Array, bool]:
    """`newton_step` by the formula of Woodbury (1950): of each point alone the change of its force
    is h - G V x, x the motion of the bodies by the changes of all, so that (1 + V^T G V) x = V^T h.

    Rounding, which grows with V over what a point gives, is that of changes, which become small.
    """
    n = len(forces)
    changes, slopes, acts = np.empty((n, 3)), np.zeros((n, 3, 3)), np.empty(n, np.bool_)
    for i in range(n):
        acts[i], regular = _alone(
            coupling.own[i],
            forces[i],
            relative[i],
            friction[i],
            rho[i],
            give,
            changes[i],
            slopes[i],
        )
        if not regular:
            return changes, False
    matrix = curvature(coupling, acts, slopes)
    right = rows_of_motion(coupling, motion_by(coupling, changes))
    if len(right) and not eliminate(matrix, right, coupling.blocks.first, coupling.blocks.coupled):
        return changes, False
    moved = moved_by(coupling, motion_of_rows(coupling, right))
    for i in range(n):
        x, y, z = moved[i, 0], moved[i, 1], moved[i, 2]
        for a in range(3):
            changes[i, a] += forces[i, a]
            if acts[i]:
                changes[i, a] -= slopes[i, a, 0] * x + slopes[i, a, 1] * y + slopes[i, a, 2] * z
    return changes, True


@njit
def _alone(
    own: Array,
    force: Array,
    relative: Array,
    mu: float,
    rho: float,
    give: float,
    change: Array,
    slope: Array,
) -> tuple[bool, bool]:
    """Put the change (3,) of the force of one point alone, and by how much less it is for a motion
    of the point by others: slope (3, 3), nil at first. Whether the point carries, and whether it
    gives at all.
    """
    state, x, y, share = _trial(force, relative, mu, rho)
    for a in range(3):
        change[a] = -force[a]
    if state == _OPEN:
        return False, True
    along = own[2] + give
    if along == 0.0:
        return True, False
    if state == _STICKS:
        for a in range(3):
            alone = own[a] + give
            if alone == 0.0:
                return True, False
            slope[a, a] = 1 / alone
            change[a] = -relative[a] / alone
        return True, True
    slope[2, 2] = 1 / along
    change[2] = -relative[2] / along
    if state == _PRESSES:
        return True, True
    # it slips: r_t = mu r_n d + y e, d = (x, y), e across it
    across = x * force[1] - y * force[0]
    # to the direction of the trial force, before it changes
    turned0, turned1 = (
        mu * x * force[2] - y * across - force[0],
        mu * y * force[2] + x * across - force[1],
    )
    stiff = (1 - share) / rho
    o0, o1 = own[0] + give, own[1] + give
    least = share * (y * y * o0 + x * x * o1) + stiff
    if least == 0.0:
        return True, False
    mixed = share * mu * x * y * (o1 - o0)
    rest = -stiff * across - share * (
        x * (relative[1] + o1 * turned1) - y * (relative[0] + o0 * turned0)
    )
    more = (rest - mixed * change[2]) / least
    change[0] = turned0 + mu * x * change[2] - y * more
    change[1] = turned1 + mu * y * change[2] + x * more
    # of the motion (u, v, w): r_n gives -w / along, y the rest
    slope[0, 2] = mu * x / along + y * mixed / (least * along)
    slope[1, 2] = mu * y / along - x * mixed / (least * along)
    slope[0, 0] = y * y * share / least
    slope[0, 1] = -x * y * share / least
    slope[1, 0] = -x * y * share / least
    slope[1, 1] = x * x * share / least
    return True, True


@njit
def solve_in_place(matrix: Array, right: Array) -> bool:
    """Solve for right (n,) in its place with row pivoting, by LAPACK where it pays; overwrites
    both, False where singular.
    """
    n = len(right)
    if n > FEW_UNKNOWNS:
        try:
            put(np.linalg.solve(matrix, right), right)
        except Exception:
            return False
        return True
    return solve_columns(matrix, right.reshape(n, 1))
