"""Fragility curves give back the parameters their data were drawn with, within the errors they
state.
"""

import math
import re

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import expit
from scipy.stats import norm

from fecolumn.statistics.displacement_fragility import displacement
from fecolumn.statistics.fragility import (
    DegenerateData,
    Fragility,
    logit,
    lognormal,
    median_of,
)

MEDIAN, BETA = 1.3, 0.4


def stripes(rng, n=40):
    """Overturned or not of n runs at each of eight intensities."""
    im = np.repeat(np.linspace(0.4, 2.6, 8), n)
    return im, rng.normal(size=im.size) < np.log(im / MEDIAN) / BETA


def test_lognormal_is_the_maximum_of_the_likelihood():
    im, overturned = stripes(np.random.default_rng(1))

    def minus_loglik(q):
        eta = np.log(im / q[0]) / q[1]
        return -norm.logcdf(np.where(overturned, eta, -eta)).sum()

    found, other = (
        lognormal(im, overturned),
        minimize(
            minus_loglik, [1.0, 0.5], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-10}
        ),
    )
    assert (found.median, found.beta) == pytest.approx(
        other.x, rel=1e-5
    ) and found.loglik == pytest.approx(-other.fun, abs=1e-8)


def minus_hessian(function, x, step=1e-4):
    """By central differences."""
    e = step * np.eye(len(x))
    return -np.array(
        [
            [
                (
                    function(x + u + v)
                    - function(x + u - v)
                    - function(x - u + v)
                    + function(x - u - v)
                )
                / (4 * step**2)
                for u in e
            ]
            for v in e
        ]
    )


def test_covariance_is_the_inverse_of_the_observed_information():
    im, overturned = stripes(np.random.default_rng(1), 10)

    def loglik(q):
        eta = (np.log(im) - q[0]) / q[1]
        return norm.logcdf(np.where(overturned, eta, -eta)).sum()

    fit = lognormal(im, overturned)
    information = minus_hessian(loglik, np.array([math.log(fit.median), fit.beta]))
    np.testing.assert_allclose(np.linalg.inv(fit.covariance), information, rtol=1e-4)


def test_covariance_with_censored_displacements_is_the_inverse_of_the_observed_information():
    im, u, overturned = draw(np.random.default_rng(12), 60)

    def loglik(q):
        mean = q[0] + q[1] * np.log(im)
        return np.where(
            overturned, norm.logsf(math.log(0.25), mean, q[2]), norm.logpdf(np.log(u), mean, q[2])
        ).sum()

    fit = displacement(im, u, overturned, cap_m=0.25)
    best = np.append(fit.coefficients, fit.sigma)
    assert fit.loglik == pytest.approx(loglik(best), abs=1e-9) and overturned.sum() > 10
    np.testing.assert_allclose(
        np.linalg.inv(fit.covariance), minus_hessian(loglik, best), rtol=1e-4, atol=1e-3
    )


def test_lognormal_parameters_lie_within_their_intervals_in_95_of_100_ensembles():
    rng, median, beta, curve = np.random.default_rng(2), [], [], []
    for _ in range(800):
        fit = lognormal(*stripes(rng))
        low, high = fit.median_interval()
        median.append(low < MEDIAN < high)
        low, high = fit.beta_interval()
        beta.append(low < BETA < high)
        band = fit.probability([0.8, 1.3])
        truth = norm.cdf(np.log(np.array([0.8, 1.3]) / MEDIAN) / BETA)
        curve.append((band.lower < truth) & (truth < band.upper))
    error = 3 * math.sqrt(0.05 * 0.95 / 800)
    for covered in (np.mean(median), np.mean(beta), *np.mean(curve, axis=0)):
        assert covered == pytest.approx(0.95, abs=error)


def test_logit_of_two_measures_recovers_both_and_tells_the_useless_one():
    rng, truth, inside, useless = np.random.default_rng(3), np.array([-1.0, 2.5, 1.5]), [], []
    for _ in range(400):
        im = rng.lognormal(0, 0.6, (300, 2))
        overturned = rng.random(300) < expit(truth[0] + np.log(im) @ truth[1:])
        fit = logit(im, overturned)
        inside.append(np.abs(fit.coefficients - truth) < 1.96 * np.sqrt(np.diag(fit.covariance)))
        useless.append(2 * (fit.loglik - logit(im[:, 0], overturned).loglik))
    np.testing.assert_allclose(np.mean(inside, axis=0), 0.95, atol=3 * math.sqrt(0.05 * 0.95 / 400))
    assert np.mean(np.array(useless) > 3.84) > 0.99  # chi-square, one degree of freedom, 95 %


