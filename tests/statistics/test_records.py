"""Runs of one record are one cluster: copies of a motion add nothing to what it says, and records
that each have one run are independent runs, to the last digit.
"""

import itertools

import numpy as np
import pytest
from ensembles import assert_uniform, censor

from fecolumn.statistics.binary_regression import DegenerateData
from fecolumn.statistics.compare import compare
from fecolumn.statistics.convergence import cdf_convergence
from fecolumn.statistics.ecdf import ecdf, proportion_interval, share_interval
from fecolumn.statistics.ensemble import summarize
from fecolumn.statistics.equivalence import distance_bound
from fecolumn.statistics.flips import contingency, flips_p, mcnemar, swapped_p
from fecolumn.statistics.incremental import first_overturning
from fecolumn.statistics.records import by_record, effective_runs, record_count, run_count
from fecolumn.statistics.sensitivity import sensitivity
from fecolumn.statistics.trend import trend
from fecolumn.statistics.two_sample import (
    anderson_darling,
    cramer_von_mises,
    kolmogorov_smirnov,
    paired_kolmogorov_smirnov,
)

COPIES = pytest.mark.parametrize("copies", [2, 9])


def pair(seed, n):
    """Peaks of n motions in two settings, inf where lost."""
    rng = np.random.default_rng(seed)
    own = rng.normal(size=n)
    return censor(own + 0.3 * rng.normal(size=n), 0.3), censor(own + 0.3, 0.3)


def repeated(copies, n, *samples):
    """Each run so many times in a row, and the records."""
    return *(np.repeat(one, copies) for one in samples), np.repeat(np.arange(n), copies)


def parted(sample):
    """Peaks and whether lost."""
    return np.where(np.isinf(sample), 0.0, sample), np.isinf(sample)


def own(n):
    """A record for each run, by names."""
    return [f"record {number}" for number in range(n)]


@COPIES
@pytest.mark.parametrize("k", [0, 1, 4, 10])
def test_copies_of_motions_leave_the_interval_of_a_share_as_it_is(copies, k):
    fallen = np.arange(10) < k
    many, records = repeated(copies, 10, fallen)
    assert effective_runs(many, records) == pytest.approx(10, rel=1e-12)
    for method in ("wilson", "exact"):
        assert share_interval(many, records, method=method) == pytest.approx(
            proportion_interval(k, 10, method=method), abs=1e-12
        )


def test_records_of_one_run_each_are_independent_runs_to_the_last_digit():
    a, b = pair(1, 40)
    (u_a, lost_a), (u_b, lost_b) = parted(a), parted(b)
    names = own(40)
    for method in ("wilson", "exact"):
        expected = proportion_interval(int(lost_a.sum()), 40, method=method)
        assert share_interval(lost_a, names, method=method) == expected
        assert share_interval(lost_a, method=method) == expected
    assert effective_runs(lost_a, names) == 40
    for test in (anderson_darling, cramer_von_mises):
        assert test(a, b, 99, records=(names, names)) == test(a, b, 99)
    assert kolmogorov_smirnov(a, b, (names, names)) == kolmogorov_smirnov(a, b)
    assert paired_kolmogorov_smirnov(a, b, records=names) == paired_kolmogorov_smirnov(a, b)
    assert flips_p(lost_a, lost_b, names) == mcnemar(contingency(lost_a, lost_b))
    runs = (u_a, lost_a, u_b, lost_b)
    assert distance_bound(*runs, records=names) == distance_bound(*runs)
    assert compare(*runs, paired=True, records=(names, names)) == compare(*runs, paired=True)
    one, other = ecdf(u_a, lost_a, records=names), ecdf(u_a, lost_a)
    assert (one.lower == other.lower).all() and one.lost_interval == other.lost_interval
    lines = np.stack([u_a, u_b]), np.stack([lost_a, lost_b])
    assert trend(*lines, records=names) == trend(*lines)
    assert sensitivity([u_a], [lost_a], [u_b], [lost_b], records=names) == sensitivity(
        [u_a], [lost_a], [u_b], [lost_b]
    )
    bounds = np.arange(1.0, 11), np.arange(1.0, 11) + np.tile([2.0, np.inf], 5)
    assert (
        first_overturning(*bounds, own(10)).median_interval()
        == first_overturning(*bounds).median_interval()
    )


@COPIES
@pytest.mark.parametrize("n", [6, 40])
def test_copies_of_motions_give_the_same_p_and_bounds(copies, n):
    a, b = pair(2, n)
    many_a, many_b, records = repeated(copies, n, a, b)
    one, many = (
        paired_kolmogorov_smirnov(a, b),
        paired_kolmogorov_smirnov(many_a, many_b, records=records),
    )
    assert many.p == one.p and many.statistic == pytest.approx(one.statistic, rel=1e-12)
    runs, more = (*parted(a), *parted(b)), (*parted(many_a), *parted(many_b))
    assert flips_p(more[1], more[3], records) == pytest.approx(flips_p(runs[1], runs[3]), rel=1e-12)
    assert distance_bound(*more, records=records) == pytest.approx(distance_bound(*runs), rel=1e-9)
    first, again = ecdf(*runs[:2]), ecdf(*more[:2], records=records)
    assert again.records == n and again.n == copies * n
    assert again.lower == pytest.approx(first.lower) and again.upper == pytest.approx(first.upper)
    assert again.lost_interval == pytest.approx(first.lost_interval, abs=1e-12)


