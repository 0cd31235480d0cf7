"""Incremental dynamic analysis against ensembles of motions whose intensity of overturning is
known.
"""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

from fecolumn.statistics.fragility import DegenerateData, lognormal
from fecolumn.statistics.incremental import first_overturning, fractile_curves, incremental_curves

MEDIAN, BETA = 0.6, 0.4
SCALES = np.array([0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0])


def ensemble(rng, motions=40):
    """Runs (motion, im, u, overturned) of motions of several strengths: u = 50 mm im / im_fall
    below the intensity of overturning.
    """
    own = rng.lognormal(math.log(0.5), 0.3, motions)
    capacity = MEDIAN * np.exp(BETA * rng.normal(size=motions))
    im = own[:, None] * SCALES
    u = 0.05 * im / capacity[:, None]
    name = np.repeat([f"m{k}" for k in range(motions)], SCALES.size)
    return name, im.ravel(), u.ravel(), (im >= capacity[:, None]).ravel(), capacity


def bounds(name, im, u, overturned):
    return np.transpose([curve.first for curve in incremental_curves(name, im, u, overturned)])


def test_intensity_of_overturning_lies_between_the_scales_of_its_motion():
    name, im, u, overturned, capacity = ensemble(np.random.default_rng(1))
    shuffled = np.random.default_rng(2).permutation(im.size)
    curves = incremental_curves(name[shuffled], im[shuffled], u[shuffled], overturned[shuffled])
    found = {curve.motion: curve.first for curve in curves}
    for k, fall in enumerate(capacity):
        low, high = found[f"m{k}"]
        assert low < fall <= high
    assert not any(curve.stands_again for curve in curves)


def test_a_motion_that_lets_the_column_stand_again_is_told():
    (low,) = incremental_curves(["a"] * 4, [1, 2, 3, 4], [0.01, 9, 0.03, 9], [0, 1, 0, 1])
    assert low.first == (1, 2) and low.stands_again
    (never,) = incremental_curves(["a"] * 2, [1, 2], [0.01, 0.02], [0, 0])
    assert never.first == (2, np.inf) and not never.stands_again
    (at_once,) = incremental_curves(["a"] * 2, [1, 2], [9, 9], [1, 1])
    assert at_once.first == (0, 1)


def test_fit_is_the_maximum_of_the_likelihood_and_its_covariance_that_of_the_information():
    lower, upper = bounds(*ensemble(np.random.default_rng(3))[:4])

    def minus_loglik(q):
        return -np.log(
            norm.cdf((np.log(upper) - q[0]) / q[1])
            - norm.cdf((np.log(np.maximum(lower, 1e-30)) - q[0]) / q[1])
        ).sum()

    fit = first_overturning(lower, upper)
    other = minimize(
        minus_loglik, [0.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-11}
    )
    assert (math.log(fit.median), fit.beta) == pytest.approx(
        other.x, rel=1e-5
    ) and fit.loglik == pytest.approx(-other.fun, abs=1e-8)
    best, e = np.array([math.log(fit.median), fit.beta]), 1e-4 * np.eye(2)
    hessian = np.array(
        [
            [
                (
                    minus_loglik(best + a + b)
                    - minus_loglik(best + a - b)
                    - minus_loglik(best - a + b)
                    + minus_loglik(best - a - b)
                )
                / 4e-8
                for a in e
            ]
            for b in e
        ]
    )
    np.testing.assert_allclose(np.linalg.inv(fit.covariance) * 40 / 39, hessian, rtol=1e-4)


def test_exact_intensities_of_overturning_are_mean_and_deviation_of_their_logarithms():
    fall = MEDIAN * np.exp(BETA * np.random.default_rng(4).normal(size=30))
    fit = first_overturning(fall * (1 - 1e-6), fall)
    assert fit.median == pytest.approx(
        math.exp(np.log(fall).mean()), rel=1e-5
    ) and fit.beta == pytest.approx(np.log(fall).std(), rel=1e-4)
    low, high = fit.median_interval()
    from scipy.stats import t

    assert math.log(high / low) / 2 == pytest.approx(
        t.ppf(0.975, 29) * np.log(fall).std(ddof=1) / math.sqrt(30), rel=1e-4
    )


