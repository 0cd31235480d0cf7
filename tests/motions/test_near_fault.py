"""Near-fault synthetics: the pulse comes out as put in, the rest has the target's spectrum, and the
ground ends at rest.
"""

import math

import numpy as np
import pytest
from record_files import motion_hash
from scipy.optimize import least_squares
from scipy.special import erfc

from fecolumn.motions import atkinson_silva
from fecolumn.motions.directivity_pulse import DirectivityPulse
from fecolumn.motions.near_fault import (
    Scenario,
    near_fault_ensemble,
    near_fault_motions,
    saragoni_hart_window,
    stochastic_spectra,
)
from fecolumn.motions.processing import integrate

SCENARIOS = [(5.5, 5.0), (6.5, 10.0), (7.0, 12.5), (7.5, 20.0)]


def generators(count, seed=0):
    return [np.random.default_rng([seed, number]) for number in range(count)]


# by hand for M 6.5, R 10 km at 1 Hz: f_a = 10^-1.043 = 0.09057, f_b = 10^-0.242 = 0.5728, eps =
# 10^-1.0525 = 0.08861 source (0.91139/(1 + 121.9) + 0.08861/(1 + 3.0478)) = 0.029306; M_0 = 10^25.8
# = 6.3096e25; C = 7.7781e-21/1508.58 = 5.1558e-24 h = 10^0.925 = 8.414, R' = 13.069; path
# exp(-0.06517) = 0.93691; kappa exp(-0.09425) = 0.91006; rock: 1.58 + 0.16 * 0.4386 = 1.6502 (2
# pi)^2 * 325.31 * 0.029306 / 13.069 * 0.93691 * 0.91006 * 1.6502 = 40.52 cm/s and at 5 Hz: source
# 0.91139/3048.6 + 0.08861/77.20 = 1.44675e-3; path exp(-0.06517 * 2.4236) = 0.85389; kappa
# exp(-0.47124) = 0.62423 rock 2.25 + 0.33 * 0.70505 = 2.48267; (10 pi)^2 * 325.31 * 1.44675e-3 /
# 13.069 * 0.85389 * 0.62423 * 2.48267 = 47.04 cm/s
def test_target_amplitude_is_that_of_a_hand_calculation():
    assert atkinson_silva.fourier_amplitude([1.0, 5.0], 6.5, 10.0) == pytest.approx(
        [0.4052, 0.4704], rel=1e-3
    )


def test_long_periods_of_the_target_are_those_of_the_moment():
    frequency, far = 1e-5, atkinson_silva.effective_distance(6.0, 10.0)
    displacement = (
        atkinson_silva.fourier_amplitude(frequency, 6.0, 10.0) / (2 * math.pi * frequency) ** 2
    )
    plateau = (
        0.55
        * 0.7071
        * 2
        * 1e18
        * 10 ** (-1e-9 + 0.05)
        / (4 * math.pi * 2800 * 3500**3 * 1000 * far)
    )
    assert displacement == pytest.approx(plateau, rel=2e-3)


def test_rock_amplifies_as_tabulated_and_no_further_outside():
    assert atkinson_silva.site_amplification([0.51, 16.6]) == pytest.approx([1.42, 3.13])
    assert atkinson_silva.site_amplification([0.0, 200.0]) == pytest.approx([1.0, 4.0])


def test_window_peaks_at_a_fifth_and_has_fallen_to_a_twentieth_at_its_length():
    time = np.linspace(-1, 12, 13001)
    window = saragoni_hart_window(time, 10.0)
    assert time[window.argmax()] == pytest.approx(2.0, abs=1e-3) and window.max() == pytest.approx(
        1.0, rel=1e-9
    )
    assert saragoni_hart_window(10.0, 10.0) == pytest.approx(0.05, rel=1e-9)
    assert not window[time <= 0].any()


