"""A foot that stays in its place: its compliance and the factor of it are found once and serve as
long as it does.

While a structure stands, its foot stays where it is but for micrometres, so that the compliance of
all its points is constant up to 1e-4 of itself. Its factor gives the forces of a wholly sticking
foot at once; points that slip or open are a small problem in their own slips, r = r_stuck + W^-1 s,
for which the rows of the inverse are found that it takes. Exact motion is checked by the iteration
around it, see `contact.problem`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put, put_matrix
from fecolumn.contact.compliance import assemble
from fecolumn.contact.coulomb import law_error
from fecolumn.contact.coupling import (
    are_stiff,
    couple,
    coupling_by_levers,
    coupling_of,
    part_of,
    stiffness_alone,
    stiffness_together,
    stiffnesses,
)
from fecolumn.contact.factor import Blocked, divide, factorize, no_blocks, solve_factored
from fecolumn.contact.newton import solve_in_place
from fecolumn.contact.pose import POSE, SLAVE
from fecolumn.contact.tolerances import PAD_TURN, STICK_STAYS, STICK_TURN, STICK_WAY
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.coupling import Coupling
    from fecolumn.contact.pad import Springs
    from fecolumn.contact.projection import GroundTops


class Stick(NamedTuple):
    """Of k points that stand, room for n: compliance W (9 n^2,), see `operator_of`, and its factor,
    and the static part without what the points give alone; inverse: (3 n, 3 n), of whose rows those
    known, (3 n,), are found, 3 k numbers each; rho, rho_all: (n,) stiffness of a point alone and
    with all others [N/m]; poses: (ni,) of POSE and angles: (ni,) of the rims for which they hold;
    key: (3,) length of the step, 1 once they are found, and 1 where the bodies do not deform. Then
    own, levers and bodies are those of a Coupling, the bodies by number among those that move, in
    place of W, and the factor is that of 1 + V^T own^-1 V (Woodbury 1950).
    """

    W: Array
    factor: Blocked
    static: Blocked
    own: Array
    levers: Array
    bodies: Array
    inverse: Array
    known: Array
    rho: Array
    rho_all: Array
    poses: Array
    angles: Array
    key: Array


def no_stick(n: int, interfaces: int = 1) -> Stick:
    """Of n points, not found yet."""
    return Stick(
        np.zeros(9 * n * n),
        no_blocks(n),
        no_blocks(n),
        np.zeros((n, 3)),
        np.zeros((n, 3, 12)),
        np.zeros((n, 2), np.int64),
        np.zeros((3 * n, 3 * n)),
        np.zeros(3 * n, bool),
        np.zeros(n),
        np.zeros(n),
        np.zeros(interfaces, POSE),
        np.zeros(interfaces),
        np.zeros(3),
    )


@njit
def operator_of(stick: Stick, k: int) -> Array:
    """Compliance (3 k, 3 k) of the k points that stand."""
    return stick.W[: 9 * k * k].reshape(3 * k, 3 * k)


@njit
def same_points(angle: float, other: float) -> bool:
    """Whether the points of a rim are in the same places on it for two angles of its lowest one,
    nan while they are its nodes.
    """
    return angle == other or np.isnan(angle) and np.isnan(other)


@njit
def holds(
    stick: Stick, interfaces: Array, rims: Array, rigid: float, poses: Array, reach: float
) -> bool:
    """Whether all feet are where the operator was found, within `reach` times STICK_TURN and
    STICK_WAY; of faces that are apart it does not matter.
    """
    if stick.key[1] == 0.0 or stick.key[0] != rigid:
        return False
    for k in range(len(interfaces)):
        if rims[k].apart:
            continue
        on_pad, then, now = interfaces[k].on_pad, stick.poses[k], poses[k]
        if not same_points(stick.angles[k], rims[k].angle):
            return False
        for a in range(0 if on_pad else 2):
            if abs(now.foot[a] - then.foot[a]) > reach * STICK_WAY * interfaces[k].width:
                return False
        for a in range(3):
            for b in range(3):
                if abs(now.turned[SLAVE, a, b] - then.turned[SLAVE, a, b]) > (
                    PAD_TURN if on_pad else reach * STICK_TURN
                ):
                    return False
    return True


@njit
def is_worth(interface: Record, pose: Record, turn: float, way: float, reach: float) -> bool:
    """Whether a foot in a pose (of POSE) that in one step turns by `turn` [rad] and goes by `way`
    [m] stays in its place, within `reach` times STICK_TURN and STICK_WAY, long enough for finding
    the operator to pay.
    """
    if interface.on_pad:
        return turn < STICK_STAYS * PAD_TURN
    # of the angle between the master's normal as the slave has it now, and as it had it
    turned, axes, sine = pose.turned, interface.axes, 0.0
    for a in range(3):
        c, d = (a + 1) % 3, (a + 2) % 3
        sine = np.hypot(sine, turned[SLAVE, 2, c] * axes[d, 2] - turned[SLAVE, 2, d] * axes[c, 2])
    stays = reach * STICK_STAYS
    return (
        sine < reach * STICK_TURN
        and turn < stays * STICK_TURN
        and way < stays * STICK_WAY * interface.width
    )


@njit
def find_stick(
    stick: Stick,
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    listed: Array,
    springs: Springs,
    dynamic: Array,
    rigid: float,
    rims: Array,
    poses: Array,
) -> None:
    """Find the operator of feet of which all points, the listed ones (k,), stand; further arguments
    as of `compliance.assemble`. Where their compliance is singular there is none: key[1] stays 0.
    """
    k, arms = len(listed), np.empty((len(points), 3))
    for i in listed:
        for a in range(3):
            arms[i, a] = points[i].arm[a]
    for j in range(3 * k):
        stick.known[j] = False
    for j in range(len(poses)):
        stick.poses[j], stick.angles[j] = poses[j], rims[j].angle
    stick.key[0], stick.key[1], stick.key[2] = rigid, 1.0, 0.0
    if are_stiff(bodies, base, points, listed):
        coupling = couple(bodies, points, arms, listed, poses, rigid, 1.0, springs.own, 0)
        if 2 * len(coupling.blocks.coupled) <= len(points):
            _take_levers(stick, coupling)
            return
    static, W = np.empty((3 * k, 3 * k)), operator_of(stick, k)
    assemble(
        bodies, base, points, arms, listed, poses, 0.0, bodies.static, 1.0, springs.own, static
    )
    assemble(bodies, base, points, arms, listed, poses, rigid, dynamic, 1.0, springs.own, W)
    for j in range(k):
        stick.rho[j] = stiffness_alone(W, j)
        stick.rho_all[j] = stiffness_together(W, j)
        for a in range(3):
            static[3 * j + a, 3 * j + a] -= springs.own[listed[j], a]
    if factorize(W, stick.factor):
        divide(static, stick.factor, stick.static)
    else:
        stick.key[1] = 0.0


@njit
def _take_levers(stick: Stick, coupling: Coupling) -> None:
    """Take over the coupling of bodies that do not deform, and find its factor."""
    k, rows, stick.key[2] = len(coupling.own), 6 * len(coupling.blocks.coupled), 1.0
    alone, together, S = (
        stiffnesses(coupling, False),
        stiffnesses(coupling, True),
        np.eye(rows),
    )
    for j in range(k):
        stick.rho[j], stick.rho_all[j] = alone[j], together[j]
        for a in range(3):
            stick.own[j, a] = coupling.own[j, a]
        put_matrix(coupling.levers[j], stick.levers[j])
        for side in range(2):
            b = coupling.bodies[j, side]
            stick.bodies[j, side] = coupling.blocks.of[b] if b >= 0 else -1
    for j in range(k):
        for side in range(2):
            for other in range(2):
                top, left = 6 * stick.bodies[j, side], 6 * stick.bodies[j, other]
                if top < 0 or left < 0:
                    continue
                for a in range(3):
                    for c in range(6):
                        value = stick.levers[j, a, 6 * side + c] / stick.own[j, a]
                        for e in range(6):
                            S[top + c, left + e] += value * stick.levers[j, a, 6 * other + e]
    if not factorize(S, stick.factor):
        stick.key[1] = 0.0


@njit
def solve_stuck(stick: Stick, right: Array) -> None:
    """Solve for right (3 k,) in its place: forces at which points that stick move by it."""
    if stick.key[2] == 0.0:
        solve_factored(stick.factor, right)
        return
    k, rows = len(right) // 3, 0
    for j in range(k):
        rows = max(rows, 6 * stick.bodies[j, 0] + 6, 6 * stick.bodies[j, 1] + 6)
    motion = np.zeros(rows)
    for j in range(k):
        for a in range(3):
            right[3 * j + a] /= stick.own[j, a]
        for side in range(2):
            first = 6 * stick.bodies[j, side]
            if first >= 0:
                for a in range(3):
                    for c in range(6):
                        motion[first + c] += stick.levers[j, a, 6 * side + c] * right[3 * j + a]
    solve_factored(stick.factor, motion)
    for j in range(k):
        for a in range(3):
            moved = 0.0
            for side in range(2):
                first = 6 * stick.bodies[j, side]
                if first >= 0:
                    for c in range(6):
                        moved += stick.levers[j, a, 6 * side + c] * motion[first + c]
            right[3 * j + a] -= moved / stick.own[j, a]


@njit
def part_of_stick(stick: Stick, k: int, listed: Array) -> Coupling:
    """Coupling of some, (m,), of the k points that stand."""
    if stick.key[2] == 0.0:
        return part_of(coupling_of(operator_of(stick, k)), listed)
    return coupling_by_levers(stick.own[listed], stick.levers[listed], stick.bodies[listed])


@njit
def _find_inverse(stick: Stick, row: int, count: int) -> None:
    """Find one row of the inverse, of `count` numbers, unless it is known."""
    if not stick.known[row]:
        line = stick.inverse[row, :count]
        for j in range(len(line)):
            line[j] = 1.0 if j == row else 0.0
        solve_stuck(stick, line)
        stick.known[row] = True


@njit
def solve_sticking(
    stick: Stick,
    points: Array,
    listed: Array,
    slack: Array,
    active: Array,
    after: Array,
    tolerance: float,
    usable: float,
) -> tuple[float, int]:
    """Contact forces by semismooth Newton on the slips of the points that do not stick; as
    `newton.newton_step`.

    Parameters
    ----------
    listed
        (k,) the points of the operator.
    slack
        (n, 3) slips and gaps [m] under the forces of `after`, which are replaced where the residual
        is `usable`.
    active
        (n,) mask; the others are open.

    Returns: residual of the laws [m], and Newton steps.
    """
    n, most, newton = len(listed), 15, 0
    stuck, r, s, best, least = (
        np.empty(3 * n),
        np.empty(3 * n),
        np.empty(3 * n),
        np.empty(3 * n),
        np.inf,
    )
    for i in range(n):
        for a in range(3):
            r[3 * i + a] = best[3 * i + a] = after[listed[i]].force[a]
            s[3 * i + a] = stuck[3 * i + a] = slack[listed[i], a]
    solve_stuck(stick, stuck)
    for j in range(3 * n):
        stuck[j] = r[j] - stuck[j]
    unknown, point, opened, turn = (
        np.empty(3 * n, np.int64),
        np.empty(3 * n, np.int64),
        np.empty(n, np.bool_),
        np.empty((n, 5)),
    )
    for newton in range(most):
        count = 0
        for i in range(n):
            rho, mu = stick.rho_all[i], points[listed[i]].friction
            normal = r[3 * i + 2] - rho * s[3 * i + 2]
            opened[i] = not active[listed[i]] or normal <= 0
            if opened[i]:
                for a in range(3):
                    unknown[count], point[count] = 3 * i + a, -1
                    count += 1
                continue
            t0, t1 = r[3 * i] - rho * s[3 * i], r[3 * i + 1] - rho * s[3 * i + 1]
            length = np.sqrt(t0 * t0 + t1 * t1)
            if length <= mu * normal:
                continue
            t0, t1 = t0 / length, t1 / length
            share = min(mu * max(r[3 * i + 2], 0.0) / length, 1.0)
            turn[i, 0], turn[i, 1], turn[i, 2] = (
                share * (1 - t0 * t0),
                -share * t0 * t1,
                share * (1 - t1 * t1),
            )
            turn[i, 3], turn[i, 4] = mu * t0, mu * t1
            for a in range(2):
                unknown[count], point[count] = 3 * i + a, i
                count += 1
        if count > 3 * n // 2:
            return np.inf, newton
        for u in range(count):
            _find_inverse(stick, unknown[u], 3 * n)
        matrix, right = np.empty((count, count)), np.empty(count)
        u = 0
        while u < count:
            row, i = unknown[u], point[u]
            if i < 0:
                right[u] = -stuck[row]
                for v in range(count):
                    matrix[u, v] = stick.inverse[row, unknown[v]]
                u += 1
                continue
            a, b, d, x, y = turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3], turn[i, 4]
            right[u] = -(1 - a) * stuck[row] + b * stuck[row + 1] + x * stuck[row + 2]
            right[u + 1] = b * stuck[row] - (1 - d) * stuck[row + 1] + y * stuck[row + 2]
            for v in range(count):
                k0, k1, k2 = (
                    stick.inverse[row, unknown[v]],
                    stick.inverse[row + 1, unknown[v]],
                    stick.inverse[unknown[v], row + 2],
                )
                matrix[u, v] = (1 - a) * k0 - b * k1 - x * k2
                matrix[u + 1, v] = -b * k0 + (1 - d) * k1 - y * k2
            rho = stick.rho_all[i]
            matrix[u, u] += rho * a
            matrix[u, u + 1] += rho * b
            matrix[u + 1, u] += rho * b
            matrix[u + 1, u + 1] += rho * d
            u += 2
        if count and not solve_in_place(matrix, right):
            return np.inf, newton
        put(stuck, r)
        s[:] = 0.0
        for v in range(count):
            value = right[v]
            s[unknown[v]] = value
            for j in range(3 * n):
                r[j] += value * stick.inverse[unknown[v], j]
        worst = 0.0
        for i in range(n):
            if opened[i]:
                # zero but for rounding
                r[3 * i] = r[3 * i + 1] = r[3 * i + 2] = 0.0
                if not active[listed[i]]:
                    continue
            worst = max(
                worst,
                law_error(
                    r[3 * i],
                    r[3 * i + 1],
                    r[3 * i + 2],
                    s[3 * i],
                    s[3 * i + 1],
                    s[3 * i + 2],
                    stick.rho[i],
                    points[listed[i]].friction,
                ),
            )
        if worst < least:
            least = worst
            put(r, best)
        if worst <= tolerance:
            break
    if least <= usable:
        for i in range(n):
            for a in range(3):
                after[listed[i]].force[a] = best[3 * i + a]
    return least, newton + 1
