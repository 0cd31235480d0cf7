import numpy as np
import pytest

from fecolumn.statistics.equivalence import distance_bound
from fecolumn.statistics.holm import holm
from fecolumn.statistics.sensitivity import sensitivity
from fecolumn.statistics.trend import trend

STANDING = np.zeros((5, 40), bool)


def test_peaks_that_rise_at_each_level_have_tau_one():
    u = np.arange(1.0, 6)[:, None] + np.random.default_rng(1).uniform(0, 0.5, (1, 40))
    found = trend(u, STANDING)
    assert found.tau == found.tau_low == found.tau_high == 1 and (found.rising, found.falling) == (40, 0)
    assert found.p < 1e-6


def test_overturning_is_the_largest_peak_and_ties_with_overturning():
    # stands, overturns, overturns: two of three pairs of levels rise
    found = trend([[0.1] * 8, [0.05] * 8, [0.2] * 8], np.repeat([[False], [True], [True]], 8, axis=1))
    assert found.tau == pytest.approx(2 / 3)
    assert trend([[0.1] * 8] * 3, np.ones((3, 8), bool)).tau == 0


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
    # standard normal against one shifted: the true largest distance is 2 Phi(shift/2) - 1, and peaks above 1 are overturns
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
    assert effect.change == pytest.approx((higher > 3).mean() - (low > 3).mean()) and effect.change_low > 0