def test_runs_of_one_motion_at_several_scales_know_less_than_their_number_says():
    """40 motions, each with a capacity of its own, at eight scales: 320 runs, 40 pieces of
    knowledge.
    """
    rng = np.random.default_rng(5)
    capacity = MEDIAN * np.exp(BETA * rng.normal(size=40))
    im = np.tile(np.linspace(0.4, 2.6, 8), 40)
    motion = np.repeat(np.arange(40), 8)
    overturned = im > capacity[motion]
    width = {}
    for name, groups in (("runs", None), ("motions", motion)):
        low, high = lognormal(im, overturned, groups).median_interval()
        width[name] = math.log(high / low) / 2
    # mean of 40 capacities: ln median to +- 1.96 * 0.4 / sqrt(40) = 0.124
    assert width["motions"] == pytest.approx(0.124, rel=0.35)
    assert width["runs"] < 0.7 * width["motions"]


def refitted(im, overturned, groups, rng, samples=400):
    """Parameters (samples, 2) of lognormal() on whole groups drawn with replacement."""
    members, found = [np.flatnonzero(groups == one) for one in np.unique(groups)], []
    for _ in range(samples):
        rows = np.concatenate([members[k] for k in rng.integers(0, len(members), len(members))])
        found.append(lognormal(im[rows], overturned[rows]).parameters)
    return np.array(found)


def test_intervals_are_those_of_samples_drawn_anew():
    im, overturned = stripes(np.random.default_rng(4), 80)
    fit = lognormal(im, overturned)
    drawn = refitted(im, overturned, np.arange(im.size), np.random.default_rng(1))
    np.testing.assert_allclose(
        np.quantile(drawn, (0.025, 0.975), axis=0).T,
        [fit.median_interval(), fit.beta_interval()],
        rtol=0.03,
    )


def curve_of(median, beta, slope_error, correlation=0.0, height_error=1.0, clusters=None):
    """Fragility with standard errors of a and b of a + b ln(im) as they are given."""
    a, b = -math.log(median) / beta, 1 / beta
    covariance = np.array(
        [
            [height_error**2, correlation * height_error * slope_error],
            [correlation * height_error * slope_error, slope_error**2],
        ]
    )
    to_shape = np.array([[-1 / b, a / b**2], [0.0, -1 / b**2]])
    shape = to_shape @ covariance @ to_shape.T
    return Fragility(median, beta, shape, 0.0, 50, 20, clusters), np.array([a, b]), covariance


CURVES = [
    (1.3, 0.4, 0.5, -0.6, 0.3, None),
    (1.3, 0.4, 1.2, 0.9, 1.0, None),
    (0.02, 0.4, 1.5, 0.2, 2.0, 12),  # slope not told from 0, and the height hardly
    (30.0, 0.8, 0.7, 0.0, 0.2, None),  # not told from 0, far above what was run
    (0.03, 0.8, 0.7, 0.0, 0.2, None),
    (1.0, 0.5, 1.2, 0.3, 3.0, None),
]


@pytest.mark.parametrize("data", CURVES)
def test_ends_of_the_median_are_where_the_band_crosses_one_half(data):
    fit = curve_of(*data)[0]
    low, high = fit.median_interval()
    assert low < fit.median < high
    for end, side in ((low, "upper"), (high, "lower")):
        if 0 < end < math.inf:
            assert getattr(fit.probability([end]), side)[0] == pytest.approx(0.5, abs=1e-9)
    inside = np.exp(np.linspace(math.log(max(low, 1e-60)), math.log(min(high, 1e60)), 999))[1:-1]
    band = fit.probability(inside)
    assert (band.lower <= 0.5).all() and (band.upper >= 0.5).all()


@pytest.mark.parametrize("data", CURVES)
def test_region_is_the_part_of_the_ellipse_that_does_not_fall(data):
    fit, best, covariance = curve_of(*data)
    quantile = 1.959964 if data[-1] is None else 2.200985  # Student's t of 11
    off = fit.region() - best
    distance = np.einsum("ni,ij,nj->n", off, np.linalg.inv(covariance), off)
    np.testing.assert_allclose(distance, quantile**2, rtol=1e-5)
    slopes = fit.region()[:, 1]
    least = best[1] - quantile * data[2]
    assert slopes.max() == pytest.approx(best[1] + quantile * data[2], rel=1e-4)
    assert slopes.min() == pytest.approx(max(least, 0.0), abs=1e-3)
    low, high = fit.beta_interval()
    assert low == pytest.approx(1 / slopes.max(), rel=1e-3)
    assert (high == math.inf) == (least <= 0)


def test_medians_that_are_not_bounded_have_intervals_and_no_overflow():
    """Of a slope that is hardly known: exp of the error of the logarithm is beyond any number."""
    for slope_error in (1.0, 1e2, 1e4):
        fit, *_ = curve_of(5.0, 50.0, slope_error, clusters=2)
        low, high = fit.median_interval()
        assert 0 <= low < 5.0 < high <= math.inf
        assert np.isfinite(fit.region()).all()


