"""Peak acceleration of a body as a limit state: closed forms of what it is, and how it is asked."""

import numpy as np
import pytest

from fecolumn.engines.peak_acceleration import HALF_WINDOW_S, peak_acceleration, window_s
from fecolumn.foundation.schema import InputError
from fecolumn.study.questions.limit import read_event, read_limit


@pytest.mark.parametrize("dt", [1e-3, 5e-4, 1e-4])
def test_a_body_that_moves_with_a_sine_has_its_peak_less_what_10_ms_even_out(dt):
    """The triangle makes it (sin x / x)^2 of itself, x = w h / 2, but for the sum over steps."""
    amplitude, frequency = 3.0, 2 * np.pi * 5.0
    time = dt * np.arange(round(1.0 / dt) + 1)
    ground = np.zeros((len(time), 3))
    ground[:, 0] = amplitude * np.sin(frequency * time)
    ground[:, 2] = 100.0  # vertical: does not count
    x = frequency * HALF_WINDOW_S / 2
    smooth = (np.sin(x) / x) ** 2
    found = peak_acceleration(time, np.zeros_like(ground), ground)
    assert found == pytest.approx(amplitude * smooth, rel=2e-3)
    # the same motion relative to a ground at rest
    moved = np.zeros_like(ground)
    moved[:, 1] = -amplitude / frequency**2 * np.sin(frequency * time)
    found = peak_acceleration(time, moved, np.zeros_like(ground))
    assert found == pytest.approx(amplitude * smooth, rel=2e-3)


@pytest.mark.parametrize("dt", [1e-3, 5e-4, 1e-4])
def test_a_change_of_velocity_at_once_is_that_over_5_ms_whatever_the_step(dt):
    time = dt * np.arange(round(0.2 / dt) + 1)
    moved = np.zeros((len(time), 3))
    moved[:, 0] = 0.3 * np.maximum(time - 0.1, 0.0)
    found = peak_acceleration(time, moved, np.zeros_like(moved))
    assert found == pytest.approx(0.3 / HALF_WINDOW_S, rel=1e-9)


@pytest.mark.parametrize(
    "dt, window",
    [(1e-4, 0.01), (1e-3, 0.01), (2e-3, 8e-3), (4e-3, 8e-3), (0.01, 0.02), (0.02, 0.04)],
)
def test_the_window_is_an_even_number_of_steps(dt, window):
    """A change of velocity at once is that over half of it."""
    time = dt * np.arange(round(0.4 / dt) + 1)
    assert window_s(time) == pytest.approx(window, rel=1e-9)
    moved = np.zeros((len(time), 3))
    moved[:, 0] = 0.3 * np.maximum(time - dt * round(0.2 / dt), 0.0)
    found = peak_acceleration(time, moved, np.zeros_like(moved))
    assert found == pytest.approx(0.3 / (window / 2), rel=1e-9)


def test_a_history_that_is_too_short_has_none():
    time = 1e-3 * np.arange(8)
    assert window_s(time) is None
    assert peak_acceleration(time, np.zeros((8, 3)), np.zeros((8, 3))) is None


@pytest.mark.parametrize("words", ["acceleration", "peak acceleration", "peak_acceleration"])
def test_limit_of_peak_acceleration_in_its_units(words):
    event = read_event(f"{words}[vase] > 0.5 g", "fecolumn design", "rigid")
    assert event.quantity == "acceleration" and event.threshold == pytest.approx(4.903325)
    summary = dict(
        overturned=False,
        engine="rigid",
        bodies=dict(
            vase=dict(tilt_max_rad=0.0, acceleration_max_m_s2=5.0),
            shelf=dict(tilt_max_rad=0.0, acceleration_max_m_s2=50.0),
        ),
    )
    assert event.happened(summary) and event.peak(summary) == 5.0
    assert not read_event("acceleration[vase] > 6 m/s2", "fecolumn design").happened(summary)
    assert read_event("acceleration > 6 m/s2", "fecolumn design").happened(summary)


def test_summaries_without_it_and_rocking_models_are_refused():
    event = read_event("acceleration > 1 g", "fecolumn design")
    old = dict(overturned=False, engine="rigid", bodies=dict(vase=dict(tilt_max_rad=0.0)))
    with pytest.raises(InputError, match="holds no acceleration"):
        event.happened(old)
    with pytest.raises(InputError, match="rocking models have no joints"):
        read_limit("P(acceleration > 2 g) < 0.1", "fecolumn design", "housner")
    with pytest.raises(InputError, match="'kg' is no unit of acceleration; must be one of g, m/s2"):
        read_limit("P(acceleration > 2 kg) < 0.1", "fecolumn design")
