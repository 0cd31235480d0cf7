"""Velocities at the end of a step in which a point lands or slip ends: plastic impact with
friction, and restitution.

The trapezoidal rule would turn the velocity of a point that lands, or that begins to stick, round
for ever. So the impulses of the step are replaced, at its end, by those of a plastic impact (Moreau
1988): the state of least kinetic energy that non-adhesive impulses with friction reach. In the
rigid limit it is Housner's (1963) impact.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import flat, marked, put_points
from fecolumn.contact.compliance import assemble
from fecolumn.contact.coupling import are_stiff, couple, coupling_of, times
from fecolumn.contact.impact_event import turning_moment
from fecolumn.contact.impulses import all_impulses, held_impulses, rough_impulses
from fecolumn.contact.points import GROUND
from fecolumn.contact.problem import IMPACT_FAILED, OK
from fecolumn.contact.restitution import returned_share
from fecolumn.contact.tolerances import IMPACT_LEAST, POINTS_A_LEVER
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.coupling import Coupling
    from fecolumn.contact.pad import Springs
    from fecolumn.contact.projection import GroundTops


class TouchingBodies(NamedTuple):
    """What touches: bodies: Bodies; base: grounds as of `compliance.assemble`; points: (n,) of
    POINT; interfaces: (ni,) of INTERFACE; springs: of pads at the points.
    """

    bodies: Bodies
    base: GroundTops
    points: Array
    interfaces: Array
    springs: Springs


class Collision(NamedTuple):
    """A step in which n points collide.

    union: (k,) points that carry at its start or at its end or land, as of `touched`; arms: (n, 3)
    of the points on their slaves at its end [m]; poses: (ni,) of POSE; before, after: (n,) of
    CONTACT at its ends; early, late: (n, 3) velocities there [m/s], relative to the master, at
    least of the points that carry; landing, turning: (n,) masks, as `impact_event` leaves them.
    dt: [s]; moment: fraction of the step at which points land, as of `landing_moment`; nan where
    slip ends.
    """

    union: Array
    arms: Array
    poses: Array
    before: Array
    after: Array
    early: Array
    late: Array
    landing: Array
    turning: Array
    dt: float
    moment: float


@njit
def find_impact(
    touching: TouchingBodies, collision: Collision, contact_work: float, counts: Array
) -> tuple[int, bool, Array]:
    """Find the impulses (n, 3) [N s] that replace those of the step: OK or the code of what failed,
    whether there are any, the impulses.

    Until the moment of impact only the points that carried before take impulses, from then on all
    points do. These are two projections. A single one would let the weight's impulse of the whole
    step act at the new contact. In a long step two projections may gain energy, because its
    positions know the new contact only. Then a single projection is made. If that gains energy too,
    only the share of the impulses is taken that gains none. An end of slip that would gain energy
    changes nothing.

    Parameters
    ----------
    touching, collision
        TouchingBodies and Collision.
    contact_work
        energy that contact added in the step [J].
    """
    points, interfaces = touching.points, touching.interfaces
    union, before, after, landing, moment, dt = (
        collision.union,
        collision.before,
        collision.after,
        collision.landing,
        collision.moment,
        collision.dt,
    )
    impulses = np.zeros((len(after), 3))
    k, lands = len(union), moment >= 0.0
    mobility = _mobility(touching, collision)
    held, m = np.empty(k, np.int64), 0
    given, start, end, friction = np.empty(3 * k), np.empty(3 * k), np.empty(3 * k), np.empty(k)
    for j in range(k):
        i = union[j]
        friction[j] = points[i].friction
        if before[i].force[2] > 0:
            held[m] = j
            m += 1
        for a in range(3):
            given[3 * j + a], start[3 * j + a], end[3 * j + a] = (
                dt * after[i].force[a],
                collision.early[i, a],
                collision.late[i, a],
            )
    pushed, speed = _jump(mobility, given), np.inf if lands else _fastest(start, end)
    pressed = np.abs(pushed).max() if k > 0 else 0.0
    free = np.empty(3 * k)
    for j in range(3 * k):
        free[j] = end[j] - pushed[j]
    if not lands:
        moment = turning_moment(
            points, before, after, start, free, pushed, union, collision.turning
        )
    second, velocity, taken = np.zeros(3 * k), np.empty(3 * k), 0.0
    carried, carried_before, guess_of_all, changed = (
        np.zeros(3 * k),
        np.empty(3 * k),
        np.empty(3 * k),
        np.empty(3 * k),
    )
    for attempt in range(2 if lands and moment > 0 else 1):
        share = moment if attempt == 0 else 0.0
        _between(start, free, share, velocity)
        for j in range(k):
            for a in range(3):
                carried_before[3 * j + a] = share * dt * before[union[j]].force[a]
        carried, solved = held_impulses(
            mobility, velocity, friction, held[:m], carried_before, speed, pressed, counts
        )
        if not solved:
            return IMPACT_FAILED, False, impulses
        jump = _jump(mobility, carried)
        for j in range(3 * k):
            velocity[j], guess_of_all[j] = free[j] + jump[j], given[j] - carried[j]
        second, solved = all_impulses(
            mobility, velocity, friction, guess_of_all, speed, pressed, counts
        )
        if not solved:
            return IMPACT_FAILED, False, impulses
        # judged by velocities relative to the master: whether contact takes energy must not depend
        # on the frame
        for j in range(3 * k):
            changed[j] = second[j] + carried[j] - given[j]
        taken = contact_work + _work(changed, end, _jump(mobility, changed))
        if taken <= 0:
            break
    if taken > 0:
        if not lands:
            return OK, False, impulses
        kept = _energy_limited_share(
            _work(changed, end, np.zeros(3 * k)),
            _work(changed, np.zeros(3 * k), _jump(mobility, changed)),
            contact_work,
        )
        if kept == 0.0:
            return OK, False, impulses
        for j in range(3 * k):
            changed[j] *= kept
    if lands and taken < 0.0 and _any_rebounds(interfaces):
        _between(start, free, share, velocity)
        jump = _jump(mobility, carried)
        for j in range(3 * k):
            velocity[j] += jump[j]
        restitution = _restitutions(interfaces, points, union, landing, velocity, start, free)
        if restitution.any():
            landing_impulses, solved = all_impulses(
                mobility, velocity, friction, second, speed, pressed, counts
            )
            if not solved:
                return IMPACT_FAILED, False, impulses
            for j in range(3 * k):
                landing_impulses[j] *= restitution[j // 3]
            returned, jump = _jump(mobility, landing_impulses), _jump(mobility, changed)
            arrived = square = 0.0
            for j in range(3 * k):
                arrived += landing_impulses[j] * (end[j] + jump[j])
                square += landing_impulses[j] * returned[j]
            given_back = returned_share(taken, arrived, square)
            for j in range(3 * k):
                changed[j] += given_back * landing_impulses[j]
    for j in range(k):
        for a in range(3):
            impulses[union[j], a] = changed[3 * j + a]
    return OK, True, impulses


@njit
def _mobility(touching: TouchingBodies, collision: Collision) -> Coupling:
    """Coupling by mobility [1/kg] of the points `union` (k,) of a Collision."""
    bodies, points, springs = touching.bodies, touching.points, touching.springs
    union, arms, poses = collision.union, collision.arms, collision.poses
    modes, sides = bodies.mobility_factor.shape[2], 1
    for i in union:
        if points[i].master != GROUND:
            sides = 2
            break
    stiff = are_stiff(bodies, touching.base, points, union)
    if stiff or modes > 0 and len(union) > POINTS_A_LEVER * sides * (6 + modes):
        modes = 0 if stiff else modes
        return couple(bodies, points, arms, union, poses, 1.0, 0.0, springs.own, modes)
    W = np.empty((3 * len(union), 3 * len(union)))
    assemble(
        bodies,
        touching.base,
        points,
        arms,
        union,
        poses,
        1.0,
        bodies.mobility,
        0.0,
        springs.own,
        W,
    )
    return coupling_of(W)


@njit
def _jump(mobility: Coupling, impulses: Array) -> Array:
    """Jump of the velocities (3 k,) [m/s] by impulses (3 k,) [N s]."""
    points = np.empty((len(impulses) // 3, 3))
    put_points(impulses, points)
    return flat(times(mobility, points))


@njit
def plastic_impact(
    mobility: Coupling,
    friction: Array,
    holds: Array,
    start: Array,
    end: Array,
    given: Array,
    moment: float,
    known: float,
) -> tuple[float, float]:
    """Kinetic energy [J] that a plastic impact of points (k,) takes at a moment in a step, and the
    fastest approach before it [m/s], both up to IMPACT_TOLD; no energy where that is not above the
    approach `known` [m/s].

    mobility: by levers. holds: (k,) mask of those that carry until then. start, end: (3 k,)
    velocities at the ends of the step [m/s], end with the impulses `given` (3 k,) [N s]. moment:
    fraction of the step.
    """
    k = len(friction)
    pushed, free, velocity = _jump(mobility, given), np.empty(3 * k), np.empty(3 * k)
    for j in range(3 * k):
        free[j] = end[j] - pushed[j]
    _between(start, free, moment, velocity)
    held = marked(holds)
    carried = rough_impulses(mobility, velocity, friction, held, np.zeros(3 * k))
    jump, approach = _jump(mobility, carried), 0.0
    for j in range(3 * k):
        velocity[j] += jump[j]
    for j in range(k):
        approach = max(approach, -velocity[3 * j + 2])
    if approach <= known:
        return 0.0, approach
    landing = rough_impulses(mobility, velocity, friction, np.arange(k), given)
    return -_work(landing, velocity, _jump(mobility, landing)), approach


@njit
def _any_rebounds(interfaces: Array) -> bool:
    """Whether any of the interfaces (ni,) has a restitution."""
    for k in range(len(interfaces)):
        if interfaces[k].restitution > 0.0:
            return True
    return False


@njit
def _restitutions(
    interfaces: Array,
    points: Array,
    union: Array,
    landing: Array,
    velocity: Array,
    start: Array,
    free: Array,
) -> Array:
    """Restitution (k,) of the points `union` (k,).

    Where a point of a joint lands, all points of the joint have the joint's own restitution. A
    point of a joint that carried before only transmits the impact: it has the least restitution of
    the joints that land.

    A joint gives nothing back where none of its points would rise for longer than a step. A point
    that arrives with v leaves with e v and rises for e v / a, a being how fast it is drawn to the
    other face. Without this rule a body would go on arriving with what its weight gives it in a
    step, and never rest.

    Parameters
    ----------
    velocity, start, free
        (3 k,) at the impact, at the start of the step, and at its end without contact [m/s].
    """
    lands, own = np.zeros(len(interfaces), np.bool_), np.zeros(len(interfaces))
    for j in range(len(union)):
        if landing[union[j]]:
            k = points[union[j]].interface
            lands[k] = True
            drawn = start[3 * j + 2] - free[3 * j + 2]
            if -interfaces[k].restitution * velocity[3 * j + 2] > drawn:
                own[k] = interfaces[k].restitution
    least, found = np.inf, np.zeros(len(union))
    for k in range(len(interfaces)):
        if lands[k]:
            least = min(least, own[k])
    for j in range(len(union)):
        k = points[union[j]].interface
        found[j] = own[k] if lands[k] else least
    return found


@njit
def _fastest(start: Array, end: Array) -> float:
    """Largest of the velocities (3 k,) at both ends of a step [m/s], at least IMPACT_LEAST."""
    most = IMPACT_LEAST
    for j in range(len(start)):
        most = max(most, abs(start[j]), abs(end[j]))
    return most


@njit
def _between(first: Array, last: Array, share: float, target: Array) -> None:
    """Target (m,): so far on the way from the first to the last."""
    for j in range(len(target)):
        target[j] = first[j] + share * (last[j] - first[j])


@njit
def _work(impulses: Array, velocity: Array, jump: Array) -> float:
    """Energy [J] that impulses bring by their velocity jump."""
    total = 0.0
    for j in range(len(impulses)):
        total += impulses[j] * (velocity[j] + jump[j] / 2)
    return total


@njit
def _energy_limited_share(first: float, second: float, contact_work: float) -> float:
    """Largest share s, at most 1, of impulses that bring the energy first s + second s^2 [J] by
    which they and contact, `contact_work` [J], bring none in all; of contact that brings some
    itself, the share that takes most.
    """
    if contact_work > 0.0:
        return min(max(-first / (2 * second), 0.0), 1.0) if second > 0.0 else 0.0
    # the larger root, written so that it loses no digits
    root = np.sqrt(first**2 - 4 * second * contact_work)
    if first > 0.0:
        return min(-2 * contact_work / (first + root), 1.0)
    return min((root - first) / (2 * second), 1.0) if second > 0.0 else 1.0
