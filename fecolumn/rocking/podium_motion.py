"""Time integration of a podium: columns that rock below an elastic building, in its modes.

State: tilt theta of the columns, its rate, and for each mode j of the building the coordinate y_j of the floors' displacements relative to
the ground, with its rate. With s the side leaned to, beta = alpha - s theta, beam u = 2 R s (sin alpha - sin beta), v = 2 R (cos beta - cos
alpha), mass-normalised modes and Gamma_j their participation, Lagrange's equations are

    (I + 4 gamma + 4 eta gamma sin^2 beta) R theta'' = s 2 eta gamma R sin(2 beta) theta'^2 - s (1 + 2 gamma + 2 eta gamma) (g + a_z) sin beta
                                                        - (1 + 2 gamma) a_x cos beta + 2 eta gamma cos(beta) V/M
    y_j'' = -Gamma_j a_x - f_j,   f_j = omega_j^2 (y_j - Gamma_j u) + 2 xi_j omega_j (y_j' - Gamma_j u'),   V = sum Gamma_j f_j.

While it stands u = 0; it lifts off where |-(1 + 2 gamma) a_x + 2 eta gamma V/M| > (1 + 2 gamma + 2 eta gamma) (g + a_z) tan alpha.
Classical Runge-Kutta steps; impacts and liftings off are located within a step by bisection.
"""

from __future__ import annotations

import math

import numpy as np

from fecolumn._compiled import njit

# Columns of the rows; all energies are per mass of the columns [J/kg]
TIME, TILT, RATE, SIDE, SHEAR, ROOF, WORK, DAMPED, LOSS, KINETIC, STRAIN, GRAVITATIONAL = range(12)
_REST = 1e-4  # of p alpha: a tilt's rate after an impact below this, the next swing would reach less than 1e-8 alpha
_FLAT = math.pi / 2
_BISECTIONS = 50
_PROGRESS = 1e-6  # of a step: the least that an impact takes, so that time goes on


@njit(alone=True)
def _rates(x, side, base, modes, n, a, az, out):
    """Rates of the state x; base (6,): alpha, R, I, gamma, eta, g; modes (3, n): omega, xi, Gamma/sqrt(M)."""
    alpha, radius, inertia, gamma, eta, g = base[0], base[1], base[2], base[3], base[4], base[5]
    beta = alpha - side * x[0]
    shift = side * 2 * radius * (math.sin(alpha) - math.sin(beta))
    speed = 2 * radius * math.cos(beta) * x[1]
    shear, damped, along = 0.0, 0.0, 0.0
    for j in range(n):
        w, xi, part = modes[0, j], modes[1, j], modes[2, j]
        stretch, slip = x[2 + j] - part * shift, x[2 + n + j] - part * speed
        force = w * w * stretch + 2 * xi * w * slip
        out[2 + j] = x[2 + n + j]
        out[2 + n + j] = -part * a - force
        shear += part * force
        damped += 2 * xi * w * slip * slip
        along += part * x[2 + n + j]
    c, s = math.cos(beta), math.sin(beta)
    turning = 0.0
    if side != 0.0:
        turning = (side * (2 * eta * gamma * radius * math.sin(2 * beta) * x[1] ** 2 - (1 + 2 * gamma + 2 * eta * gamma) * (g + az) * s)
                   - (1 + 2 * gamma) * a * c + 2 * eta * gamma * c * shear) / ((inertia + 4 * gamma + 4 * eta * gamma * s * s) * radius)
    out[0], out[1] = x[1], turning
    rising = side * (1 + 2 * gamma + 2 * eta * gamma) * radius * s * x[1]
    out[2 + 2 * n] = -a * ((1 + 2 * gamma) * radius * c * x[1] + gamma * eta * along) - az * rising
    out[3 + 2 * n] = gamma * eta * damped
    return shear


