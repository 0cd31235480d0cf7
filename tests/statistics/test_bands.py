"""Bands hold the truth as often as they say: pointwise at one u, simultaneous at all."""

import math

import numpy as np
import pytest
from scipy.stats import binom, binomtest

from fecolumn.statistics.bands import (
    dkw,
    dkw_distance,
    greenwood,
    wilson,
)
from fecolumn.statistics.ecdf import ecdf


def test_greenwood_by_hand():
    # 0.6 +- 1.95996 sqrt(0.6 * 0.4 / 5) = 0.6 +- 0.42941, clipped
    lower, upper = greenwood([0.0, 0.6, 1.0], 5)
    np.testing.assert_allclose(lower, [0, 0.170593, 1], atol=1e-6)
    np.testing.assert_allclose(upper, [0, 1, 1], atol=1e-6)


@pytest.mark.parametrize("n", [1, 7, 115])
def test_wilson_is_scipys(n):
    k = np.arange(n + 1)
    lower, upper = wilson(k, n, 0.9)
    expected = [binomtest(int(count), n).proportion_ci(0.9, method="wilson") for count in k]
    np.testing.assert_allclose(lower, [interval.low for interval in expected], atol=1e-12)
    np.testing.assert_allclose(upper, [interval.high for interval in expected], atol=1e-12)


@pytest.mark.parametrize(
    "band, floor, ceiling",
    [(greenwood, 0.90, 0.965), (wilson, 0.93, 0.97)],
)
def test_pointwise_bands_cover_an_ensemble_of_115_as_they_say(band, floor, ceiling):
    """Coverage summed over all outcomes: exact, no simulation.

    Greenwood's falls short of 95 % towards F = 0 and 1.
    """
    n, k = 115, np.arange(116)
    lower, upper = band(k / n if band is greenwood else k, n)
    coverage = [
        binom.pmf(k, n, p)[(lower <= p) & (p <= upper)].sum() for p in np.linspace(0.06, 0.94, 89)
    ]
    assert floor < min(coverage) and np.mean(coverage) < ceiling


def test_dkw_has_massarts_constant():
    # sqrt(ln(2 / 0.05) / (2 * 115)) = sqrt(3.688879 / 230) = 0.126644
    assert dkw_distance(115) == pytest.approx(0.126644, abs=1e-6)
    f = ecdf([0.01, 0.02, 0.03, 0.04], [False, False, False, True])
    lower, upper = dkw(f.cdf, f.n)
    reach = math.sqrt(math.log(40) / 8)
    np.testing.assert_allclose(lower, np.maximum(f.cdf - reach, 0))
    np.testing.assert_allclose(upper, np.minimum(f.cdf + reach, 1))


@pytest.mark.parametrize("share", [0.0, 0.4, 0.9])
def test_simultaneous_band_holds_the_whole_curve_in_95_of_100_ensembles(share):
    """Uniform u, the runs above 1 - share overturned.

    The band is exact for many runs and none overturned, safe otherwise.
    """
    rng, n, inside = np.random.default_rng(810), 115, []
    for _ in range(1500):
        u = rng.random(n)
        f = ecdf(u, u > 1 - share)
        lower, upper = dkw(f.cdf, f.n)
        # F is continuous: the worst is at a step or just before it
        edges = np.append(f.x, 1 - share)
        before = np.concatenate([[0.0], upper]) if upper.size else [dkw_distance(n)]
        before[0] = dkw_distance(n)
        inside.append((lower <= f.x).all() and (edges <= before).all())
    error = 3 * math.sqrt(0.05 * 0.95 / 1500)
    assert np.mean(inside) > 0.95 - error
    assert share or np.mean(inside) < 0.97 + error


def test_counts_beyond_the_sample_are_refused():
    with pytest.raises(ValueError, match="counts must lie in"):
        wilson([3, 6], 5)
    with pytest.raises(ValueError, match="confidence"):
        dkw_distance(5, 95)