@pytest.mark.parametrize("motions", [15, 60])
def test_median_and_scatter_lie_in_their_intervals_in_95_of_100_ensembles(motions):
    rng, inside = np.random.default_rng(5), []
    for _ in range(400):
        fit = first_overturning(*bounds(*ensemble(rng, motions)[:4]))
        (a, b), (c, d) = fit.median_interval(), fit.beta_interval()
        inside.append((a < MEDIAN < b, c < BETA < d))
    # beta of few motions is estimated too small, which its interval, symmetric in the logarithm,
    # knows in part only
    np.testing.assert_allclose(
        np.mean(inside, axis=0), 0.95, atol=0.033 + (0.02 if motions < 20 else 0)
    )


def test_runs_of_the_same_motions_have_intervals_of_motions_and_not_of_runs():
    """40 motions at seven scales are 280 runs; taken as independent their intervals hold the truth
    much too rarely.
    """
    rng, inside = np.random.default_rng(6), {"motions": [], "runs": []}
    for _ in range(300):
        name, im, _, overturned, _ = ensemble(rng)
        for kind, groups in (("motions", name), ("runs", None)):
            low, high = lognormal(im, overturned, groups).median_interval()
            inside[kind].append(low < MEDIAN < high)
    assert np.mean(inside["motions"]) == pytest.approx(0.95, abs=0.035)
    assert np.mean(inside["runs"]) < 0.85


def test_independent_runs_have_the_same_interval_with_and_without_groups():
    rng = np.random.default_rng(7)
    im = rng.lognormal(0, 0.6, 600)
    overturned = rng.normal(size=600) < np.log(im) / BETA
    one, other = lognormal(im, overturned), lognormal(im, overturned, np.arange(600))
    assert one.median == other.median and one.median_interval() == pytest.approx(
        other.median_interval(), rel=0.02
    )


def test_fractiles_take_overturned_motions_as_infinite_and_end_where_a_motion_is_not_known():
    name = np.repeat(["a", "b", "c"], 2)
    curves = incremental_curves(
        name, [1, 2] * 3, [0.01, 0.02, 0.02, 9, 0.03, 0.06], [0, 0, 0, 1, 0, 0]
    )
    low, middle, high = fractile_curves(curves, [0.5, 1.0, 2.0, 2.1])
    np.testing.assert_allclose(low, [0.005, 0.01, 0.02, np.nan])
    np.testing.assert_allclose(middle, [0.01, 0.02, 0.06, np.nan])
    np.testing.assert_allclose(high, [0.015, 0.03, np.inf, np.nan])


@pytest.mark.parametrize(
    "lower, upper, reason",
    [([1, 2], [np.inf, np.inf], "none of 2"), ([1, 0.5], [2, 3], "finer or more scales")],
)
def test_intervals_that_do_not_bound_the_curve_are_refused_in_words(lower, upper, reason):
    with pytest.raises(DegenerateData, match=reason):
        first_overturning(lower, upper)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("records", [None, ["a", "a", "b", "c", "d", "d"]])
def test_motion_of_which_nothing_is_known_tells_nothing(records):
    lower, upper = [1.0, 2.0, 1.5, 3.0, 0.0, 2.5], [2.0, 4.0, 3.0, np.inf, 1.0, 5.0]
    fit = first_overturning(lower, upper, records)
    more = first_overturning(
        [0.0, *lower, 0.0], [np.inf, *upper, np.inf], records and ["a", *records, "e"]
    )
    assert more.n == fit.n == 6 and more.overturned == 5 and more.clusters == fit.clusters
    assert more.parameters == pytest.approx(fit.parameters, rel=1e-9)
    np.testing.assert_allclose(more.covariance, fit.covariance, rtol=1e-9)


def test_motions_of_which_nothing_is_known_are_refused():
    with pytest.raises(DegenerateData, match="of none of 3 motions anything is known"):
        first_overturning(np.zeros(3), np.full(3, np.inf))
    with pytest.raises(ValueError, match="2 records of 3 runs"):
        first_overturning(np.zeros(3), np.full(3, np.inf), ["a", "b"])


def test_two_runs_of_one_intensity_are_refused():
    with pytest.raises(ValueError, match="two runs of one intensity"):
        incremental_curves(["a", "a"], [1, 1], [0.1, 0.2], [0, 0])
