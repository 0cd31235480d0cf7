"""How contact points move one another: by a whole matrix, or, where their bodies do not deform or
move in few modes only, by what each gives alone and its levers on two bodies.

Then W = own + V V^T with six columns of V a body, and one for each of its modes (Delassus 1917),
and equations with W cost what the points are, not the third power of their number (Woodbury 1950).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put_points
from fecolumn.contact.blocks import Blocks, find_blocks, least_filling
from fecolumn.contact.points import FLAT_GROUND, GROUND
from fecolumn.contact.pose import turns
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.projection import GroundTops


class Coupling(NamedTuple):
    """Compliance W of n points [m/N], or their mobility [1/kg].

    whole: (3 n, 3 n), or (0, 0) where the rest tells it. own: (n, 3) of each point alone along the
    axes of its frame; levers: (n, 3, 2 w) rows of V, w columns of the slave and w of the master,
    these negative: six of rigid motion and those of modes; bodies: (n, 2) slave and master, -1 of
    one that does not move. blocks: of the points of a whole matrix; else of the bodies, their rows
    of V^T W^-1 V by their order of elimination.
    """

    whole: Array
    own: Array
    levers: Array
    bodies: Array
    blocks: Blocks


@njit
def coupling_of(W: Array) -> Coupling:
    """Of a matrix (3 n, 3 n)."""
    return Coupling(
        W,
        np.empty((0, 3)),
        np.empty((0, 3, 12)),
        np.empty((0, 2), np.int64),
        find_blocks(W),
    )


@njit
def coupling_by_levers(own: Array, levers: Array, bodies: Array) -> Coupling:
    """Of bodies that move in few ways, by what Coupling has of them."""
    blocks = _blocks_of_bodies(bodies, levers.shape[2] // 2)
    return Coupling(np.empty((0, 0)), own, levers, bodies, blocks)


@njit
def _blocks_of_bodies(bodies: Array, width: int) -> Blocks:
    """Blocks of bodies, `width` rows each, coupled where they have a point in common."""
    count, g = 0, 0
    for j in range(len(bodies)):
        count = max(count, bodies[j, 0] + 1, bodies[j, 1] + 1)
    of = np.full(count, -1)
    for j in range(len(bodies)):
        for side in range(2):
            if bodies[j, side] >= 0 and of[bodies[j, side]] < 0:
                of[bodies[j, side]] = g
                g += 1
    coupled = np.zeros((g, g), np.bool_)
    for k in range(g):
        coupled[k, k] = True
    for j in range(len(bodies)):
        b, m = bodies[j, 0], bodies[j, 1]
        if b >= 0 and m >= 0:
            coupled[of[b], of[m]] = coupled[of[m], of[b]] = True
    ranks = least_filling(np.arange(g + 1), coupled)
    blocks = Blocks(ranks, width * np.arange(g + 1), of, np.empty((g, g), np.bool_))
    rank = np.empty(g, np.int64)
    for k in range(g):
        rank[ranks[k]] = k
        for l in range(g):
            blocks.coupled[k, l] = coupled[ranks[k], ranks[l]]
    for b in range(count):
        if of[b] >= 0:
            of[b] = rank[of[b]]
    return blocks


@njit
def are_stiff(bodies: Bodies, base: GroundTops, points: Array, listed: Array) -> bool:
    """Whether neither bodies nor grounds of the listed points (k,) deform."""
    for i in listed:
        if not bodies.body[points[i].slave].stiff:
            return False
        if points[i].master != GROUND:
            if not bodies.body[points[i].master].stiff:
                return False
        elif points[i].facet != FLAT_GROUND and not base.tops[points[i].ground].stiff:
            return False
    return True


@njit
def couple(
    bodies: Bodies,
    points: Array,
    arms: Array,
    listed: Array,
    poses: Array,
    rigid: float,
    factor: float,
    own: Array,
    modes: int,
) -> Coupling:
    """Coupling of the listed points (k,) of bodies that do not deform, or whose compliance is the
    mobility of `modes` columns of their factor; other arguments as of `compliance.assemble`.
    """
    k, nb, width = len(listed), len(bodies.body), 6 + modes
    alone, levers, sides = np.empty((k, 3)), np.zeros((k, 3, 2 * width)), np.full((k, 2), -1)
    turned, roots, known = turns(poses), np.zeros((nb, 3, 3)), np.zeros(nb, np.bool_)
    for j in range(k):
        i = listed[j]
        for a in range(3):
            alone[j, a] = factor * (own[i, a] + points[i].uneven[a, a])
        for side in range(2):
            b = points[i].master if side else points[i].slave
            if b == GROUND:
                continue
            floats = bodies.body[b].inverse_mass != 0.0
            if not floats and (modes == 0 or bodies.body[b].stiff):
                continue
            if floats and not known[b]:
                put_root(bodies.body[b].inverse_inertia, roots[b])
                known[b] = True
            sides[j, side] = b
            sign = np.sqrt(rigid) * (-1.0 if side else 1.0)
            along = sign * np.sqrt(bodies.body[b].inverse_mass)
            T, C = turned[points[i].interface, side], roots[b]
            if side:
                x, y, z = points[i].seat[0], points[i].seat[1], points[i].seat[2]
            else:
                x, y, z = arms[i, 0], arms[i, 1], arms[i, 2]
            for a in range(3):
                # t . (w x arm) = w . (arm x t)
                u = y * T[a, 2] - z * T[a, 1]
                v = z * T[a, 0] - x * T[a, 2]
                w = x * T[a, 1] - y * T[a, 0]
                for c in range(3):
                    levers[j, a, width * side + c] = along * T[a, c]
                    levers[j, a, width * side + 3 + c] = sign * (
                        u * C[0, c] + v * C[1, c] + w * C[2, c]
                    )
            if modes > 0 and not bodies.body[b].stiff:
                _add_modes(bodies.mobility_factor, points[i], side, T, levers[j])
    return coupling_by_levers(alone, levers, sides)


@njit
def _add_modes(factors: Array, point: Record, side: int, turn: Array, levers: Array) -> None:
    """Put what the modes move the point by into its levers (3, 2 w): turn (3, 3) times the factor
    of the mobility (N, 3, r), negative on the master.
    """
    modes, width = factors.shape[2], levers.shape[1] // 2
    first = width * side + width - modes
    for q in range(4):
        node = point.below[q] if side else point.carriers[q]
        share = -point.shares[q] if side else point.weights[q]
        if share == 0.0:
            continue
        for a in range(3):
            for c in range(3):
                factor, row, target = share * turn[a, c], factors[node, c], levers[a]
                for m in range(modes):
                    target[first + m] += factor * row[m]


@njit
def put_root(matrix: Array, root: Array) -> None:
    """Cholesky's factor C (3, 3) of a symmetric positive definite matrix, C C^T."""
    for i in range(3):
        for j in range(3):
            root[i, j] = 0.0
        for j in range(i + 1):
            rest = matrix[i, j]
            for k in range(j):
                rest -= root[i, k] * root[j, k]
            root[i, j] = np.sqrt(rest) if i == j else rest / root[j, j]


