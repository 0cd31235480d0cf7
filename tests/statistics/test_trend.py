import math

import numpy as np
import pytest

from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.statistics.equivalence import (
    detectable_distance,
    distance_bound,
    motions_needed,
    score_bound,
    upper_bound,
)
from fecolumn.statistics.holm import holm
from fecolumn.statistics.records import by_record
from fecolumn.statistics.sensitivity import sensitivity
from fecolumn.statistics.trend import trend
from fecolumn.statistics.two_sample import kolmogorov_smirnov

STANDING = np.zeros((5, 40), bool)


def test_peaks_that_rise_at_each_level_have_tau_one():
    u = np.arange(1.0, 6)[:, None] + np.random.default_rng(1).uniform(0, 0.5, (1, 40))
    found = trend(u, STANDING)
    assert found.tau == found.tau_low == found.tau_high == 1 and (found.rising, found.falling) == (
        40,
        0,
    )
    assert found.p < 1e-6


def test_overturning_is_the_largest_peak_and_ties_with_overturning():
    # stands, overturns, overturns: two of three pairs of levels rise
    found = trend(
        [[0.1] * 8, [0.05] * 8, [0.2] * 8], np.repeat([[False], [True], [True]], 8, axis=1)
    )
    assert found.tau == pytest.approx(2 / 3)
    assert trend([[0.1] * 8] * 3, np.ones((3, 8), bool)).tau == 0


@pytest.mark.long
@pytest.mark.parametrize("levels", [2, 5])
def test_without_a_trend_it_is_found_no_oftener_than_its_level(levels):
    rng = np.random.default_rng(2)
    p = [trend(rng.normal(size=(levels, 60)), np.zeros((levels, 60), bool)).p for _ in range(400)]
    # 400 trials at 5 %: 20 +- 4.4; the sign test is discrete and rejects less often
    assert 4 <= sum(one < 0.05 for one in p) <= 33
    assert 0.3 < np.mean(p) < 0.7


def test_a_trend_needs_two_levels():
    with pytest.raises(ValueError, match="two levels"):
        trend([[0.1, 0.2]], [[False, False]])


def test_holm_corrects_the_smallest_most_and_keeps_the_order():
    # Holm (1979): 4 x 0.01, 3 x 0.02 -> 0.06, 2 x 0.03 -> 0.06, 1 x 0.5
    assert holm([0.03, 0.01, 0.5, 0.02]) == pytest.approx([0.06, 0.04, 0.5, 0.06])


def test_distance_of_two_settings_is_that_of_their_cdfs():
    none = np.zeros(4, bool)
    distance, bound = distance_bound([1, 2, 3, 4.0], none, [3, 4, 5, 6.0], none)
    assert distance == 0.5 < bound <= 1
    # all stand below 1 in a, all overturn in b
    assert distance_bound([1.0] * 4, none, [1.0] * 4, ~none)[0] == 1


@pytest.mark.parametrize("shift", [0.0, 0.3, 1.2])
def test_bound_covers_the_true_distance(shift):
    # standard normal against one shifted: the true largest distance is 2 Phi(shift/2) - 1, and
    # peaks above 1 are overturns
    from statistics import NormalDist

    rng, true, below = np.random.default_rng(3), 2 * NormalDist().cdf(shift / 2) - 1, 0
    for _ in range(300):
        common = rng.normal(size=115) * 0.7
        a, b = (common + 0.7141428 * rng.normal(size=115) + s for s in (0, shift))
        below += distance_bound(a, a > 1, b, b > 1)[1] < true
    assert below / 300 < 0.08
    if shift > 1:  # far apart, where the bound is hardly conservative
        assert below > 0


def test_an_axis_without_effect_stays_within_chance_and_one_with_effect_does_not():
    rng = np.random.default_rng(4)
    common = rng.normal(size=80)
    low, high = (np.exp(common + 0.5 * rng.normal(size=(3, 80))) for _ in range(2))
    nothing = sensitivity(low, low > 3, high, high > 3)
    assert nothing.distance < 1.2 * nothing.chance and nothing.change_low < 0 < nothing.change_high
    higher = 2 * high
    effect = sensitivity(low, low > 3, higher, higher > 3)
    assert effect.distance > 1.5 * effect.chance and effect.distance_low > effect.chance
    assert (
        effect.change == pytest.approx((higher > 3).mean() - (low > 3).mean())
        and effect.change_low > 0
    )


@pytest.mark.parametrize("n, shift", [(6, 0.0), (20, 0.0), (20, 0.4), (40, 0.05)])
def test_an_effect_lies_within_its_own_interval(n, shift):
    """Samples drawn anew have larger largest distances than the data: their percentiles left the
    estimate out.
    """
    for seed in range(8):
        rng = np.random.default_rng(seed)
        common = rng.normal(size=n)
        low, high = (np.exp(common + 0.5 * rng.normal(size=(2, n)) + s) for s in (0, shift))
        it = sensitivity(low, low > 2, high, high > 2, resamples=200)
        assert 0 <= it.distance_low <= it.distance <= it.distance_high <= 1
        assert -1 <= it.change_low <= it.change <= it.change_high <= 1


