"""Processing against closed forms: sines, pulses and band-limited noise."""

import math
import warnings

import numpy as np
import pytest
from record_files import motion_hash

from fecolumn.motions import processing
from fecolumn.motions.record import GRAVITY, GroundMotion


def motion_of(x, y=0.0, z=0.0, dt=0.01):
    x = np.asarray(x, dtype=float)
    return GroundMotion(
        np.column_stack([x, np.broadcast_to(y, x.shape), np.broadcast_to(z, x.shape)]),
        dt,
        "test",
        "made up",
    )


def tones(time):
    """Three components below 20 Hz under a smooth envelope that is at rest at 0 s and 20 s."""
    envelope = np.sin(math.pi * time / 20) ** 2
    bands = ((1.3, 17.7), (4.1, 9.2), (0.7, 19.1))
    return np.column_stack(
        [envelope * sum(np.sin(2 * math.pi * f * time + f) for f in band) for band in bands]
    )


def band_limited(dt):
    return GroundMotion(tones(np.arange(round(20 / dt) + 1) * dt), dt, "tones", "made up")


def test_quarter_turn_brings_x_to_y_and_y_to_minus_x():
    turned = processing.rotate(motion_of([1.0, 2.0], 3.0, 5.0), 90)
    assert turned.acceleration == pytest.approx(np.array([[-3, 1, 5], [-3, 2, 5]]))


def test_rotation_keeps_the_horizontal_intensity():
    motion = band_limited(0.01)
    turned = processing.rotate(motion, 33.3)
    before, after = (processing.arias_intensity(m)[-1, :2].sum() for m in (motion, turned))
    assert after == pytest.approx(before, rel=1e-12)


def test_sine_has_the_closed_form_velocity_displacement_and_arias_intensity():
    dt, w = 1e-4, 2 * math.pi
    motion = motion_of(np.cos(w * np.arange(20001) * dt), dt=dt)
    velocity, displacement = processing.integrate(motion)
    assert np.abs(velocity).max(axis=0) == pytest.approx([1 / w, 0, 0], rel=1e-6)
    assert np.abs(displacement).max(axis=0) == pytest.approx([2 / w**2, 0, 0], rel=1e-6)
    # int cos^2 over two periods of 1 s is 1
    assert processing.arias_intensity(motion)[-1, 0] == pytest.approx(
        math.pi / (2 * GRAVITY), rel=1e-6
    )


def test_compression_scales_pgv_by_the_factor_and_pgd_by_its_square():
    motion = band_limited(0.005)
    compressed = processing.scale_time(motion, 0.5)
    assert np.array_equal(compressed.pga, motion.pga) and compressed.duration == 10
    for before, after, factor in zip(
        processing.integrate(motion), processing.integrate(compressed), (0.5, 0.25)
    ):
        assert np.abs(after).max(axis=0) == pytest.approx(
            factor * np.abs(before).max(axis=0), rel=1e-12
        )


@pytest.mark.parametrize(
    "old, new",
    [
        (0.01, 0.001),
        (0.005, 0.02),
        (0.005, 0.0047),
        (0.02, 0.01 / 3),
        (0.0024, 0.001),
        (0.02, 0.01 / math.sqrt(3)),
    ],
)
def test_band_limited_motion_is_reproduced(old, new):
    motion = band_limited(old)
    resampled = processing.resample(motion, new)
    time = np.arange(len(resampled.acceleration)) * new
    assert resampled.dt == new and motion.duration - new < time[-1] < motion.duration + 1e-3 * new
    assert np.abs(resampled.acceleration - tones(time)).max() < 1e-3


@pytest.mark.parametrize("new", [0.001, 0.004, 0.02])
def test_band_limited_motion_keeps_its_arias_intensity(new):
    motion = band_limited(0.005)
    before, after = (
        processing.arias_intensity(m)[-1] for m in (motion, processing.resample(motion, new))
    )
    assert after == pytest.approx(before, rel=0.01)


def test_equal_step_is_the_identity():
    motion = band_limited(0.01)
    same = processing.resample(motion, 0.01)
    assert motion_hash(same) == motion_hash(motion)
    assert np.array_equal(
        processing.resample(processing.scale_time(motion, 0.3), 0.003).acceleration,
        motion.acceleration,
    )


