"""Energy ledger of the reduced engine: the terms of `dynamics.energy` in compiled code."""

from __future__ import annotations

from fecolumn._compiled import njit
from fecolumn.contact.pad import dashpot_work
from fecolumn.reduced.motion import STATIC, total_force

# Places in a ledger: the energy at the start, then the works in the order of dynamics.energy.TERMS [J]
START, BASE, FRICTION, HIT, CONTACT_WORK, ALGORITHMIC, DAMPING, ROLLING = range(8)
N_PLACES = ROLLING + 1


@njit
def kinetic(column, motion):
    """Kinetic energy [J]."""
    v, w, J, total = motion.velocity, motion.spin, column.inertia, 0.0
    for a in range(3):
        total += column.mass * v[a] * v[a] + w[a] * (J[a, 0] * w[0] + J[a, 1] * w[1] + J[a, 2] * w[2])
    for k in range(len(motion.modal)):
        total += motion.modal_rate[k] ** 2
    return total / 2


@njit
def strain(column, motion):
    """Strain energy of the modes, and of what responds statically [J]."""
    total = 0.0
    for k in range(len(motion.modal)):
        total += column.squares[k] * motion.modal[k] ** 2
    return total / 2 + motion.scalars[STATIC]


@njit
def weight_energy(column, reference, motion):
    """Gravity energy relative to the centre of mass at `reference` (3,) [J]."""
    g, c = column.gravity, motion.center
    return -column.mass * (g[0] * (c[0] - reference[0]) + g[1] * (c[1] - reference[1]) + g[2] * (c[2] - reference[2]))


@njit
def book(column, scheme, points, start, end, sway, ledger):
    """Book a step before its impact, as Stepper._book; returns the work of contact [J]."""
    al, ga, dt, work, algorithmic, base = scheme.alpha, scheme.gamma, scheme.dt, 0.0, 0.0, 0.0
    numerical = dt**2 * al**2 / 4
    damping = rolling = 0.0
    total = total_force(end.forces)
    for a in range(3):
        moved, push = end.center[a] - start.center[a], total[a]
        mean = column.mass * ((1 - ga) * start.acceleration[a] + ga * end.acceleration[a])
        load = column.mass * (column.gravity[a] - (start.ground[a] + end.ground[a]) / 2)
        algorithmic += moved * (mean - load) - numerical * (end.acceleration[a] - start.acceleration[a]) * (mean + push)
        work += moved * push + sway.turn[a] * sway.moment[a]
        rolling += sway.turn[a] * sway.resistance[a]
        base -= (start.ground[a] + end.ground[a]) / 2 * column.mass * moved
    for k in range(len(end.modal)):
        moved = end.modal[k] - start.modal[k]
        mean = (1 - ga) * start.modal_acceleration[k] + ga * end.modal_acceleration[k]
        algorithmic += moved * (mean + column.squares[k] * (start.modal[k] + end.modal[k]) / 2)
        algorithmic -= numerical * (end.modal_acceleration[k] - start.modal_acceleration[k]) * (mean + sway.modal[k])
        work += moved * sway.modal[k]
        # with the rate that the damping meets, see Stepper._hht_step
        rate = end.modal_rate[k] - dt * al**2 / (4 * scheme.beta) * sway.modal[k]
        damping -= moved * column.damping[k] * (start.modal_rate[k] + rate) / 2
    contact = work - rolling + end.scalars[STATIC] - start.scalars[STATIC]
    dashpots = dashpot_work(column.springs, scheme.give, scheme.kept, end.forces, points.indent, end.indent) if column.soft else 0.0
    friction = landed = 0.0
    for i in range(len(end.forces)):
        if end.forces[i, 2] > 0:
            friction += end.forces[i, 0] * (end.anchors[i, 0] - points.anchors[i, 0]) + end.forces[i, 1] * (end.anchors[i, 1] - points.anchors[i, 1])
            if points.forces[i, 2] <= 0 and not column.soft:
                landed += end.forces[i, 2] * (end.relative[i, 2] - points.relative[i, 2])
    ledger[BASE] += base
    ledger[FRICTION] += friction
    ledger[HIT] += landed
    ledger[CONTACT_WORK] += contact - friction - landed + dashpots
    ledger[ALGORITHMIC] += algorithmic - damping
    ledger[DAMPING] += damping - dashpots
    ledger[ROLLING] += rolling
    return contact
