"""Time integration of the wobbling column and frame: eighth-order Runge-Kutta steps, rolling
through upright, standing and lifting off.

The equations (`wobbling_equations`) have tilt, azimuth, tilt_rate and spin, the momentum of the
azimuth. A step never passes a sample of the ground's motion, which is linear between samples. Where
the column rolls past upright closely, within seconds or within microseconds, the steps follow;
where it comes closer than CLOSEST they end in closed form: there nothing but the inertias A of the
tilt and B tilt^2 of the azimuth counts, and A tilt'^2 + B tilt^2 azimuth'^2 is the metric of a
cone. Unrolled its geodesics are straight lines, so that the azimuth turns by 2 sqrt(A/B)
acos(closest tilt / tilt), towards the side of the spin. That is nearly half a turn: the column
leans to the other side. A spin of nothing has no side: half a turn, as in a plane. Nothing is lost,
for nothing lands; `restitution` below 1 takes its share there.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import DOP853

from fecolumn.engines.rocking.wobbling_equations import force, inertia, moments, potential, rates
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Columns of the rows
WOBBLE_TIME, WOBBLE_TILT, WOBBLE_AZIMUTH, WOBBLE_RATE, WOBBLE_SPIN, WOBBLE_WORK, WOBBLE_LOSS = (
    range(7)
)
# tilt [rad] below which passing upright is done in closed form; its error is of this order
CLOSEST = 1e-9
LIFTED_TILT = 1e-8  # tilt [rad] at which a column starts that lifts off
_PLANAR = 1e-3  # of CLOSEST: what comes closer passes in a plane, as its spin is rounding
_REST = 1e-6  # of the critical tilt: a column that would swing no higher stands
_FLAT = math.pi / 2
_NEARER = 0.75  # of the time to upright at the present rate: the most a step takes
_A, _B, _C = (np.ascontiguousarray(one) for one in (DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]))
_E3, _E5 = np.ascontiguousarray(DOP853.E3), np.ascontiguousarray(DOP853.E5)
_LEAST, _MOST, _SAFE = 0.2, 6.0, 0.9  # change of a step's size, and the share of it that is dared


@njit(alone=("wobbling_equations.py",))
def _step(
    body: Array,
    y: Array,
    k: Array,
    h: float,
    start: Array,
    slope: Array,
    scale: Array,
    tolerance: float,
) -> tuple[Array, float]:
    """State (5,) after a step of h [s] from y, and its error over what is tolerated; the ground
    starts from `start` and changes by `slope`.
    """
    x = np.empty(5)
    for stage in range(13):
        last = stage == 12
        for i in range(5):
            total = 0.0
            for j in range(stage):
                total += (_B[j] if last else _A[stage, j]) * k[j, i]
            x[i] = y[i] + h * total
        c = h * (1.0 if last else _C[stage])
        k[stage, 0], k[stage, 1], k[stage, 2], k[stage, 3], k[stage, 4] = rates(
            body,
            x[0],
            x[1],
            x[2],
            x[3],
            start[0] + c * slope[0],
            start[1] + c * slope[1],
            start[2] + c * slope[2],
        )
    third, fifth = 0.0, 0.0
    for i in range(5):
        e3, e5 = 0.0, 0.0
        for j in range(13):
            e3 += _E3[j] * k[j, i]
            e5 += _E5[j] * k[j, i]
        allowed = tolerance * (scale[i] + (0.0 if i == 1 else max(abs(y[i]), abs(x[i]))))
        third += (e3 / allowed) ** 2
        fifth += (e5 / allowed) ** 2
    # the estimate of Hairer, Norsett and Wanner (1993), section II.10
    error = (
        0.0
        if third == 0.0 and fifth == 0.0
        else abs(h) * fifth / math.sqrt((fifth + 0.01 * third) * 5)
    )
    return x, error


@njit(alone=("wobbling_equations.py",))
def _excess(body: Array, acceleration: Array) -> float:
    """Moment that overturns the standing column over the one that holds it [N m]; > 0 where it
    lifts off.
    """
    rise, lever, tendon = moments(body, 0.0)
    return (
        lever * math.hypot(acceleration[0], acceleration[1])
        - (body[9] + acceleration[2]) * rise
        - tendon
    )


@njit(alone=("wobbling_equations.py",))
def _lift(body: Array, start: Array, slope: Array, left: float) -> float:
    """When the standing column lifts off within `left` [s], -1 if it does not."""
    if _excess(body, start) > 0:
        return 0.0
    # the excess is convex along a straight line: it cannot be positive between two ends where it is
    # not
    if not _excess(body, start + left * slope) > 0:
        return -1.0
    early, late = 0.0, left
    for _ in range(60):
        middle = 0.5 * (early + late)
        if _excess(body, start + middle * slope) > 0:
            late = middle
        else:
            early = middle
    return late


@njit(alone=("wobbling_equations.py",))
def _pass(body: Array, y: Array, restitution: float) -> float:
    """Let the column, tilted by CLOSEST or less and falling, pass upright; returns the energy lost
    [J].
    """
    along, across = inertia(body, y[0])
    twice = along * y[2] ** 2 + y[3] ** 2 / across
    # over the tilt: the sine of how far from the point the line passes
    closest = abs(y[3]) / math.sqrt(twice * across) if twice > 0 else 0.0
    if closest * y[0] < _PLANAR * CLOSEST:
        # what is left of the spin would turn the plane near upright, and the turn would grow from
        # swing to swing
        y[1], y[2], y[3] = y[1] + math.pi, -math.sqrt(twice / along), 0.0
    else:
        y[1] += math.copysign(
            2 * math.sqrt(along / across) * y[0] * math.acos(min(closest, 1.0)), y[3]
        )
    lost = 0.5 * along * y[2] ** 2 * (1 - restitution**2)
    y[2] = -restitution * y[2]
    return lost


@njit(alone=("wobbling_equations.py",))
def _energy(body: Array, y: Array) -> tuple[float, float, float]:
    """Kinetic, strain and gravity [J]."""
    along, across = inertia(body, y[0])
    gravity, strain = potential(body, y[0])
    return (
        0.5 * along * y[2] ** 2 + (0.5 * y[3] ** 2 / across if y[0] > 0 else 0.0),
        strain,
        gravity,
    )


@njit(alone=("wobbling_equations.py",))
def wobble(
    body: Array,
    ground: Array,
    dt: float,
    start: Array,
    critical: float,
    tolerance: float,
    restitution: float,
) -> tuple[Array, Array, bool]:
    """Motion of one column with its share of the slab.

    Parameters
    ----------
    body
        (10,), see `wobbling_equations`.
    ground
        (n, 3) acceleration of the ground [m/s2], straight between samples `dt` [s] apart.
    start
        (4,) tilt >= 0, azimuth, tilt_rate, spin; tilt 0 stands.
    critical
        tilt [rad] that scales errors and rest.
    tolerance
        of a step's error, relative to the state.
    restitution
        of the tilt's rate where the column passes upright within CLOSEST.

    Returns
    -------
    rows (m, 7) of WOBBLE_TIME ... WOBBLE_LOSS at the samples, the last one where it lies flat;
        (passages,) their times [s]; whether it lies flat.
    """
    n = len(ground)
    rows = np.zeros((n, 7))
    y = np.zeros(5)
    y[:4] = start
    standing = y[0] == 0.0
    loss = 0.0
    along, _ = inertia(body, 0.0)
    rise, lever, tendon = moments(body, 0.0)
    held = body[9] * rise + tendon
    rest = _REST * critical * held
    pace = math.sqrt(body[9] * lever / along)
    # what an error of nearly nothing is held against: of tilt, azimuth, its rate, spin and work
    scale = np.array(
        [
            1e-4 * CLOSEST,
            1.0,
            1e-3 * pace * critical,
            1e-6 * along * pace * critical**2,
            held * critical,
        ]
    )
    k = np.zeros((13, 5))
    passages = [0.0]
    passages.clear()  # a list of numbers, empty
    rows[0, WOBBLE_TILT:WOBBLE_WORK] = y[:4]
    h = 0.1 * dt
    for sample in range(n - 1):
        first, slope = ground[sample], (ground[sample + 1] - ground[sample]) / dt
        elapsed = 0.0
        while elapsed < dt * (1 - 1e-12):
            now, left = first + elapsed * slope, dt - elapsed
            if standing:
                wait = _lift(body, now, slope, left)
                if wait < 0:
                    break
                elapsed += wait
                now = first + elapsed * slope
                square = now[0] ** 2 + now[1] ** 2
                turn = (now[0] * slope[1] - now[1] * slope[0]) / square
                # it leans against the ground's acceleration and turns with it: any other spin would
                # be a quick vibration
                y[0], y[1], y[2], y[3] = (
                    LIFTED_TILT,
                    math.atan2(-now[1], -now[0]),
                    0.0,
                    inertia(body, LIFTED_TILT)[1] * turn,
                )
                loss += sum(_energy(body, y))
                standing, h = False, 1e-3 * dt
                continue
            if y[0] <= CLOSEST and y[2] <= 0:
                before = _energy(body, y)[0]
                loss -= _pass(body, y, restitution)
                passages.append(sample * dt + elapsed)
                if before < rest:
                    loss -= sum(_energy(body, y))
                    y[0], y[2], y[3], standing = 0.0, 0.0, 0.0, True
                    continue
            most = min(h, left)
            if y[2] < 0:
                most = min(most, _NEARER * y[0] / -y[2])
            x, error = _step(body, y, k, most, now, slope, scale, tolerance)
            factor = _MOST if error == 0 else min(_MOST, max(_LEAST, _SAFE * error ** (-1 / 8)))
            if not (error <= 1 and x[0] > 0.1 * min(y[0], CLOSEST)):
                h = most * (min(factor, 0.5) if error == error else _LEAST)
                continue
            h = max(h, most * factor) if most < h else most * factor
            elapsed += most
            y[:] = x
            if y[0] >= _FLAT:
                (
                    rows[sample + 1, WOBBLE_TIME],
                    rows[sample + 1, WOBBLE_TILT:WOBBLE_LOSS],
                    rows[sample + 1, WOBBLE_LOSS],
                ) = (
                    sample * dt + elapsed,
                    y,
                    loss,
                )
                return rows[: sample + 2], np.array(passages), True
        (
            rows[sample + 1, WOBBLE_TIME],
            rows[sample + 1, WOBBLE_TILT:WOBBLE_LOSS],
            rows[sample + 1, WOBBLE_LOSS],
        ) = (
            (sample + 1) * dt,
            y,
            loss,
        )
    return rows, np.array(passages), False


@njit(alone=("wobbling_equations.py",))
def energies(body: Array, rows: Array) -> Array:
    """Kinetic, strain and gravity of each row (n, 3) [J]."""
    found = np.zeros((len(rows), 3))
    for row in range(len(rows)):
        found[row, 0], found[row, 1], found[row, 2] = _energy(
            body, rows[row, WOBBLE_TILT:WOBBLE_LOSS]
        )
    return found


@njit(alone=("wobbling_equations.py",))
def foot_forces(body: Array, rows: Array, ground: Array) -> Array:
    """Force of the ground on the foot (n, 3) towards the azimuth, across it and up [N] at each row;
    `ground` (n, 3) at the rows; 0 where it stands.
    """
    found = np.zeros((len(rows), 3))
    for row in range(len(rows)):
        tilt, azimuth, rate, spin = (
            rows[row, WOBBLE_TILT],
            rows[row, WOBBLE_AZIMUTH],
            rows[row, WOBBLE_RATE],
            rows[row, WOBBLE_SPIN],
        )
        if tilt > 0:
            x, y = ground[row, 0], ground[row, 1]
            c, s = math.cos(azimuth), math.sin(azimuth)
            found[row, 0], found[row, 1], found[row, 2] = force(
                body, tilt, rate, spin, c * x + s * y, c * y - s * x, ground[row, 2]
            )
    return found
