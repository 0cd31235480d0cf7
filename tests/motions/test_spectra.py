"""Response spectra against closed forms, and against other people's packages where they are
installed.
"""

import math

import numpy as np
import pytest
from scipy.signal import lsim

from fecolumn.motions.processing import integrate
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.spectra import (
    component_spectra,
    horizontal_spectrum,
    rotated_peaks,
    rotd_spectrum,
)


def motion_of(x, y=0.0, z=0.0, dt=0.01):
    x = np.asarray(x, dtype=float)
    return GroundMotion(
        np.column_stack([x, np.broadcast_to(y, x.shape), np.broadcast_to(z, x.shape)]),
        dt,
        "test",
        "made up",
    )


def noise(seed=1, n=3000, dt=0.005):
    """Modulated noise below 20 Hz with two different components."""
    rng = np.random.default_rng(seed)
    time = np.arange(n) * dt
    frequency, phase = rng.uniform(0.2, 20, (2, 40, 1)), rng.uniform(0, 2 * math.pi, (2, 40, 1))
    tones = (
        np.sin(2 * math.pi * frequency * time + phase).sum(axis=1)
        * np.sin(math.pi * time / time[-1]) ** 2
    )
    return GroundMotion(
        np.column_stack([tones[0], 0.6 * tones[1], 0.3 * tones[0]]), dt, "noise", "made up"
    )


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.2])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_harmonic_reaches_its_steady_state_amplification(damping, ratio):
    # forcing over natural frequency = ratio; |H| = 1 / sqrt((1 - r^2)^2 + (2 zeta r)^2); grown and
    # faded slowly, so without transients
    period, time = 0.5, np.arange(60001) * 1e-3
    growth = np.clip(np.minimum(time, 60 - time) / 20, 0, 1)
    growth = growth**2 * (3 - 2 * growth)
    motion = motion_of(growth * np.sin(2 * math.pi * ratio / period * time), dt=1e-3)
    expected = 1 / math.sqrt((1 - ratio**2) ** 2 + (2 * damping * ratio) ** 2)
    assert component_spectra(motion, [period], damping)[0, 0] == pytest.approx(expected, rel=3e-3)


def test_undamped_oscillator_under_a_rectangular_pulse():
    # u_max = 2 a / omega^2 if the pulse lasts longer than half a period; ramps of one step of 0.1
    # ms at its ends
    acceleration = np.ones(12001)
    acceleration[[0, -1]] = 0
    assert component_spectra(motion_of(acceleration, dt=1e-4), [1.0], 0.0)[0, 0] == pytest.approx(
        2, rel=1e-3
    )


def test_short_pulse_is_felt_after_it_ended():
    # impulse response: peak pseudo-acceleration omega * impulse for no damping, a quarter of a
    # period after the motion's end
    motion = motion_of(np.full(11, 2.0), dt=1e-3)
    assert component_spectra(motion, [4.0], 0.0)[0, 0] == pytest.approx(
        2 * math.pi / 4 * 0.021, rel=1e-3
    )


def test_any_motion_agrees_with_an_independent_integration():
    motion, omega, damping = noise(), 2 * math.pi / 0.37, 0.05
    time = np.arange(len(motion.acceleration)) * motion.dt
    for axis in range(3):
        # scipy's first-order hold is exact for piecewise linear input, too, by a matrix exponential
        displacement = lsim(
            ([-1.0], [1.0, 2 * damping * omega, omega**2]), motion.acceleration[:, axis], time
        )[1]
        assert component_spectra(motion, [0.37], damping)[axis, 0] == pytest.approx(
            omega**2 * np.abs(displacement).max(), rel=1e-9
        )


def test_stiff_oscillator_feels_the_ground_and_a_soft_one_its_displacement():
    time = np.arange(4001) * 0.005
    motion = motion_of(np.sin(math.pi * time / 20) ** 2 * np.sin(2 * math.pi * time), dt=0.005)
    stiff, soft = rotd_spectrum(motion, [0.01, 200.0], 0.05, (100,))[0]
    assert stiff == pytest.approx(1, rel=1e-2)
    pgd = np.abs(integrate(motion)[1][:, 0]).max()
    assert soft == pytest.approx((2 * math.pi / 200) ** 2 * pgd, rel=0.05)


