"""The directivity pulse: velocity as its integral and derivative say, peak as asked, scenarios as
tabulated by hand.
"""

import math

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from fecolumn.motions.directivity_pulse import DirectivityPulse, scenario_pulse

PULSES = [
    DirectivityPulse(0.6, 2.0),
    DirectivityPulse(1.2, 0.7, 0.0, 1.2),
    DirectivityPulse(0.3, 5.0, 3.0, 3.4),
]


@pytest.mark.parametrize("pulse", PULSES)
def test_acceleration_velocity_and_displacement_belong_together(pulse):
    time = np.linspace(-pulse.half_length, pulse.half_length, 20001)
    velocity = cumulative_trapezoid(pulse.acceleration(time), time, initial=0.0)
    displacement = cumulative_trapezoid(pulse.velocity(time), time, initial=0.0)
    assert np.abs(pulse.velocity(time) - velocity).max() < 1e-6 * np.abs(velocity).max()
    assert np.abs(pulse.displacement(time) - displacement).max() < 1e-6 * np.abs(displacement).max()


@pytest.mark.parametrize("pulse", PULSES)
def test_largest_velocity_is_the_one_asked_for_whatever_the_phase(pulse):
    time = np.linspace(-pulse.half_length, pulse.half_length, 200001)
    assert np.abs(pulse.velocity(time)).max() == pytest.approx(pulse.velocity_amplitude, rel=1e-8)


@pytest.mark.parametrize("pulse", PULSES)
def test_ground_stops_and_stays_displaced_as_stated(pulse):
    g = pulse.gamma
    stated = (
        pulse.envelope_amplitude
        * pulse.period
        * math.cos(pulse.phase)
        * math.sin(math.pi * g)
        / (2 * math.pi * (1 - g**2))
    )
    assert pulse.velocity(100.0) == 0 and pulse.acceleration(100.0) == 0
    assert pulse.displacement(100.0) == pytest.approx(stated, rel=1e-9, abs=1e-12)
    assert pulse.displacement(-100.0) == pytest.approx(0, abs=1e-15)


# by hand: M 6.5, R 10: -5.17 + 12.87 - 5.915 - 0.10 * 2.00243 = 1.58476, 38.44 cm/s; -2.87 + 3.055
# = 0.185, 1.531 s M 7.5, R 5: -5.17 + 13.86 - 6.86 - 0.10 * 1.40756 = 1.68924, 48.89 cm/s; -2.87 +
# 3.525 = 0.655, 4.519 s
@pytest.mark.parametrize(
    "magnitude, distance, velocity, period", [(6.5, 10.0, 0.3844, 1.531), (7.5, 5.0, 0.4889, 4.519)]
)
def test_scenario_gives_the_mean_pulse(magnitude, distance, velocity, period):
    pulse = scenario_pulse(magnitude, distance)
    assert (pulse.velocity_amplitude, pulse.period) == (
        pytest.approx(velocity, rel=3e-4),
        pytest.approx(period, rel=3e-4),
    )


@pytest.mark.parametrize(
    "arguments, said",
    [
        ((0.0, 1.0), "V_p = 0 m/s"),
        ((1.0, -1.0), "T_p = -1 s"),
        ((1.0, 1.0, math.inf), "nu = inf rad"),
        ((1.0, 1.0, 0.0, 1.0), "gamma = 1 "),
    ],
)
def test_impossible_pulse_is_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        DirectivityPulse(*arguments)
