"""Intensity measures against closed forms."""

import math

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.motions import intensity
from fecolumn.motions.record import GroundMotion


def motion_of(x, y, dt):
    return GroundMotion(np.column_stack([x, y, np.zeros(len(x))]), dt, "test", "made up")


def circle(cycles=5, dt=1e-3):
    """Unit acceleration turning once a second: the same in every direction."""
    time = np.arange(round(cycles / dt) + 1) * dt
    return motion_of(np.cos(2 * math.pi * time), np.sin(2 * math.pi * time), dt)


def test_arias_intensity_of_a_sine():
    # pi/(2 g) int (cos^2 + sin^2) dt over 5 s
    assert intensity.total_arias_intensity(circle()) == pytest.approx(
        math.pi / (2 * GRAVITY) * 5, rel=1e-6
    )


def test_steady_motion_spends_its_intensity_evenly():
    assert intensity.significant_duration(circle()) == pytest.approx(0.9 * 5, rel=1e-6)
    assert intensity.significant_duration(circle(), 0.05, 0.75) == pytest.approx(0.7 * 5, rel=1e-6)


def test_husid_curve_of_an_exponential_decay():
    # Arias fraction 1 - exp(-2 t): 5 % and 95 % lie ln(19)/2 apart
    time = np.arange(20001) * 1e-3
    assert intensity.significant_duration(
        motion_of(np.exp(-time), 0 * time, 1e-3)
    ) == pytest.approx(math.log(19) / 2, rel=1e-4)


def test_peaks_of_a_circular_motion_are_the_same_in_all_directions():
    pga, pgv, _ = intensity.peak_values(circle())
    assert pga == pytest.approx(1, rel=1e-6)
    # from rest: v = (sin, 1 - cos)/w, a circle through the origin; along angle phi its extent is
    # (|sin phi| + 1)/w, median 1 + sin(45 deg)
    assert pgv == pytest.approx((1 + math.sin(math.pi / 4)) / (2 * math.pi), rel=1e-3)


def test_cumulative_absolute_velocity_of_a_sine():
    # mean of |cos| is 2/pi
    assert intensity.cumulative_absolute_velocity(circle()) == pytest.approx(
        5 * 2 / math.pi, rel=1e-4
    )


def test_housner_intensity_of_an_impulse():
    # undamped pseudo-velocity of a short impulse is the impulse, at every long period: 0.02 m/s *
    # 2.4 s
    motion = motion_of(np.r_[0, 2, 0], np.zeros(3), 0.01)
    assert intensity.housner_intensity(motion, 0.0) == pytest.approx(0.02 * 2.4, rel=5e-3)
    # the same impulse along both axes is sqrt(2) along the diagonal: RotD50 cos(45 deg) of that
    assert intensity.housner_intensity(
        motion_of(np.r_[0, 2, 0], np.r_[0, 2, 0], 0.01), 0.0
    ) == pytest.approx(0.02 * 2.4, rel=5e-3)


@pytest.mark.parametrize("turned", [False, True])
def test_measures_of_one_component_are_its_own(turned):
    # one cycle of 2 sin(w t), w = 2 pi, from rest: v = 2 (1 - cos)/w, d = 2 (t - sin(w t)/w)/w; int
    # |a| dt = 8/w
    time, omega = np.arange(1001) * 1e-3, 2 * math.pi
    components = 2 * np.sin(omega * time), np.zeros(1001)
    motion = motion_of(*(components[::-1] if turned else components), 1e-3)
    assert intensity.peak_values(motion) == pytest.approx((2, 4 / omega, 2 / omega), rel=1e-5)
    assert intensity.cumulative_absolute_velocity(motion) == pytest.approx(8 / omega, rel=1e-5)


def test_motion_of_zeros_has_measures_of_zero():
    assert set(
        intensity.intensity_measures(motion_of(np.zeros(100), np.zeros(100), 0.01)).values()
    ) == {0.0}
