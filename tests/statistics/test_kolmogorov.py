"""The asymptotic p-value of MATLAB's kstest2, and which samples have a printed one."""

import pytest
from scipy.stats import kstwobign

from fecolumn.statistics.kolmogorov import asymptotic_p, samples_of_p


def test_it_is_the_limiting_distribution_at_the_corrected_distance():
    root = (30 * 20 / 50) ** 0.5
    assert asymptotic_p(0.25, 30, 20) == pytest.approx(
        kstwobign.sf((root + 0.12 + 0.11 / root) * 0.25), rel=1e-9
    )


def test_no_distance_has_p_1_and_a_whole_one_nearly_none():
    assert asymptotic_p(0.0, 10, 10) == 1.0 and asymptotic_p(1.0, 50, 50) < 1e-15


def test_a_printed_p_has_few_samples():
    assert samples_of_p(0.65, 9, 26) == [(25, 5)]
    assert samples_of_p(0.15, 25, 42) == [(41, 10), (27, 8)]


def test_a_distance_beyond_one_is_refused():
    with pytest.raises(ValueError, match="distance"):
        asymptotic_p(1.2, 10, 10)
