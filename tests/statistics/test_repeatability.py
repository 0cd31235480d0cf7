"""Growth of tiny perturbations: measured on systems whose rate is known."""

import math

import numpy as np
import pytest

from fecolumn.statistics.repeatability import aligned, horizon, spread, time_gained


def growing(rate=3.0, size=1e-9, k=8, seed=1):
    """Runs that part as size exp(rate t) around a sine of 0.1 m, until they differ by the sine
    itself.
    """
    rng, times = np.random.default_rng(seed), np.linspace(0, 8, 801)
    away = size * rng.normal(size=(k, 1)) * np.exp(rate * times)
    return 0.1 * (np.sin(5 * times) + np.tanh(away)), times


def test_exponential_rate_is_recovered():
    paths, times = growing()
    found = spread(paths, times)
    assert found.rate == pytest.approx(3.0, rel=0.01)
    assert found.interval == pytest.approx((3.0, 3.0), abs=0.1)  # all runs part at one rate
    assert found.window[1] == pytest.approx(horizon(found.spread, times, found.peak), abs=0.011)


def test_logistic_map_parts_at_ln_2_a_step():
    """x -> 4 x (1 - x): Lyapunov exponent ln 2, exactly."""
    rng = np.random.default_rng(2)
    rates = []
    for _ in range(40):
        x = rng.uniform(0.1, 0.9) + 1e-12 * rng.normal(size=12)
        path = [x]
        for _ in range(60):
            path.append(4 * path[-1] * (1 - path[-1]))
        rates.append(spread(np.array(path).T, np.arange(61.0)).rate)
    assert np.mean(rates) == pytest.approx(
        math.log(2), abs=3 * np.std(rates) / math.sqrt(40) + 0.01
    )


def test_runs_that_never_part_have_no_rate_and_no_horizon():
    times = np.linspace(0, 5, 501)
    paths = np.sin(times) + 1e-9 * np.arange(4)[:, None]
    found = spread(paths, times)
    assert math.isnan(found.rate) and horizon(found.spread, times, found.peak) == math.inf
    assert math.isnan(spread(np.tile(np.sin(times), (3, 1)), times).rate)


def test_response_that_follows_its_perturbation_is_not_taken_for_chaos():
    """A path that begins at rest and is proportional to the load, the load perturbed: spread rises
    from 0 to 1e-6 of the peak, no more.
    """
    times = np.linspace(0, 5, 501)
    paths = np.expm1(np.minimum(times, 2))[None] * (1 + 1e-6 * np.arange(4)[:, None])
    assert spread(paths, times).rate > 0.5
    assert math.isnan(spread(paths, times, size=1e-6).rate)
    paths, times = growing(3.0, 1e-9)
    assert spread(paths, times, size=1e-9).rate == pytest.approx(3.0, rel=0.01)


def test_horizon_is_where_the_spread_passes_the_share():
    times = np.linspace(0, 10, 1001)
    assert horizon(1e-6 * np.exp(2 * times), times, peak=0.1, share=0.1) == pytest.approx(
        math.log(1e4) / 2, abs=0.011
    )
    with pytest.raises(ValueError, match="share"):
        horizon(times, times, 1.0, 0)


def test_tenfold_smaller_perturbation_gains_ln_10_over_the_rate():
    sizes, horizons = [], []
    for size in (1e-9, 1e-7, 1e-5, 1e-3):
        for seed in (1, 2, 3):
            paths, times = growing(3.0, size, seed=seed)
            sizes.append(size)
            horizons.append(horizon(spread(paths, times).spread, times, 0.1))
    gain, low, high = time_gained(sizes, horizons)
    assert low < math.log(10) / 3 < high and gain == pytest.approx(math.log(10) / 3, rel=0.05)
    with pytest.raises(ValueError, match="three finite"):
        time_gained([1e-9, 1e-6, 1e-3], [1.0, math.inf, 2.0])


def test_horizontal_path_counts_in_both_directions():
    paths, times = growing()
    turned = np.stack([0.6 * paths, 0.8 * paths], axis=-1)
    np.testing.assert_allclose(
        spread(turned, times).spread, spread(paths, times).spread, rtol=1e-9, atol=1e-16
    )


def test_run_that_overturned_early_stays_fallen():
    times, paths = aligned(
        [
            (np.arange(4) * 0.1, np.zeros((4, 2))),
            (np.arange(2) * 0.1, np.array([[0, 0], [0.25, 0.1]])),
        ]
    )
    assert times.size == 4 and paths.shape == (2, 4, 2)
    np.testing.assert_array_equal(paths[1, 1:], [[0.25, 0.1]] * 3)
    with pytest.raises(ValueError, match="same time step"):
        aligned([([0, 1.0, 2.0], [0, 0, 0]), ([0, 0.5, 1.0], [0, 0, 0])])


def test_last_row_of_a_thinned_history_does_not_make_a_step_of_its_own():
    thin, times = np.arange(5) * 0.005, np.array([0, 0.005, 0.010, 0.013])
    common, paths = aligned(
        [(np.append(thin, 0.022), np.append(2 * thin, 0.044)), (times, 2 * times)]
    )
    np.testing.assert_array_equal(common, thin)
    np.testing.assert_allclose(
        paths[:, :, 0], [2 * thin, [0, 0.01, 0.02, 0.026, 0.026]], rtol=1e-12
    )
