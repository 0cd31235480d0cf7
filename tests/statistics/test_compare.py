"""Two ensembles: evidence words, medians, correlation, flips."""

import math

import numpy as np
import pytest
from scipy.stats import binom

from fecolumn.statistics.compare import compare, evidence, median_error
from fecolumn.statistics.correlation import correlation
from fecolumn.statistics.flips import contingency, flips, mcnemar


def pair(seed=3, n=115, shift=1.0):
    """Same motions in two settings: lognormal maxima [m] with 25 % scatter between the settings,
    overturned beyond 0.1 m.
    """
    rng = np.random.default_rng(seed)
    b = rng.lognormal(-2.5, 0.8, n)
    a = shift * b * rng.lognormal(0, 0.25, n)
    return a, a > 0.1, b, b > 0.1


def test_evidence_in_the_words_of_the_field():
    assert [evidence(p) for p in (0.0, 0.0099, 0.01, 0.049, 0.05, 0.1, 0.1001, 1.0)] == [
        "very strong",
        "very strong",
        "strong",
        "strong",
        "medium-weak",
        "medium-weak",
        "small or none",
        "small or none",
    ]
    with pytest.raises(ValueError, match="must lie in"):
        evidence(math.nan)


def test_an_ensemble_and_itself():
    a, over, *_ = pair()
    same = compare(a, over, a, over, paired=True)
    assert (same.ks, same.ks_p, same.paired_p, same.flips, same.mcnemar_p, same.e50) == (
        0,
        1,
        1,
        0,
        1,
        0,
    )
    assert (
        same.correlation == pytest.approx(1)
        and same.ks_evidence == "small or none"
        and same.p_lost_a == same.p_lost_b
    )
    assert same.ad_p > 0.99 and same.cvm_p > 0.99


def test_a_stronger_setting_is_told_by_every_figure():
    a, over_a, b, over_b = pair(shift=1.8)
    result = compare(a, over_a, b, over_b, paired=True)
    assert (
        max(result.ks_p, result.ad_p, result.cvm_p, result.paired_p, result.mcnemar_p) < 0.01
        and result.ks_evidence == "very strong"
    )
    assert (
        result.median_a_m > result.median_b_m
        and result.p_lost_a > result.p_lost_b
        and result.correlation > 0.5
    )


def test_medians_count_overturned_runs_and_may_lie_beyond_them():
    # u50 of a is 0.02 (three of five stand at or below 0.03), of b 0.04; e50 = 0.02 / 0.04
    result = compare(
        [0.01, 0.02, 0.02, 9, 9],
        [0, 0, 0, 1, 1],
        [0.01, 0.02, 0.04, 9, 9],
        [0, 0, 0, 1, 1],
        paired=False,
    )
    assert (result.median_a_m, result.median_b_m, result.e50) == (0.02, 0.04, 0.5)
    assert median_error(math.inf, 0.1) == math.inf and math.isnan(median_error(0.1, math.inf))


def test_unpaired_ensembles_have_no_pairwise_figures():
    a, over_a, b, over_b = pair()
    result = compare(a, over_a, b[:80], over_b[:80], paired=False)
    assert (result.n_a, result.n_b) == (115, 80)
    assert result.paired_p is result.correlation is result.flips is result.mcnemar_p is None
    with pytest.raises(ValueError, match="same motions"):
        compare(a, over_a, b[:80], over_b[:80], paired=True)


def test_order_of_the_ensembles_does_not_matter_for_the_tests():
    a, over_a, b, over_b = pair(shift=1.2)
    one, other = (
        compare(*order, paired=True) for order in ((a, over_a, b, over_b), (b, over_b, a, over_a))
    )
    assert (one.ks, one.ks_p, one.flips, one.mcnemar_p) == pytest.approx(
        (other.ks, other.ks_p, other.flips, other.mcnemar_p)
    )
    assert (one.ad, one.cvm, one.correlation) == pytest.approx(
        (other.ad, other.cvm, other.correlation)
    )
    assert (one.ad_p, one.cvm_p, one.paired_p) == pytest.approx(
        (other.ad_p, other.cvm_p, other.paired_p), abs=0.02
    )


def test_correlation_sets_overturned_and_larger_to_the_cap():
    a, over_a, b, over_b = (
        [0.05, 0.10, 7.0, 0.30],
        [0, 0, 1, 0],
        [0.06, math.nan, 0.2, 0.25],
        [0, 1, 0, 0],
    )
    expected = np.corrcoef([0.05, 0.10, 0.25, 0.25], [0.06, 0.25, 0.20, 0.25])[0, 1]
    assert correlation(a, over_a, b, over_b, 0.25) == pytest.approx(expected, abs=1e-14)
    # without a cap what overturned ties with the largest peak of all that stood: 0.30
    expected = np.corrcoef([0.05, 0.10, 0.30, 0.30], [0.06, 0.30, 0.20, 0.25])[0, 1]
    assert correlation(a, over_a, b, over_b) == pytest.approx(expected, abs=1e-14)
    assert math.isnan(correlation([1, 1], [1, 1], [1, 1], [1, 1]))
    assert math.isnan(correlation([1, 1], [0, 0], [0.1, 0.2], [0, 0]))


def test_flips_and_mcnemar_by_hand():
    # of 115 motions 60 stand and 40 overturn in both, 12 overturn in b alone, 3 in a alone: p = 2
    # P(Bin(15, 1/2) <= 3)
    outcomes = [(0, 0)] * 60 + [(1, 1)] * 40 + [(0, 1)] * 12 + [(1, 0)] * 3
    table = contingency(*np.array(outcomes, bool).T)
    np.testing.assert_array_equal(table, [[60, 12], [3, 40]])
    assert flips(table) == 15 and mcnemar(table) == pytest.approx(
        2 * binom.cdf(3, 15, 0.5), rel=1e-12
    )


def test_flips_that_cancel_leave_no_evidence():
    assert mcnemar([[50, 20], [20, 25]]) == 1.0 and mcnemar([[50, 0], [0, 65]]) == 1.0
