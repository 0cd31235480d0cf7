"""Rocking of rigid structures with one degree of freedom, from impact to impact, by the equations
of `swing_equations`.

It stands as long as neither side's phi'' at phi = 0 is positive. An impact is the event phi = 0,
found to rounding inside a step: phi' falls to e_s times its value and the other edge takes over; a
structure that can lean to one side alone goes back there. It never slides.
"""

from __future__ import annotations

import math

from fecolumn.engines.rocking.swing_equations import (
    BISECTIONS,
    FASTEST,
    HELD,
    LYING,
    ONLY,
    P2,
    PER_MASS,
    RESTITUTION,
    SLENDERNESS,
    critical_lean,
    lift,
    swing_potential,
    swing_step,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

_GRAVITY = 9.80665  # [m/s2], as in fecolumn.case: this file is compiled by itself
# what these functions are compiled with
_EQUATIONS = ("swing_equations.py",)
# step over 1/p, p the fastest rate: the fourth-order error of a step is then some 1e-8
_STEP = 0.05
# velocity after an impact below this many p alpha: the next swing would reach less than 1e-8 alpha
_REST = 1e-4
# Columns of results: peak tilt [rad], inf if it fell; impacts before it fell or came to rest or the
# motion ended; last tilt and its rate; time of the fall [s]; side it fell to
PEAK_TILT, IMPACT_COUNT, LAST_TILT, LAST_RATE, FALL_TIME, FALL_SIDE = range(6)
# Columns of recorded states: time [s], tilt [rad], rate [rad/s], side, work of the ground and loss
# of impacts over the mass [m2/s2]
SWING_TIME, SWING_TILT, SWING_RATE, SWING_EDGE, SWING_WORK, SWING_LOSS = range(6)


@njit(alone=_EQUATIONS)
def _wait(value: float, slope: float, left: float) -> float:
    """When a straight line becomes positive [s]; `left` or more where it does not in time."""
    if value > 0.0 or (value == 0.0 and slope > 0.0):
        return 0.0
    return -value / slope if slope > 0.0 else 2 * left


@njit(alone=_EQUATIONS)
def _rock(
    ground: Array,
    length: int,
    total: int,
    dt: float,
    scale: float,
    par: Array,
    tilt: float,
    rate: float,
    states: Array,
    impacts: Array,
    out: Array,
) -> None:
    fastest = par[FASTEST]
    pieces = max(1, math.ceil(fastest * dt / _STEP))
    full = dt / pieces
    over_g = scale / _GRAVITY
    s = 0.0
    if tilt != 0.0 or rate != 0.0:
        s = math.copysign(1.0, tilt if tilt != 0.0 else rate)
    k = 1 if s < 0.0 else 0
    phi, rate = abs(tilt), s * rate
    peak, count, work, loss = phi, 0, 0.0, 0.0
    fall, record, n_states = -1.0, states.shape[0] > 0, 1
    if record:
        (
            states[0, SWING_TIME],
            states[0, SWING_TILT],
            states[0, SWING_RATE],
            states[0, SWING_EDGE],
        ) = 0.0, tilt, s * rate, s
    for sample in range(total - 1):
        x0 = z0 = x1 = z1 = 0.0
        if sample < length:
            x0, z0 = ground[sample, 0] * over_g, ground[sample, 1] * over_g
        if sample + 1 < length:
            x1, z1 = ground[sample + 1, 0] * over_g, ground[sample + 1, 1] * over_g
        stands = s == 0.0
        if stands:
            for j in range(2):
                side = 1.0 - 2.0 * j
                stands = (
                    stands
                    and lift(par, j, side, x0, z0) <= 0.0
                    and lift(par, j, side, x1, z1) <= 0.0
                )
        if not stands:
            dx, dz = (x1 - x0) / dt, (z1 - z0) / dt
            for piece in range(pieces):
                start, elapsed = piece * full, 0.0
                while elapsed < full * (1 - 1e-12):
                    x, z, left = (
                        x0 + dx * (start + elapsed),
                        z0 + dz * (start + elapsed),
                        full - elapsed,
                    )
                    if s == 0.0:
                        first = 2 * left
                        for j in range(2):
                            side = 1.0 - 2.0 * j
                            now = lift(par, j, side, x, z)
                            later = lift(par, j, side, x + dx * left, z + dz * left)
                            wait = _wait(now, (later - now) / left, left)
                            if wait < first:
                                first, s, k = wait, side, j
                        if first >= left:
                            s = 0.0
                            break
                        elapsed += first
                        phi = rate = 0.0
                        continue
                    next_phi, next_rate, done, turn = swing_step(
                        par, k, s, phi, rate, x, z, dx, dz, left
                    )
                    if next_phi >= 0.0:
                        # the turning point, of the cubic through both ends
                        if rate > 0.0 and next_rate < 0.0:
                            at = rate / (rate - next_rate)
                            top = (
                                phi * (1 + 2 * at) * (1 - at) ** 2
                                + left * rate * at * (1 - at) ** 2
                            )
                            peak = max(
                                peak,
                                top
                                + next_phi * at * at * (3 - 2 * at)
                                - left * next_rate * at * at * (1 - at),
                            )
                        phi, rate, elapsed = next_phi, next_rate, full
                        work += done * par[PER_MASS + k]
                    else:
                        # regula falsi (Illinois) between a lean and an overlap; halving where it
                        # starts upright, which is a root, too
                        early, late, above, below, kept = 0.0, left, phi, next_phi, 0
                        for _ in range(BISECTIONS):
                            middle = (
                                (early * below - late * above) / (below - above)
                                if above > 0.0
                                else 0.5 * (early + late)
                            )
                            found = swing_step(par, k, s, phi, rate, x, z, dx, dz, middle)[0]
                            if found > 0.0:
                                early, above = middle, found
                                if kept > 0:
                                    below *= 0.5
                                kept = 1
                            else:
                                late, below = middle, found
                                if kept < 0:
                                    above *= 0.5
                                kept = -1
                            if late - early < 1e-14 * full or abs(found) < 1e-16:
                                late = middle
                                break
                        _, rate, done, turn = swing_step(par, k, s, phi, rate, x, z, dx, dz, late)
                        work += done * par[PER_MASS + k]
                        elapsed += late
                        loss += 0.5 * par[PER_MASS + k] * rate * rate
                        rate = par[RESTITUTION + k] * abs(rate)
                        phi = 0.0
                        if par[ONLY] == 0.0:
                            s, k = -s, 1 - k
                        if count < impacts.shape[0]:
                            impacts[count] = sample * dt + start + elapsed
                        count += 1
                        if rate <= _REST * math.sqrt(par[P2 + k]) * par[SLENDERNESS + k]:
                            rate, s, k = 0.0, 0.0, 0
                            # at the very threshold rounding decides between uplift and rest: time
                            # must go on
                            elapsed += 1e-3 * full
                        loss -= 0.5 * par[PER_MASS + k] * rate * rate
                    peak = max(peak, phi)
                    if phi > LYING:
                        fall = sample * dt + start + elapsed
                        break
                if fall >= 0.0:
                    break
        if record:
            states[n_states, SWING_TIME] = (sample + 1) * dt if fall < 0.0 else fall
            (
                states[n_states, SWING_TILT],
                states[n_states, SWING_RATE],
                states[n_states, SWING_EDGE],
            ) = (
                s * phi,
                s * rate,
                s,
            )
            states[n_states, SWING_WORK], states[n_states, SWING_LOSS] = work, -loss
            n_states += 1
        if fall >= 0.0:
            break
    out[LAST_TILT], out[LAST_RATE], out[FALL_TIME], out[FALL_SIDE] = s * phi, s * rate, fall, s
    if fall < 0.0 and s != 0.0:
        free, more, side = _free_peak(par, k, s, phi, rate)
        peak, count, out[FALL_SIDE] = max(peak, free), count + more, side
    if fall >= 0.0:
        peak = math.inf
    out[PEAK_TILT], out[IMPACT_COUNT] = peak, count


@njit(alone=_EQUATIONS)
def _free_peak(par: Array, k: int, s: float, phi: float, rate: float) -> tuple[float, int, float]:
    """Largest lean of the free rocking that is left, inf if it ends in a fall; impacts before that;
    side of the fall. By energy.
    """
    peak, count = phi, 0
    for swing in range(6):
        critical = critical_lean(par, k)
        energy, barrier = (
            0.5 * rate * rate + swing_potential(par, k, phi),
            swing_potential(par, k, critical),
        )
        if critical < LYING:
            # beyond the critical lean it falls without the energy to come back, however it moves
            if (energy >= barrier and rate > 0.0) or (phi > critical and energy < barrier):
                return math.inf, count, s
        if rate > 0.0:
            low, high = phi, critical
            for _ in range(BISECTIONS):
                middle = 0.5 * (low + high)
                if swing_potential(par, k, middle) < energy:
                    low = middle
                else:
                    high = middle
            peak = max(peak, high)
        if par[HELD] == 0.0 and swing == 1:  # each swing is less than the one before
            break
        rate = par[RESTITUTION + k] * math.sqrt(max(2 * energy, 0.0))
        phi = 0.0
        if par[ONLY] == 0.0:
            s, k = -s, 1 - k
        if rate <= _REST * math.sqrt(par[P2 + k]) * par[SLENDERNESS + k]:
            break
        count += 1
    return peak, 0, s


@njit(alone=_EQUATIONS, nogil=True)
def rock_motions(
    grounds: Array,
    offsets: Array,
    lengths: Array,
    totals: Array,
    steps: Array,
    scales: Array,
    parameters: Array,
    starts: Array,
    states: Array,
    impacts: Array,
    out: Array,
) -> None:
    """`rock_all` and `rock_one`; states (n, n_rows, 6) and impacts (n, n_times) are filled where
    they have room.
    """
    for one in range(len(offsets)):
        ground = grounds[offsets[one] : offsets[one] + lengths[one]]
        _rock(
            ground,
            lengths[one],
            totals[one],
            steps[one],
            scales[one],
            parameters[one],
            starts[one, 0],
            starts[one, 1],
            states[one],
            impacts[one],
            out[one],
        )
