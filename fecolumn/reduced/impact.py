"""Plastic impact of the reduced column: velocities at the end of a step in which a point lands or slip ends."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.friction import FEW, iterate
from fecolumn.contact.interface import IMPACT_TOLERANCE
from fecolumn.contact.restitution import returned_share
from fecolumn.dynamics.stepper import SLIDE, YIELD
from fecolumn.reduced.compliance import add_below, assemble, even
from fecolumn.reduced.equilibrium import IMPACT, N_CONTACT, N_IMPACTS, OK
from fecolumn.reduced.ledger import FRICTION, HIT, kinetic
from fecolumn.reduced.motion import modal_forces, point_velocities


@njit
def turning_points(column, points, start, end, dt, early, late):
    """Mask (n,) of points whose slip ends within the step: as Stepper._turning; early, late: velocities at its ends, found if needed."""
    n, mu = len(points.forces), column.friction
    turns, slid, slips = np.zeros(n, np.bool_), np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    some, wanted = False, np.empty(n, np.bool_)
    for i in range(n):
        if not (points.forces[i, 2] > 0 or end.forces[i, 2] > 0):
            continue
        pull = np.hypot(points.forces[i, 0], points.forces[i, 1])
        touching = end.forces[i, 2] > 0
        slid[i] = pull > 0 and pull >= (1 - 1e-9) * mu * points.forces[i, 2]
        slips[i] = touching and (end.anchors[i, 0] != points.anchors[i, 0] or end.anchors[i, 1] != points.anchors[i, 1])
        # nothing else can be among those that turn
        wanted[i] = slid[i] and touching and not slips[i] or slips[i] and points.forces[i, 2] > 0
        some |= wanted[i]
    if not some:
        return turns
    point_velocities(column, points, start, wanted, early)
    point_velocities(column, points, end, wanted, late)
    for i in range(n):
        if not wanted[i] or not dt * np.hypot(early[i, 0], early[i, 1]) > SLIDE * column.width:
            continue
        s0, s1 = end.anchors[i, 0] - points.anchors[i, 0], end.anchors[i, 1] - points.anchors[i, 1]
        against = min(early[i, 0] * s0 + early[i, 1] * s1, late[i, 0] * s0 + late[i, 1] * s1) < 0
        turns[i] = slid[i] and not slips[i] or against and points.forces[i, 2] > 0
    return turns


@njit
def collide(column, plate, scheme, points, footing, start, end, landing, turns, contact_work, ledger, record):
    """Replace the impulses of the step by those of a plastic impact, as Stepper._impact; changes velocities of `end`, books."""
    n, dt, lands = len(points.forces), scheme.dt, landing.any()
    union = np.flatnonzero((end.forces[:, 2] > 0) | (points.forces[:, 2] > 0))
    k = len(union)
    held = np.empty(k, np.bool_)
    for j in range(k):
        held[j] = points.forces[union[j], 2] > 0
    before = np.flatnonzero(held)
    arms = points.arms + _elastic_of_points(points, end.elastic)
    mobility, compliance = np.empty((3 * k, 3 * k)), np.empty((3 * k, 3 * k))
    for i in union:
        even(column, points, plate, footing, end.rotation, i)
    assemble(column, points, arms, union, end.rotation, 0.0, column.static, compliance)
    add_below(scheme.own, plate, footing, union, compliance, 1.0)
    assemble(column, points, arms, union, end.rotation, 1.0, column.mobility, mobility)
    compliance *= YIELD * 2 / dt**2
    compliance += mobility
    early, late = np.empty((n, 3)), np.empty((n, 3))
    wanted = np.zeros(n, np.bool_)
    wanted[union] = True
    point_velocities(column, points, start, wanted, early)
    point_velocities(column, points, end, wanted, late)
    early, late, given = early[union], late[union], dt * end.forces[union]
    pushed = (mobility @ given.ravel()).reshape(k, 3)
    free = late - pushed
    if lands:
        moment = _landing_moment(points, end, early, union, landing, dt)
    else:
        moment = _turning_moment(column, points, end, early, free, pushed, union, turns)
    m = len(before)
    inner = np.empty((3 * m, 3 * m))
    for i in range(m):
        for j in range(m):
            inner[3 * i:3 * i + 3, 3 * j:3 * j + 3] = compliance[3 * before[i]:3 * before[i] + 3, 3 * before[j]:3 * before[j] + 3]
    changed, jump, taken, share = np.zeros((k, 3)), np.zeros((k, 3)), 0.0, 0.0
    carried = second = np.zeros((k, 3))
    for attempt in range(2 if lands and moment > 0 else 1):
        share = moment if attempt == 0 else 0.0
        carried = np.zeros((k, 3))
        velocity = early + share * (free - early)
        first, solved = _impulses(inner, velocity[before], column.friction, share * dt * points.forces[union[before]], record)
        if not solved:
            return IMPACT
        for i in range(m):
            carried[before[i]] = first[i]
        velocity = free + (mobility @ carried.ravel()).reshape(k, 3)
        second, solved = _impulses(compliance, velocity, column.friction, given - carried, record)
        if not solved:
            return IMPACT
        changed = second + carried - given
        jump = (mobility @ changed.ravel()).reshape(k, 3)
        # judged by velocities relative to the base: whether contact takes energy must not depend on the frame
        taken = contact_work + np.sum(changed * (late + jump / 2))
        if taken <= 0:
            break
    if taken > 0 and not lands:
        return OK
    if lands and column.restitution > 0.0 and taken < 0.0:
        velocity = early + share * (free - early) + (mobility @ carried.ravel()).reshape(k, 3)
        blow, solved = _impulses(compliance, velocity, column.friction, second, record)
        if not solved:
            return IMPACT
        returned = (mobility @ blow.ravel()).reshape(k, 3)
        given_back = returned_share(column.restitution, taken, np.sum(blow * (late + jump)), np.sum(blow * returned))
        changed = changed + given_back * blow
    before_jump = kinetic(column, end)
    _push(column, scheme, points, arms, union, changed, end)
    ledger[HIT if lands else FRICTION] += kinetic(column, end) - before_jump
    record[N_IMPACTS] += lands
    return OK


@njit
def _impulses(mobility, velocity, mu, guess, record):
    """As Interface.impact: impulses (k, 3), and whether they obey the laws."""
    largest = 1e-3
    for i in range(len(velocity)):
        for a in range(3):
            largest = max(largest, abs(velocity[i, a]))
    for attempt in range(2):
        # a guess far off can trap the iteration: zero is the second
        start = guess if attempt == 0 else np.zeros_like(guess)
        impulses, residual, newtons, sweeps = iterate(mobility, velocity, mu, start, 0.1 * IMPACT_TOLERANCE * largest, len(velocity) <= FEW)
        record[N_CONTACT] += newtons + sweeps
        if residual <= IMPACT_TOLERANCE * largest:
            return impulses, True
    return impulses, False


@njit
def _push(column, scheme, points, arms, union, impulses, motion):
    """Velocity jump by impulses (k, 3) at the union's points."""
    R, all_impulses, moment = motion.rotation, np.zeros_like(points.forces), np.zeros(3)
    for j in range(len(union)):
        i = union[j]
        p0, p1, p2 = impulses[j, 0], impulses[j, 1], impulses[j, 2]
        for a in range(3):
            all_impulses[i, a] = impulses[j, a]
            motion.velocity[a] += impulses[j, a] / column.mass
        b0, b1, b2 = (R[0, 0] * p0 + R[1, 0] * p1 + R[2, 0] * p2, R[0, 1] * p0 + R[1, 1] * p1 + R[2, 1] * p2,
                      R[0, 2] * p0 + R[1, 2] * p1 + R[2, 2] * p2)
        moment[0] += arms[i, 1] * b2 - arms[i, 2] * b1
        moment[1] += arms[i, 2] * b0 - arms[i, 0] * b2
        moment[2] += arms[i, 0] * b1 - arms[i, 1] * b0
    for a in range(3):
        motion.spin[a] += column.inverse[a, 0] * moment[0] + column.inverse[a, 1] * moment[1] + column.inverse[a, 2] * moment[2]
    modal = np.empty_like(motion.modal)
    modal_forces(column, points, R, all_impulses, modal)
    motion.modal_rate[:] += modal
    # the damping that HHT remembers is that of the new rates
    motion.modal_acceleration[:] -= (1 + scheme.alpha) * column.damping * modal