@pytest.mark.parametrize("magnitude, distance", SCENARIOS)
def test_root_mean_square_amplitude_of_the_stochastic_part_is_the_target_in_every_octave(
    magnitude, distance
):
    scenario, n_steps, dt = Scenario(magnitude, distance), 8192, 0.01
    spectra = stochastic_spectra(scenario, generators(60), dt, n_steps, 5.0)
    frequency = np.fft.rfftfreq(n_steps, dt)
    target = atkinson_silva.fourier_amplitude(frequency, magnitude, distance)
    for low in (0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8, 25.6):
        octave = (frequency >= low) & (frequency < 1.95 * low)
        ratio = np.abs(spectra[:, octave]) / target[octave]
        # independent values: bandwidth times duration, times motions
        few = 0.39 * low * atkinson_silva.duration(magnitude, distance) * 60
        assert np.sqrt((ratio**2).mean()) == pytest.approx(1.0, abs=max(3 / math.sqrt(few), 0.05))
        # amplitudes of Gaussian noise are Rayleigh's: the mean is sqrt(pi)/2 of the root mean
        # square
        assert ratio.mean() == pytest.approx(
            math.sqrt(math.pi) / 2, abs=max(3 / math.sqrt(few), 0.05)
        )


# Rayleigh amplitudes of mean square Y^2, lowered by the pulse's p to zero at most, have the mean
# square Y^2 exp(-p^2/Y^2) - sqrt(pi) Y p erfc(p/Y); the pulse adds p^2
@pytest.mark.parametrize("magnitude, distance", SCENARIOS)
def test_motion_has_the_target_amplitude_lowered_by_the_pulse(magnitude, distance):
    scenario, dt = Scenario(magnitude, distance), 0.01
    motions = near_fault_motions(scenario, generators(300), dt)
    frequency = np.fft.rfftfreq(len(motions[0].acceleration), dt)
    power = np.mean(
        [np.abs(np.fft.rfft(motion.acceleration[:, 0]) * dt) ** 2 for motion in motions], axis=0
    )
    time = np.arange(len(motions[0].acceleration)) * dt
    pulse = np.abs(np.fft.rfft(scenario.pulse.acceleration(time - time[len(time) // 2])) * dt)
    target = atkinson_silva.fourier_amplitude(frequency, magnitude, distance)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = pulse / target
    expected = (
        target**2 * np.exp(-(share**2))
        - math.sqrt(math.pi) * target * pulse * erfc(share)
        + pulse**2
    )
    corner = 1 / scenario.pulse.period
    for low, high in (
        (0.8 * corner, 1.4 * corner),
        (1.4 * corner, 2 * corner),
        (2 * corner, 10.0),
        (10.0, 20.0),
        (20.0, 40.0),
    ):
        band = (frequency > low) & (frequency < high)
        assert (power[band] / expected[band]).mean() == pytest.approx(1.0, abs=0.08)
    highest = (frequency > 20) & (frequency < 40)
    assert math.sqrt((power[highest] / target[highest] ** 2).mean()) == pytest.approx(1.0, abs=0.05)


def test_within_the_band_of_the_pulse_the_motion_has_the_pulses_amplitude_not_the_sum():
    scenario, dt = Scenario(7.0, 5.0), 0.01
    motions = near_fault_motions(scenario, generators(100), dt)
    time = np.arange(len(motions[0].acceleration)) * dt
    pulse = np.abs(np.fft.rfft(scenario.pulse.acceleration(time - time[len(time) // 2])) * dt)
    frequency = np.fft.rfftfreq(len(time), dt) * scenario.pulse.period
    band = (frequency > 0.7) & (frequency < 1.3)
    power = np.mean(
        [np.abs(np.fft.rfft(motion.acceleration[:, 0]) * dt)[band] ** 2 for motion in motions],
        axis=0,
    )
    stochastic = (
        atkinson_silva.fourier_amplitude(frequency[band] / scenario.pulse.period, 7.0, 5.0) ** 2
    )
    assert (power / pulse[band] ** 2).mean() == pytest.approx(1.0, abs=0.02)
    assert (1 + stochastic / pulse[band] ** 2).mean() > 1.1


@pytest.mark.parametrize("magnitude, distance", SCENARIOS)
def test_pulse_fitted_to_the_velocity_has_the_period_and_velocity_put_in(magnitude, distance):
    scenario = Scenario(magnitude, distance)
    true, found = scenario.pulse, []
    for motion in near_fault_motions(scenario, generators(8), 0.01):
        velocity = integrate(motion)[0][:, 0]
        time = np.arange(len(velocity)) * motion.dt
        middle = time[np.abs(velocity).argmax()]

        def misfit(x, time=time, velocity=velocity):
            return (
                DirectivityPulse(abs(x[0]), abs(x[1]), x[2], true.gamma).velocity(time - x[3])
                - velocity
            )

        starts = (
            [true.velocity_amplitude, factor * true.period, phase, middle]
            for factor in (0.8, 1.3)
            for phase in (0.5, 2.5)
        )
        found.append(
            min((least_squares(misfit, start) for start in starts), key=lambda fit: fit.cost).x
        )
    fitted = np.median(np.abs(found), axis=0)
    assert fitted[0] == pytest.approx(true.velocity_amplitude, rel=0.07)
    assert fitted[1] == pytest.approx(true.period, rel=0.05)


@pytest.mark.parametrize("magnitude, distance", SCENARIOS)
def test_mean_velocity_of_many_motions_is_the_pulse(magnitude, distance):
    scenario = Scenario(magnitude, distance)
    velocity = np.mean(
        [
            integrate(motion)[0][:, 0]
            for motion in near_fault_motions(scenario, generators(100), 0.01)
        ],
        axis=0,
    )
    assert np.abs(velocity).max() == pytest.approx(scenario.pulse.velocity_amplitude, rel=0.05)


@pytest.mark.parametrize("magnitude, distance", SCENARIOS)
def test_ground_starts_and_ends_at_rest_displaced_by_the_pulse_alone(magnitude, distance):
    scenario = Scenario(magnitude, distance)
    for motion in near_fault_motions(scenario, generators(5), 0.01, fault_parallel=True):
        velocity, displacement = integrate(motion)
        assert np.abs(velocity[-1]).max() < 1e-4 * scenario.pulse.velocity_amplitude
        assert displacement[-1, 0] == pytest.approx(
            float(scenario.pulse.displacement(99.0)), abs=2e-3 * np.abs(displacement).max()
        )
        assert abs(displacement[-1, 1]) < 2e-3 * np.abs(displacement).max()
        quiet = len(velocity) // 40
        assert np.abs(motion.acceleration[:quiet]).max() < 1e-3 * motion.pga.max()
        assert np.abs(velocity[:quiet]).max() < 0.01 * np.abs(velocity).max()


def test_fault_parallel_component_has_no_pulse_and_its_own_noise():
    scenario = Scenario(7.0, 10.0)
    motions = near_fault_motions(scenario, generators(20), 0.01, fault_parallel=True)
    alone = near_fault_motions(scenario, generators(20), 0.01)
    assert all(
        np.array_equal(a.acceleration[:, 0], b.acceleration[:, 0]) for a, b in zip(motions, alone)
    )
    mean = np.mean([integrate(motion)[0] for motion in motions], axis=0)
    assert np.abs(mean[:, 1]).max() < 0.2 * np.abs(mean[:, 0]).max()
    correlations = [np.corrcoef(motion.acceleration[:, :2].T)[0, 1] for motion in motions]
    assert abs(np.mean(correlations)) < 0.05


def test_same_seed_gives_the_same_motions_whatever_else_is_made():
    whole = near_fault_ensemble([6.0, 6.5], [5.0, 10.0], 3, seed=7)
    part = near_fault_ensemble([6.5], [10.0], 2, seed=7)
    assert (
        len(whole.motions) == 12 and whole.parameters["magnitude"].tolist() == [6.0] * 6 + [6.5] * 6
    )
    assert [motion_hash(m) for m in part.motions] == [motion_hash(m) for m in whole.motions[9:11]]
    assert motion_hash(near_fault_ensemble([6.5], [10.0], 1, seed=8).motions[0]) != motion_hash(
        part.motions[0]
    )
    # no two scenarios share their noise: their accelerations, mostly of high frequency, are unlike
    first = np.array([motion.acceleration[:2500, 0] for motion in whole.motions])
    assert np.abs(np.corrcoef(np.diff(first)) - np.eye(12)).max() < 0.3


@pytest.mark.parametrize(
    "arguments, said",
    [
        (dict(magnitudes=[9.0]), "magnitude = 9 must lie"),
        (dict(distances=[-1.0]), "distance = -1 km"),
        (dict(count=0), "count = 0"),
        (dict(seed=-1), "seed = -1"),
        (dict(dt=0.05), "dt = 0.05 s"),
    ],
)
def test_impossible_ensemble_is_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        near_fault_ensemble(**{"magnitudes": [6.0], "distances": [5.0], "count": 1, **arguments})
