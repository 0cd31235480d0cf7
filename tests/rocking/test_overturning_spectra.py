"""Pulses that overturn a block: bands, gaps and closed forms."""

import math

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.overturning import (
    Band,
    critical_tilt_rate,
    half_sine_overturning,
    linear_overturning,
    overturning_bands,
    pulse_outcomes,
    slenderness_factor,
)
from fecolumn.engines.rocking.swing import rock_all, rock_one
from fecolumn.engines.rocking.swing_equations import row_of_block

TEN = math.radians(10)


def test_one_sine_has_a_safe_gap_between_overturning_with_one_impact_and_without():
    bands = overturning_bands("one_sine", 6.0, TEN, lowest=3.0, highest=11.0, points=161)
    assert [band.impacts for band in bands] == [1, 0] and math.isinf(bands[1].high)
    assert [bands[0].low, bands[0].high, bands[1].low] == pytest.approx(
        [3.932, 9.04, 9.56], rel=1e-3
    )
    # a step to each side of every boundary
    edges = np.array([bands[0].low, bands[0].high, bands[1].low])
    assert pulse_outcomes("one_sine", 6.0, edges * (1 + 1e-5), TEN).tolist() == [1, -1, 0]
    assert pulse_outcomes("one_sine", 6.0, edges * (1 - 1e-5), TEN).tolist() == [-1, 1, -1]


# Computed with scipy's solve_ivp, events and rtol 1e-10: islands of the one-cosine pulse, whose
# acceleration jumps
@pytest.mark.parametrize(
    "frequency, safe, falls, impacts",
    [
        (1.25, 1.1525, 1.154, 4),
        (1.25, 2.477, 2.48, 2),
        (1.0, 1.9705, 1.9715, 2),
        (1.5, 1.29, 1.2915, 1),
        (4.25, 3.435, 3.445, 1),
        (4.5, 4.68, 4.69, 1),
    ],
)
def test_islands_of_the_one_cosine_lie_where_an_adaptive_solver_finds_them(
    frequency, safe, falls, impacts
):
    assert pulse_outcomes("one_cosine", frequency, [safe, falls], TEN).tolist() == [-1, impacts]


@pytest.mark.parametrize("shape", ["symmetric_ricker", "antisymmetric_ricker"])
def test_ricker_wavelets_overturn_after_impacts_above_their_islands_and_the_one_sine_does_not(
    shape,
):
    several = [
        band
        for band in overturning_bands(shape, 1.0, TEN, lowest=2.0, highest=6.0, points=161)
        if band.impacts > 1
    ]
    assert several and all(band.low > 2 for band in several)
    assert not [
        band
        for band in overturning_bands("one_sine", 1.0, TEN, lowest=2.0, highest=6.0, points=161)
        if band.impacts > 1
    ]


def test_linear_formula_is_not_conservative_at_ten_degrees():
    for ratio, below in ((1.0, 0.06), (2.0, 0.09), (3.0, 0.08)):
        least = overturning_bands("one_sine", ratio, TEN, highest=2.0, points=201)[0].low
        assert least / linear_overturning("one_sine", ratio) == pytest.approx(1 - below, abs=0.006)


def test_band_that_leaves_the_range_has_no_upper_end():
    bands = overturning_bands("one_sine", 2.0, TEN, lowest=1.0, highest=1.5, points=51)
    assert bands[-1] == Band(bands[-1].low, math.inf, 1)
    assert overturning_bands("one_cosine", 8.0, TEN, highest=3.0, points=21) == []


def rectangular_overturning(duration):
    """Housner (1963): cosh(p T) = 1 + 1/(2 a (a - 1))."""
    return 0.5 + math.sqrt(0.25 + 0.5 / (math.cosh(duration) - 1))


def test_half_sine_needs_more_than_the_rectangular_pulse_of_its_length_and_less_at_low_frequency():
    for ratio in (0.5, 2.0, 6.0):
        assert half_sine_overturning(ratio) > rectangular_overturning(math.pi / ratio) > 1
    assert half_sine_overturning(1e-2) == pytest.approx(1.0, abs=1e-3)


def test_column_of_the_design_slenderness_stands_a_rectangular_pulse():
    """Makris and Vassiliou's formula and Housner's exact one meet where p T is small."""
    for duration in (0.05, 0.2, 1.0):
        amplitude = 1 / slenderness_factor(duration)  # over g tan(alpha)
        assert amplitude == pytest.approx((1 + duration) / duration)
    assert rectangular_overturning(0.05) * 0.05 == pytest.approx(1.0, abs=0.05)
    assert slenderness_factor(0.0) == 0


def test_verge_is_reached_from_upright_at_its_velocity_and_not_below():
    alpha = 0.3
    ground, row = np.zeros((2, 2)), row_of_block(alpha, 1.0, 0.9)
    for share, falls in ((1 - 1e-6, False), (1 + 1e-6, True)):
        assert (
            math.isinf(
                rock_one(ground, 0.01, row, tilt_rate=share * critical_tilt_rate(alpha))[2][0]
            )
            == falls
        )


def test_many_analyses_at_once_are_the_same_as_one_by_one_whatever_the_threads():
    rng = np.random.default_rng(2)
    motions = [rng.normal(size=(300, 2)) * 3, rng.normal(size=(200, 2)) * 3]
    rows = np.array(
        [row_of_block(alpha, p, 0.93) for alpha, p in rng.uniform([0.1, 1.0], [0.3, 5.0], (200, 2))]
    )
    which, scales = rng.integers(0, 2, 200), rng.uniform(0.5, 2.0, 200)
    together = rock_all(motions, [0.01, 0.02], which, scales, rows, threads=3)
    alone = np.array(
        [
            rock_all([motions[i]], [0.01, 0.02][i], [0], [scale], row[None])[0]
            for i, scale, row in zip(which, scales, rows)
        ]
    )
    assert np.array_equal(together, alone)
    assert 10 < np.isinf(together[:, 0]).sum() < 190


def test_gravity_is_one_number():
    from fecolumn.case import sections as case

    assert GRAVITY == case.GRAVITY