@njit
def _elastic_of_points(points, elastic):
    """Elastic displacement (n, 3) of the points from that of the nodes."""
    result = elastic.copy()
    for i in range(len(elastic)):
        if points.count[i] > 1:
            result[i] = 0.0
            for q in range(points.count[i]):
                for a in range(3):
                    result[i, a] += points.weights[i, q] * elastic[points.carriers[i, q], a]
    return result


@njit
def _landing_moment(points, end, early, union, landing, dt):
    """As Stepper._landing_moment."""
    total = weights = 0.0
    for j in range(len(union)):
        i = union[j]
        if landing[i]:
            gap = points.relative[i, 2]
            total += end.forces[i, 2] * gap / max(-dt * early[j, 2], gap)
            weights += end.forces[i, 2]
    return total / weights


@njit
def _turning_moment(column, points, end, early, free, pushed, union, turns):
    """As Stepper._turning_moment."""
    total = weights = 0.0
    for j in range(len(union)):
        i = union[j]
        if not turns[i]:
            continue
        s0, s1 = end.anchors[i, 0] - points.anchors[i, 0], end.anchors[i, 1] - points.anchors[i, 1]
        if not early[j, 0] * s0 + early[j, 1] * s1 > 0:
            s0, s1 = early[j, 0], early[j, 1]
        r0, r1, r2 = end.forces[i, 0], end.forces[i, 1], end.forces[i, 2]
        # a point found to stick had less than full friction, possibly forwards
        share = np.hypot(r0, r1) / max(column.friction * r2, 2.3e-308)
        start = early[j, 0] * s0 + early[j, 1] * s1
        friction = abs(pushed[j, 0] * s0 + pushed[j, 1] * s1)
        stop = free[j, 0] * s0 + free[j, 1] * s1 - friction / max(share, 2.2e-16)
        fraction = start / (start - stop) if start > 0 and stop < 0 else 1.0
        total += r2 * fraction
        weights += r2
    return total / weights
