"""Time integration of a podium: columns that rock below an elastic building, in its modes.

State: tilt theta of the columns, its rate, and for each mode j of the building the coordinate y_j
of the floors' displacements relative to the ground, with its rate. With s the side leaned to, beta
= alpha - s theta, beam u = 2 R s (sin alpha - sin beta), v = 2 R (cos beta - cos alpha),
mass-normalised modes and Gamma_j their participation, Lagrange's equations are

    (I + 4 gamma + 4 eta gamma sin^2 beta) R theta''
        = s 2 eta gamma R sin(2 beta) theta'^2 - s (1 + 2 gamma + 2 eta gamma) (g + a_z) sin beta
          - (1 + 2 gamma) a_x cos beta + 2 eta gamma cos(beta) V/M,
    y_j'' = -Gamma_j a_x - f_j,   V = sum Gamma_j f_j,
    f_j = omega_j^2 (y_j - Gamma_j u) + 2 xi_j omega_j (y_j' - Gamma_j u').

While it stands u = 0; it lifts off where |-(1 + 2 gamma) a_x + 2 eta gamma V/M| > (1 + 2 gamma + 2
eta gamma) (g + a_z) tan alpha. While it stands the modes are stepped exactly, below a straight
ground acceleration; else by classical Runge-Kutta steps. Impacts and liftings off are located
within a step.
"""

from __future__ import annotations

import math

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Columns of the rows; all energies are per mass of the columns [J/kg]
(
    PODIUM_TIME,
    PODIUM_TILT,
    PODIUM_RATE,
    PODIUM_SIDE,
    PODIUM_SHEAR,
    PODIUM_WORK,
    PODIUM_DAMPED,
    PODIUM_LOSS,
    PODIUM_KINETIC,
    PODIUM_STRAIN,
    PODIUM_GRAVITATIONAL,
    PODIUM_FLOORS,
) = range(12)
# of p alpha: a tilt's rate after an impact below this, the next swing would reach less than 1e-8
# alpha
_REST = 1e-4
_FLAT = math.pi / 2
_TRIES = 60  # for the instant of an impact or of lifting off
_WITHIN = 1e-13  # of a step: how exactly that instant is found
_SUMS = {"reassoc", "contract", "nsz"}  # sums over modes in any order
_PROGRESS = 1e-6  # of a step: the least that an impact takes, so that time goes on


@njit(alone=True, fastmath=_SUMS)
def _rates(
    x: Array, side: float, base: Array, modes: Array, n: int, a: float, az: float, out: Array
) -> float:
    """Rates of the state x, and the base shear V/M; base (9,): alpha, R, I, gamma, eta, g, sin,
    cos, tan of alpha; modes (3, n): omega^2, 2 xi omega, Gamma/sqrt(M).
    """
    radius, inertia, gamma, eta, g = base[1], base[2], base[3], base[4], base[5]
    s, c, shift, speed = base[6], base[7], 0.0, 0.0
    if side != 0.0:
        beta = base[0] - side * x[0]
        s, c = math.sin(beta), math.cos(beta)
        shift, speed = side * 2 * radius * (base[6] - s), 2 * radius * c * x[1]
    shear, damped, along = 0.0, 0.0, 0.0
    for j in range(n):
        part = modes[2, j]
        slip = x[2 + n + j] - part * speed
        force = modes[0, j] * (x[2 + j] - part * shift) + modes[1, j] * slip
        out[2 + j] = x[2 + n + j]
        out[2 + n + j] = -part * a - force
        shear += part * force
        damped += modes[1, j] * slip * slip
        along += part * x[2 + n + j]
    turning = 0.0
    if side != 0.0:
        turning = (
            side
            * (
                4 * eta * gamma * radius * s * c * x[1] ** 2
                - (1 + 2 * gamma + 2 * eta * gamma) * (g + az) * s
            )
            - (1 + 2 * gamma) * a * c
            + 2 * eta * gamma * c * shear
        ) / ((inertia + 4 * gamma + 4 * eta * gamma * s * s) * radius)
    out[0], out[1] = x[1], turning
    rising = side * (1 + 2 * gamma + 2 * eta * gamma) * radius * s * x[1]
    out[2 + 2 * n] = -a * ((1 + 2 * gamma) * radius * c * x[1] + gamma * eta * along) - az * rising
    out[3 + 2 * n] = gamma * eta * damped
    return shear


