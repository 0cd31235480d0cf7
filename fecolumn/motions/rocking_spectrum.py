"""Rocking spectra: how far free-standing rigid blocks of every size tilt in a motion (Makris and Konstantinidis 2003).

A block of slenderness alpha (tilt at which its centre of mass stands over the edge), frequency parameter p and tilt theta about
its edges, positive towards +x, obeys (Housner 1963)

    theta'' = -p^2 { sin(alpha sgn theta - theta) + a_g/g cos(alpha sgn theta - theta) },     p^2 = m g R / I_O,

a rectangular block p^2 = 3 g/(4 R), R half its diagonal. It stands until |a_g| > g tan alpha and never slides. As theta passes
zero the angular velocity falls to r times its value: 1 - 3/2 sin^2 alpha for a rectangular block whose impact is plastic.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numba
import numpy as np

from fecolumn.case import GRAVITY
from fecolumn.motions.processing import rotate
from fecolumn.motions.record import GroundMotion

# of 1/p: the fourth-order error of a step is then some 1e-8
_STEP = 0.05
# tilt velocity after an impact below this many p alpha: the next swing would reach less than 1e-8 alpha
_REST = 1e-4
_FLAT = math.pi / 2
_BISECTIONS = 60


@dataclass(frozen=True, slots=True, eq=False)
class Rocking:
    """Motion of one block.

    Attributes:
        time: (n_states,) [s].
        tilt: (n_states,) [rad], within +-pi/2.
        tilt_velocity: (n_states,) [rad/s].
        impact_times: (n_impacts,) [s].
        overturned: whether the block fell flat.
    """

    time: np.ndarray
    tilt: np.ndarray
    tilt_velocity: np.ndarray
    impact_times: np.ndarray
    overturned: bool


def housner_restitution(slenderness: float) -> float:
    """Angular velocity after over before a plastic impact of a rectangular block (Housner 1963); 0 for alpha above 54.7 degrees."""
    return max(1.0 - 1.5 * math.sin(slenderness)**2, 0.0)


def rocking_spectrum(motion: GroundMotion, periods, slenderness, restitution: float | None = None, angle_deg: float = 0.0) -> np.ndarray:
    """Peak tilt over slenderness of planar rigid blocks.

    After the motion's end the free rocking that is left is followed by its energy. A block may pass |theta| = alpha and come
    back: that is its peak then, above 1.

    Args:
        motion: its horizontal component along `angle_deg` (from x towards y) counts.
        periods: (n_periods,) 2 pi/p [s], greater than 0.
        slenderness: alpha, one or (n_slendernesses,) [rad], in (0, pi/2).
        restitution: of the angular velocity at an impact, in [0, 1]; None for that of a rectangular block.

    Returns:
        (n_periods,) or (n_slendernesses, n_periods) max |theta| / alpha; 0 where the block stands still, inf where it overturns.

    Raises:
        ValueError: a value outside its range.
    """
    acceleration = np.ascontiguousarray(rotate(motion, -angle_deg).acceleration[:, 0])
    periods = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    result = np.empty((np.size(slenderness), len(periods)))
    for row, alpha in enumerate(np.atleast_1d(slenderness)):
        for column, period in enumerate(periods):
            p, alpha, r = _block(period, alpha, restitution)
            peak, tilt, velocity, side, *_ = _rock(acceleration, motion.dt, p, alpha, r, 0.0, 0.0, False)
            result[row, column] = max(peak, _free_peak(tilt, velocity, side, p, alpha, r)) / alpha
    return result if np.ndim(slenderness) else result[0]


def rock(motion: GroundMotion, period: float, slenderness: float, restitution: float | None = None, *,
         tilt: float = 0.0, tilt_velocity: float = 0.0) -> Rocking:
    """Planar rocking along x, from a tilt [rad] and tilt velocity [rad/s] on; other arguments as in rocking_spectrum."""
    p, alpha, r = _block(period, slenderness, restitution)
    acceleration = np.ascontiguousarray(motion.acceleration[:, 0])
    peak, *_, states, impacts = _rock(acceleration, motion.dt, p, alpha, r, float(tilt), float(tilt_velocity), True)
    return Rocking(states[:, 0], states[:, 1], states[:, 2], impacts, math.isinf(peak))


def _block(period, slenderness, restitution):
    if not 0 < period < math.inf:
        raise ValueError(f"period 2 pi/p = {period:g} s must be finite and greater than 0")
    if not 0 < slenderness < math.pi / 2:
        raise ValueError(f"slenderness = {slenderness:g} rad must lie between 0 and pi/2")
    if restitution is None:
        restitution = housner_restitution(slenderness)
    if not 0 <= restitution <= 1:
        raise ValueError(f"restitution = {restitution:g} must lie in [0, 1]")
    return 2 * math.pi / float(period), float(slenderness), float(restitution)


@numba.njit(cache=True)
def _tilt_acceleration(tilt, side, ground, p, alpha):
    lever = alpha * side - tilt
    return -p * p * (math.sin(lever) + ground / GRAVITY * math.cos(lever))


@numba.njit(cache=True)
def _advance(tilt, velocity, side, ground, slope, step, p, alpha):
    """Tilt and tilt velocity after a classical Runge-Kutta step about one edge; the ground acceleration changes by `slope`."""
    k1 = _tilt_acceleration(tilt, side, ground, p, alpha)
    v2 = velocity + 0.5 * step * k1
    k2 = _tilt_acceleration(tilt + 0.5 * step * velocity, side, ground + 0.5 * step * slope, p, alpha)
    v3 = velocity + 0.5 * step * k2
    k3 = _tilt_acceleration(tilt + 0.5 * step * v2, side, ground + 0.5 * step * slope, p, alpha)
    v4 = velocity + step * k3
    k4 = _tilt_acceleration(tilt + step * v3, side, ground + step * slope, p, alpha)
    return tilt + step * (velocity + 2 * v2 + 2 * v3 + v4) / 6, velocity + step * (k1 + 2 * k2 + 2 * k3 + k4) / 6


@numba.njit(cache=True)
def _rock(acceleration, dt, p, alpha, restitution, tilt, velocity, record):
    """Peak tilt (inf if overturned), last tilt, velocity and edge, states (n, 3) and impact times if to be recorded.

    The edge the block stands on is its `side`, the sign of the tilt; 0 while it stands on both.
    """
    threshold = GRAVITY * math.tan(alpha)
    pieces = max(1, math.ceil(p * dt / _STEP))
    full = dt / pieces
    side = 0.0
    if tilt != 0 or velocity != 0:
        side = math.copysign(1.0, tilt if tilt != 0 else velocity)
    peak = abs(tilt)
    states = [(0.0, tilt, velocity)]
    impacts = [0.0 for _ in range(0)]
    for sample in range(len(acceleration) - 1):
        slope = (acceleration[sample + 1] - acceleration[sample]) / dt
        for piece in range(pieces):
            start = piece * full
            elapsed = 0.0
            while elapsed < full * (1 - 1e-12):
                ground = acceleration[sample] + slope * (start + elapsed)
                left = full - elapsed
                if side == 0.0:
                    wait = _time_to_uplift(ground, slope, left, threshold)
                    if wait < 0:
                        break
                    elapsed += wait
                    side = -math.copysign(1.0, ground + slope * wait)
                    continue
                next_tilt, next_velocity = _advance(tilt, velocity, side, ground, slope, left, p, alpha)
                if side * next_tilt >= 0:
                    tilt, velocity, elapsed = next_tilt, next_velocity, full
                else:
                    early, late = 0.0, left
                    for _ in range(_BISECTIONS):
                        middle = 0.5 * (early + late)
                        if side * _advance(tilt, velocity, side, ground, slope, middle, p, alpha)[0] > 0:
                            early = middle
                        else:
                            late = middle
                    _, velocity = _advance(tilt, velocity, side, ground, slope, late, p, alpha)
                    elapsed += late
                    tilt, velocity, side = 0.0, restitution * velocity, -side
                    impacts.append(sample * dt + start + elapsed)
                    if abs(velocity) <= _REST * p * alpha:
                        velocity, side = 0.0, 0.0
                        # at the very threshold rounding decides between uplift and rest: time must go on
                        elapsed += 1e-3 * full
                peak = max(peak, abs(tilt))
                if abs(tilt) > _FLAT:
                    states.append((sample * dt + start + elapsed, math.copysign(_FLAT, tilt), velocity))
                    return math.inf, tilt, velocity, side, np.array(states), np.array(impacts)
            if record:
                states.append((sample * dt + start + full, tilt, velocity))
    return peak, tilt, velocity, side, np.array(states), np.array(impacts)


@numba.njit(cache=True)
def _time_to_uplift(ground, slope, left, threshold):
    """When the ground acceleration passes the threshold, from now on [s]; -1 if not while the straight line lasts."""
    if abs(ground) > threshold or (abs(ground) == threshold and ground * slope > 0):
        return 0.0
    if slope == 0.0:
        return -1.0
    wait = (math.copysign(threshold, slope) - ground) / slope
    return wait if wait < left else -1.0


@numba.njit(cache=True)
def _free_peak(tilt, velocity, side, p, alpha, restitution):
    """Largest tilt of free rocking (inf if the block overturns), by its energy: theta'^2/2 + p^2 cos(alpha - |theta|)."""
    if side == 0.0:
        return 0.0
    tilt, velocity = side * tilt, side * velocity
    energy = 0.5 * velocity**2 + p**2 * math.cos(alpha - tilt)
    peak = tilt
    if velocity > 0 or tilt > alpha:
        # beyond alpha a block without the energy to come back falls, whichever way it moves
        if energy >= p**2 and velocity > 0 or energy < p**2 and tilt > alpha:
            return math.inf
        if velocity > 0:
            peak = alpha - math.acos(min(energy / p**2, 1.0))
    lowest = p**2 * math.cos(alpha)
    after = lowest + restitution**2 * max(energy - lowest, 0.0)
    if after >= p**2:
        return math.inf
    return max(peak, alpha - math.acos(after / p**2))