@njit(alone=True)
def _advance(x, side, base, modes, n, a, az, slope, slope_z, h, work, out):
    """State after a Runge-Kutta step; `work` (5, size) is scratch."""
    size = len(x)
    _rates(x, side, base, modes, n, a, az, work[0])
    for i in range(size):
        work[4, i] = x[i] + 0.5 * h * work[0, i]
    _rates(work[4], side, base, modes, n, a + 0.5 * h * slope, az + 0.5 * h * slope_z, work[1])
    for i in range(size):
        work[4, i] = x[i] + 0.5 * h * work[1, i]
    _rates(work[4], side, base, modes, n, a + 0.5 * h * slope, az + 0.5 * h * slope_z, work[2])
    for i in range(size):
        work[4, i] = x[i] + h * work[2, i]
    _rates(work[4], side, base, modes, n, a + h * slope, az + h * slope_z, work[3])
    for i in range(size):
        out[i] = x[i] + h * (work[0, i] + 2 * work[1, i] + 2 * work[2, i] + work[3, i]) / 6


@njit(alone=True)
def _push(base, shear, a, az):
    """Side to which a standing podium lifts off, 0 if it stands: moment over the edges over that which holds it, in g tan alpha."""
    gamma, eta = base[3], base[4]
    push = -(1 + 2 * gamma) * a + 2 * eta * gamma * shear
    held = (1 + 2 * gamma + 2 * eta * gamma) * (base[5] + az) * math.tan(base[0])
    return 0.0 if abs(push) <= held else math.copysign(1.0, push)


@njit(alone=True)
def _energy(x, side, base, modes, n):
    """Kinetic, strain and gravity, per mass of the columns [J/kg]."""
    alpha, radius, inertia, gamma, eta, g = base[0], base[1], base[2], base[3], base[4], base[5]
    beta = alpha - side * x[0]
    shift = side * 2 * radius * (math.sin(alpha) - math.sin(beta))
    kinetic = 0.5 * radius**2 * (inertia + 4 * gamma + 4 * gamma * eta * math.sin(beta) ** 2) * x[1] ** 2
    strain = 0.0
    for j in range(n):
        kinetic += 0.5 * gamma * eta * x[2 + n + j] ** 2
        strain += 0.5 * gamma * eta * (modes[0, j] * (x[2 + j] - modes[2, j] * shift)) ** 2
    return kinetic, strain, (1 + 2 * gamma + 2 * gamma * eta) * g * radius * (math.cos(beta) - math.cos(alpha))


