"""A rigid structure that rocks in a plane with one degree of freedom: block, restrained block,
block with a roof mass, rocking frame.

It leans by phi >= 0 about its edge on side s = +1 or -1; theta = s phi is its tilt, positive
towards +x. With M its mass, I_s its inertia, and R_s and alpha_s the distance of its centre of mass
from the edge and the angle of that line to the vertical at phi = 0,

    phi'' = -p_s^2 { (1 + a_z/g) sin(alpha_s - phi) + s a_x/g cos(alpha_s - phi) } - U_s'(phi)/I_s,
    p_s^2 = M g R_s/I_s  (Housner 1963).

U_s: potential of springs, tendons and a thrust. A point of the structure at height y, at the
horizontal distance c inside the edge, moves by u = y sin phi + c (1 - cos phi) towards s; a tendon
in a duct at c is stretched by 2 c sin(phi/2) in each joint that opens:

    U_s = sum K u^2 / 2 + K_t (2 n c sin(phi/2))^2 / 2 + P n 2 c sin(phi/2) - s H u_H.

It stands as long as neither side's phi'' at phi = 0 is positive. An impact is the event phi = 0,
found to rounding inside a step: phi' falls to e_s times its value and the other edge takes over; a
structure that can lean to one side alone goes back there. It never slides. The manual derives all
of it (fecolumn help rocking).
"""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

_GRAVITY = 9.80665  # [m/s2], as in fecolumn.case: this file is compiled by itself
# step over 1/p, p the fastest rate: the fourth-order error of a step is then some 1e-8
_STEP = 0.05
# velocity after an impact below this many p alpha: the next swing would reach less than 1e-8 alpha
_REST = 1e-4
_FLAT = math.pi / 2
_BISECTIONS = 55
_SCAN = 128  # points at which the restoring moment is looked at between upright and flat
# Columns of a row of parameters; those of two sides stand one after the other, + first
SLENDERNESS, P2, RESTITUTION, SPRING, TENDON, TENDON_THRUST, ONLY, PER_MASS, FASTEST, HELD = (
    0,
    2,
    4,
    6,
    12,
    16,
    20,
    21,
    23,
    24,
)
N_PARAMETERS = 25
# Columns of results: peak tilt [rad], inf if it fell; impacts before it fell or came to rest or the
# motion ended; last tilt and its rate; time of the fall [s]; side it fell to
PEAK_TILT, IMPACT_COUNT, LAST_TILT, LAST_RATE, FALL_TIME, FALL_SIDE = range(6)
# Columns of recorded states: time [s], tilt [rad], rate [rad/s], side, work of the ground and loss
# of impacts over the mass [m2/s2]
SWING_TIME, SWING_TILT, SWING_RATE, SWING_EDGE, SWING_WORK, SWING_LOSS = range(6)


def row_of_block(slenderness: float, p: float, restitution: float) -> Array:
    """Parameters (N_PARAMETERS,) of a free-standing symmetric block of slenderness [rad] and p
    [rad/s].
    """
    row = np.zeros(N_PARAMETERS)
    (
        row[SLENDERNESS : SLENDERNESS + 2],
        row[P2 : P2 + 2],
        row[RESTITUTION : RESTITUTION + 2],
        row[PER_MASS : PER_MASS + 2],
        row[FASTEST],
    ) = slenderness, p * p, restitution, 1.0, p
    return row


def rock_all(
    grounds: list[Array],
    steps: ArrayLike,
    which: ArrayLike,
    scales: ArrayLike,
    parameters: Array,
    *,
    threads: int | None = None,
) -> Array:
    """Rock many structures in many motions, from rest, until nothing can overturn them any more;
    one row an analysis.

    Parameters
    ----------
    grounds
        arrays (n_samples, 2) of ground accelerations along x and z [m/s2].
    steps
        sampling step of each [s].
    which, scales
        (n,) motion of each analysis, and the factor on its accelerations.
    parameters
        (n, N_PARAMETERS), or (1, N_PARAMETERS) for all.
    threads
        at work at once; left out, as many as the machine has, or NUMBA_NUM_THREADS.

    Returns
    -------
    (n, 6) in the columns PEAK_TILT, IMPACT_COUNT, ...
    """
    lengths = np.array([len(ground) for ground in grounds], np.int64)
    offsets = np.concatenate([[0], np.cumsum(lengths)])[:-1]
    whole = np.ascontiguousarray(
        np.concatenate([np.asarray(ground, float).reshape(-1, 2) for ground in grounds])
    )
    motions = np.ascontiguousarray(which, np.int64)
    factors = np.ascontiguousarray(np.broadcast_to(scales, motions.shape), float)
    parameters = np.ascontiguousarray(
        np.broadcast_to(parameters, (len(motions), N_PARAMETERS)), float
    )
    samples = np.ascontiguousarray(np.broadcast_to(steps, lengths.shape), float)
    out = np.empty((len(motions), 6))
    starts, nothing = np.zeros((len(motions), 2)), np.zeros((len(motions), 0, 6))

    def some(part: slice) -> None:
        _rock_all(
            whole,
            offsets[motions[part]],
            lengths[motions[part]],
            lengths[motions[part]],
            samples[motions[part]],
            factors[part],
            parameters[part],
            starts[part],
            nothing[part],
            np.zeros((len(out[part]), 0)),
            out[part],
        )

    threads = threads or int(os.environ.get("NUMBA_NUM_THREADS", 0)) or os.cpu_count() or 1
    parts = [
        slice(begin, begin + max(1, math.ceil(len(motions) / (8 * threads))))
        for begin in range(0, len(motions), max(1, math.ceil(len(motions) / (8 * threads))))
    ]
    if threads == 1 or len(motions) < 64:
        some(slice(None))
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(some, parts))
    return out