def test_rotd_of_one_component_are_the_percentiles_of_a_cosine():
    # |cos| over directions has median cos(45 deg) and maximum 1
    along = motion_of(np.sin(np.arange(2000) * 0.05))
    rotd50, rotd100 = rotd_spectrum(along, [0.5])[:, 0]
    peak = component_spectra(along, [0.5])[0, 0]
    assert rotd100 == pytest.approx(peak, rel=1e-12) and rotd50 == pytest.approx(
        peak * math.cos(math.pi / 4), rel=1e-4
    )


def test_horizontal_spectrum_of_one_component_is_its_own_and_of_two_rotd50():
    periods, wave = [0.1, 0.5, 2.0], np.sin(np.arange(2000) * 0.05)
    own = component_spectra(motion_of(wave), periods)[0]
    for one in (motion_of(wave), motion_of(0 * wave, wave), motion_of(wave, 0, wave)):
        assert horizontal_spectrum(one, periods) == pytest.approx(own, rel=1e-12)
    assert np.array_equal(
        horizontal_spectrum(noise(), periods), rotd_spectrum(noise(), periods, percentiles=(50,))[0]
    )


def test_rotd_does_not_depend_on_the_axes():
    motion = noise()
    angle = math.radians(37)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    turned = GroundMotion(
        np.column_stack([motion.acceleration[:, :2] @ turn, motion.acceleration[:, 2]]),
        motion.dt,
        "turned",
        "",
    )
    periods = np.geomspace(0.02, 5, 15)
    assert rotd_spectrum(turned, periods) == pytest.approx(
        rotd_spectrum(motion, periods), rel=1e-12
    )


def test_states_left_out_as_too_near_to_rest_were_no_peaks():
    history = noise().acceleration[:, :2]
    angles = np.pi * np.arange(180) / 180
    every = np.abs(
        np.outer(np.cos(angles), history[:, 0]) + np.outer(np.sin(angles), history[:, 1])
    ).max(axis=1)
    assert rotated_peaks(history) == pytest.approx(every, rel=1e-14)


def test_spectrum_scales_with_the_motion_and_with_its_time():
    motion, periods = noise(), np.geomspace(0.05, 5, 10)
    slower = GroundMotion(3 * motion.acceleration, 2 * motion.dt, "slow", "")
    assert rotd_spectrum(slower, 2 * periods) == pytest.approx(
        3 * rotd_spectrum(motion, periods), rel=1e-10
    )


@pytest.mark.parametrize(
    "periods, damping", [([0.0], 0.05), ([1.0, -1.0], 0.05), ([1.0], 1.0), ([1.0], -0.1)]
)
def test_impossible_oscillators_are_refused(periods, damping):
    with pytest.raises(ValueError, match="must"):
        rotd_spectrum(noise(), periods, damping)


def test_eqsig_finds_the_same_spectrum():
    eqsig = pytest.importorskip("eqsig")
    motion, periods = noise(), np.geomspace(0.1, 5, 20)
    # eqsig looks at the samples only, 20 a period at worst: up to 1.2 % off
    theirs = eqsig.sdof.pseudo_response_spectra(
        motion.acceleration[:, 0].copy(), motion.dt, periods, 0.05
    )[2]
    assert component_spectra(motion, periods)[0] == pytest.approx(theirs, rel=0.02)


def test_pyrotd_finds_the_same_rotd_spectra():
    pyrotd = pytest.importorskip("pyrotd")
    motion, periods = noise(), np.geomspace(0.1, 3, 20)
    # pyrotd works in the frequency domain: 30 s of rest keep the end from running into the start
    quiet = np.zeros(6000)
    x, y = (np.concatenate([motion.acceleration[:, axis], quiet]) for axis in (0, 1))
    found = pyrotd.calc_rotated_spec_accels(
        motion.dt, x, y, 1 / periods, 0.05, percentiles=[50, 100]
    )
    theirs = np.array([found.spec_accel[found.percentile == p] for p in (50, 100)])
    # band-limited between the samples there, straight lines here: weaker by 3 % at 20 Hz
    assert rotd_spectrum(motion, periods) == pytest.approx(theirs, rel=0.03)
