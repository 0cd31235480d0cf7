"""Two-sample tests: scipy's where there are no ties, and p-values that mean what they say whatever
share overturns.
"""

import itertools
import math
import warnings

import numpy as np
import pytest
from ensembles import assert_uniform, censor
from scipy import stats

from fecolumn.statistics.two_sample import (
    anderson_darling,
    cramer_von_mises,
    kolmogorov_smirnov,
    paired_kolmogorov_smirnov,
)

SHARES = pytest.mark.parametrize("share", [0.0, 0.4, 0.9])


def samples(seed, n=40, m=33, share=0.0):
    rng = np.random.default_rng(seed)
    return censor(rng.normal(size=n), share), censor(rng.normal(0.4, 1, m), share)


@pytest.mark.parametrize("n, m", [(40, 33), (115, 115), (1, 5)])
def test_kolmogorov_smirnov_without_overturns_is_scipys_exact_one(n, m):
    a, b = samples(1, n, m)
    ours, theirs = kolmogorov_smirnov(a, b), stats.ks_2samp(a, b, method="exact")
    assert (ours.statistic, ours.p) == pytest.approx((theirs.statistic, theirs.pvalue), rel=1e-9)


def test_kolmogorov_smirnov_with_overturns_counts_all_orders():
    """All 252 ways to deal ten runs, six of them overturned, to two settings, counted one by
    one.
    """
    pooled = np.array([1, 2, 3, 4] + [math.inf] * 6)
    a, b = pooled[[0, 1, 2, 4, 5]], pooled[[3, 6, 7, 8, 9]]

    def distance(chosen):
        is_a = np.isin(np.arange(10), chosen)
        return max(abs(np.mean(pooled[is_a] <= u) - np.mean(pooled[~is_a] <= u)) for u in pooled)

    deals = [distance(chosen) for chosen in itertools.combinations(range(10), 5)]
    expected = np.mean(np.array(deals) >= distance((0, 1, 2, 4, 5)) - 1e-12)
    result = kolmogorov_smirnov(a, b)
    assert result.statistic == pytest.approx(0.6) and result.p == pytest.approx(expected, rel=1e-12)
    # made for continuous variables: too large here
    assert result.p < stats.ks_2samp(a, b, method="exact").pvalue


def test_statistics_without_overturns_are_scipys():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # scipy's p is capped
        theirs = [stats.anderson_ksamp(samples(seed)).statistic for seed in (1, 2, 3)]
    ours = [anderson_darling(*samples(seed), resamples=9).statistic for seed in (1, 2, 3)]
    # scipy shows (A2 - 1) / sigma, sigma a constant of the sizes
    assert np.ptp((np.array(ours) - 1) / theirs) < 1e-12
    a, b = samples(4)
    assert cramer_von_mises(a, b, 9).statistic == pytest.approx(
        stats.cramervonmises_2samp(a, b).statistic, rel=1e-12
    )


def test_anderson_darling_with_overturns_is_scipys_midrank_version():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = [stats.anderson_ksamp(samples(seed, share=0.5)).statistic for seed in (1, 2, 3)]
    ours = [
        anderson_darling(*samples(seed, share=0.5), resamples=9).statistic for seed in (1, 2, 3)
    ]
    assert np.ptp((np.array(ours) - 1) / theirs) < 1e-12


def test_cramer_von_mises_is_the_mean_over_all_orders_of_overturned_runs():
    a, b = samples(5, 12, 15, share=0.5)
    rng, orders = np.random.default_rng(0), []
    for _ in range(4000):
        x, y = (np.where(np.isinf(u), 100 + rng.random(u.size), u) for u in (a, b))
        orders.append(stats.cramervonmises_2samp(x, y, method="asymptotic").statistic)
    assert cramer_von_mises(a, b, 9).statistic == pytest.approx(
        np.mean(orders), abs=4 * np.std(orders) / math.sqrt(4000)
    )


