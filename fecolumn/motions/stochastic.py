"""Stochastic ground motion with an evolutionary spectrum: a gamma-modulated, filtered Gaussian
process made of harmonics.

Model of Rezaeian and Der Kiureghian (2008, 2010) in its spectral form (after Broccardo and Dabaghi
2017). One component is

    a(t) = q(t)/s(t) sum_k sqrt(2 S(w_k, t) dw) (u_k cos w_k t + v_k sin w_k t),
    u_k, v_k ~ N(0, 1),   s^2 = sum_k 2 S dw,
    S(w, t) = |H_f(w; t)|^2 G(w),   H_f = w_f^2 / (w_f^2 - w^2 + 2 i z w_f w),
    w_f(t) = w_mid + w' (t - t_mid),
    q(t)^2 = Ia 2 g/pi p(t),   p the density of a gamma law in time.

The product goes through a high-pass without phase shift, Butterworth's of fourth order (Dabaghi and
Der Kiureghian 2018): the modulation spreads long periods to still longer ones, which would rule the
displacement.

G is ours: a correction of the spectral shape, given at some frequencies and the same for all
motions of an ensemble. One filter mode cannot hold more than one peak; G holds what else a record
and its site have, in the ensemble and not motion by motion, while filter and modulation keep their
parameters, their drift in time and their variability. sqrt(S)/s is computed at knots in time and
joined by straight lines, so that a component costs one Fourier transform a knot.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.stats import gamma

from fecolumn.case.sections import GRAVITY

_KNOT_S = 1.0
_LOWEST_FILTER_HZ = 0.3  # a falling filter frequency stops here (Dabaghi and Der Kiureghian 2018)
_END = 0.9999  # share of the Arias intensity after which a motion ends
_TAPER_S = 1.0


@dataclass(frozen=True, slots=True)
class Component:
    """Parameters of one component.

    Attributes
    ----------
    arias_m_s
        expected Arias intensity [m/s].
    duration_s
        time between 5 % and 95 % of the expected Arias intensity [s].
    frequency_hz
        filter frequency when 45 % of the expected Arias intensity have passed [Hz].
    frequency_slope_hz_s
        its change with time [Hz/s].
    damping
        filter damping ratio.
    """

    arias_m_s: float
    duration_s: float
    frequency_hz: float
    frequency_slope_hz_s: float
    damping: float


@dataclass(frozen=True, slots=True, eq=False)
class EnsembleShape:
    """What all motions of an ensemble share.

    Attributes
    ----------
    modulation_shape
        shape of the gamma law, 2 a2 - 1 in Rezaeian's and Der Kiureghian's letters.
    corner_hz
        corner frequency of the high-pass [Hz].
    frequencies_hz
        (n,) rising, where the correction is given [Hz].
    ln_gains
        (n,) ln sqrt(G) there; straight lines in ln f between, level outside.
    dt
        sampling step [s].
    """

    modulation_shape: float
    corner_hz: float
    frequencies_hz: NDArray[Any]
    ln_gains: NDArray[Any]
    dt: float


def modulation_scale(shape: float, duration_s: float) -> float:
    """Scale [s] of the gamma law with `duration_s` between its 5 % and 95 % quantiles; 1/(2 a3)."""
    early, late = gamma.ppf([0.05, 0.95], shape)
    result: float = duration_s / (late - early)
    return result


def bidirectional(
    components: Sequence[Component], shape: EnsembleShape, rng: np.random.Generator
) -> NDArray[Any]:
    """Accelerations (n_steps, n_components) [m/s2]; velocity and displacement by the trapezoidal
    rule start and end at zero.

    Components are independent given their parameters: x and y are principal axes (Penzien and
    Watabe 1975).
    """
    scales = [modulation_scale(shape.modulation_shape, one.duration_s) for one in components]
    # the strong shaking of all components starts together, though it may last longer along one than
    # along the other
    early, end = gamma.ppf([0.05, _END], shape.modulation_shape)
    starts = [early * (max(scales) - scale) for scale in scales]
    n_steps = (
        math.ceil(max(start + end * scale for start, scale in zip(starts, scales)) / shape.dt) + 1
    )
    n_harmonics = 1 << math.ceil(math.log2(1.3 * n_steps))
    # drawn before anything else and component by component, so that parameters do not shift the
    # random numbers
    phases = [rng.standard_normal((2, n_harmonics // 2)) for _ in components]
    return np.column_stack(
        [
            _component(one, start, scale, shape, n_steps, n_harmonics, phase)
            for one, start, scale, phase in zip(components, starts, scales, phases)
        ]
    )


def amplitude(
    frequencies: ArrayLike, component: Component, shape: EnsembleShape, filter_hz: float
) -> NDArray[Any]:
    """sqrt(S) at frequencies [Hz] for a filter frequency [Hz], up to a constant factor."""
    ratio = np.asarray(frequencies) / filter_hz
    peak = 1 / np.sqrt((1 - ratio**2) ** 2 + (2 * component.damping * ratio) ** 2)
    correction = np.interp(np.log(frequencies), np.log(shape.frequencies_hz), shape.ln_gains)
    result: NDArray[Any] = peak * np.exp(correction)
    return result


def _component(
    component: Component,
    start: float,
    scale: float,
    shape: EnsembleShape,
    n_steps: int,
    n_harmonics: int,
    phase: NDArray[Any],
) -> NDArray[Any]:
    time = np.arange(n_steps) * shape.dt
    modulation = np.sqrt(
        2
        * GRAVITY
        / math.pi
        * component.arias_m_s
        * gamma.pdf(time, shape.modulation_shape, start, scale)
    )
    taper = np.clip((time[-1] - time) / _TAPER_S, 0, 1)
    modulation *= 0.5 * (1 - np.cos(math.pi * taper))
    mid = gamma.ppf(0.45, shape.modulation_shape, start, scale)
    frequencies = np.arange(1, n_harmonics // 2 + 1) / (n_harmonics * shape.dt)
    wave = phase[0] - 1j * phase[1]
    process = np.zeros(n_steps)
    for knot in np.arange(0, time[-1] + _KNOT_S, _KNOT_S):
        filter_hz = max(
            component.frequency_hz + component.frequency_slope_hz_s * (knot - mid),
            _LOWEST_FILTER_HZ,
        )
        amplitudes = amplitude(frequencies, component, shape, filter_hz)
        amplitudes /= math.sqrt((amplitudes**2).sum())
        first, last = np.searchsorted(time, [knot - _KNOT_S, knot + _KNOT_S])
        hat = 1 - np.abs(time[first:last] - knot) / _KNOT_S
        spectrum = np.concatenate([[0], wave * amplitudes])
        spectrum[-1] = 0
        process[first:last] += (
            hat * np.fft.irfft(spectrum, n_harmonics)[first:last] * n_harmonics / 2
        )
    passed = np.concatenate([[0], high_pass(frequencies, shape.corner_hz)])
    moved = np.fft.irfft(np.fft.rfft(process * modulation, n_harmonics) * passed, n_harmonics)[
        :n_steps
    ]
    return brought_to_rest(moved, shape.dt)


def high_pass(frequencies: ArrayLike, corner_hz: float) -> NDArray[Any]:
    """Amplitude of Butterworth's high-pass of fourth order at frequencies [Hz]."""
    result: NDArray[Any] = 1 / np.sqrt(1 + (corner_hz / np.asarray(frequencies)) ** 8)
    return result


def brought_to_rest(acceleration: NDArray[Any], dt: float) -> NDArray[Any]:
    """Acceleration (n_steps,) corrected so that its velocity and displacement (trapezoidal rule)
    end at zero.

    The least smooth change does it: two slow functions under a window that rises from zero and ends
    at zero.
    """
    n_steps = len(acceleration)
    place = np.linspace(-1, 1, n_steps)
    window = (1 - place**2) ** 2
    slow = np.column_stack([window, window * place])
    ends = _ends(slow, dt)
    result: NDArray[Any] = (
        acceleration - slow @ np.linalg.solve(ends, _ends(acceleration[:, None], dt))[:, 0]
    )
    return result


def _ends(acceleration: NDArray[Any], dt: float) -> NDArray[Any]:
    """Final velocity and displacement (2, n) of accelerations (n_steps, n)."""
    velocity = cumulative_trapezoid(acceleration, dx=dt, axis=0, initial=0)
    displacement = cumulative_trapezoid(velocity, dx=dt, axis=0)
    return np.array([velocity[-1], displacement[-1]])
