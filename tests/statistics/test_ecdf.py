import math
import re

import numpy as np
import pandas
import pytest
from scipy.stats import beta

from fecolumn.foundation.schema import InputError
from fecolumn.statistics.bands import normal_quantile
from fecolumn.statistics.ecdf import censored, ecdf, percentile, proportion_interval
from fecolumn.statistics.ensemble import summarize


def test_five_runs_by_hand():
    # F = 1/5, 3/5 (a tie), 4/5 and one overturned; band at 3/5: 0.6 +- 1.95996 sqrt(0.6 * 0.4 / 5)
    # = 0.6 +- 0.42941
    f = ecdf([0.03, 0.01, 9.0, 0.03, 0.07], [False, False, True, False, False])
    np.testing.assert_array_equal(f.x, [0.01, 0.03, 0.07])
    np.testing.assert_allclose(f.cdf, [0.2, 0.6, 0.8], rtol=1e-15)
    np.testing.assert_allclose(f.lower[1], 0.170593, atol=1e-6)
    assert f.upper[1] == 1.0 and f.lower[0] == 0.0  # clipped
    assert (f.n, f.lost) == (5, 1)


def test_cdf_ends_at_the_probability_of_standing():
    overturned = np.arange(115) < 50
    f = ecdf(np.where(overturned, np.nan, np.linspace(0.01, 0.2, 115)), overturned)
    assert f.cdf[-1] == pytest.approx(1 - 50 / 115, abs=1e-15)


def test_value_of_an_overturned_run_does_not_matter():
    u, overturned = np.array([0.01, 0.02, 0.03]), np.array([False, True, False])
    first, second = ecdf(u, overturned), ecdf(np.array([0.01, math.nan, 0.03]), overturned)
    np.testing.assert_array_equal(first.cdf, second.cdf)


def test_band_is_kaplan_meiers_with_greenwoods_variance():
    """Product-limit estimate and Greenwood's sum, written out, agree with the closed form used."""
    rng = np.random.default_rng(810)
    u = rng.lognormal(-3, 1, 40)
    overturned = u > 0.12
    survival, greenwood, at_risk = 1.0, 0.0, 40
    f = ecdf(u, overturned)
    for k, _ in enumerate(np.sort(u[~overturned])):
        survival *= 1 - 1 / at_risk
        greenwood += 1 / (at_risk * (at_risk - 1))
        at_risk -= 1
        reach = 1.959963984540054 * survival * math.sqrt(greenwood)
        assert f.cdf[k] == pytest.approx(1 - survival, abs=1e-12)
        assert f.upper[k] == pytest.approx(min(1 - survival + reach, 1), abs=1e-12)
        assert f.lower[k] == pytest.approx(max(1 - survival - reach, 0), abs=1e-12)
    assert overturned.sum() > 3


def test_all_overturned_leaves_no_curve_and_no_percentile():
    f = ecdf([1.0, 1.0], [True, True])
    assert (
        f.x.size == 0
        and f.lost == 2
        and percentile([1.0, 1.0], [True, True], fraction=0.16) == math.inf
    )


def test_lists_of_two_lengths_are_refused_as_input():
    with pytest.raises(InputError, match=r"ecdf: lost: .*u_max \(2,\).*of one length"):
        ecdf([0.1, 0.2], [False])


def test_nan_of_a_standing_run_is_refused_not_counted_as_overturned():
    with pytest.raises(ValueError, match="neither standing nor lost"):
        ecdf([0.1, math.nan], [False, False])
    with pytest.raises(ValueError, match="not empty"):
        ecdf([], [])


def test_percentiles_are_the_inverse_of_the_ecdf():
    u = np.arange(1, 26) / 100
    standing = np.zeros(25, bool)
    assert [percentile(u, standing, fraction=q) for q in (0.16, 0.5, 0.84)] == [0.04, 0.13, 0.21]
    for q in (0.16, 0.5, 0.84):
        assert percentile(u, standing, fraction=q) == np.quantile(u, q, method="inverted_cdf")
    # 0.07 * 100 > 7 in binary
    assert percentile(np.arange(1, 101) / 100, np.zeros(100, bool), 0.07) == 0.07
    assert (
        percentile(u, u > 0.2, fraction=0.84) == math.inf
        and percentile(u, u > 0.2, fraction=0.5) == 0.13
    )


def test_wilson_interval_of_the_published_ensemble():
    # 50 of 115, z = 1.959964: (p + z2/2n +- z sqrt(p(1-p)/n + z2/4n2)) / (1 + z2/n) with z2 =
    # 3.841459: centre (0.434783 + 0.016702) / 1.033404 = 0.436891; reach 1.959964 sqrt(0.002136927
    # + 0.00007262) / 1.033404 = 0.089152
    low, high = proportion_interval(50, 115)
    assert low == pytest.approx(0.34774, abs=1e-5) and high == pytest.approx(0.52604, abs=1e-5)


