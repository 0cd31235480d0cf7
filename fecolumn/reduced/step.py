"""One step of the reduced column: HHT for translation and modes, an energy-momentum rule for rotation, contact, impact."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.dynamics.rolling import rolling_moment
from fecolumn.dynamics.stepper import CREATED, OPEN, STUCK
from fecolumn.reduced.equilibrium import OK, equilibrate
from fecolumn.reduced.impact import collide, turning_points
from fecolumn.reduced.ledger import book
from fecolumn.reduced.motion import RIM_ANGLE, RIM_LIFT, TIME, orthonormal, total_force
from fecolumn.reduced.points import roll


@njit
def step(column, plate, scheme, points, footing, bed, start, ground, end, sway, ledger, record):
    """Carry `start` to `end`, one scheme.dt later, under the ground acceleration (3,); the steps of `Stepper._hht_step`.

    Returns: a way to end, OK or the reason why not; then `start` is unharmed and `ledger` is not to be used.
    """
    dt, booked = scheme.dt, ledger.copy()
    rolled = roll(column, start, dt, True, points)
    answer, contact_work = _carry(column, plate, scheme, points, footing, bed, start, ground, end, sway, ledger, record)
    if answer == OK and rolled and contact_work > CREATED * column.mass * np.sqrt(np.sum(column.gravity**2)) * column.width:
        # several points of the rim carry while it rolls fast: they stay for this step. No recursion: numba cannot load it from its cache
        ledger[:] = booked
        roll(column, start, dt, False, points)
        answer, contact_work = _carry(column, plate, scheme, points, footing, bed, start, ground, end, sway, ledger, record)
    if answer != OK or column.soft:
        # the springs of a pad bring a landing foot to rest in their own time: there is no impact
        return answer
    n = len(end.forces)
    landing = np.zeros(n, np.bool_)
    for i in range(n):
        landing[i] = points.forces[i, 2] <= 0 and points.relative[i, 2] > OPEN * column.width and end.forces[i, 2] > 0
    early, late = np.empty((n, 3)), np.empty((n, 3))
    turns = turning_points(column, points, start, end, dt, early, late)
    turning = total = 0.0
    for i in range(n):
        total += end.forces[i, 2]
        turning += end.forces[i, 2] if turns[i] else 0.0
    # few points of many turn where a standing foot slips in part: that is elastic, not motion
    if landing.any() or 2 * turning > total > 0:
        return collide(column, plate, scheme, points, footing, start, end, landing, turns, contact_work, ledger, record)
    return OK


@njit
def _carry(column, plate, scheme, points, footing, bed, start, ground, end, sway, ledger, record):
    """`step` with the points where they are and without impact: a way to end, and the energy that contact created.

    The contact force r acts at the end of the step and is kept out of the accelerations that HHT remembers; the rotation is
    energy-momentum conserving whatever alpha is, since HHT does not damp rigid motion.
    """
    dt, al, be, m = scheme.dt, scheme.alpha, scheme.beta, len(start.modal)
    free_center, free_modal = np.empty(3), np.empty(m)
    for a in range(3):
        before, now = column.gravity[a] - start.ground[a], column.gravity[a] - ground[a]
        end.acceleration[a] = (1 + al) * now - al * before
        free_center[a] = start.center[a] + dt * start.velocity[a] + dt**2 * ((0.5 - be) * start.acceleration[a] + be * end.acceleration[a])
    for k in range(m):
        memory = (0.5 - be) * start.modal_acceleration[k] + be * al * column.squares[k] * start.modal[k]
        free_modal[k] = start.modal[k] + dt * start.modal_rate[k] + dt**2 * memory
        if column.damping[k] > 0.0:
            way, rate = _foreseen(scheme, start, k)
            free_modal[k] += column.damping[k] * dt * (be * dt * (al * start.modal_rate[k] - (1 + al) * rate) + (1 + al) * scheme.gamma * way)
    sway.resistance[:] = 0.0
    if column.rolling > 0.0:
        load = total_force(points.forces)[2]
        sway.resistance[:] = rolling_moment(start.rotation, start.spin, load, column.rim_radius, column.rolling, column.inverse, dt)
    answer = equilibrate(column, plate, scheme, points, footing, bed, start, free_center, free_modal, dt * start.spin, end, sway, record)
    if answer != OK:
        return answer, 0.0
    _finish(column, scheme, points, start, ground, end, sway)
    return OK, book(column, scheme, points, start, end, sway, ledger)


@njit
def _foreseen(scheme, start, k):
    """Coordinate and rate of a mode at the end of the step without new accelerations: as Stage.target and Stage.velocity."""
    dt, before = scheme.dt, start.modal_acceleration[k]
    return start.modal[k] + dt * (start.modal_rate[k] + dt * (0.5 - scheme.beta) * before), start.modal_rate[k] + dt * (1 - scheme.gamma) * before


@njit
def _finish(column, scheme, points, start, ground, end, sway):
    """Velocities, accelerations and anchors at the end of the step."""
    dt, al, ga = scheme.dt, scheme.alpha, scheme.gamma
    J, momentum = column.inertia, np.empty(3)
    total = total_force(end.forces)
    for a in range(3):
        acceleration = (1 - ga) * start.acceleration[a] + ga * end.acceleration[a] + total[a] / column.mass
        end.velocity[a] = start.velocity[a] + dt * acceleration
        momentum[a] = J[a, 0] * start.spin[0] + J[a, 1] * start.spin[1] + J[a, 2] * start.spin[2] + dt * sway.moment[a]
    # into the column's frame at the end: exp(-Th) = R1^T R0
    R0, R1, carried = start.rotation, end.rotation, np.zeros(3)
    for b in range(3):
        along = R0[b, 0] * momentum[0] + R0[b, 1] * momentum[1] + R0[b, 2] * momentum[2]
        for a in range(3):
            carried[a] += R1[b, a] * along
    for a in range(3):
        end.spin[a] = column.inverse[a, 0] * carried[0] + column.inverse[a, 1] * carried[1] + column.inverse[a, 2] * carried[2]
    orthonormal(end.rotation)
    for k in range(len(end.modal)):
        end.modal_acceleration[k] = column.squares[k] * (al * start.modal[k] - (1 + al) * end.modal[k])
        if column.damping[k] > 0.0:
            way, rate = _foreseen(scheme, start, k)
            rate += ga / (scheme.beta * dt) * (end.modal[k] - way)
            end.modal_acceleration[k] += column.damping[k] * (al * start.modal_rate[k] - (1 + al) * rate)
        rate = (1 - ga) * start.modal_acceleration[k] + ga * end.modal_acceleration[k] + sway.modal[k]
        end.modal_rate[k] = start.modal_rate[k] + dt * rate
    for i in range(len(end.forces)):
        x = end.relative[i, 0] + scheme.own[i, 0] * end.forces[i, 0] + scheme.kept * points.indent[i, 0]
        y = end.relative[i, 1] + scheme.own[i, 1] * end.forces[i, 1] + scheme.kept * points.indent[i, 1]
        stuck = end.forces[i, 2] > 0 and np.hypot(x - points.anchors[i, 0], y - points.anchors[i, 1]) <= STUCK * column.width
        end.anchors[i, 0] = points.anchors[i, 0] if stuck else x
        end.anchors[i, 1] = points.anchors[i, 1] if stuck else y
    end.ground[:] = ground
    end.scalars[TIME] = start.scalars[TIME] + dt
    end.scalars[RIM_ANGLE] = points.angle[0]
    end.scalars[RIM_LIFT:] = points.rim_lift