def test_copies_counted_as_runs_would_make_a_difference_of_chance_a_certain_one():
    """Eight motions in nine directions of which none tells more than the first."""
    a, b = np.arange(8.0), np.array([np.inf, 4.5, 3.5, np.inf, 2.5, 6.5, np.inf, 5.5])
    many_a, many_b, records = repeated(9, 8, a, b)
    assert paired_kolmogorov_smirnov(many_a, many_b).p < 0.001
    assert paired_kolmogorov_smirnov(many_a, many_b, records=records).p > 0.05
    runs = [(*parted(many_a), *parted(many_b)), (*parted(a), *parted(b))]
    of_records, of_motions = (
        compare(*one, paired=True, records=records)
        for one, records in zip(runs, ((records, records), (None, None)))
    )
    assert of_records.records_a == 8 and of_records.n_a == 72
    assert of_records.paired_p == of_motions.paired_p
    for name in ("ks_p", "ad_p", "cvm_p"):
        one, other = getattr(of_records, name), getattr(of_motions, name)
        assert one == pytest.approx(other, abs=0.03), name


def test_independent_ensembles_are_tested_by_all_ways_to_deal_their_records():
    """Records of different size: D of all 20 ways to deal six of them to two ensembles."""
    sizes = [1, 2, 3, 2, 1, 3]
    values = [np.arange(size) + 2.0 * number for number, size in enumerate(sizes)]
    values[3][0] = 0.5

    def distance(chosen):
        a = np.concatenate([values[k] for k in chosen])
        b = np.concatenate([values[k] for k in range(6) if k not in chosen])
        at = np.concatenate([a, b])
        return np.abs((a[:, None] <= at).mean(axis=0) - (b[:, None] <= at).mean(axis=0)).max()

    deals = [distance(chosen) for chosen in itertools.combinations(range(6), 3)]
    expected = np.mean(np.array(deals) >= distance((0, 1, 2)) - 1e-12)
    records = np.repeat(np.arange(6), sizes)
    found = kolmogorov_smirnov(
        np.concatenate(values[:3]), np.concatenate(values[3:]), (records[:6], records[6:])
    )
    assert found.statistic == pytest.approx(distance((0, 1, 2)))
    assert found.p == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / 9999))


@pytest.mark.parametrize(
    "test", [kolmogorov_smirnov, anderson_darling, cramer_von_mises], ids=lambda one: one.__name__
)
def test_p_of_clustered_ensembles_means_what_it_says(test):
    """Ten records of two or three runs that have most in common, in two ensembles alike."""
    rng, p = np.random.default_rng(3), []
    records = np.repeat(np.arange(10), [2, 3] * 5)
    for seed in range(300):
        a, b = (
            censor(0.9 * rng.normal(size=10)[records] + 0.4 * rng.normal(size=25), 0.3)
            for _ in "ab"
        )
        p.append(test(a, b, records=(records, records), resamples=199, seed=seed).p)
    assert_uniform(p, resolution=0.03)


def test_paired_p_of_clustered_motions_means_what_it_says():
    rng, p, alone = np.random.default_rng(4), [], []
    records = np.repeat(np.arange(12), 6)
    for seed in range(300):
        common = rng.normal(size=12)[records]
        a, b = (
            common + 0.5 * rng.normal(size=12)[records] + 0.1 * rng.normal(size=72) for _ in "ab"
        )
        p.append(paired_kolmogorov_smirnov(a, b, 199, seed, records).p)
        alone.append(paired_kolmogorov_smirnov(a, b, 199, seed).p)
    # D of twelve records has few values, so that p is rather too large
    for level in (0.05, 0.10, 0.25, 0.5):
        assert np.mean(np.array(p) <= level) <= level + 3 * np.sqrt(level * (1 - level) / 300)
    assert np.mean(np.array(alone) <= 0.05) > 0.2


def test_flips_of_records_are_all_ways_to_swap_them():
    a = np.array([1, 1, 0, 1, 0, 0, 1, 0, 1, 1], bool)
    b = np.array([0, 0, 1, 1, 0, 1, 0, 0, 0, 0], bool)
    records = np.array([0, 0, 0, 1, 1, 2, 3, 3, 4, 4])
    net = np.array([1, 0, -1, 1, 2])
    sums = [sum(np.array(sign) * net) for sign in itertools.product([-1, 1], repeat=5)]
    assert flips_p(a, b, records) == pytest.approx(np.mean(np.abs(sums) >= abs(net.sum())))
    for one, other in ((0, 0), (3, 0), (5, 2), (12, 12), (1, 30)):
        net = np.array([1] * one + [-1] * other, int)
        table = [[4, other], [one, 7]]
        assert swapped_p(net) == pytest.approx(mcnemar(table), rel=1e-9)