def rock_one(
    ground: Array,
    step: float,
    parameters: Array,
    *,
    free_s: float = 0.0,
    tilt: float = 0.0,
    tilt_rate: float = 0.0,
) -> tuple[Array, Array, Array]:
    """Rock one structure and record it.

    Parameters
    ----------
    ground
        (n_samples, 2) along x and z [m/s2].
    step
        [s].
    parameters
        (N_PARAMETERS,).
    free_s
        followed after the motion [s].
    tilt, tilt_rate
        theta and theta' at the start [rad, rad/s].

    Returns
    -------
    (n, 6) states in the columns SWING_TIME, SWING_TILT, ..., one a sample, the fall last; impact
        times (k,) [s]; results (6,), of which PEAK_TILT is inf where
    the structure fell, or is bound to.
    """
    ground = np.ascontiguousarray(ground, float)
    total = len(ground) + math.ceil(free_s / step - 1e-9)
    states, impacts, out = np.zeros((1, total + 1, 6)), np.zeros((1, 200_000)), np.empty((1, 6))
    one = np.zeros(1, np.int64)
    _rock_all(
        ground,
        one,
        one + len(ground),
        one + total,
        np.array([step]),
        np.ones(1),
        np.ascontiguousarray(parameters[None], float),
        np.array([[tilt, tilt_rate]]),
        states,
        impacts,
        out,
    )
    filled = 1 + np.flatnonzero(states[0, 1:, SWING_TIME])
    n_impacts = np.count_nonzero(impacts[0])
    return states[0, : 1 + len(filled)], impacts[0, :n_impacts], out[0]


@njit(alone=True)
def _held(par: Array, k: int, phi: float) -> float:
    """U'(phi) over the inertia [1/s2]."""
    sine, cosine = math.sin(phi), math.cos(phi)
    a, t, h = SPRING + 3 * k, TENDON + 2 * k, TENDON_THRUST + 2 * k
    moment = (
        par[a] * sine * cosine
        + par[a + 1] * (sine * sine + cosine - cosine * cosine)
        + par[a + 2] * sine * (1 - cosine)
    )
    return (
        moment
        + par[t] * sine
        + par[t + 1] * math.cos(0.5 * phi)
        - par[h] * cosine
        - par[h + 1] * sine
    )


@njit(alone=True)
def _held_potential(par: Array, k: int, phi: float) -> float:
    """U(phi) over the inertia [1/s2]."""
    sine, less = math.sin(phi), 1 - math.cos(phi)
    a, t, h = SPRING + 3 * k, TENDON + 2 * k, TENDON_THRUST + 2 * k
    energy = 0.5 * par[a] * sine * sine + par[a + 1] * sine * less + 0.5 * par[a + 2] * less * less
    return (
        energy
        + par[t] * less
        + 2 * par[t + 1] * math.sin(0.5 * phi)
        - par[h] * sine
        - par[h + 1] * less
    )


@njit(alone=True)
def _restoring(par: Array, k: int, phi: float) -> float:
    """Restoring moment over the inertia [1/s2]."""
    moment = par[P2 + k] * math.sin(par[SLENDERNESS + k] - phi)
    return moment + _held(par, k, phi) if par[HELD] != 0.0 else moment


@njit(alone=True)
def _potential(par: Array, k: int, phi: float) -> float:
    """Potential over the inertia, 0 upright [1/s2]."""
    energy = par[P2 + k] * (math.cos(par[SLENDERNESS + k] - phi) - math.cos(par[SLENDERNESS + k]))
    return energy + _held_potential(par, k, phi) if par[HELD] != 0.0 else energy


@njit(alone=True)
def _critical_lean(par: Array, k: int) -> float:
    """Least lean from which the restoring moment pushes over; pi/2 where none does."""
    if par[HELD] == 0.0:
        return par[SLENDERNESS + k]
    early = late = 0.0
    if _restoring(par, k, 0.0) <= 0.0:
        return 0.0
    for point in range(1, _SCAN + 1):
        late = _FLAT * point / _SCAN
        if _restoring(par, k, late) < 0.0:
            for _ in range(_BISECTIONS):
                middle = 0.5 * (early + late)
                if _restoring(par, k, middle) > 0.0:
                    early = middle
                else:
                    late = middle
            return late
        early = late
    return _FLAT