@njit(alone=True, fastmath=_SUMS)
def _advance(
    x: Array,
    side: float,
    base: Array,
    modes: Array,
    n: int,
    a: float,
    az: float,
    slope: float,
    slope_z: float,
    h: float,
    first: Array,
    second: Array,
    third: Array,
    fourth: Array,
    out: Array,
) -> None:
    """State after a Runge-Kutta step; `first` are the rates at x; second, third and fourth (size,)
    are scratch.
    """
    size = len(x)
    for i in range(size):
        out[i] = x[i] + 0.5 * h * first[i]
    _rates(out, side, base, modes, n, a + 0.5 * h * slope, az + 0.5 * h * slope_z, second)
    for i in range(size):
        out[i] = x[i] + 0.5 * h * second[i]
    _rates(out, side, base, modes, n, a + 0.5 * h * slope, az + 0.5 * h * slope_z, third)
    for i in range(size):
        out[i] = x[i] + h * third[i]
    _rates(out, side, base, modes, n, a + h * slope, az + h * slope_z, fourth)
    for i in range(size):
        out[i] = x[i] + h * (first[i] + 2 * second[i] + 2 * third[i] + fourth[i]) / 6


@njit(alone=True)
def _push(base: Array, shear: float, a: float, az: float) -> tuple[float, float]:
    """Moment over the edges of a standing podium, in g tan alpha, and what it is over that which
    holds it; it lifts off where this is positive.
    """
    gamma, eta = base[3], base[4]
    push = -(1 + 2 * gamma) * a + 2 * eta * gamma * shear
    return push, abs(push) - (1 + 2 * gamma + 2 * eta * gamma) * (base[5] + az) * base[8]


@njit(alone=True)
def _free(omega: float, xi: float, h: float) -> tuple[float, float, float]:
    """Of a mode in free vibration, damped less than critically, in a step h: displacement from
    displacement and velocity, velocity from velocity.
    """
    damped = omega * math.sqrt(1 - xi * xi)
    s, c, decay = math.sin(damped * h), math.cos(damped * h), math.exp(-xi * omega * h)
    turned = xi * omega / damped * s
    return decay * (c + turned), decay * s / damped, decay * (c - turned)


@njit(alone=True)
def _stand(
    x: Array,
    modes: Array,
    n: int,
    free: Array,
    a: float,
    slope: float,
    h: float,
    shares: float,
    out: Array,
) -> None:
    """State of a standing podium after a step in which the ground's acceleration is straight:
    exact; `shares`: gamma eta.
    """
    work, damped = 0.0, 0.0
    for j in range(n):
        stiff, damping, part = modes[0, j], modes[1, j], modes[2, j]
        # a straight line drives a straight line, what differs from it vibrates freely
        speed = -part * slope / stiff
        place = -(part * a + damping * speed) / stiff
        y, v = x[2 + j] - place, x[2 + n + j] - speed
        out[2 + j] = place + speed * h + free[0, j] * y + free[1, j] * v
        out[2 + n + j] = speed - stiff * free[1, j] * y + free[2, j] * v
        moved, sped = out[2 + j] - x[2 + j], out[2 + n + j] - x[2 + n + j]
        # integral of y from the equation of motion, and of a y' by parts
        area = -(part * (a + 0.5 * slope * h) * h + sped + damping * moved) / stiff
        done = -part * ((a + slope * h) * out[2 + j] - a * x[2 + j] - slope * area)
        work += done
        damped += done - 0.5 * (
            out[2 + n + j] ** 2 - x[2 + n + j] ** 2 + stiff * (out[2 + j] ** 2 - x[2 + j] ** 2)
        )
    out[0], out[1] = 0.0, 0.0
    out[2 + 2 * n], out[3 + 2 * n] = x[2 + 2 * n] + shares * work, x[3 + 2 * n] + shares * damped


@njit(alone=True, fastmath=_SUMS)
def _energy(x: Array, side: float, base: Array, modes: Array, n: int) -> tuple[float, float, float]:
    """Kinetic, strain and gravity, per mass of the columns [J/kg]."""
    alpha, radius, inertia, gamma, eta, g = base[0], base[1], base[2], base[3], base[4], base[5]
    beta = alpha - side * x[0]
    shift = side * 2 * radius * (base[6] - math.sin(beta))
    kinetic = (
        0.5 * radius**2 * (inertia + 4 * gamma + 4 * gamma * eta * math.sin(beta) ** 2) * x[1] ** 2
    )
    strain = 0.0
    for j in range(n):
        kinetic += 0.5 * gamma * eta * x[2 + n + j] ** 2
        strain += 0.5 * gamma * eta * modes[0, j] * (x[2 + j] - modes[2, j] * shift) ** 2
    return (
        kinetic,
        strain,
        (1 + 2 * gamma + 2 * gamma * eta) * g * radius * (math.cos(beta) - base[7]),
    )


