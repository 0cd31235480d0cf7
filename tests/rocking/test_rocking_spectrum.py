"""Planar rocking against closed forms: threshold, period, impacts, overturning pulses, and a solver
of another kind.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.spectrum import (
    larger_rocking_spectrum,
    rocking_spectrum,
    tilt_quantile,
)
from fecolumn.engines.rocking.swing import rock_one
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.engines.rocking.swing_motion import SWING_RATE, SWING_TILT, SWING_TIME
from fecolumn.motions.processing import rotate
from fecolumn.motions.pulses import Pulse, sample
from fecolumn.motions.record import GroundMotion

SLENDER = 0.05
P = 2.0
PERIOD = 2 * math.pi / P


def still(duration, dt=0.01):
    return GroundMotion(np.zeros((round(duration / dt) + 1, 3)), dt, "still", "made up")


def along_x(values, dt):
    return GroundMotion(np.column_stack([values, 0 * values, 0 * values]), dt, "test", "made up")


def rock(motion, slenderness, restitution=None, p=P, tilt=0.0):
    """Time, tilt, its rate (n,) each, and impact times of a block along x."""
    kept = housner_restitution(slenderness) if restitution is None else restitution
    ground, row = motion.acceleration[:, [0, 2]], row_of_block(slenderness, p, kept)
    states, impacts, _ = rock_one(ground, motion.dt, row, tilt=tilt)
    return states[:, SWING_TIME], states[:, SWING_TILT], states[:, SWING_RATE], impacts


# the slender form cos(alpha - theta) = 1 - (alpha - theta)^2/2 is off by alpha^2/6
@pytest.mark.parametrize("amplitude", [0.1, 0.5, 0.9])
def test_quarter_period_of_free_rocking_is_housners(amplitude):
    first = rock(still(3.0), SLENDER, tilt=amplitude * SLENDER)[-1][0]
    assert first == pytest.approx(math.acosh(1 / (1 - amplitude)) / P, rel=SLENDER**2 / 3)


@pytest.mark.parametrize("slenderness", [0.05, 0.3])
def test_every_impact_takes_the_same_share_of_the_energy(slenderness):
    time, tilt, _, impacts = rock(still(12.0, 1e-3), slenderness, tilt=0.7 * slenderness)
    peaks = [np.abs(tilt[(time > a) & (time < b)]).max() for a, b in zip(impacts[:4], impacts[1:5])]
    energy = math.cos(slenderness - 0.7 * slenderness) - math.cos(slenderness)
    for number, peak in enumerate(peaks, 1):
        expected = energy * housner_restitution(slenderness) ** (2 * number)
        assert math.cos(slenderness - peak) - math.cos(slenderness) == pytest.approx(
            expected, rel=1e-5
        )


def test_elastic_impacts_lose_no_energy():
    _, tilt, rate, impacts = rock(still(20.0), SLENDER, 1.0, tilt=0.8 * SLENDER)
    assert len(impacts) > 8
    energy = 0.5 * rate**2 + P**2 * np.cos(SLENDER - np.abs(tilt))
    lowest = P**2 * math.cos(SLENDER)
    assert energy - lowest == pytest.approx((energy[0] - lowest) * np.ones(len(energy)), rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize("slenderness", [0.05, 0.2, 0.6])
def test_block_uplifts_at_g_tan_alpha_and_not_below(slenderness):
    time = np.arange(0, 2, 0.01)
    for share, lifts in ((1 - 1e-6, False), (1 + 1e-3, True)):
        motion = along_x(share * GRAVITY * math.tan(slenderness) * np.sin(np.pi * time / 2), 0.01)
        assert (rocking_spectrum(motion, [1.0, 3.0], slenderness) > 0).tolist() == [lifts, lifts]


def test_uplift_is_located_between_samples():
    threshold = GRAVITY * math.tan(SLENDER)
    slope = 0.37 * threshold
    coarse, fine = (
        rock(along_x(slope * np.arange(0, 3.0 + dt / 2, dt), dt), SLENDER)[1][-1]
        for dt in (0.5, 0.0005)
    )
    assert coarse < 0
    assert coarse == pytest.approx(fine, rel=1e-6)


def test_ground_that_accelerates_towards_x_tilts_the_block_away_from_x():
    tilt = rock(along_x(np.full(30, 2 * GRAVITY * SLENDER), 0.01), SLENDER)[1]
    assert (tilt[1:] < 0).all()


# Shi et al. (1996), slender: (w/p) sin psi - cos psi = exp(-(p/w)(pi - psi)), a_p = g
# tan(alpha)/sin psi; the pulse starts when the block lifts off, which a half-sine from zero reaches
# at the same point: what is below the threshold moves nothing
@pytest.mark.parametrize("ratio", [1.0, 2.0, 4.0])
def test_half_sine_just_overturns_at_the_amplitude_of_shi(ratio):
    psi = brentq(
        lambda x: ratio * math.sin(x) - math.cos(x) - math.exp(-(math.pi - x) / ratio),
        1e-6,
        math.pi / 2,
    )
    slenderness = 0.01
    exact = GRAVITY * math.tan(slenderness) / math.sin(psi)
    period = 2 * math.pi / (ratio * P)

    def peak(share):
        return rocking_spectrum(
            sample(Pulse("half_sine", share * exact, period), period / 2000), [PERIOD], slenderness
        )[0]

    assert peak(0.998) < 1 and math.isinf(peak(1.002))


# Housner (1963): a rectangular pulse of duration T just overturns where cosh(p T) = 1 + 1 / (2 a (a
# - 1)), a = a_p/(g alpha)
@pytest.mark.parametrize("strength", [1.2, 2.0, 5.0])
def test_rectangular_pulse_just_overturns_at_the_duration_of_housner(strength):
    duration, slenderness = math.acosh(1 + 1 / (2 * strength * (strength - 1))) / P, 0.01

    def peak(share):
        pulse = Pulse("rectangular", strength * GRAVITY * math.tan(slenderness), share * duration)
        return rocking_spectrum(sample(pulse, share * duration / 2000), [PERIOD], slenderness)[0]

    assert peak(0.996) < 1 and math.isinf(peak(1.004))


# 1 + w/(6 p) is a straight line through Makris and Roussos' (2000) spectrum for w/p < pi; it lies
# above, by up to a tenth
@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 3.0])
def test_least_one_sine_that_overturns_lies_under_the_line_of_makris_and_roussos(ratio):
    slenderness, period = math.radians(10), 2 * math.pi / (ratio * P)

    def overturns(share):
        pulse = Pulse("one_sine", share * GRAVITY * math.tan(slenderness), period)
        return math.isinf(rocking_spectrum(sample(pulse, period / 500), [PERIOD], slenderness)[0])

    least = next(share for share in np.arange(1.0, 2.0, 0.01) if overturns(share))
    assert 0.9 < least / (1 + ratio / 6) < 1.0


def test_tilt_in_a_pulse_is_that_of_an_adaptive_solver_with_events():
    alpha, p = 0.2, 1.5
    pulse = Pulse("one_sine", 0.35 * GRAVITY, 1.0)
    motion = sample(pulse, 0.005, tail=4.0)
    clock = np.arange(len(motion.acceleration)) * motion.dt

    def ground(t):
        return np.interp(t, clock, motion.acceleration[:, 0])

    threshold = GRAVITY * math.tan(alpha)
    start, end = brentq(lambda t: ground(t) - threshold, 0, 0.25), clock[-1]
    state, side, times, tilts = [0.0, 0.0], -1.0, [], []
    for _ in range(5):

        def impact(t, y, side=side):
            return side * y[0]

        impact.terminal, impact.direction = True, -1
        done = solve_ivp(
            lambda t, y, side=side: [
                y[1],
                -(p**2)
                * (
                    math.sin(side * alpha - y[0])
                    + ground(t) / GRAVITY * math.cos(side * alpha - y[0])
                ),
            ],
            (start, end),
            [side * 1e-12, state[1]],
            events=impact,
            rtol=1e-9,
            atol=1e-12,
            max_step=0.005,
        )
        tilts.append(np.abs(done.y[0]).max())
        if done.status == 0:
            break
        start, state, side = done.t[-1], [0.0, housner_restitution(alpha) * done.y[1, -1]], -side
        times.append(start)
    _, tilt, _, impacts = rock(motion, alpha, p=p)
    assert len(times) >= 2 and impacts[: len(times)] == pytest.approx(times, abs=5e-5)
    assert np.abs(tilt).max() == pytest.approx(max(tilts), rel=1e-5)
    assert rocking_spectrum(motion, [2 * math.pi / p], alpha)[0] == pytest.approx(
        max(tilts) / alpha, rel=1e-5
    )


def test_what_happens_after_the_motions_end_counts():
    pulse = Pulse("one_sine", 0.5 * GRAVITY, 0.5)
    short, long = sample(pulse, 0.001), sample(pulse, 0.001, tail=30.0)
    periods = np.linspace(1.0, 8.0, 15)
    for alpha in (0.1, 0.2):
        assert rocking_spectrum(short, periods, alpha) == pytest.approx(
            rocking_spectrum(long, periods, alpha), rel=2e-6
        )


def test_larger_blocks_tilt_less_in_the_same_pulse():
    spectrum = rocking_spectrum(
        sample(Pulse("symmetric_ricker", 0.6 * GRAVITY, 0.5), 0.002),
        [3.0, 4.0, 6.0, 9.0],
        [0.2, 0.25],
    )
    assert spectrum.shape == (2, 4) and np.isfinite(spectrum).all()
    assert (np.diff(spectrum, axis=1) < 0).all()


def test_component_follows_the_angle():
    motion = sample(Pulse("one_sine", 0.4 * GRAVITY, 0.6), 0.002)
    turned = rotate(motion, 40.0)
    along, across, back = (
        rocking_spectrum(turned, [4.0], 0.2, angle_deg=angle)[0] for angle in (40.0, 130.0, -40.0)
    )
    assert along == pytest.approx(rocking_spectrum(motion, [4.0], 0.2)[0], rel=1e-9)
    assert across == 0 and back == 0


def test_larger_of_two_directions_is_that_of_the_component_that_tilts_more():
    weak, strong = (sample(Pulse("one_sine", share * GRAVITY, 0.6), 0.002) for share in (0.25, 0.4))
    both = GroundMotion(
        np.column_stack(
            [weak.acceleration[:, 0], strong.acceleration[:, 0], 0 * strong.acceleration[:, 0]]
        ),
        0.002,
        "",
        "",
    )
    periods = [1.0, 3.0, 5.0]
    alone = rocking_spectrum(strong, periods, 0.2)
    assert math.isinf(alone[0]) and 0 < alone[2] < 1
    for motion in (both, rotate(both, 90.0), rotate(strong, 90.0), strong):
        assert larger_rocking_spectrum(motion, periods, 0.2) == pytest.approx(alone, rel=1e-9)
    assert larger_rocking_spectrum(still(1.0), periods, 0.2).tolist() == [0, 0, 0]


def test_quantiles_count_overturned_motions_as_the_largest():
    peaks = np.array([[0.1, math.inf], [0.4, 0.3], [math.inf, math.inf], [0.2, 0.1]])
    assert [tilt_quantile(peaks, share).tolist() for share in (0.25, 0.5, 0.75, 1.0)] == [
        [0.1, 0.1],
        [0.2, 0.3],
        [0.4, math.inf],
        [math.inf, math.inf],
    ]


def test_block_at_the_very_threshold_neither_hangs_nor_falls():
    motion = along_x(np.full(500, np.nextafter(GRAVITY * math.tan(0.2), 1e9)), 0.01)
    assert rocking_spectrum(motion, [2.0], 0.2)[0] < 1e-6


@pytest.mark.parametrize(
    "arguments, said",
    [
        (([0.0], 0.2), "period 2 pi/p = 0 s"),
        (([1.0], 0.0), "slenderness = 0 rad"),
        (([1.0], 1.6), "slenderness = 1.6 rad"),
        (([1.0], 0.2, 1.1), "restitution = 1.1 must lie in"),
    ],
)
def test_impossible_block_is_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        rocking_spectrum(still(1.0), *arguments)
