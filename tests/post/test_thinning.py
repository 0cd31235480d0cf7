"""A thinned history draws the same lines with fewer points."""

import numpy as np
import pytest

from fecolumn.pictures.figures.thinning import thinned


def _rocking(n: int = 4000):
    """Time [s] and three components of a decaying motion with kinks, as impacts make them."""
    time = np.cumsum(np.random.default_rng(3).uniform(2e-3, 8e-3, n))
    return time, np.column_stack(
        [
            np.exp(-time / 8) * np.abs(np.sin(7 * time)),
            0.3 * np.sin(5 * time),
            np.random.default_rng(4).normal(0, 1e-3, n),
        ]
    )


@pytest.mark.parametrize("share", [0.002, 0.02, 0.2])
def test_straight_lines_between_the_rows_kept_miss_no_row_by_more_than_the_tolerance(share):
    time, values = _rocking()
    tolerance = share * np.abs(values).max(axis=0)
    rows = thinned(time, values, tolerance)
    drawn = np.column_stack([np.interp(time, time[rows], column[rows]) for column in values.T])
    assert (np.abs(drawn - values) <= tolerance * (1 + 1e-9)).all()
    assert rows[0] == 0 and rows[-1] == len(time) - 1 and (np.diff(rows) > 0).all()


def test_a_coarser_tolerance_keeps_fewer_rows_and_a_straight_line_its_ends_alone():
    time, values = _rocking()
    kept = [len(thinned(time, values[:, :2], (share, share))) for share in (0.002, 0.02, 0.2)]
    assert len(time) / 3 > kept[0] > 2 * kept[1] > 4 * kept[2]
    assert thinned(time, np.column_stack([2 * time - 1, 0 * time]), (1e-6, 1e-6)).tolist() == [
        0,
        len(time) - 1,
    ]


def test_one_or_two_rows_stay():
    assert thinned([0.0], [[1.0]], (0.1,)).tolist() == [0]
    assert thinned([0.0, 1.0], [[1.0], [2.0]], (0.1,)).tolist() == [0, 1]
