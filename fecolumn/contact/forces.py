"""The contact forces of a step: how well they obey the laws, and those that do.

The motion of the bodies under given forces is found elsewhere; here the points' positions under the
present forces are known. Newton about these forces: with s the slips and gaps that they leave and W
the compliance of the points in this place, new forces r' solve the laws for s + W (r' - r). It is
done when the laws hold for the positions that the motion finds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.arrays import marked, put_matrix
from fecolumn.contact.compliance import assemble, even_out
from fecolumn.contact.coulomb import law_error
from fecolumn.contact.coupling import (
    are_stiff,
    couple,
    coupling_by_levers,
    coupling_of,
    stiffness_alone,
    stiffnesses,
    times,
)
from fecolumn.contact.displacement import static_displacement
from fecolumn.contact.factor import multiply
from fecolumn.contact.friction import iterate
from fecolumn.contact.pad import any_pad, indent, indented
from fecolumn.contact.problem import (
    ALL_STIFF,
    ASSEMBLED,
    CONTACT_FAILED,
    FAR_BASE,
    IN_PLACE,
    ITERATIONS_SPENT,
    N_ASSEMBLED,
    N_CONTACT,
    OFF_BASE,
    OK,
    STICKS_STILL,
    WORTH_STICK,
    Problem,
    list_near_points,
    near_points,
    present_points,
)
from fecolumn.contact.projection import ON, UNKNOWN, project
from fecolumn.contact.stick import find_stick, operator_of, part_of_stick, solve_sticking
from fecolumn.contact.tolerances import EXACT, FORCE_SHARE, NEAR, SHARP, SOLVED, SWEEPS_MOST, USABLE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.coupling import Coupling
    from fecolumn.contact.pad import Springs
    from fecolumn.contact.projection import GroundTops
    from fecolumn.contact.stick import Stick


@njit
def find_residual(
    problem: Problem,
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    interfaces: Array,
    springs: Springs,
    dynamic: Array,
    rigid: float,
    stick: Stick,
    rims: Array,
    poses: Array,
    positions: Array,
    first: bool,
    before: Array,
    after: Array,
    counts: Array,
) -> tuple[int, float]:
    """Find relative positions in `after`, and how well its forces obey the laws.

    Returns OK or the code of what failed, and the largest violation over the allowed one: the
    problem is solved where that is 1 at most. Two lengths bound the violation. One is short for the
    width of the foot. The other is the indentation by a small share of the strongest force: a stiff
    contact meets the first length under wrong forces, too. A point that carries although it is
    above the base is never solved.

    Parameters
    ----------
    dynamic, rigid
        compliance of the bodies within a step, as of `compliance.assemble`.
    rims
        (ni,) of RIM.
    poses
        (ni,) of POSE.
    positions
        (n, 3) of the points under the forces of `after`, without static displacement [m].
    first
        whether in this step for the first time.
    before
        (n,) of CONTACT at the start of the step.
    """
    sticks, listed = problem.flags[STICKS_STILL], near_points(problem)
    stale = sticks and not problem.flags[IN_PLACE]
    if first or not stale:
        answer = project(base, positions, listed, points)
        if answer != ON:
            return FAR_BASE if answer == UNKNOWN else OFF_BASE, np.inf
    if not stale:
        for i in listed:
            # the foot turns too little in an iteration to change it
            if after[i].force[2] > 0 and not problem.evened[i]:
                even_out(bodies, base, points, i, poses)
                problem.evened[i] = True
    if problem.flags[WORTH_STICK]:
        if 2 * len(listed) > problem.count[2]:
            problem.flags[WORTH_STICK] = False
            if len(listed) == problem.count[2]:
                for i in listed:
                    even_out(bodies, base, points, i, poses)
                    problem.evened[i] = True
                find_stick(
                    stick, bodies, base, points, listed, springs, dynamic, rigid, rims, poses
                )
                counts[N_ASSEMBLED] += 1
                problem.flags[STICKS_STILL] = sticks = stick.key[1] == 1.0
                stale = sticks and not problem.flags[IN_PLACE]
    if stale and stick.key[2] == 0.0:
        _displace_all(stick, listed, after, problem.displaced)
    else:
        static_displacement(bodies, base, points, poses, after, listed, problem.displaced)
    changed, active = not problem.flags[ASSEMBLED], 0
    for i in listed:
        for a in range(3):
            after[i].relative[a] = positions[i, a] + problem.displaced[i, a]
        width = interfaces[points[i].interface].width
        new = after[i].relative[2] < NEAR * width or after[i].force[2] > 0
        changed |= new != problem.active[i]
        problem.active[i] = new
        active += new
    # points may have left the list
    changed |= active != problem.count[1]
    problem.count[1] = active
    if sticks:
        for j in range(len(listed)):
            problem.rho[listed[j]] = stick.rho[j]
    elif changed:
        _assemble_active(problem, bodies, base, points, springs, dynamic, rigid, poses)
        counts[N_ASSEMBLED] += 1
    worst, strongest = 0.0, np.zeros(len(interfaces))
    for i in listed:
        k = points[i].interface
        strongest[k] = max(strongest[k], after[i].force[2])
    for i in listed:
        most, width = strongest[points[i].interface], interfaces[points[i].interface].width
        for a in range(3):
            slack = (
                after[i].relative[a]
                + springs.own[i, a] * after[i].force[a]
                + indented(points, springs, before, i, a)
            )
            problem.slack[i, a] = slack - before[i].anchor[a] if a < 2 else slack
        if problem.active[i]:
            problem.allowed[i] = SOLVED * width
            if most > 0.0:
                problem.allowed[i] = min(
                    problem.allowed[i], max(FORCE_SHARE * most / problem.rho[i], EXACT * width)
                )
            error = law_error(
                after[i].force[0],
                after[i].force[1],
                after[i].force[2],
                problem.slack[i, 0],
                problem.slack[i, 1],
                problem.slack[i, 2],
                problem.rho[i],
                points[i].friction,
            )
            worst = max(
                worst,
                np.inf if _is_spurious_load(problem, after, i) else error / problem.allowed[i],
            )
    return OK, worst


@njit
def _is_spurious_load(problem: Problem, after: Array, i: int) -> bool:
    """Whether point i carries, above the base, a force that its place does not call for."""
    return (
        problem.slack[i, 2] > problem.allowed[i]
        and 0 < after[i].force[2] <= problem.rho[i] * problem.slack[i, 2]
    )


@njit
def _active(problem: Problem) -> Array:
    """The points (k,) that take part."""
    found, k = np.empty(problem.count[1], np.int64), 0
    for i in near_points(problem):
        if problem.active[i]:
            found[k] = i
            k += 1
    return found


@njit
def _displace_all(stick: Stick, listed: Array, after: Array, target: Array) -> None:
    """Target (n, 3): static displacement of the points of the stick operator, the listed ones
    (k,).
    """
    k = len(listed)
    forces, moved = np.empty(3 * k), np.empty(3 * k)
    for j in range(k):
        for a in range(3):
            forces[3 * j + a] = after[listed[j]].force[a]
    multiply(stick.static, forces, moved)
    for j in range(k):
        for a in range(3):
            target[listed[j], a] = moved[3 * j + a]


@njit
def _assemble_active(
    problem: Problem,
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    springs: Springs,
    dynamic: Array,
    rigid: float,
    poses: Array,
) -> None:
    """Compliance of the active points."""
    n = len(points)
    listed, arms = _active(problem), np.empty((n, 3))
    count = len(listed)
    for j in range(count):
        i = listed[j]
        if not problem.evened[i]:
            even_out(bodies, base, points, i, poses)
            problem.evened[i] = True
        for a in range(3):
            arms[i, a] = points[i].arm[a]
    problem.flags[ALL_STIFF] = are_stiff(bodies, base, points, listed)
    if problem.flags[ALL_STIFF]:
        coupling = couple(bodies, points, arms, listed, poses, rigid, 1.0, springs.own, 0)
        alone = stiffnesses(coupling, False)
        for j in range(count):
            problem.rho[listed[j]] = alone[j]
            for a in range(3):
                problem.own[j, a] = coupling.own[j, a]
            for side in range(2):
                problem.moved[j, side] = coupling.bodies[j, side]
            put_matrix(coupling.levers[j], problem.levers[j])
    else:
        W = problem.W[: 9 * count * count].reshape(3 * count, 3 * count)
        assemble(bodies, base, points, arms, listed, poses, rigid, dynamic, 1.0, springs.own, W)
        for j in range(count):
            problem.rho[listed[j]] = stiffness_alone(W, j)
    problem.flags[ASSEMBLED] = True


@njit
def _coupling(problem: Problem, stick: Stick) -> Coupling:
    """Coupling of the active points."""
    listed = _active(problem)
    count = len(listed)
    if problem.flags[STICKS_STILL]:
        near = near_points(problem)
        taken = np.empty(len(near), np.bool_)
        for n in range(len(near)):
            taken[n] = problem.active[near[n]]
        return part_of_stick(stick, len(near), marked(taken))
    if problem.flags[ALL_STIFF]:
        return coupling_by_levers(
            problem.own[:count], problem.levers[:count], problem.moved[:count]
        )
    W = problem.W[: 9 * count * count].reshape(3 * count, 3 * count)
    return coupling_of(W)


@njit
def find_forces(
    problem: Problem,
    points: Array,
    interfaces: Array,
    stick: Stick,
    after: Array,
    stalled: bool,
    counts: Array,
) -> int:
    """Forces in `after` that obey the laws as far as the compliance tells: OK, or the code of what
    failed. stalled: whether Newton on the slips of feet that stand has come to its end before, so
    that what it leaves is too much.
    """
    usable, tight, listed, sticks = np.inf, np.inf, _active(problem), problem.flags[STICKS_STILL]
    for i in listed:
        usable, tight = (
            min(usable, USABLE * interfaces[points[i].interface].width),
            min(tight, problem.allowed[i]),
        )
    tight *= SHARP
    if sticks:
        enough = tight if stalled else usable
        residual, newtons = solve_sticking(
            stick, points, near_points(problem), problem.slack, problem.active, after, tight, enough
        )
        counts[N_CONTACT] += newtons
        if residual <= enough:
            return OK
    count, coupling = len(listed), _coupling(problem, stick)
    q, old, friction = np.empty((count, 3)), np.empty((count, 3)), np.empty(count)
    for j in range(count):
        friction[j] = points[listed[j]].friction
        for a in range(3):
            old[j, a] = after[listed[j]].force[a]
    moved = times(coupling, old)
    for j in range(count):
        for a in range(3):
            q[j, a] = problem.slack[listed[j], a] - moved[j, a]
    for j in range(count):
        # so small that the length would let it stay
        if _is_spurious_load(problem, after, listed[j]):
            for a in range(3):
                old[j, a] = 0.0
    forces, residual, newtons, others = iterate(
        coupling, q, friction, old, tight, True, SWEEPS_MOST
    )
    counts[N_CONTACT] += newtons + others
    if not residual <= usable:
        return CONTACT_FAILED
    for j in range(count):
        for a in range(3):
            after[listed[j]].force[a] = forces[j, a]
    return OK


@njit
def stored_energy(
    problem: Problem,
    points: Array,
    interfaces: Array,
    springs: Springs,
    before: Array,
    after: Array,
) -> float:
    """Strain energy [J] of base, static rest of the bodies, contact law and pad, whose indentation
    is found.
    """
    energy = 0.0
    on_pad = any_pad(interfaces)
    if on_pad:
        indent(points, springs, before, after)
    for i in near_points(problem):
        for a in range(3):
            energy += after[i].force[a] * (
                problem.displaced[i, a] + points[i].law[a] * after[i].force[a]
            )
    if on_pad:
        for i in range(len(after)):
            for a in range(3):
                energy += points[i].springs[a] * after[i].indentation[a] ** 2
    return energy / 2


@njit
def solve_linear(
    problem: Problem,
    bodies: Bodies,
    base: GroundTops,
    points: Array,
    interfaces: Array,
    springs: Springs,
    dynamic: Array,
    elastic: Array,
    stick: Stick,
    rims: Array,
    poses: Array,
    positions: Array,
    most: int,
    before: Array,
    after: Array,
    counts: Array,
) -> tuple[int, float]:
    """Forces of bodies that answer a change of forces linearly: OK or the code of what failed,
    largest violation of the laws as of `find_residual`.

    Parameters
    ----------
    elastic
        (3 N, 3 n) of the bodies, `dynamic` without the static part.
    positions
        (n, 3) [m] of the points under the forces of `after` at first; those of close points change
        along with them.
    most
        times that forces are found; 0 only looks how well they obey the laws.
    """
    list_near_points(problem, present_points(problem), points, interfaces, positions, before, after)
    listed = near_points(problem)
    k, arms, old = len(listed), np.zeros((len(after), 3)), np.empty(3 * len(listed))
    # feet that stick still have it in their operator
    response, sticks = np.empty((3 * k, 3 * k)), problem.flags[STICKS_STILL]
    if most > 0 and not sticks:
        assemble(
            bodies, base, points, arms, listed, poses, 0.0, elastic, 0.0, springs.own, response
        )
    for attempt in range(most + 1):
        answer, residual = find_residual(
            problem,
            bodies,
            base,
            points,
            interfaces,
            springs,
            dynamic,
            0.0,
            stick,
            rims,
            poses,
            positions,
            attempt == 0,
            before,
            after,
            counts,
        )
        if answer != OK or residual <= 1.0 or attempt == most:
            return answer, residual
        for j in range(k):
            for a in range(3):
                old[3 * j + a] = after[listed[j]].force[a]
        answer = find_forces(problem, points, interfaces, stick, after, False, counts)
        if answer != OK:
            return answer, residual
        for j in range(k):
            for a in range(3):
                old[3 * j + a] = after[listed[j]].force[a] - old[3 * j + a]
        if sticks:
            moved, static = operator_of(stick, k) @ old, np.empty(3 * k)
            multiply(stick.static, old, static)
            for j in range(3 * k):
                moved[j] -= static[j]
        else:
            moved = response @ old
        for j in range(k):
            for a in range(3):
                positions[listed[j], a] += moved[3 * j + a] - (
                    springs.own[listed[j], a] * old[3 * j + a] if sticks else 0.0
                )
    return ITERATIONS_SPENT, np.inf