@njit(alone=True)
def shake(ground, dt, base, modes, storey, roof, restitution, relative, step, tilt, rate):
    """Motion of a podium.

    Args:
        ground: (n, 2) acceleration along x and up [m/s2], straight between samples `dt` [s] apart.
        base: (6,) alpha [rad], R [m], I, gamma, eta, g [m/s2].
        modes: (3, n) omega [rad/s], damping ratio, participation over sqrt(M).
        storey: (n, n) shear of each storey over M for accelerations f_j. roof: (n,) displacement of the roof for modal coordinates.
        restitution: of the tilt's rate at an impact. relative: whether floors keep their velocity relative to the beam there (CRV).
        step: largest step [s]. tilt, rate: at the start [rad, rad/s], the building moving with the beam.

    Returns:
        rows (m, 12); impact times [s]; peak shear of each storey over M (n,) [m/s2]; peak tilt [rad]; whether it lies flat.
    """
    n = modes.shape[1]
    samples = len(ground)
    size = 4 + 2 * n
    x, y, work, last = np.zeros(size), np.zeros(size), np.zeros((5, size)), np.zeros(size)
    alpha, radius = base[0], base[1]
    squared = math.sin(alpha) ** 2
    pace = math.sqrt((1 + 2 * base[3] + 2 * base[3] * base[4]) * base[5] / ((base[2] + 4 * base[3] + 4 * base[3] * base[4] * squared) * radius))
    side = math.copysign(1.0, tilt if tilt != 0 else rate) if tilt != 0 or rate != 0 else 0.0
    x[0], x[1] = tilt, rate
    beta = alpha - side * tilt
    for j in range(n):
        x[2 + j] = modes[2, j] * side * 2 * radius * (math.sin(alpha) - math.sin(beta))
        x[2 + n + j] = modes[2, j] * 2 * radius * math.cos(beta) * rate
    rows, peaks, impacts = np.zeros((samples, 12)), np.zeros(n), [0.0 for _ in range(0)]
    peak, loss, shear = abs(tilt), 0.0, 0.0
    pieces = max(1, math.ceil(dt / step - 1e-9))
    full = dt / pieces
    for sample in range(samples):
        if sample:
            slope, slope_z = (ground[sample, 0] - ground[sample - 1, 0]) / dt, (ground[sample, 1] - ground[sample - 1, 1]) / dt
            for piece in range(pieces):
                elapsed = 0.0
                while elapsed < full * (1 - 1e-12):
                    start, h = piece * full + elapsed, full - elapsed
                    a, az = ground[sample - 1, 0] + start * slope, ground[sample - 1, 1] + start * slope_z
                    if side == 0.0:
                        side = _push(base, _rates(x, 0.0, base, modes, n, a, az, work[0]), a, az)
                    _advance(x, side, base, modes, n, a, az, slope, slope_z, h, work, y)
                    landed = side != 0.0 and side * y[0] < 0
                    lifted = 0.0
                    if side == 0.0:
                        lifted = _push(base, _rates(y, 0.0, base, modes, n, a + h * slope, az + h * slope_z, work[0]), a + h * slope, az + h * slope_z)
                    if landed or lifted != 0.0:
                        early, late = 0.0, h
                        for _ in range(_BISECTIONS):
                            middle = 0.5 * (early + late)
                            _advance(x, side, base, modes, n, a, az, slope, slope_z, middle, work, y)
                            a1, z1 = a + middle * slope, az + middle * slope_z
                            past = side * y[0] < 0 if landed else _push(base, _rates(y, 0.0, base, modes, n, a1, z1, work[0]), a1, z1) != 0.0
                            if past:
                                late = middle
                            else:
                                early = middle
                        h = max(late, _PROGRESS * full) if landed else late
                        _advance(x, side, base, modes, n, a, az, slope, slope_z, h, work, y)
                    x[:] = y
                    elapsed += h
                    if landed:
                        before = sum(_energy(x, side, base, modes, n))
                        after = restitution * x[1]
                        if relative:
                            for j in range(n):
                                x[2 + n + j] += modes[2, j] * 2 * radius * math.cos(alpha) * (after - x[1])
                        x[0], x[1], side = 0.0, after, -side
                        if abs(after) <= _REST * pace * alpha:
                            x[1], side = 0.0, 0.0
                        loss += sum(_energy(x, side, base, modes, n)) - before
                        impacts.append((sample - 1) * dt + piece * full + elapsed)
                    peak = max(peak, abs(x[0]))
                    shear = _rates(x, side, base, modes, n, 0.0, 0.0, last)
                    for i in range(n):
                        total = 0.0
                        for j in range(n):
                            total -= storey[i, j] * last[2 + n + j]
                        peaks[i] = max(peaks[i], abs(total))
                    if abs(x[0]) >= _FLAT:
                        break
                if abs(x[0]) >= _FLAT:
                    break
        rows[sample, TIME], rows[sample, TILT], rows[sample, RATE], rows[sample, SIDE] = sample * dt, x[0], x[1], side
        rows[sample, SHEAR] = shear
        for j in range(n):
            rows[sample, ROOF] += roof[j] * x[2 + j]
        rows[sample, WORK], rows[sample, DAMPED], rows[sample, LOSS] = x[2 + 2 * n], -x[3 + 2 * n], loss
        rows[sample, KINETIC], rows[sample, STRAIN], rows[sample, GRAVITATIONAL] = _energy(x, side, base, modes, n)
        if abs(x[0]) >= _FLAT:
            return rows[:sample + 1], np.array(impacts), peaks, peak, True
    return rows, np.array(impacts), peaks, peak, False
