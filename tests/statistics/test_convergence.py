import numpy as np
import pytest
from scipy.stats import kstwo

from fecolumn.statistics.convergence import cdf_convergence


def test_distance_from_the_whole_falls_as_drawing_without_replacement_says():
    """2000 motions, none overturned: Kolmogorov's quantiles times sqrt((N - n) / (N - 1)), within
    what 1000 draws can tell.
    """
    u, sizes = np.random.default_rng(1).lognormal(-3, 1, 2000), np.array([20, 100, 500, 1000])
    found = cdf_convergence(u, np.zeros(2000, bool), sizes, 1000, 2)
    factor = np.sqrt((2000 - sizes) / 1999)
    np.testing.assert_allclose(found.median, factor * kstwo.ppf(0.5, sizes), rtol=0.06)
    np.testing.assert_allclose(found.upper_95, factor * kstwo.ppf(0.95, sizes), rtol=0.08)
    assert (found.upper_95 < found.dkw_95).all()
    # halving what is left out matters as much as the number drawn: at n = N/2 the distance is
    # 1/sqrt(2) of an endless ensemble's
    expected = factor[-1] * kstwo.ppf(0.95, 1000)
    assert expected / found.dkw_95[-1] == pytest.approx(np.sqrt(0.5), abs=0.01)


def test_the_whole_is_itself_whatever_it_is_worth():
    found = cdf_convergence([0.1, 0.2, 0.3], [False, False, True], [1, 3])
    assert found.median[1] == found.upper_95[1] == 0 and found.dkw_95[1] > 0.7


def test_overturned_runs_are_ties_and_bring_the_distance_down():
    rng = np.random.default_rng(3)
    u = rng.lognormal(-3, 1, 400)
    none, most = (cdf_convergence(u, u > np.quantile(u, q), [50], 500, 4) for q in (1.0, 0.1))
    assert most.median[0] < 0.75 * none.median[0]


def test_size_beyond_the_ensemble_is_refused():
    with pytest.raises(ValueError, match=r"in \[1, 3\]"):
        cdf_convergence([0.1, 0.2, 0.3], [False] * 3, [4])