def test_line_too_flat_for_a_median_is_refused():
    """Of 4,000 runs at each of two intensities, 1,000 and 1,001 overturn."""
    overturned = np.tile(np.arange(4000), 2) < np.repeat([1000, 1001], 4000)
    low, high = lognormal(np.repeat([1.0, 1.01], 4000), overturned).median_interval()
    assert 1 < low < high == math.inf
    with pytest.raises(DegenerateData, match="hardly depends on the intensity"):
        lognormal(np.repeat([1.0, 10.0], 4000), overturned)


@pytest.mark.long
@pytest.mark.parametrize("n, median, beta", [(40, 0.4, 0.4), (115, 1.0, 0.4), (115, 1.5, 0.5)])
def test_intervals_of_few_runs_hold_the_truth_as_often_as_they_say(n, median, beta):
    """A normal interval of the logarithm of the median held it in 92, 92 and 87 of 100."""
    rng, held = np.random.default_rng(7), []
    while len(held) < 500:
        im = rng.lognormal(math.log(0.4), 0.6, n)
        try:
            fit = lognormal(im, rng.normal(size=n) < np.log(im / median) / beta)
        except DegenerateData:
            continue
        ends = fit.median_interval(), fit.beta_interval()
        held.append([low < one < high for (low, high), one in zip(ends, (median, beta))])
    error = 3 * math.sqrt(0.05 * 0.95 / 500)
    assert (np.mean(held, axis=0) >= 0.95 - error).all()


@pytest.mark.parametrize("fit", [lognormal, logit])
def test_scores_of_whole_motions_make_the_covariance_that_is_documented(fit):
    im, overturned = stripes(np.random.default_rng(9), 10)
    motion, step = np.tile(np.arange(10), 8), 1e-5
    x, own = np.column_stack([np.ones(im.size), np.log(im)]), fit(im, overturned, motion)
    log_p = norm.logcdf if fit is lognormal else lambda eta: -np.log1p(np.exp(-eta))
    sign = np.where(overturned, 1.0, -1.0)
    score = np.stack(
        [
            log_p(sign * (x @ (own.fit.params + e))) - log_p(sign * (x @ (own.fit.params - e)))
            for e in step * np.eye(2)
        ],
        axis=1,
    ) / (2 * step)
    groups = np.array([score[motion == one].sum(axis=0) for one in range(10)])
    inverse = np.linalg.inv(-own.fit.model.hessian(own.fit.params))
    expected = 10 / 9 * inverse @ groups.T @ groups @ inverse
    found = own.covariance
    if fit is lognormal:  # of (ln median, beta), back to (a, b)
        a, b = own.fit.params
        back = np.linalg.inv(np.array([[-1 / b, a / b**2], [0.0, -1 / b**2]]))
        found = back @ found @ back.T
    assert own.clusters == 10
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_diagnostics_name_the_run_that_pulls_at_the_curve():
    im, overturned = stripes(np.random.default_rng(1))
    odd = int(np.argmin(im))
    overturned[odd] = True  # at the least intensity
    influence = lognormal(im, overturned).fit.get_influence()
    assert int(np.argmax(influence.cooks_distance[0])) == odd


@pytest.mark.parametrize(
    "im, overturned, reason",
    [
        ([1, 2, 3], [0, 0, 0], "none of 3"),
        ([1, 2, 3], [1, 1, 1], "all of 3"),
        ([1, 2, 3, 4], [0, 0, 1, 1], "parts all runs"),
        ([1, 2, 2, 3], [0, 0, 1, 1], "parts all runs"),
        ([2, 2, 2], [0, 1, 0], "do not vary"),
    ],
)
def test_data_without_a_maximum_are_refused_in_words(im, overturned, reason):
    for fit in (lognormal, logit):
        with pytest.raises(DegenerateData, match=reason):
            fit(im, overturned)


@pytest.mark.parametrize(
    "im, beyond, said",
    [
        ([1, 2], [0, 0], "none of 2 runs are beyond the limit: that bounds P(top > 50 mm), but"),
        ([1, 2, 3, 4], [0, 0, 1, 1], "all runs beyond the limit from all within it: the slope"),
        ([1, 2, 3, 4, 5], [1, 1, 0, 1, 0], "top > 50 mm gets rarer with the intensity measure"),
    ],
)
def test_refusals_name_the_limit_state(im, beyond, said):
    with pytest.raises(DegenerateData, match=re.escape(said)):
        lognormal(im, beyond, event="top > 50 mm")


