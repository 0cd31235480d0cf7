"""What a count of runs says beside runs that failed: bounds over all that those might have been."""

import pytest

from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.statistics.failed_runs import RunCount


def test_without_failed_runs_it_is_the_plain_count():
    count = RunCount(3, 12)
    assert count.share == 0.25 and count.bounds == (0.25, 0.25) and count.runs == 12
    assert count.interval == proportion_interval(3, 12)
    assert count.text == "25.0 % [8.9, 53.2]"


@pytest.mark.parametrize("k, n, failed", [(3, 12, 4), (0, 2, 14), (9, 9, 1), (0, 0, 5)])
def test_interval_holds_that_of_every_outcome_of_the_failed_runs(k, n, failed):
    count = RunCount(k, n, failed)
    low, high = count.interval
    for events in range(failed + 1):
        least, most = proportion_interval(k + events, n + failed)
        assert low <= least <= most <= high
        assert count.bounds[0] <= (k + events) / (n + failed) <= count.bounds[1]
    assert count.bounds == (k / (n + failed), (k + failed) / (n + failed))


def test_bounds_are_told_where_runs_failed():
    assert RunCount(3, 12, 4).text == "between 18.8 and 43.8 % [6.6, 66.8]"
    assert RunCount(0, 0, 5).share != RunCount(0, 0, 5).share  # nobody knows it