@njit(alone=True)
def shake(
    ground: Array,
    dt: float,
    base: Array,
    modes: Array,
    storey: Array,
    floors: Array,
    restitution: float,
    relative: bool,
    step: float,
    tilt: float,
    rate: float,
) -> tuple[Array, Array, Array, float, bool]:
    """Motion of a podium.

    Parameters
    ----------
    ground
        (n, 2) acceleration along x and up [m/s2], straight between samples `dt` [s] apart.
    base
        (6,) alpha [rad], R [m], I, gamma, eta, g [m/s2].
    modes
        (3, n) omega [rad/s], damping ratio, participation over sqrt(M).
    storey
        (n, n) shear of each storey over M for accelerations f_j.
    floors
        (n, n) displacement of each floor, the roof last, for modal coordinates.
    restitution
        of the tilt's rate at an impact.
    relative
        whether floors keep their velocity relative to the beam there (CRV).
    step
        largest step [s].
    tilt, rate
        at the start [rad, rad/s], the building moving with the beam.

    Returns
    -------
    rows (m, 11 + n), the last n the displacements of the floors [m]; impact times [s]; peak shear
        of each storey over M (n,) [m/s2]; peak tilt [rad]; whether it lies flat.
    """
    n = modes.shape[1]
    samples = len(ground)
    size = 4 + 2 * n
    x, y, first, second, third, fourth, last = (
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
    )
    alpha, radius = base[0], base[1]
    base = np.append(base, np.array([math.sin(alpha), math.cos(alpha), math.tan(alpha)]))
    above, total = storey.T.copy(), np.zeros(n)
    pace = math.sqrt(
        (1 + 2 * base[3] + 2 * base[3] * base[4])
        * base[5]
        / ((base[2] + 4 * base[3] + 4 * base[3] * base[4] * base[6] ** 2) * radius)
    )
    side = math.copysign(1.0, tilt if tilt != 0 else rate) if tilt != 0 or rate != 0 else 0.0
    x[0], x[1] = tilt, rate
    beta = alpha - side * tilt
    for j in range(n):
        x[2 + j] = modes[2, j] * side * 2 * radius * (base[6] - math.sin(beta))
        x[2 + n + j] = modes[2, j] * 2 * radius * math.cos(beta) * rate
    rows, peaks, impacts = (
        np.zeros((samples, PODIUM_FLOORS + n)),
        np.zeros(n),
        [0.0 for _ in range(0)],
    )
    peak, loss = abs(tilt), 0.0
    pieces = max(1, math.ceil(dt / step - 1e-9))
    full = dt / pieces
    # of damping ratios: the step of a standing podium is that of underdamped modes
    exact = modes[1].max() < 1.0
    free = np.zeros((3, n))
    if exact:
        for j in range(n):
            free[0, j], free[1, j], free[2, j] = _free(modes[0, j], modes[1, j], full)
    modes = np.stack((modes[0] ** 2, 2 * modes[1] * modes[0], modes[2]))
    shear = _rates(x, side, base, modes, n, ground[0, 0], ground[0, 1], first)
    for sample in range(samples):
        if sample:
            slope, slope_z = (
                (ground[sample, 0] - ground[sample - 1, 0]) / dt,
                (ground[sample, 1] - ground[sample - 1, 1]) / dt,
            )
            for piece in range(pieces):
                elapsed = 0.0
                while elapsed < full * (1 - 1e-12):
                    start, h = piece * full + elapsed, full - elapsed
                    a, az = (
                        ground[sample - 1, 0] + start * slope,
                        ground[sample - 1, 1] + start * slope_z,
                    )
                    if side == 0.0:
                        push, over = _push(base, shear, a, az)
                        if over > 0:
                            side = math.copysign(1.0, push)
                            _rates(x, side, base, modes, n, a, az, first)
                    stands = side == 0.0
                    if stands and exact and elapsed == 0.0:
                        _stand(x, modes, n, free, a, slope, h, base[3] * base[4], y)
                    else:
                        _advance(
                            x,
                            side,
                            base,
                            modes,
                            n,
                            a,
                            az,
                            slope,
                            slope_z,
                            h,
                            first,
                            second,
                            third,
                            fourth,
                            y,
                        )
                    a1, z1 = a + h * slope, az + h * slope_z
                    shear = _rates(y, side, base, modes, n, a1, z1, last)
                    late_past = _push(base, shear, a1, z1)[1] if stands else -side * y[0]
                    landed = late_past > 0 and not stands
                    if late_past > 0:
                        # false position, the end that stays counting half each time (Illinois)
                        early, late, kept = 0.0, h, 0
                        early_past = (
                            _push(base, _rates(x, 0.0, base, modes, n, a, az, second), a, az)[1]
                            if stands
                            else -side * x[0]
                        )
                        for _ in range(_TRIES):
                            share = early_past / (early_past - late_past) if early_past < 0 else 0.5
                            middle = early + share * (late - early)
                            _advance(
                                x,
                                side,
                                base,
                                modes,
                                n,
                                a,
                                az,
                                slope,
                                slope_z,
                                middle,
                                first,
                                second,
                                third,
                                fourth,
                                y,
                            )
                            a1, z1 = a + middle * slope, az + middle * slope_z
                            past = (
                                _push(base, _rates(y, 0.0, base, modes, n, a1, z1, last), a1, z1)[1]
                                if stands
                                else -side * y[0]
                            )
                            if past > 0:
                                late, late_past = middle, past
                                early_past *= 0.5 if kept == 1 else 1.0
                                kept = 1
                            else:
                                early, early_past = middle, past
                                late_past *= 0.5 if kept == -1 else 1.0
                                kept = -1
                            if late - early <= _WITHIN * full:
                                break
                        h = max(late, _PROGRESS * full) if landed else late
                        _advance(
                            x,
                            side,
                            base,
                            modes,
                            n,
                            a,
                            az,
                            slope,
                            slope_z,
                            h,
                            first,
                            second,
                            third,
                            fourth,
                            y,
                        )
                        a1, z1 = a + h * slope, az + h * slope_z
                        shear = _rates(y, side, base, modes, n, a1, z1, last)
                    for i in range(size):
                        x[i] = y[i]
                    elapsed += h
                    if landed:
                        before = sum(_energy(x, side, base, modes, n))
                        after = restitution * x[1]
                        if relative:
                            for j in range(n):
                                x[2 + n + j] += modes[2, j] * 2 * radius * base[7] * (after - x[1])
                        x[0], x[1], side = 0.0, after, -side
                        if abs(after) <= _REST * pace * alpha:
                            x[1], side = 0.0, 0.0
                        loss += sum(_energy(x, side, base, modes, n)) - before
                        impacts.append((sample - 1) * dt + piece * full + elapsed)
                        shear = _rates(x, side, base, modes, n, a1, z1, last)
                    # the ground's motion is continuous: the next step begins with these rates
                    for i in range(size):
                        first[i] = last[i]
                    peak = max(peak, abs(x[0]))
                    total[:] = 0.0
                    for j in range(n):
                        force = -last[2 + n + j] - modes[2, j] * a1
                        for i in range(n):
                            total[i] += above[j, i] * force
                    for i in range(n):
                        peaks[i] = max(peaks[i], abs(total[i]))
                    if abs(x[0]) >= _FLAT:
                        break
                if abs(x[0]) >= _FLAT:
                    break
        (
            rows[sample, PODIUM_TIME],
            rows[sample, PODIUM_TILT],
            rows[sample, PODIUM_RATE],
            rows[sample, PODIUM_SIDE],
        ) = (
            sample * dt,
            x[0],
            x[1],
            side,
        )
        rows[sample, PODIUM_SHEAR] = shear
        for j in range(n):
            for k in range(n):
                rows[sample, PODIUM_FLOORS + k] += floors[k, j] * x[2 + j]
        rows[sample, PODIUM_WORK], rows[sample, PODIUM_DAMPED], rows[sample, PODIUM_LOSS] = (
            x[2 + 2 * n],
            -x[3 + 2 * n],
            loss,
        )
        (
            rows[sample, PODIUM_KINETIC],
            rows[sample, PODIUM_STRAIN],
            rows[sample, PODIUM_GRAVITATIONAL],
        ) = _energy(x, side, base, modes, n)
        if abs(x[0]) >= _FLAT:
            return rows[: sample + 1], np.array(impacts), peaks, peak, True
    return rows, np.array(impacts), peaks, peak, False