def test_a_median_that_no_number_tells_names_the_limit_state():
    for event, said in (
        ("overturn", "overturning hardly depends on the intensity measure: half would overturn at"),
        ("lost", "lost hardly depends on the intensity measure: half would be beyond the limit at"),
    ):
        with pytest.raises(DegenerateData, match=said):
            median_of(1.0, 1e-9, event)


def test_plane_that_parts_two_measures_is_found():
    rng = np.random.default_rng(6)
    im = rng.lognormal(0, 1, (60, 2))
    with pytest.raises(DegenerateData, match="parts all runs"):
        logit(im, np.log(im).sum(axis=1) > 0.1)
    with pytest.raises(DegenerateData, match="independently"):
        logit(np.column_stack([im[:, 0], im[:, 0] ** 2]), rng.random(60) < 0.5)


def test_overturning_that_gets_rarer_has_no_lognormal_fragility_but_a_trend():
    im, overturned = stripes(np.random.default_rng(7))
    with pytest.raises(DegenerateData, match="rarer"):
        lognormal(im, ~overturned)
    assert logit(im, ~overturned).coefficients[1] < 0


def test_intensities_must_be_positive():
    with pytest.raises(ValueError, match="positive"):
        lognormal([0.0, 1, 2], [0, 1, 0])
    with pytest.raises(ValueError, match="one length"):
        lognormal([1.0, 2], [0, 1, 0])


def draw(rng, n=150):
    """ln u = -2.5 + 1.5 ln im + 0.5 e, overturned beyond 0.25 m: about a third."""
    im = rng.lognormal(0.4, 0.6, n)
    u = np.exp(-2.5 + 1.5 * np.log(im) + 0.5 * rng.normal(size=n))
    return im, u, u > 0.25


def test_displacements_with_overturned_runs_censored_are_unbiased():
    rng, found, inside = np.random.default_rng(8), [], []
    truth = np.array([-2.5, 1.5, 0.5])
    for _ in range(400):
        fit = displacement(*draw(rng), cap_m=0.25)
        estimate = np.append(fit.coefficients, fit.sigma)
        found.append(estimate)
        inside.append(np.abs(estimate - truth) < 1.96 * np.sqrt(np.diag(fit.covariance)))
    np.testing.assert_allclose(np.mean(found, axis=0), truth, atol=0.02)
    np.testing.assert_allclose(
        np.mean(inside, axis=0), 0.95, atol=3 * math.sqrt(0.05 * 0.95 / 400) + 0.01
    )
    im, u, overturned = draw(rng, 5000)
    # without the censored runs: biased
    assert np.polyfit(np.log(im[~overturned]), np.log(u[~overturned]), 1)[0] < 1.3


def test_displacements_without_overturns_are_least_squares():
    im, u, _ = draw(np.random.default_rng(9))
    fit = displacement(im, u, np.zeros(u.size, bool), cap_m=10)
    slope, constant = np.polyfit(np.log(im), np.log(u), 1)
    assert fit.coefficients == pytest.approx([constant, slope], rel=1e-6)
    assert fit.sigma == pytest.approx(np.std(np.log(u) - constant - slope * np.log(im)), rel=1e-6)
    assert fit.median_m([2.0]) == pytest.approx([math.exp(constant) * 2**slope], rel=1e-6)


def test_exceedance_at_the_cap_is_the_share_that_overturns():
    im, u, overturned = draw(np.random.default_rng(10), 20000)
    near = np.abs(np.log(im / 2)) < 0.05
    band = displacement(im, u, overturned, cap_m=0.25).exceedance(0.25, [2.0])
    assert (
        band.p[0] == pytest.approx(overturned[near].mean(), abs=0.04)
        and band.lower[0] < band.p[0] < band.upper[0]
    )
    with pytest.raises(ValueError, match="censored there"):
        displacement(im, u, overturned, cap_m=0.25).exceedance(0.3, [2.0])


def test_displacements_that_cannot_be_fitted_are_refused():
    with pytest.raises(DegenerateData, match="too few"):
        displacement([1.0, 2, 3], [0.1, 9, 9], [0, 1, 1])
    with pytest.raises(DegenerateData, match="without scatter"):
        displacement([1.0, 2, 4, 8], [0.01, 0.02, 0.04, 0.08], [0, 0, 0, 0])


@pytest.mark.parametrize("noise", [0.0, 1e-13, 1e-8])
def test_measures_that_go_with_each_other_are_refused(noise):
    rng = np.random.default_rng(3)
    im = np.exp(rng.normal(size=80))
    both = np.column_stack([im, 9.81 * im * (1 + noise * rng.normal(size=80))])
    with pytest.raises(DegenerateData, match="independently"):
        logit(both, im * np.exp(rng.normal(size=80)) > 1)
