"""Motion of a podium under a ground motion, by steps of `podium_step`: impacts, peaks and rows."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fecolumn.engines.rocking.podium_equations import (
    GroundPiece,
    PodiumNumbers,
    free_vibration,
    podium_energy,
    podium_push,
    podium_rates,
)
from fecolumn.engines.rocking.podium_step import PodiumRates, podium_step
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# what these functions are compiled with
_EQUATIONS = ("podium_equations.py", "podium_step.py")
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


class PodiumCase(NamedTuple):
    """A podium that is to be shaken.

    Attributes
    ----------
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
    """

    base: Array
    modes: Array
    storey: Array
    floors: Array
    restitution: float
    relative: bool
    step: float


@njit(alone=_EQUATIONS)
def _numbers(base: Array, modes: Array) -> PodiumNumbers:
    """What the equations take of a podium."""
    alpha = base[0]
    return PodiumNumbers(
        alpha,
        base[1],
        base[2],
        base[3],
        base[4],
        base[5],
        math.sin(alpha),
        math.cos(alpha),
        math.tan(alpha),
        modes[0] ** 2,
        2 * modes[1] * modes[0],
        modes[2].copy(),
    )


@njit(alone=_EQUATIONS)
def _slowest_after_impact(podium: PodiumNumbers) -> float:
    """Rate of the tilt [rad/s] up to which an impact ends in rest."""
    gamma, eta = podium.gamma, podium.eta
    pace = math.sqrt(
        (1 + 2 * gamma + 2 * gamma * eta)
        * podium.gravity
        / ((podium.inertia + 4 * gamma + 4 * gamma * eta * podium.sine**2) * podium.radius)
    )
    return _REST * pace * podium.alpha


@njit(alone=_EQUATIONS)
def _free_modes(modes: Array, h: float) -> Array:
    """(3, n) of `free_vibration` in a step h [s]; (3, 0) where a mode is damped critically or
    more.
    """
    if modes[1].max() >= 1.0:
        return np.zeros((3, 0))
    free = np.zeros((3, modes.shape[1]))
    for j in range(modes.shape[1]):
        free[0, j], free[1, j], free[2, j] = free_vibration(modes[0, j], modes[1, j], h)
    return free


@njit(alone=_EQUATIONS)
def _start(podium: PodiumNumbers, tilt: float, rate: float, x: Array) -> float:
    """State at the start, the building moving with the beam, into x; the side leaned to."""
    n, radius = len(podium.part), podium.radius
    side = math.copysign(1.0, tilt if tilt != 0 else rate) if tilt != 0 or rate != 0 else 0.0
    x[0], x[1] = tilt, rate
    beta = podium.alpha - side * tilt
    for j in range(n):
        part = podium.part[j]
        x[2 + j] = part * side * 2 * radius * (podium.sine - math.sin(beta))
        x[2 + n + j] = part * 2 * radius * math.cos(beta) * rate
    return side


@njit(alone=_EQUATIONS)
def _impact(
    x: Array, side: float, podium: PodiumNumbers, restitution: float, relative: bool
) -> tuple[float, float]:
    """Take an impact in the state x; the side leaned to from then on, and the energy gained per
    mass of the columns, a loss being negative [J/kg].
    """
    n, before = len(podium.part), sum(podium_energy(x, side, podium))
    after = restitution * x[1]
    if relative:
        for j in range(n):
            x[2 + n + j] += podium.part[j] * 2 * podium.radius * podium.cosine * (after - x[1])
    x[0], x[1], side = 0.0, after, -side
    if abs(after) <= _slowest_after_impact(podium):
        x[1], side = 0.0, 0.0
    return side, sum(podium_energy(x, side, podium)) - before


@njit(alone=_EQUATIONS)
def _raise_peaks(
    peaks: Array, last: Array, podium: PodiumNumbers, along: float, above: Array, total: Array
) -> None:
    """Raise the peak shears of storeys to those of a state with rates `last`; total (n,) is
    scratch.
    """
    n = len(podium.part)
    total[:] = 0.0
    for j in range(n):
        force = -last[2 + n + j] - podium.part[j] * along
        for i in range(n):
            total[i] += above[j, i] * force
    for i in range(n):
        peaks[i] = max(peaks[i], abs(total[i]))


@njit(alone=_EQUATIONS)
def _write_row(row: Array, x: Array, side: float, podium: PodiumNumbers, floors: Array) -> None:
    """The columns of a row that its state alone decides."""
    n = len(podium.part)
    row[PODIUM_TILT], row[PODIUM_RATE], row[PODIUM_SIDE] = x[0], x[1], side
    for j in range(n):
        for k in range(n):
            row[PODIUM_FLOORS + k] += floors[k, j] * x[2 + j]
    row[PODIUM_WORK], row[PODIUM_DAMPED] = x[2 + 2 * n], -x[3 + 2 * n]
    row[PODIUM_KINETIC], row[PODIUM_STRAIN], row[PODIUM_GRAVITATIONAL] = podium_energy(
        x, side, podium
    )


@njit(alone=_EQUATIONS)
def shake(
    ground: Array, dt: float, case: PodiumCase, tilt: float, rate: float
) -> tuple[Array, Array, Array, float, bool]:
    """Motion of a podium.

    Parameters
    ----------
    ground
        (n, 2) acceleration along x and up [m/s2], straight between samples `dt` [s] apart.
    tilt, rate
        at the start [rad, rad/s], the building moving with the beam.

    Returns
    -------
    rows (m, 11 + n), the last n the displacements of the floors [m]; impact times [s]; peak shear
        of each storey over M (n,) [m/s2]; peak tilt [rad]; whether it lies flat.
    """
    podium, n, samples = _numbers(case.base, case.modes), case.modes.shape[1], len(ground)
    size = 4 + 2 * n
    x, y, total, above = np.zeros(size), np.zeros(size), np.zeros(n), case.storey.T.copy()
    rates = PodiumRates(
        np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)
    )
    rows, peaks = np.zeros((samples, PODIUM_FLOORS + n)), np.zeros(n)
    impacts = [0.0]
    impacts.clear()  # a list of numbers, empty
    peak, loss = abs(tilt), 0.0
    pieces = max(1, math.ceil(dt / case.step - 1e-9))
    full = dt / pieces
    free = _free_modes(case.modes, full)
    side = _start(podium, tilt, rate, x)
    at_rest = GroundPiece(ground[0, 0], ground[0, 1], 0.0, 0.0)
    shear = podium_rates(x, side, podium, at_rest, 0.0, rates.first)
    for sample in range(samples):
        for piece in range(pieces if sample else 0):
            slope = (ground[sample, 0] - ground[sample - 1, 0]) / dt
            slope_up = (ground[sample, 1] - ground[sample - 1, 1]) / dt
            elapsed = 0.0
            while elapsed < full * (1 - 1e-12) and abs(x[0]) < _FLAT:
                begin = piece * full + elapsed
                now = GroundPiece(
                    ground[sample - 1, 0] + begin * slope,
                    ground[sample - 1, 1] + begin * slope_up,
                    slope,
                    slope_up,
                )
                if side == 0.0:
                    push, over = podium_push(podium, shear, now, 0.0)
                    if over > 0:
                        side = math.copysign(1.0, push)
                        podium_rates(x, side, podium, now, 0.0, rates.first)
                h, shear, lands = podium_step(
                    x, side, podium, free, now, (full - elapsed, full), rates, y
                )
                x[:] = y
                elapsed += h
                if lands:
                    side, gained = _impact(x, side, podium, case.restitution, case.relative)
                    loss += gained
                    impacts.append((sample - 1) * dt + piece * full + elapsed)
                    shear = podium_rates(x, side, podium, now, h, rates.last)
                # the ground's motion is continuous: the next step begins with these rates
                rates.first[:] = rates.last
                peak = max(peak, abs(x[0]))
                _raise_peaks(peaks, rates.last, podium, now.along + h * slope, above, total)
        row = rows[sample]
        row[PODIUM_TIME], row[PODIUM_SHEAR], row[PODIUM_LOSS] = sample * dt, shear, loss
        _write_row(row, x, side, podium, case.floors)
        if abs(x[0]) >= _FLAT:
            return rows[: sample + 1], np.array(impacts), peaks, peak, True
    return rows, np.array(impacts), peaks, peak, False
