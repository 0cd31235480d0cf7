"""Fit of the stochastic model: the medians of a large ensemble are brought to the figures of the
seed motion.

Unknown is the spectral shape, as gains at eighty frequencies, with the Arias intensity as its
level; and scale and shape of the modulation. By random vibration a figure's change with the gain at
a frequency is the share of the response variance that comes from there, so that a few regularised
Gauss-Newton steps do it, over the same random numbers each time.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import gamma

from fecolumn.motions.intensity import total_arias_intensity
from fecolumn.motions.processing import arias_intensity
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.seeded import (
    VARIABILITIES,
    Components,
    Fitted,
    SeededModel,
    ensemble_shape,
    medians,
    seeded_acceleration,
)
from fecolumn.motions.stochastic import amplitude, high_pass
from fecolumn.motions.target import SPECTRUM_RANGE_S, Target, figures, measured

_N_FREQUENCIES, _RANGE_HZ = 80, (0.04, 40.0)
_SEED = 8101989  # of the ensembles fitted on, none that anybody would draw
_SMOOTHNESS, _RESTRAINT, _LARGEST_STEP, _RELAXATION = 0.02, 0.015, 1.0, 0.6
_FALL_HZ = (
    1.0  # below it the first guess falls with the square of frequency, as earthquake sources do
)
_SHAPES = (1.5, 200.0)
_DAMPING, _CORNER_HZ = 0.135, 0.1


def fit(
    target: Target,
    components: Components,
    n: int = 400,
    iterations: int = 12,
    report: Callable[[str], None] | None = None,
) -> SeededModel:
    """Model whose ensembles have the target's figures in the median, with fixed and with drawn
    parameters.

    Parameters
    ----------
    target
        figures at full scale.
    components
        parameters that are not fitted.
    n
        size of the ensemble fitted on; its sampling error stays in the fit.
    iterations
        steps; the best is kept.
    report
        called with a line of text a step.
    """
    frequencies = np.geomspace(*_RANGE_HZ, _N_FREQUENCIES)
    source_like = tuple((-np.log1p((_FALL_HZ / frequencies) ** 2)).tolist())
    start = Fitted(1.0, target.ds5_95_s, _shape_of(target.ds5_75_s / target.ds5_95_s), source_like)
    model = SeededModel(target, components, start, start, tuple(frequencies.tolist()))
    for variability in VARIABILITIES:
        if variability == "drawn":
            model = dataclasses.replace(model, drawn=model.fixed)
        best = math.inf
        for iteration in range(iterations):
            found = np.median([_figures(model, variability, number) for number in range(n)], axis=0)
            error = figures(target) / found
            misfit = (
                float((_weights(target) * np.log(error) ** 2).sum() / _weights(target).sum()) ** 0.5
            )
            if report:
                report(
                    f"{variability}, step {iteration + 1}: weighted rms of ln error {misfit:.4f}; "
                    "PGA, PGV, PGD, Ds5-75, Ds5-95 over target "
                    + " ".join(f"{1 / value:.3f}" for value in error[-5:])
                )
            current = getattr(model, variability)
            if misfit < best:
                best, kept = misfit, current
            improved = _improved(model, variability, error)
            # another modulation makes other motions of the same random numbers: once it is
            # kept, the spectrum settles
            if iteration >= iterations // 2:
                improved = dataclasses.replace(
                    improved,
                    duration_s=current.duration_s,
                    modulation_shape=current.modulation_shape,
                )
            model = _with(model, variability, improved)
        model = _with(model, variability, kept)
    return model


def _with(model: SeededModel, variability: str, fitted: Fitted) -> SeededModel:
    """The model with other parameters of one variability."""
    if variability == "fixed":
        return dataclasses.replace(model, fixed=fitted)
    return dataclasses.replace(model, drawn=fitted)


def components_of_record(motion: GroundMotion) -> tuple[GroundMotion, Components]:
    """A record along its principal axes, the major one along x, and its filter parameters.

    Frequency and its slope come from the rate of upward zero crossings between 5 % and 95 % of the
    Arias intensity (Rezaeian and Der Kiureghian 2008); damping and corner frequency are typical
    values, since the correction takes up what is left.
    """
    horizontal = motion.acceleration[:, :2]
    axes = np.linalg.eigh(horizontal.T @ horizontal)[1][:, ::-1]
    turned = GroundMotion(
        np.column_stack([horizontal @ axes, motion.acceleration[:, 2]]),
        motion.dt,
        motion.name,
        motion.source,
    )
    intensity = arias_intensity(turned)[:, :2]
    mean = total_arias_intensity(turned) / 2
    frequency, slope = zip(
        *(
            _crossing_rate(turned.acceleration[:, axis], intensity[:, axis], motion.dt)
            for axis in range(2)
        )
    )
    return turned, Components(
        "principal axes and zero crossings of the record",
        tuple((intensity[-1] / mean).tolist()),
        frequency,
        slope,
        (_DAMPING, _DAMPING),
        _CORNER_HZ,
        min(motion.dt, 0.01),
    )


def _crossing_rate(
    acceleration: NDArray[Any], intensity: NDArray[Any], dt: float
) -> tuple[float, float]:
    """Rate of upward zero crossings [Hz] at 45 % of the Arias intensity, and its slope [Hz/s]."""
    first, mid, last = np.searchsorted(intensity, np.array([0.05, 0.45, 0.95]) * intensity[-1])
    crossings = np.cumsum((acceleration[:-1] <= 0) & (acceleration[1:] > 0))
    time = (np.arange(first, last) - mid) * dt
    curvature, rate, _ = np.polyfit(time, crossings[first:last], 2)
    return float(rate), float(np.clip(2 * curvature, -3, 1))


def _shape_of(ratio: float) -> float:
    """Shape of the gamma law whose 5-75 % duration is `ratio` of its 5-95 % duration."""

    def excess(shape: float) -> float:
        early, middle, late = gamma.ppf([0.05, 0.75, 0.95], shape)
        result: float = (middle - early) / (late - early) - ratio
        return result

    low, high = (excess(shape) for shape in _SHAPES)
    return float(brentq(excess, *_SHAPES)) if low < 0 < high else _SHAPES[0 if low >= 0 else 1]


def _figures(model: SeededModel, variability: str, number: int) -> NDArray[Any]:
    motion = GroundMotion(
        seeded_acceleration(model, variability, _SEED, number), model.components.dt_s, "", ""
    )
    return measured(motion, model.target.periods_s)


def _weights(target: Target) -> NDArray[Any]:
    periods = np.array(target.periods_s)
    required = (periods >= SPECTRUM_RANGE_S[0]) & (periods <= SPECTRUM_RANGE_S[1])
    return np.concatenate([np.where(required, 1.0, 0.2), [4.0, 4.0, 4.0, 1.0, 1.0]])


def _improved(model: SeededModel, variability: str, error: NDArray[Any]) -> Fitted:
    """Next parameters.  error: (n_periods + 5,) target over median."""
    current = getattr(model, variability)
    weights, wanted = np.sqrt(_weights(model.target))[:-2], np.log(error[:-2])
    gains = np.array(current.ln_gains)
    shares, power = _shares(model, variability)
    bend = np.diff(np.eye(len(gains)), 2, axis=0)
    matrix = np.vstack(
        [weights[:, None] * shares, _SMOOTHNESS * bend, _RESTRAINT * np.eye(len(gains))]
    )
    right = np.concatenate([weights * wanted, -_SMOOTHNESS * bend @ gains, np.zeros(len(gains))])
    gains = gains + _RELAXATION * np.clip(
        np.linalg.lstsq(matrix, right, rcond=None)[0], -_LARGEST_STEP, _LARGEST_STEP
    )
    changed = dataclasses.replace(
        model, **{variability: dataclasses.replace(current, ln_gains=tuple(gains.tolist()))}
    )
    arias = current.arias_m_s * _shares(changed, variability)[1] / power
    gains -= gains.mean()  # the level is the Arias intensity
    early, middle, late = gamma.ppf([0.05, 0.75, 0.95], current.modulation_shape)
    shape = _shape_of((middle - early) / (late - early) * (error[-2] / error[-1]) ** _RELAXATION)
    return Fitted(
        arias, current.duration_s * error[-1] ** _RELAXATION, shape, tuple(gains.tolist())
    )


def _shares(model: SeededModel, variability: str) -> tuple[NDArray[Any], float]:
    """Share (n_figures, n_frequencies) of the variance of each figure's response around each
    frequency, and the power.
    """
    frequencies = np.geomspace(_RANGE_HZ[0] / 4, 0.45 / model.components.dt_s, 4000)
    shape = ensemble_shape(model, variability)
    powers = [
        ratio * amplitude(frequencies, one, shape, one.frequency_hz) ** 2 * frequencies
        for ratio, one in zip(
            model.components.arias_ratio, medians(model.components, getattr(model, variability))
        )
    ]
    totals = [power.sum() for power in powers]
    density = sum(
        power / total * ratio
        for power, total, ratio in zip(powers, totals, model.components.arias_ratio)
    )
    ratios = np.outer(model.target.periods_s, frequencies)
    filters = np.vstack(
        [
            1 / ((1 - ratios**2) ** 2 + (0.1 * ratios) ** 2),
            np.ones(len(frequencies)),
            1 / frequencies**2,
            1 / frequencies**4,
        ]
    )
    responses = filters * high_pass(frequencies, model.components.corner_hz) ** 2 * density
    hats = np.array(
        [
            np.interp(np.log(frequencies), np.log(model.frequencies_hz), unit)
            for unit in np.eye(len(model.frequencies_hz))
        ]
    )
    return responses / responses.sum(axis=1, keepdims=True) @ hats.T, float(np.mean(totals))
