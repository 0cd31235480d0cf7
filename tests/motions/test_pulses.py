"""Pulses: closed forms against their own derivatives and integrals, and what is left when they are
over.
"""

import math

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from fecolumn.motions.processing import integrate
from fecolumn.motions.pulses import SHAPES, Pulse, pulse_ensemble, sample, type_c_phase

PULSES = [Pulse(shape, 3.0, 0.8) for shape in SHAPES] + [
    Pulse("type_c", -2.0, 1.7, 2),
    Pulse("type_c", 4.0, 0.3, 3),
]
named = pytest.mark.parametrize("pulse", PULSES, ids=lambda pulse: f"{pulse.shape}{pulse.cycles}")


@named
def test_velocity_and_displacement_are_the_integrals_of_the_acceleration(pulse):
    time = np.linspace(pulse.start, pulse.end, 20001)
    velocity = cumulative_trapezoid(pulse.acceleration(time), time, initial=0.0)
    displacement = cumulative_trapezoid(pulse.velocity(time), time, initial=0.0)
    assert np.abs(pulse.velocity(time) - velocity).max() < 1e-6 * np.abs(velocity).max()
    assert np.abs(pulse.displacement(time) - displacement).max() < 1e-6 * np.abs(displacement).max()


@named
def test_pulse_starts_from_rest_and_peaks_at_its_amplitude(pulse):
    time = np.linspace(pulse.start, pulse.end, 20001)
    assert np.abs(pulse.acceleration(time)).max() == pytest.approx(abs(pulse.amplitude), rel=1e-6)
    assert abs(pulse.velocity(pulse.start)) < 1e-8 * abs(pulse.amplitude) * pulse.period
    assert abs(pulse.displacement(pulse.start)) < 1e-8 * pulse.length_scale
    assert pulse.acceleration(pulse.start - 1) == 0 and pulse.acceleration(pulse.end + 1) == 0


# in units of a_p T_p and a_p T_p^2: one-sine slides forward and stops; half-sine and rectangle
# leave the ground moving
@named
def test_what_is_left_after_the_pulse_is_as_stated(pulse):
    velocity = {"half_sine": 1 / math.pi, "rectangular": 1.0}.get(pulse.shape, 0.0)
    displacement = {
        "half_sine": 1 / (4 * math.pi),
        "rectangular": 0.5,
        "one_sine": 1 / (2 * math.pi),
    }.get(pulse.shape, 0.0)
    assert pulse.residual_velocity == pytest.approx(
        velocity * pulse.amplitude * pulse.period, abs=1e-8 * pulse.length_scale
    )
    assert pulse.displacement(pulse.end) == pytest.approx(
        displacement * pulse.amplitude * pulse.period**2, abs=1e-8 * pulse.length_scale
    )
    later = pulse.displacement(pulse.end + 2.0) - pulse.displacement(pulse.end)
    assert later == pytest.approx(2.0 * pulse.residual_velocity, abs=1e-8 * pulse.length_scale)


@named
@pytest.mark.parametrize("steps", [10.0, 37.3, 400.0])
def test_sampled_pulse_ends_with_the_exact_velocity_and_displacement_whatever_the_step(
    pulse, steps
):
    dt = pulse.period / steps
    motion = sample(pulse, dt, lead=0.1, tail=0.2)
    velocity, displacement = integrate(motion)
    end = pulse.start + dt * (len(velocity) - 1 - math.ceil(0.1 / dt - 1e-9) - 1)
    assert velocity[-1, 0] == pytest.approx(
        pulse.residual_velocity, abs=1e-8 * pulse.length_scale / pulse.period
    )
    assert displacement[-1, 0] == pytest.approx(
        float(pulse.displacement(end)), abs=1e-7 * pulse.length_scale
    )
    assert (
        not motion.acceleration[0].any()
        and not motion.acceleration[-1].any()
        and not motion.acceleration[:, 1:].any()
    )


@pytest.mark.parametrize("shape", ["symmetric_ricker", "antisymmetric_ricker"])
def test_fourier_amplitude_of_a_ricker_wavelet_peaks_at_its_period(shape):
    motion = sample(Pulse(shape, 1.0, 0.8), 0.01, lead=100, tail=100)
    amplitude = np.abs(np.fft.rfft(motion.acceleration[:, 0]))
    frequency = np.fft.rfftfreq(len(motion.acceleration), 0.01)
    assert frequency[amplitude.argmax()] == pytest.approx(1 / 0.8, rel=0.005)


def test_fourier_amplitude_of_the_symmetric_ricker_is_that_of_a_gaussian_differentiated_twice():
    pulse, dt = Pulse("symmetric_ricker", 2.0, 0.5), 1e-3
    acceleration = pulse.acceleration(np.arange(-4000, 4000) * dt)
    frequency = np.fft.rfftfreq(8000, dt)[1:100]
    ratio = frequency * pulse.period
    exact = 2.0 * pulse.period * 2 / math.sqrt(math.pi) * ratio**2 * np.exp(-(ratio**2))
    assert np.abs(np.fft.rfft(acceleration))[1:100] * dt == pytest.approx(exact, rel=1e-6, abs=1e-9)


# Makris and Roussos (2000)
@pytest.mark.parametrize("cycles, over_pi", [(1, 0.0697), (2, 0.0410)])
def test_phase_of_type_c_is_that_published(cycles, over_pi):
    assert type_c_phase(cycles) / math.pi == pytest.approx(over_pi, abs=5e-5)


def test_velocity_of_type_c_turns_twice_a_cycle():
    for cycles in (1, 2, 3):
        pulse = Pulse("type_c", 1.0, 1.0, cycles)
        velocity = pulse.velocity(np.linspace(0.001, pulse.end - 0.001, 5000))
        assert (np.diff(np.sign(velocity)) != 0).sum() == 2 * cycles


def test_sampled_peak_is_lower_by_the_stated_share():
    dt = 0.02
    peak = (
        sample(Pulse("one_sine", 1.0, 1.0), dt / 4).pga[0],
        sample(Pulse("symmetric_ricker", 1.0, 1.0), dt).pga[0],
    )
    assert 1 - peak[0] == pytest.approx((2 * math.pi * dt / 4) ** 2 / 12, rel=0.01)
    assert 1 - peak[1] < 2 * 6 * (2 * math.pi * dt) ** 2 / 12


def test_ensemble_holds_every_amplitude_at_every_period():
    ensemble = pulse_ensemble("one_cosine", [1.0, 2.0], [0.5, 1.0, 2.0], 0.01)
    assert len(ensemble.motions) == 6
    assert ensemble.parameters["pulse_length_m"].tolist() == [0.25, 0.5, 1.0, 2.0, 4.0, 8.0]
    assert [motion.pga[0] for motion in ensemble.motions] == pytest.approx(
        ensemble.parameters["pulse_amplitude_m_s2"], rel=2e-3
    )


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("ricker", 1.0, 1.0), "must be one of symmetric_ricker, "),
        (("one_sine", math.nan, 1.0), "amplitude = nan m/s2"),
        (("one_sine", 0.0, 1.0), "amplitude = 0 m/s2"),
        (("one_sine", 1.0, -2.0), "period = -2 s"),
        (("type_c", 1.0, 1.0, 0), "at least 1"),
        (("one_sine", 1.0, 1.0, 2), "only type_c"),
    ],
)
def test_impossible_pulse_is_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        Pulse(*arguments)


def test_step_too_coarse_for_the_pulse_is_refused():
    with pytest.raises(ValueError, match="at most 0.01 s, a tenth of the pulse's period"):
        sample(Pulse("one_sine", 1.0, 0.1), 0.02)