@njit(fastmath={"reassoc", "contract"})
def times_whole(W: Array, forces: Array) -> Array:
    """A matrix (3 n, 3 n) times forces (n, 3), as (n, 3)."""
    n, result = len(forces), np.empty((len(forces), 3))
    if n > 8:
        # W is symmetric; of many points few carry
        moved = np.zeros(3 * n)
        for i in range(n):
            for a in range(3):
                force = forces[i, a]
                if force != 0.0:
                    row = W[3 * i + a]
                    for j in range(3 * n):
                        moved[j] += force * row[j]
        put_points(moved, result)
        return result
    # so small, a call of BLAS costs more than the product
    for i in range(n):
        for a in range(3):
            line, total = W[3 * i + a], 0.0
            for j in range(n):
                total += (
                    line[3 * j] * forces[j, 0]
                    + line[3 * j + 1] * forces[j, 1]
                    + line[3 * j + 2] * forces[j, 2]
                )
            result[i, a] = total
    return result


@njit(fastmath={"reassoc", "contract"})
def times(coupling: Coupling, forces: Array) -> Array:
    """W times forces (n, 3), as (n, 3)."""
    if len(coupling.whole):
        return times_whole(coupling.whole, forces)
    n, result = len(forces), moved_by(coupling, motion_by(coupling, forces))
    for i in range(n):
        for a in range(3):
            result[i, a] += coupling.own[i, a] * forces[i, a]
    return result