def test_permutation_p_without_overturns_is_scipys():
    a, b = samples(3)
    assert cramer_von_mises(a, b).p == pytest.approx(
        stats.cramervonmises_2samp(a, b, method="asymptotic").pvalue, abs=0.015
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        expected = stats.anderson_ksamp([a, b]).significance_level
    assert 0.001 < expected < 0.25 and anderson_darling(a, b).p == pytest.approx(expected, abs=0.02)


@pytest.mark.long
@SHARES
@pytest.mark.parametrize("test", [anderson_darling, cramer_von_mises])
def test_p_is_uniform_where_the_settings_are_one(test, share):
    rng, p = np.random.default_rng(11), []
    for seed in range(600):
        a, b = censor(rng.normal(size=60), share), censor(rng.normal(size=60), share)
        p.append(test(a, b, 399, seed).p)
    # at 90 % few runs stand and few values of the statistic are possible
    assert_uniform(p, 0.03 if share == 0.9 else 0.005)


@pytest.mark.long
@SHARES
def test_kolmogorov_smirnovs_p_never_promises_too_much_and_keeps_most_of_its_level(share):
    """D has few values, so p jumps: P(p <= level) is at most the level; scipy's p for continuous
    variables falls far below.
    """
    rng, ours, theirs = np.random.default_rng(12), [], []
    for _ in range(800):
        a, b = censor(rng.normal(size=60), share), censor(rng.normal(size=60), share)
        ours.append(kolmogorov_smirnov(a, b).p)
        theirs.append(stats.ks_2samp(a, b, method="asymp").pvalue)
    for level in (0.05, 0.25, 0.5):
        error = 3 * math.sqrt(level * (1 - level) / 800)
        assert 0.4 * level < np.mean(np.array(ours) <= level) <= level + error
    if share == 0.9:
        assert np.mean(np.array(theirs) <= 0.05) < 0.01


@SHARES
def test_paired_p_is_uniform_where_the_setting_does_not_matter(share):
    """u_max of one motion in two settings correlated by 0.9, their distributions one."""
    rng, p = np.random.default_rng(13), []
    for seed in range(800):
        motion = rng.normal(size=80)
        a, b = (
            censor(math.sqrt(0.9) * motion + math.sqrt(0.1) * rng.normal(size=80), share)
            for _ in "ab"
        )
        p.append(paired_kolmogorov_smirnov(a, b, 399, seed).p)
    for level in (0.05, 0.25, 0.5):
        error = 3 * math.sqrt(level * (1 - level) / 800)
        assert (
            (0.2 if share == 0.9 else 0.5) * level - error
            < np.mean(np.array(p) <= level)
            <= level + error
        )


def test_same_motions_hide_a_difference_from_the_independent_test_that_the_paired_one_sees():
    rng, paired, independent = np.random.default_rng(14), 0, 0
    for seed in range(60):
        motion = rng.normal(size=115)
        a, b = motion + 0.05 * rng.normal(size=115), motion + 0.15 + 0.05 * rng.normal(size=115)
        paired += paired_kolmogorov_smirnov(a, b, 399, seed).p < 0.05
        independent += kolmogorov_smirnov(a, b).p < 0.05
    assert paired > 50 and independent < 10


def test_paired_p_of_few_motions_is_exact():
    # three motions, all larger in a: D = 1 with all signs alike, so 2 of 8 outcomes
    assert paired_kolmogorov_smirnov([4, 5, 6], [1, 2, 3]).p == 0.25
    assert paired_kolmogorov_smirnov([1, 2, math.inf], [1, 2, math.inf]).p == 1.0
    # of 20 motions one flips: nothing else changes, and the other way round is as likely
    a = np.arange(20.0)
    b = a.copy()
    b[3] = math.inf
    assert paired_kolmogorov_smirnov(a, b).p == 1.0


def test_a_setting_that_overturns_more_is_found_by_all():
    rng = np.random.default_rng(15)
    a, b = (np.where(rng.random(115) < p, math.inf, rng.random(115)) for p in (0.2, 0.6))
    for test in (kolmogorov_smirnov, anderson_darling, cramer_von_mises):
        assert test(a, b).p < 0.001


def test_same_seed_same_p():
    a, b = samples(7, share=0.4)
    assert anderson_darling(a, b, 999, 5) == anderson_darling(a, b, 999, 5)
    assert 1 / 1000 <= anderson_darling(a, a + 10, 999, 5).p <= 2 / 1000


def test_all_overturned_in_both_gives_no_evidence():
    a = np.full(5, math.inf)
    for test in (kolmogorov_smirnov, anderson_darling, cramer_von_mises, paired_kolmogorov_smirnov):
        assert test(a, a).p == 1.0


def test_nan_is_refused():
    with pytest.raises(ValueError, match="list of numbers"):
        kolmogorov_smirnov([0.1, math.nan], [0.1])