def test_no_motion_that_flips_leaves_an_interval_of_the_change_open():
    u = np.linspace(0.1, 1, 8)[None]
    it = sensitivity(u, u > 2, u, u > 2)
    assert (
        it.distance == it.change == 0
        and it.change_low < 0 < it.change_high
        and it.distance_high > 0.1
    )


@pytest.mark.parametrize("shift", [0.0, 0.5, 1.5])
def test_the_true_distance_lies_in_the_interval_in_95_of_100_ensembles_at_least(shift):
    from statistics import NormalDist

    rng, true, below, above = np.random.default_rng(5), 2 * NormalDist().cdf(shift / 2) - 1, 0, 0
    for _ in range(200):
        common = rng.normal(size=(1, 60)) * 0.7
        low, high = (common + 0.7141428 * rng.normal(size=(1, 60)) + s for s in (0, shift))
        it = sensitivity(low, low > 1, high, high > 1, resamples=150)
        below, above = below + (true < it.distance_low), above + (true > it.distance_high)
    allowed = 0.025 + 2 * (0.025 * 0.975 / 200) ** 0.5  # 2.5 % and twice the error of 200 ensembles
    assert below / 200 < allowed and above / 200 < allowed


def test_a_distance_that_few_motions_hide_and_the_number_that_shows_it():
    assert detectable_distance(40) == pytest.approx(0.304, abs=5e-4)  # 1.358 sqrt(2 / 40)
    assert motions_needed(0.1) == 369 and motions_needed(detectable_distance(115)) == 115
    rng, seen = np.random.default_rng(6), 0
    for _ in range(300):
        a, b = rng.normal(size=(2, 40))
        seen += kolmogorov_smirnov(a, b).statistic > detectable_distance(40)
    assert seen / 300 < 0.08


def test_a_peak_that_is_not_known_is_refused_and_not_taken_as_lost():
    u, lost = np.array([[1.0, 2.0, 3.0], [2.0, np.nan, 4.0]]), np.zeros((2, 3), bool)
    for ask in (
        lambda: trend(u, lost),
        lambda: sensitivity(u[:1], lost[:1], u[1:], lost[1:]),
        lambda: distance_bound(u[0], lost[0], u[1], lost[1]),
    ):
        with pytest.raises(ValueError, match="neither standing nor lost"):
            ask()


@pytest.mark.parametrize("flips", [(0.101, 0.0), (0.111, 0.01), (0.2, 0.099)])
@pytest.mark.parametrize("n", [40, 115])
def test_bound_covers_the_true_distance_where_few_motions_differ(n, flips):
    """Also where all that differ do so one way: a bound from the error of the mean misses 8 % of
    those at n = 40.
    """
    random, misses, runs = np.random.default_rng(3), 0, 2000
    for u in random.random((runs, n, 1)):
        difference = np.where(u < flips[0], 1.0, np.where(u < sum(flips), -1.0, 0.0))
        misses += upper_bound(difference, 0.95) < flips[0] - flips[1]
    assert misses / runs < 0.05 + 3 * np.sqrt(0.05 * 0.95 / runs)


@pytest.mark.long
@pytest.mark.parametrize("groups", [80, 160])
def test_records_that_differ_in_part_do_not_make_the_bound_too_small(groups):
    """Flips one way of a tenth of the records, a fifth of them in one of two motions."""
    random, misses, runs = np.random.default_rng(5), 0, 2000
    records = np.repeat(np.arange(groups), 2).astype(str)
    share = 0.1 / 0.9  # of records with a flip: the mean difference is 0.1
    for _ in range(runs):
        flips = random.random(groups) < share
        partly = random.random(groups) < 0.2
        both = np.stack([flips, flips & ~partly], axis=1).ravel()[:, None].astype(float)
        misses += upper_bound(by_record(both, tuple(records)), 0.95) < share * 0.9
    assert misses / runs < 0.05 + 3 * np.sqrt(0.05 * 0.95 / runs)


def test_a_motion_that_differs_does_not_lower_the_bound():
    records = tuple(f"r{n // 2}" for n in range(88))
    none = np.zeros((88, 1))
    one = none.copy()
    one[0] = 1.0
    assert upper_bound(by_record(one, records), 0.95) > upper_bound(by_record(none, records), 0.95)


def test_score_bound_of_flips_one_way_is_wilsons():
    for k, n in ((0, 40), (3, 50), (20, 115)):
        high = proportion_interval(k, n, confidence=0.9)[1]
        assert score_bound(np.array([k]), np.array([0]), n, 0.95)[0] == pytest.approx(
            high, rel=1e-9
        )
    # as often one way as the other: the difference that Tango's statistic does not reject
    b, c, n, z = 12, 9, 115, 1.6448536269514722
    found = float(score_bound(np.array([b]), np.array([c]), n, 0.95)[0])
    lean = 2 * n - b + c
    second = (-b - c + lean * found, -c * found * (1 - found))
    alone = (math.sqrt(second[0] ** 2 - 8 * n * second[1]) - second[0]) / (4 * n)
    assert (b - c - n * found) / math.sqrt(n * (2 * alone + found * (1 - found))) == pytest.approx(
        -z, rel=1e-9
    )
