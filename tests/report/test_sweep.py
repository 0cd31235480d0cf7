"""What a report reads from a study."""

import numpy as np
from synthetic_study import DT, LIMIT_M, write_synthetic

from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.sample import read_sample


def test_displacement_at_which_an_overturned_run_stopped_is_no_peak(tmp_path):
    """Without a cap in the case nothing is known of what overturned but that it went further than
    all that stood.
    """
    folder = write_synthetic(tmp_path, {DT: [1e-3]}, 40)
    sweep, sample = read_sweep(folder), read_sample(str(folder))
    u, overturned = sweep.done[0].peaks()
    assert 0 < overturned.sum() < 40
    np.testing.assert_array_equal(np.isnan(u), overturned)
    np.testing.assert_array_equal(np.isnan(sample.u_max), sample.lost)
    assert sweep.limit_m == np.nanmax(u) < LIMIT_M
