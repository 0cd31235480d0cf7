"""The stochastic model against what its equations say: intensity, duration, spectrum, rest at the
end, variability.
"""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from fecolumn.case.sections import GRAVITY
from fecolumn.motions.stochastic import (
    Component,
    EnsembleShape,
    amplitude,
    bidirectional,
    brought_to_rest,
)
from fecolumn.motions.variability import (
    _CORRELATIONS,
    damping_of,
    damping_score,
    drawn,
    slope_of,
    slope_score,
)

FLAT = EnsembleShape(
    modulation_shape=10.0,
    corner_hz=0.1,
    frequencies_hz=np.array([0.1, 10.0]),
    ln_gains=np.zeros(2),
    dt=0.01,
)
ONE = Component(
    arias_m_s=2.0, duration_s=10.0, frequency_hz=4.0, frequency_slope_hz_s=0.0, damping=0.3
)


def many(component=ONE, shape=FLAT, n=100):
    return np.column_stack(
        [
            bidirectional((component, component), shape, np.random.default_rng(number))
            for number in range(n // 2)
        ]
    )


def test_mean_arias_intensity_is_the_parameter():
    intensity = math.pi / (2 * GRAVITY) * (many() ** 2).sum(axis=0) * FLAT.dt
    assert intensity.mean() == pytest.approx(2.0, rel=0.05)


def test_significant_duration_of_the_mean_intensity_is_the_parameter():
    husid = cumulative_trapezoid((many() ** 2).mean(axis=1), initial=0)
    first, last = np.interp([0.05, 0.95], husid / husid[-1], np.arange(len(husid)) * FLAT.dt)
    assert last - first == pytest.approx(10.0, rel=0.04)


def test_energy_lies_where_the_filter_puts_it():
    # white noise through an oscillator: share of the variance below the natural frequency, from the
    # filter's own transfer function
    frequencies = np.linspace(0.2, 49, 5000)
    density = amplitude(frequencies, ONE, FLAT, ONE.frequency_hz) ** 2
    expected = density[frequencies < 4].sum() / density.sum()
    motions = many()
    power = (np.abs(np.fft.rfft(motions, axis=0)) ** 2).sum(axis=1)
    found = power[np.fft.rfftfreq(len(motions), FLAT.dt) < 4].sum() / power.sum()
    assert found == pytest.approx(expected, abs=0.02)


def test_falling_filter_frequency_lowers_the_crossing_rate():
    motions = many(
        dataclasses.replace(ONE, frequency_hz=6.0, frequency_slope_hz_s=-0.5, damping=0.1)
    )
    ups = (motions[:-1] <= 0) & (motions[1:] > 0)
    # 5-8 s and 11-14 s
    rates = [ups[start : start + 300].mean() / FLAT.dt for start in (500, 1100)]
    assert rates[1] - rates[0] == pytest.approx(-0.5 * 6, abs=0.4)


def test_correction_multiplies_the_amplitude():
    gained = dataclasses.replace(FLAT, ln_gains=np.array([1.0, 1.0]))
    frequencies = np.array([0.5, 4.0, 30.0])
    assert amplitude(frequencies, ONE, gained, 4.0) == pytest.approx(
        math.e * amplitude(frequencies, ONE, FLAT, 4.0)
    )


def test_velocity_and_displacement_end_at_zero():
    motions = many(n=10)
    velocity = cumulative_trapezoid(motions, dx=FLAT.dt, axis=0, initial=0)
    displacement = cumulative_trapezoid(velocity, dx=FLAT.dt, axis=0, initial=0)
    assert np.abs(velocity[-1]).max() < 1e-12 * np.abs(velocity).max()
    assert np.abs(displacement[-1]).max() < 1e-10 * np.abs(displacement).max()


def test_correction_for_rest_leaves_a_motion_at_rest_as_it_is():
    motion = many(n=2)[:, 0]
    assert brought_to_rest(motion, FLAT.dt) == pytest.approx(motion, abs=1e-12)


def test_components_are_independent():
    motions = many()
    x, y = motions[:, ::2].ravel(), motions[:, 1::2].ravel()
    assert abs(np.corrcoef(x, y)[0, 1]) < 0.03


def test_frequency_slope_and_damping_are_told_by_their_scores():
    for slope in (-2.0, -0.2, 0.0, 0.1, 0.4):
        assert slope_of(slope_score(slope)) == pytest.approx(slope, abs=1e-9)
    for damping in (0.02, 0.13, 0.6):
        assert damping_of(damping_score(damping)) == pytest.approx(damping)
    assert all(np.diff([slope_of(score) for score in np.linspace(-4, 5, 50)]) >= 0)


def test_draws_have_the_published_medians_deviations_and_correlations():
    medians = (ONE, dataclasses.replace(ONE, arias_m_s=1.0))
    draws = [drawn(medians, 3, number) for number in range(2000)]
    logs = np.log(
        [
            [value for one in pair for value in (one.arias_m_s, one.duration_s, one.frequency_hz)]
            for pair in draws
        ]
    )
    assert np.exp(np.median(logs, axis=0)) == pytest.approx([2, 10, 4, 1, 10, 4], rel=0.02)
    assert logs.std(axis=0) == pytest.approx([1.053, 0.398, 0.448, 1.028, 0.376, 0.400], rel=0.03)
    places = [0, 1, 2, 5, 6, 7]
    assert np.corrcoef(logs.T) == pytest.approx(_CORRELATIONS[np.ix_(places, places)], abs=0.04)


def test_medians_of_a_hundred_draws_are_near_those_of_the_population():
    spread = [
        np.median(
            [math.log(drawn((ONE, ONE), seed, number)[0].arias_m_s / 2) for number in range(115)]
        )
        for seed in range(20)
    ]
    # independent draws would scatter by 1.25 * 1.05 / sqrt(115) = 0.12
    assert np.std(spread) < 0.03


def test_strong_shaking_of_both_components_starts_together():
    pair = (ONE, dataclasses.replace(ONE, duration_s=4.0))
    histories = np.array(
        [bidirectional(pair, FLAT, np.random.default_rng(number)) for number in range(50)]
    )
    husid = cumulative_trapezoid((histories**2).mean(axis=0), axis=0, initial=0)
    starts = [
        np.interp(0.05, husid[:, axis] / husid[-1, axis], np.arange(len(husid)) * FLAT.dt)
        for axis in (0, 1)
    ]
    assert starts[1] == pytest.approx(starts[0], abs=0.3)