@njit(fastmath={"reassoc", "contract"})
def motion_by(coupling: Coupling, forces: Array) -> Array:
    """Motion (nb, w) of the bodies, V^T r, by forces (n, 3) of points that have levers."""
    levers, bodies, width = coupling.levers, coupling.bodies, coupling.levers.shape[2] // 2
    motion, both, i, n = (
        np.zeros((len(coupling.blocks.of), width)),
        np.empty(2 * width),
        0,
        len(forces),
    )
    while i < n:
        # the points between the same two bodies, whose columns are beside each other
        slave, master = bodies[i, 0], bodies[i, 1]
        both[:] = 0.0
        while i < n and bodies[i, 0] == slave and bodies[i, 1] == master:
            x, y, z = forces[i, 0], forces[i, 1], forces[i, 2]
            first, second, third = levers[i, 0], levers[i, 1], levers[i, 2]
            for c in range(2 * width):
                both[c] += x * first[c] + y * second[c] + z * third[c]
            i += 1
        for c in range(width):
            if slave >= 0:
                motion[slave, c] += both[c]
            if master >= 0:
                motion[master, c] += both[width + c]
    return motion


@njit(fastmath={"reassoc", "contract"})
def moved_by(coupling: Coupling, motion: Array) -> Array:
    """How far (n, 3) a motion (nb, w) of the bodies moves the points, V x."""
    levers, bodies, width = coupling.levers, coupling.bodies, coupling.levers.shape[2] // 2
    moved = np.zeros((len(levers), 3))
    for i in range(len(levers)):
        for side in range(2):
            b = bodies[i, side]
            if b >= 0:
                for a in range(3):
                    row, of_body, total = levers[i, a], motion[b], 0.0
                    for c in range(width):
                        total += row[width * side + c] * of_body[c]
                    moved[i, a] += total
    return moved


@njit
def slips_under(coupling: Coupling, q: Array, forces: Array) -> Array:
    """Slips and gaps (n, 3): W r + q."""
    if len(coupling.whole):
        return slips_by_whole(coupling.whole, q, forces)
    result = times(coupling, forces)
    for i in range(len(q)):
        for a in range(3):
            result[i, a] += q[i, a]
    return result


@njit
def slips_by_whole(W: Array, q: Array, forces: Array) -> Array:
    """As `slips_under`, of a whole matrix (3 n, 3 n): a Coupling is many arrays, whose hand over
    costs more than the product of a few points.
    """
    result = times_whole(W, forces)
    for i in range(len(q)):
        for a in range(3):
            result[i, a] += q[i, a]
    return result


@njit
def whole_of(coupling: Coupling) -> Array:
    """The matrix (3 n, 3 n)."""
    if len(coupling.whole):
        return coupling.whole
    n, levers, bodies = len(coupling.own), coupling.levers, coupling.bodies
    W, width = np.zeros((3 * n, 3 * n)), levers.shape[2] // 2
    for i in range(n):
        for j in range(i, n):
            for side in range(2):
                for other in range(2):
                    if bodies[i, side] < 0 or bodies[i, side] != bodies[j, other]:
                        continue
                    for a in range(3):
                        for b in range(3):
                            total = 0.0
                            for c in range(width):
                                total += (
                                    levers[i, a, width * side + c] * levers[j, b, width * other + c]
                                )
                            W[3 * i + a, 3 * j + b] += total
        for a in range(3):
            W[3 * i + a, 3 * i + a] += coupling.own[i, a]
    for i in range(3 * n):
        for j in range(i + 1, 3 * n):
            W[j, i] = W[i, j]
    return W


