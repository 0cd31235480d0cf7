"""Baseline correction and band-pass against what was put in: drifts go, tones stay."""

import math

import numpy as np
import pytest

from fecolumn.motions.processing import band_pass, correct_baseline, end_at_rest, integrate
from fecolumn.motions.record import GroundMotion

DT = 0.01
TIME = np.arange(0, 40 + DT / 2, DT)


def tone(frequency):
    """A tone of 10 s in the middle, under an envelope that starts and ends smoothly; velocity and
    displacement return to zero.
    """
    s = np.clip((TIME - 15) / 10, 0, 1)
    return np.sin(math.pi * s) ** 4 * np.sin(2 * math.pi * frequency * (TIME - 20))


def motion_of(x, y=0.0, z=0.0):
    x = np.asarray(x, dtype=float)
    return GroundMotion(
        np.column_stack([x, np.broadcast_to(y, x.shape), np.broadcast_to(z, x.shape)]),
        DT,
        "test",
        "made up",
    )


@pytest.mark.parametrize("degree", [2, 4, 6])
def test_drift_that_is_a_polynomial_is_taken_out_whole(degree):
    powers = np.random.default_rng(degree).normal(size=degree - 1) * 1e-2
    drift = sum(c * (TIME / 40) ** k for k, c in enumerate(powers))
    corrected = correct_baseline(motion_of(drift, 2 * drift, -drift), degree)
    assert np.abs(corrected.acceleration).max() < 1e-4 * np.abs(drift).max()


def test_drift_goes_and_motion_stays():
    clean = motion_of(tone(1.0))
    _, before = integrate(clean)
    drifting = motion_of(tone(1.0) + 0.003 - 0.002 * TIME / 40)
    _, after = integrate(correct_baseline(drifting))
    assert np.abs(integrate(drifting)[1]).max() > 20 * np.abs(before).max()
    assert np.abs(after - before).max() < 0.05 * np.abs(before).max()


def test_wrong_degree_is_refused():
    for degree in (1, 11, 2.5):
        with pytest.raises(ValueError, match=r"must be a whole number in \[2, 10\]"):
            correct_baseline(motion_of(tone(1.0)), degree)


@pytest.mark.parametrize("place", [0.0, 0.25, -0.1])
def test_ground_ends_at_rest_where_it_is_told_to(place):
    motion = motion_of(
        tone(1.0) + 0.01, np.cumsum(np.random.default_rng(0).normal(size=len(TIME))) * 1e-3, 1.0
    )
    velocity, displacement = integrate(end_at_rest(motion, place))
    assert np.abs(velocity[-1]).max() < 1e-9 and displacement[-1] == pytest.approx(
        [place] * 3, abs=1e-8
    )


def test_ground_may_stay_where_it_comes_to_rest():
    offset = motion_of(tone(1.0) + 1e-3)
    corrected = end_at_rest(offset, None)
    velocity, displacement = integrate(corrected)
    assert abs(velocity[-1, 0]) < 1e-10
    assert corrected.acceleration[1:-1, 0] == pytest.approx(tone(1.0)[1:-1], abs=1e-6)


def test_no_other_correction_that_ends_at_rest_is_smaller():
    motion, rng = motion_of(tone(1.0) + 0.01), np.random.default_rng(1)
    least = end_at_rest(motion)
    size = ((least.acceleration - motion.acceleration) ** 2).sum()
    for _ in range(5):
        other = end_at_rest(
            motion_of(motion.acceleration[:, 0] + 1e-3 * rng.normal(size=len(TIME)))
        )
        assert ((other.acceleration - motion.acceleration) ** 2).sum() > size
    assert np.allclose(end_at_rest(least).acceleration, least.acceleration, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    "frequency, passes", [(0.2, False), (1.0, True), (5.0, True), (30.0, False)]
)
def test_band_pass_lets_through_what_is_in_the_band_without_shifting_it(frequency, passes):
    filtered = band_pass(motion_of(tone(frequency)), 0.5, 12.0, order=8)
    pad = (len(filtered.acceleration) - len(TIME)) // 2
    inside = filtered.acceleration[pad : pad + len(TIME), 0]
    if passes:
        assert np.abs(inside - tone(frequency)).max() < 0.02
    else:
        assert np.abs(inside).max() < 0.02


@pytest.mark.parametrize("order", [2, 4, 8])
def test_amplitude_is_butterworths_squared_half_at_the_corner(order):
    impulse = np.zeros(len(TIME))
    impulse[2000] = 1.0
    filtered = band_pass(motion_of(impulse), 1.0, None, order)
    response = np.abs(np.fft.rfft(filtered.acceleration[:, 0]))
    frequency = np.fft.rfftfreq(len(filtered.acceleration), DT)
    some = (frequency > 0.1) & (frequency < 2.0)
    assert response[some] == pytest.approx(1 / (1 + frequency[some] ** -order), rel=0.02)


def test_padded_record_neither_drifts_nor_loses_its_end():
    rng = np.random.default_rng(2)
    motion = motion_of(rng.normal(size=len(TIME)) * np.exp(-TIME / 15))
    velocity, displacement = integrate(band_pass(motion, 0.2, 20.0))
    assert np.abs(velocity[-1]).max() < 1e-3 * np.abs(velocity).max()
    assert np.abs(displacement[-1]).max() < 0.01 * np.abs(displacement).max()


@pytest.mark.parametrize(
    "arguments, said",
    [
        ((0.0, 10.0), "low = 0 Hz"),
        ((0.1, 50.0), "high = 50 Hz must lie between 0 and 50 Hz"),
        ((5.0, 2.0), "less than high = 2 Hz"),
        ((0.1, 10.0, 3), "order = 3"),
    ],
)
def test_impossible_band_is_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        band_pass(motion_of(tone(1.0)), *arguments)