@njit(alone=True)
def _turn(par: Array, k: int, s: float, phi: float, x: float, z: float) -> tuple[float, float]:
    """Phi'' [1/s2], and the part of it that the ground makes; x, z: ground acceleration over g."""
    lever = par[SLENDERNESS + k] - phi
    sine, cosine = math.sin(lever), math.cos(lever)
    driven = -par[P2 + k] * (z * sine + s * x * cosine)
    turn = driven - par[P2 + k] * sine
    if par[HELD] != 0.0:
        turn -= _held(par, k, phi)
    return turn, driven


@njit(alone=True)
def _advance(
    par: Array,
    k: int,
    s: float,
    phi: float,
    rate: float,
    x: float,
    z: float,
    dx: float,
    dz: float,
    step: float,
) -> tuple[float, float, float, float]:
    """phi, phi', the work of the ground over the inertia, and phi'' at the start, after a classical
    Runge-Kutta step; dx, dz: slopes of the ground's acceleration.
    """
    half = 0.5 * step
    k1, w1 = _turn(par, k, s, phi, x, z)
    v2 = rate + half * k1
    k2, w2 = _turn(par, k, s, phi + half * rate, x + half * dx, z + half * dz)
    v3 = rate + half * k2
    k3, w3 = _turn(par, k, s, phi + half * v2, x + half * dx, z + half * dz)
    v4 = rate + step * k3
    k4, w4 = _turn(par, k, s, phi + step * v3, x + step * dx, z + step * dz)
    work = step * (w1 * rate + 2 * w2 * v2 + 2 * w3 * v3 + w4 * v4) / 6
    return (
        phi + step * (rate + 2 * v2 + 2 * v3 + v4) / 6,
        rate + step * (k1 + 2 * k2 + 2 * k3 + k4) / 6,
        work,
        k1,
    )


@njit(alone=True)
def _lift(par: Array, k: int, s: float, x: float, z: float) -> float:
    """Phi'' at phi = 0 [1/s2]: positive where the ground lifts the structure onto this side; -1
    where it cannot lean there.
    """
    if par[ONLY] * s < 0.0:
        return -1.0
    return _turn(par, k, s, 0.0, x, z)[0]


@njit(alone=True)
def _wait(value: float, slope: float, left: float) -> float:
    """When a straight line becomes positive [s]; `left` or more where it does not in time."""
    if value > 0.0 or (value == 0.0 and slope > 0.0):
        return 0.0
    return -value / slope if slope > 0.0 else 2 * left


@njit(alone=True)
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
                    and _lift(par, j, side, x0, z0) <= 0.0
                    and _lift(par, j, side, x1, z1) <= 0.0
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
                            now = _lift(par, j, side, x, z)
                            later = _lift(par, j, side, x + dx * left, z + dz * left)
                            wait = _wait(now, (later - now) / left, left)
                            if wait < first:
                                first, s, k = wait, side, j
                        if first >= left:
                            s = 0.0
                            break
                        elapsed += first
                        phi = rate = 0.0
                        continue
                    next_phi, next_rate, done, turn = _advance(
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
                        for _ in range(_BISECTIONS):
                            middle = (
                                (early * below - late * above) / (below - above)
                                if above > 0.0
                                else 0.5 * (early + late)
                            )
                            found = _advance(par, k, s, phi, rate, x, z, dx, dz, middle)[0]
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
                        _, rate, done, turn = _advance(par, k, s, phi, rate, x, z, dx, dz, late)
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
                    if phi > _FLAT:
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


@njit(alone=True)
def _free_peak(par: Array, k: int, s: float, phi: float, rate: float) -> tuple[float, int, float]:
    """Largest lean of the free rocking that is left, inf if it ends in a fall; impacts before that;
    side of the fall. By energy.
    """
    peak, count = phi, 0
    for swing in range(6):
        critical = _critical_lean(par, k)
        energy, barrier = 0.5 * rate * rate + _potential(par, k, phi), _potential(par, k, critical)
        if critical < _FLAT:
            # beyond the critical lean it falls without the energy to come back, however it moves
            if (energy >= barrier and rate > 0.0) or (phi > critical and energy < barrier):
                return math.inf, count, s
        if rate > 0.0:
            low, high = phi, critical
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if _potential(par, k, middle) < energy:
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


@njit(alone=True)
def look(par: Array, k: int, leans: Array, out: Array) -> None:
    """Restoring moment, gravity and held potential over the inertia at leans (n,), and the critical
    lean; out: (n, 4).
    """
    critical = _critical_lean(par, k)
    for one in range(len(leans)):
        gravity = par[P2 + k] * (
            math.cos(par[SLENDERNESS + k] - leans[one]) - math.cos(par[SLENDERNESS + k])
        )
        out[one, 0], out[one, 1], out[one, 2], out[one, 3] = (
            _restoring(par, k, leans[one]),
            gravity,
            _potential(par, k, leans[one]) - gravity,
            critical,
        )


@njit(alone=True, nogil=True)
def _rock_all(
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