def test_wilson_interval_of_no_overturn_stays_open():
    # k = 0: [0, z2 / (n + z2)]
    assert proportion_interval(0, 5) == pytest.approx((0.0, 3.841459 / 8.841459), abs=1e-6)


def test_exact_interval_is_made_of_beta_quantiles():
    assert proportion_interval(3, 10, method="exact") == pytest.approx(
        (beta.ppf(0.025, 3, 8), beta.ppf(0.975, 4, 7)), abs=1e-9
    )
    assert proportion_interval(0, 10, method="exact") == pytest.approx(
        (0, 1 - 0.025**0.1), abs=1e-9
    )


@pytest.mark.parametrize(
    "k, n, said",
    [
        (0.3, 40, "k = 0.3: must be a whole number: runs, not their share"),
        (math.nan, 40, "k = nan: must be a whole"),
        ("3", 40, "k = '3': must be a whole"),
        (True, 40, "k = True: must be a whole"),
        (3, 40.5, "n = 40.5: must be a whole"),
        (3, math.inf, "n = inf: must be a whole"),
        (41, 40, "k = 41: must be in [0, 40]"),
    ],
)
def test_counts_that_are_none_are_refused(k, n, said):
    with pytest.raises(InputError, match=re.escape(said)):
        proportion_interval(k, n)


def test_counts_may_come_as_numpy_has_them():
    counts = np.array([True, False, True]).sum(), np.float64(3)
    assert proportion_interval(*counts) == proportion_interval(2, 3)


def test_normal_quantile():
    assert normal_quantile(0.95) == pytest.approx(1.959963984540054, abs=1e-12)


def test_row_of_an_ensemble():
    row = summarize(
        [0.01, 0.02, 0.5, 0.03],
        [False, False, True, False],
        [1e-3, -4e-3, 2e-3, 0],
        [0.1, 0.3, 0.1, 0.3],
    )
    assert (row.n, row.overturned, row.p_overturn, row.u50_m, row.u84_m) == (
        4,
        1,
        0.25,
        0.02,
        math.inf,
    )
    assert row.energy_closure_worst == 4e-3 and row.s_per_step == pytest.approx(0.2)


@pytest.mark.parametrize(
    "call, told",
    [
        (
            lambda: ecdf([1.0, 2.0], [0, 0], confidence=95),
            "confidence = 95: must lie between 0 and 1",
        ),
        (
            lambda: percentile([1.0, 2.0], [0, 0], fraction=2),
            "fraction = 2: must lie between 0 and 1",
        ),
        (lambda: proportion_interval(3, 2), r"k = 3: must be in \[0, 2\]"),
        (lambda: proportion_interval(0, 0), "n = 0: must be at least 1"),
        (lambda: proportion_interval(1, 2, confidence=0.0), "confidence = 0.0"),
        (lambda: proportion_interval(1, 2, method="wald"), "must be 'wilson' or 'exact'"),
    ],
)
def test_what_no_share_can_be_is_refused_by_name(call, told):
    with pytest.raises(InputError, match=told):
        call()


@pytest.mark.parametrize(
    "lost", [["no", "no"], ["0", "0"], [None, None], [0, 2], [0.5, 0], [math.nan, 0], [False, "no"]]
)
def test_what_says_neither_lost_nor_standing_is_refused(lost):
    with pytest.raises(InputError, match="must be True or False, or 1 or 0, for each run"):
        ecdf([1.0, 2.0], lost)
    with pytest.raises(InputError, match="must be True or False, or 1 or 0, for each run"):
        percentile([1.0, 2.0], lost, fraction=0.5)


@pytest.mark.parametrize(
    "lost",
    [
        [0, 1],
        [0.0, 1.0],
        np.array([False, True], object),
        np.array([0, 1], np.uint8),
        pandas.Series([False, True], dtype="boolean"),
    ],
)
def test_ones_and_noughts_tell_what_is_lost(lost):
    assert ecdf([1.0, 2.0], lost).lost == 1


def test_percentile_of_a_small_share_is_the_least_peak():
    assert percentile([1, 2, 3], [0, 0, 0], fraction=1e-10) == 1.0


def test_median_is_finite_where_half_are_lost_and_not_where_more_are():
    assert percentile([1, 2, 3, 4], [0, 0, 1, 1], fraction=0.5) == 2.0
    assert percentile([1, 2, 3, 4, 5], [0, 0, 1, 1, 1], fraction=0.5) == math.inf


def test_tables_of_motions_at_several_settings_are_checked_alike():
    u, lost = np.array([[1.0, 2.0], [3.0, math.nan]]), np.array([[False, True], [False, True]])
    np.testing.assert_array_equal(censored(u, lost, 2), [[1.0, math.inf], [3.0, math.inf]])
    for wrong in ((u[0], lost[0]), (u, lost[0]), (u, ~lost), (np.zeros((2, 0)), np.zeros((2, 0)))):
        with pytest.raises(InputError, match="^ecdf: "):
            censored(*wrong, 2)
    with pytest.raises(InputError, match="two lists of one length"):
        censored(u, lost)
