"""The check of restarts in the suite does what it says: it stops an analysis at half, and one that
goes on is the uninterrupted one.
"""

import numpy as np
import pytest

from fecolumn.verification.invariance import SHAKEN_DT, resumed
from fecolumn.verification.models import shaking


@pytest.mark.long
def test_the_reduced_engine_is_interrupted_at_half_and_goes_on_to_the_same_end():
    motion = shaking(SHAKEN_DT * np.arange(1, 101))
    whole, halves = resumed("reduced", motion, 1), resumed("reduced", motion, 2)
    assert len(whole) == len(motion) + 1 and np.abs(whole).max() > 1e-4
    np.testing.assert_allclose(halves, whole, atol=1e-10 * np.abs(whole).max())