@njit
def columns_used(coupling: Coupling) -> int:
    """Columns of the levers (n, 3, 2 w) that are not all zero: w where no point has a master that
    moves.
    """
    for i in range(len(coupling.bodies)):
        if coupling.bodies[i, 1] >= 0:
            return coupling.levers.shape[2]
    return coupling.levers.shape[2] // 2


@njit
def part_of(coupling: Coupling, listed: Array) -> Coupling:
    """Coupling of some of the points (k,)."""
    k = len(listed)
    if len(coupling.whole):
        W = np.empty((3 * k, 3 * k))
        for u in range(k):
            for v in range(k):
                for a in range(3):
                    for b in range(3):
                        W[3 * u + a, 3 * v + b] = coupling.whole[
                            3 * listed[u] + a, 3 * listed[v] + b
                        ]
        return coupling_of(W)
    return coupling_by_levers(
        coupling.own[listed],
        coupling.levers[listed],
        coupling.bodies[listed],
    )


@njit
def softened(coupling: Coupling, give: Array) -> Coupling:
    """Coupling of points that each give so much (n,) more, alone."""
    whole, own = coupling.whole.copy(), coupling.own.copy()
    for i in range(len(give)):
        for a in range(3):
            if len(whole):
                whole[3 * i + a, 3 * i + a] += give[i]
            else:
                own[i, a] += give[i]
    return Coupling(whole, own, coupling.levers, coupling.bodies, coupling.blocks)


@njit
def stiffnesses_by_whole(W: Array, together: bool) -> Array:
    """As `stiffnesses`, of a whole matrix (3 n, 3 n)."""
    n = len(W) // 3
    found = np.empty(n)
    for i in range(n):
        found[i] = stiffness_together(W, i) if together else stiffness_alone(W, i)
    return found


@njit
def stiffnesses(coupling: Coupling, together: bool) -> Array:
    """Stiffness (n,) [N/m] of each point when it moves alone, or when all move `together`, which is
    less: with the stiffness alone, points would change their direction of slip at each iteration.
    """
    if len(coupling.whole):
        return stiffnesses_by_whole(coupling.whole, together)
    n = len(coupling.own)
    found = np.empty(n)
    levers, bodies = coupling.levers, coupling.bodies
    # lengths of the rows of V, whose products are no larger than those of the lengths
    length, total = np.empty((n, 2, 3)), np.zeros(len(coupling.blocks.of))
    width = levers.shape[2] // 2
    for i in range(n):
        for side in range(2):
            for a in range(3):
                square = 0.0
                for c in range(width):
                    square += levers[i, a, width * side + c] ** 2
                length[i, side, a] = np.sqrt(square)
                if bodies[i, side] >= 0:
                    total[bodies[i, side]] += length[i, side, a]
    for i in range(n):
        trace = 0.0
        for a in range(3):
            trace += coupling.own[i, a]
            for side in range(2):
                if bodies[i, side] >= 0:
                    all_of_body = total[bodies[i, side]] if together else length[i, side, a]
                    trace += length[i, side, a] * all_of_body
        found[i] = 3 / trace
    return found


@njit
def stiffness_alone(W: Array, i: int) -> float:
    """Stiffness [N/m] of point i of a compliance (3 n, 3 n) when it moves alone."""
    return 3 / (W[3 * i, 3 * i] + W[3 * i + 1, 3 * i + 1] + W[3 * i + 2, 3 * i + 2])


@njit(fastmath={"reassoc", "contract"})
def stiffness_together(W: Array, i: int) -> float:
    """Stiffness [N/m] of point i of a compliance (3 n, 3 n) when all points move."""
    total = 0.0
    for a in range(3):
        row = W[3 * i + a]
        for j in range(len(row)):
            total += abs(row[j])
    return 3 / total
