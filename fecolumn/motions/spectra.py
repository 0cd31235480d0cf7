"""Response spectra of bidirectional motions: of each component, and over all directions (RotD)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.motions.record import GroundMotion

N_ANGLES = 180  # one a degree; beyond 180 degrees the peaks repeat
_SAMPLES_PER_PERIOD = 24  # the peak between samples is then missed by 0.9 % at most
_SIGHTS = 8


def rotd_spectrum(
    motion: GroundMotion,
    periods: ArrayLike,
    damping: float = 0.05,
    percentiles: Sequence[float] = (50.0, 100.0),
) -> NDArray[Any]:
    """Pseudo-acceleration of the horizontal motion, as a percentile over all directions (Boore
    2010).

    The linear oscillator is solved exactly for an acceleration that is piecewise linear between the
    samples (Nigam and Jennings 1969) and followed by rest for half a period. Peaks are sought at no
    fewer than 24 points a period.

    Parameters
    ----------
    motion
        its vertical component does not count.
    periods
        (n_periods,) natural periods [s], greater than 0.
    damping
        fraction of critical damping, in [0, 1).
    percentiles
        (n_percentiles,) over directions; 50 is RotD50, 100 is RotD100.

    Returns
    -------
    (n_percentiles, n_periods) [m/s2].
    """
    result: NDArray[Any] = np.percentile(
        _peaks_over_directions(motion, periods, damping), percentiles, axis=0
    )
    return result


def horizontal_spectrum(
    motion: GroundMotion, periods: ArrayLike, damping: float = 0.05
) -> NDArray[Any]:
    """Pseudo-acceleration (n_periods,) [m/s2]: RotD50, or the spectrum of the only component of a
    motion along x or y alone.

    RotD50 of one component would be cos 45 degrees of it. Arguments as in rotd_spectrum.
    """
    if len(motion.horizontal_axes) == 1:
        spectra, row = component_spectra(motion, periods, damping), motion.horizontal_axes[0]
    else:
        spectra, row = rotd_spectrum(motion, periods, damping, (50.0,)), 0
    result: NDArray[Any] = spectra[row]
    return result


def component_spectra(
    motion: GroundMotion, periods: ArrayLike, damping: float = 0.05
) -> NDArray[Any]:
    """Pseudo-acceleration along x, y and z, (3, n_periods) [m/s2]; oscillator and arguments as in
    rotd_spectrum.
    """
    horizontal = _peaks_over_directions(motion, periods, damping)
    upright = np.zeros((len(motion.acceleration), 2))
    upright[:, 0] = motion.acceleration[:, 2]
    return np.array(
        [
            horizontal[0],
            horizontal[N_ANGLES // 2],
            _peaks(upright, motion.dt, *_oscillators(periods, damping))[0],
        ]
    )


def rotated_peaks(history: NDArray[Any]) -> NDArray[Any]:
    """Peak absolute value of a horizontal history (n_steps, 2) along each of 180 directions, a
    degree apart, from x towards y.
    """
    history = np.ascontiguousarray(history, dtype=np.float64)
    peaks = np.zeros(N_ANGLES)
    _directional_peaks(history[:, 0].copy(), history[:, 1].copy(), len(history), peaks)
    return peaks


def _oscillators(periods: ArrayLike, damping: float) -> tuple[NDArray[Any], float]:
    periods = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    if not (periods > 0).all():
        raise ValueError(f"natural periods must be greater than 0 s, not {periods.min():g} s")
    if not 0 <= damping < 1:
        raise ValueError(f"damping = {damping:g} must lie in [0, 1)")
    return periods, float(damping)


def _peaks_over_directions(
    motion: GroundMotion, periods: ArrayLike, damping: float
) -> NDArray[Any]:
    result: NDArray[Any] = _peaks(
        np.ascontiguousarray(motion.acceleration[:, :2]), motion.dt, *_oscillators(periods, damping)
    )
    return result


@numba.njit(cache=True)
def _peaks(
    acceleration: NDArray[Any], dt: float, periods: NDArray[Any], damping: float
) -> NDArray[Any]:
    """Peak pseudo-acceleration (180, n_periods) of the horizontal acceleration (n_steps, 2)."""
    result = np.empty((N_ANGLES, len(periods)))
    directions = np.empty(N_ANGLES)
    for number, period in enumerate(periods):
        pieces = max(1, math.ceil(_SAMPLES_PER_PERIOD * dt / period - 1e-9))
        step = dt / pieces
        tail = math.ceil(0.5 * period / dt) + 1
        n_states = (len(acceleration) - 1 + tail) * pieces + 1
        ux, uy = np.zeros(n_states), np.zeros(n_states)
        _oscillate(acceleration, pieces, step, 2 * math.pi / period, damping, ux, uy)
        _directional_peaks(ux, uy, n_states, directions)
        result[:, number] = directions * (2 * math.pi / period) ** 2
    return result


@numba.njit(cache=True)
def _oscillate(
    acceleration: NDArray[Any],
    pieces: int,
    step: float,
    omega: float,
    damping: float,
    ux: NDArray[Any],
    uy: NDArray[Any],
) -> None:
    """Relative displacements of two equal oscillators from rest, after Nigam and Jennings (1969),
    equation 2.7.
    """
    root = math.sqrt(1 - damping**2)
    damped = omega * root
    decay = math.exp(-damping * omega * step)
    sine, cosine = math.sin(damped * step), math.cos(damped * step)
    a11 = decay * (damping / root * sine + cosine)
    a12 = decay / damped * sine
    a21 = -omega / root * decay * sine
    a22 = decay * (cosine - damping / root * sine)
    first = (2 * damping**2 - 1) / (omega**2 * step)
    second = 2 * damping / (omega**3 * step)
    rise, fall = sine / damped, damping / root * sine
    b11 = decay * ((first + damping / omega) * rise + (second + 1 / omega**2) * cosine) - second
    b12 = -decay * (first * rise + second * cosine) - 1 / omega**2 + second
    b21 = decay * (
        (first + damping / omega) * (cosine - fall)
        - (second + 1 / omega**2) * (damped * sine + damping * omega * cosine)
    ) + 1 / (omega**2 * step)
    b22 = -decay * (
        first * (cosine - fall) - second * (damped * sine + damping * omega * cosine)
    ) - 1 / (omega**2 * step)
    x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
    ax, ay = acceleration[0, 0], acceleration[0, 1]
    state, samples = 0, len(acceleration)
    for sample in range((len(ux) - 1) // pieces):
        rest = sample + 1 >= samples
        slope_x = ((0.0 if rest else acceleration[sample + 1, 0]) - ax) / pieces
        slope_y = ((0.0 if rest else acceleration[sample + 1, 1]) - ay) / pieces
        for _ in range(pieces):
            bx, by = ax + slope_x, ay + slope_y
            x, vx = (
                a11 * x + a12 * vx + b11 * ax + b12 * bx,
                a21 * x + a22 * vx + b21 * ax + b22 * bx,
            )
            y, vy = (
                a11 * y + a12 * vy + b11 * ay + b12 * by,
                a21 * y + a22 * vy + b21 * ay + b22 * by,
            )
            ax, ay = bx, by
            state += 1
            ux[state], uy[state] = x, y
        if rest:
            ax, ay = 0.0, 0.0


@numba.njit(cache=True)
def _directional_peaks(
    x: NDArray[Any], y: NDArray[Any], n_states: int, peaks: NDArray[Any]
) -> None:
    """Peaks (180,) of |x cos + y sin|.

    Peaks along eight sights bound the peaks along all directions from below; states nearer to rest
    than the least of these bounds cannot be a peak in any direction, and few states remain.
    """
    cosines, sines = np.empty(N_ANGLES), np.empty(N_ANGLES)
    for angle in range(N_ANGLES):
        cosines[angle], sines[angle] = (
            math.cos(math.pi * angle / N_ANGLES),
            math.sin(math.pi * angle / N_ANGLES),
        )
    peaks[:] = 0.0
    for sight in range(_SIGHTS):
        cos, sin = math.cos(math.pi * sight / _SIGHTS), math.sin(math.pi * sight / _SIGHTS)
        farthest, where = 0.0, 0
        for state in range(n_states):
            reach = abs(cos * x[state] + sin * y[state])
            if reach > farthest:
                farthest, where = reach, state
        for angle in range(N_ANGLES):
            peaks[angle] = max(
                peaks[angle], abs(cosines[angle] * x[where] + sines[angle] * y[where])
            )
    bound = peaks.min() ** 2
    for state in range(n_states):
        if x[state] ** 2 + y[state] ** 2 >= bound:
            for angle in range(N_ANGLES):
                peaks[angle] = max(
                    peaks[angle], abs(cosines[angle] * x[state] + sines[angle] * y[state])
                )