def test_sine_above_the_new_nyquist_frequency_vanishes_with_a_warning():
    time = np.arange(8001) * 0.0025
    motion = motion_of(np.sin(2 * math.pi * 60 * time) * np.sin(math.pi * time / 20), dt=0.0025)
    with pytest.warns(
        processing.AliasingWarning,
        match=r"100 % of the Arias intensity lies above 25 Hz.*dt = 0.02 s",
    ):
        coarse = processing.resample(motion, 0.02)
    # every eighth sample alone would be a sine of 10 Hz and full size
    assert np.abs(motion.acceleration[::8]).max() > 0.9 and np.abs(coarse.acceleration).max() < 1e-3


def test_little_above_the_nyquist_frequency_is_no_warning():
    time = np.arange(8001) * 0.0025
    motion = motion_of(
        np.sin(2 * math.pi * 5 * time) + 0.2 * np.sin(2 * math.pi * 60 * time), dt=0.0025
    )
    assert processing.energy_above(motion, 25) == pytest.approx(0.04 / 1.04, rel=0.01)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        processing.resample(motion, 0.02)


def test_share_above_a_frequency_counts_the_mean_as_below():
    # 1 + sin: mean square of 1 below, of 1/2 above
    motion = motion_of(1 + np.sin(2 * math.pi * 10 * np.arange(2000) * 0.01))
    assert processing.energy_above(motion, 5) == pytest.approx(1 / 3, rel=1e-9)


@pytest.mark.parametrize("new", [0.003, 0.02])
def test_ends_do_not_ring(new):
    ramp = motion_of(np.linspace(2.0, 3.0, 1001), -1.0)
    resampled = processing.resample(ramp, new)
    time = np.arange(len(resampled.acceleration)) * new
    assert np.allclose(
        resampled.acceleration,
        np.column_stack([2 + time / 10, np.full_like(time, -1), np.zeros_like(time)]),
        atol=1e-3,
    )


@pytest.mark.parametrize(
    "ratio, n_steps",
    [
        (5.0, 8000),
        (math.sqrt(2), 20000),
        (0.1 / math.sqrt(3), 18000),
        (2.4000001, 16392),
        (0.01, 300),
    ],
)
def test_last_sample_is_off_by_less_than_a_thousandth_of_either_step(ratio, n_steps):
    fraction = processing._ratio(ratio, n_steps)
    off_in_new_steps = n_steps * abs(ratio / fraction - 1) * ratio
    assert max(off_in_new_steps, off_in_new_steps / ratio) < 1e-3


def test_step_longer_than_the_motion_is_refused():
    with pytest.raises(ValueError, match="longer than the motion"):
        processing.resample(motion_of(np.ones(5)), 0.05)


def test_strong_part_of_a_steady_sine_is_that_share_of_its_length():
    motion = motion_of(np.sin(2 * math.pi * 5 * np.arange(2001) * 0.01))
    part = processing.strong_part(motion, (0.25, 0.75))
    taper = math.ceil(0.02 * 1000)
    assert len(part.acceleration) == pytest.approx(1001 + 2 * taper, abs=20)
    offset = next(
        i
        for i in range(400, 600)
        if np.array_equal(motion.acceleration[i + 30 : i + 1000], part.acceleration[30:1000])
    )
    assert offset + taper == pytest.approx(500, abs=10)
    led_in, recorded = (
        part.acceleration[:, 0],
        motion.acceleration[offset : offset + len(part.acceleration), 0],
    )
    kept = np.isclose(led_in, recorded, rtol=1e-12, atol=0)
    assert not kept[2:taper].all() and kept[taper + 1 : -taper - 1].all()
    assert np.abs(led_in[:3]).max() < 0.03 and np.abs(led_in[-3:]).max() < 0.03


def test_strong_part_is_judged_by_both_horizontal_components_and_not_by_the_vertical():
    x, y, z = np.zeros((3, 1000))
    x[100:200], y[800:900], z[:50] = 1, 1, 50
    part = processing.strong_part(motion_of(x, y, z), (0.01, 0.99))
    assert part.acceleration[:, :2].sum(axis=0) == pytest.approx([100, 100], abs=3)
    assert not part.acceleration[:, 2].any() and len(part.acceleration) == pytest.approx(
        800 * 1.04, abs=5
    )


def test_whole_motion_is_not_cut_and_its_ends_are_not_tapered():
    motion = motion_of(np.ones(50))
    assert np.array_equal(
        processing.strong_part(motion, (0.0, 1.0)).acceleration, motion.acceleration
    )
    start_kept = processing.strong_part(motion, (0.0, 0.5)).acceleration
    assert start_kept[0, 0] == 1 and start_kept[-1, 0] < 1 and len(start_kept) < 30


def test_motion_without_horizontal_part_is_not_cut():
    motion = motion_of(np.zeros(50), 0.0, 1.0)
    assert processing.strong_part(motion, (0.1, 0.9)) is motion