@pytest.mark.parametrize("size", [2, 9])
def test_interval_of_a_share_holds_it_as_often_as_it_says(size):
    """Fifteen records whose runs have their share in common, beta distributed."""
    rng, held, alone = np.random.default_rng(5), 0, 0
    records = np.repeat(np.arange(15), size)
    for _ in range(1000):
        share = rng.beta(0.3 * 1.5, 0.7 * 1.5, 15)[records]
        fallen = rng.random(records.size) < share
        low, high = share_interval(fallen, records)
        held += low <= 0.3 <= high
        low, high = share_interval(fallen)
        alone += low <= 0.3 <= high
    assert 0.92 <= held / 1000 <= 0.99 and alone / 1000 < 0.92


def test_number_of_independent_runs_lies_between_records_and_runs():
    records = np.repeat(np.arange(20), 5)
    rng = np.random.default_rng(6)
    independent = effective_runs(rng.random(100) < 0.4, records)
    assert 60 < independent <= 100
    # all of one record, and records of different size whose runs agree (Kish 1965)
    assert effective_runs([True, False, True], [0, 0, 0]) == 1
    assert effective_runs([True] * 4 + [False], [0] * 4 + [1]) == pytest.approx(25 / 17)
    # two records say nothing of how records differ, whatever their runs do
    turned = np.tile([True, False], 18)
    assert effective_runs(turned, np.repeat([0, 1], 18)) == 2


def test_effects_trends_and_convergence_draw_records():
    a, b = pair(7, 12)
    many_a, many_b, records = repeated(3, 12, a, b)
    (u_a, lost_a), (u_b, lost_b) = parted(a), parted(b)
    (v_a, fell_a), (v_b, fell_b) = parted(many_a), parted(many_b)
    one = sensitivity([u_a], [lost_a], [u_b], [lost_b])
    many = sensitivity([v_a], [fell_a], [v_b], [fell_b], records=records)
    for name in ("n", "distance", "distance_low", "distance_high", "chance", "change"):
        assert getattr(many, name) == pytest.approx(getattr(one, name), abs=1e-9), name
    for extra in ((), (np.stack([u_a + 0.1]), np.stack([lost_a]))):
        u, lost = np.stack([u_a, u_b]), np.stack([lost_a, lost_b])
        if extra:
            u, lost = np.concatenate([u, extra[0]]), np.concatenate([lost, extra[1]])
        one = trend(u, lost)
        many = trend(np.repeat(u, 3, axis=1), np.repeat(lost, 3, axis=1), records=records)
        assert (many.tau_low, many.tau_high) == pytest.approx((one.tau_low, one.tau_high))
        assert many.p == pytest.approx(one.p, rel=1e-9) and many.n == 36
    one = cdf_convergence(u_a, lost_a, [3, 12])
    many = cdf_convergence(v_a, fell_a, [3, 12], records=records)
    assert many.upper_95 == pytest.approx(one.upper_95) and (many.dkw_95 == one.dkw_95).all()


def test_each_record_counts_once_in_the_law_of_first_overturning():
    lower = np.array([0.2, 0.3, 0.3, 0.5, 0.4, 0.2])
    upper = np.array([0.3, 0.4, 0.5, np.inf, 0.5, 0.4])
    one = first_overturning(lower, upper)
    many = first_overturning(*(np.repeat(side, 9) for side in (lower, upper)), np.repeat(own(6), 9))
    assert many.median == pytest.approx(one.median, rel=1e-6)
    assert many.median_interval() == pytest.approx(one.median_interval(), rel=1e-6)
    assert many.beta_interval() == pytest.approx(one.beta_interval(), rel=1e-6)
    assert many.clusters == 6 and many.n == 54
    with pytest.raises(DegenerateData, match="of one record"):
        first_overturning(lower, upper, ["a"] * 6)


def test_names_of_records_are_counted_and_told():
    assert record_count(["b", "a", "b"], 3) == 2 and record_count(None, 3) == 3
    assert run_count(72, np.repeat(np.arange(8), 9)) == "72 runs of 8 records"
    assert run_count(2, ["a", "a"], "motion") == "2 motions of 1 record"
    assert run_count(1, ["a"]) == "1 run" and run_count(8, None, "motion") == "8 motions"
    values = np.array([1.0, 2, 3, 10])
    assert by_record(values, ["x", "y", "x", "y"]).tolist() == [2, 6]
    assert by_record(values, None) is values
    with pytest.raises(ValueError, match="2 records of 3 runs"):
        share_interval([True] * 3, ["a", "b"])


def test_row_of_an_ensemble_counts_records():
    row = summarize([1.0] * 6, [True, False] * 3, [0.0] * 6, [1.0] * 6, records=[0, 1] * 3)
    assert row.records == 2 and row.wilson == pytest.approx(proportion_interval(1, 2))
    assert summarize([1.0], [False], [0.0], [1.0]).records == 1
