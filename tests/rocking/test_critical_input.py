"""The worst impulses for a block: closed form against the block that gets them."""

import math

import numpy as np
import pytest

from fecolumn.engines.rocking.critical_input import critical_motion, least_impulse, tilt_velocities
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.overturning import critical_tilt_rate
from fecolumn.engines.rocking.swing import rock_one
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.engines.rocking.swing_motion import FALL_TIME, IMPACT_COUNT, PEAK_TILT

ALPHA, P = 0.2, 2.0
KEPT = housner_restitution(ALPHA)


@pytest.mark.parametrize("impulses", [1, 2, 5])
def test_the_last_impulse_overturns_and_a_little_less_does_not(impulses):
    """Impulses of two steps of 0.1 ms: the block tilts by w dt meanwhile, 1e-4 of alpha."""
    for share, falls in ((0.998, False), (1.002, True)):
        impulse = share * least_impulse(ALPHA, P, KEPT, impulses)
        motion = critical_motion(ALPHA, P, KEPT, impulse, impulses, 1e-4)
        found = rock_one(
            motion.acceleration[:, [0, 2]], motion.dt, row_of_block(ALPHA, P, KEPT), free_s=20.0
        )[2]
        assert math.isinf(found[PEAK_TILT]) == falls, share
        if falls:
            assert found[IMPACT_COUNT] == impulses - 1 and (
                found[FALL_TIME] > 0 or found[PEAK_TILT] > 1
            )


def test_many_impulses_below_the_limit_never_overturn_and_above_it_do():
    limit = least_impulse(ALPHA, P, KEPT)
    assert tilt_velocities(ALPHA, P, KEPT, 0.999 * limit, 2000).max() < P * critical_tilt_rate(
        ALPHA
    )
    assert tilt_velocities(ALPHA, P, KEPT, 1.001 * limit, 2000).max() > P * critical_tilt_rate(
        ALPHA
    )
    assert np.diff([least_impulse(ALPHA, P, KEPT, n) for n in (1, 2, 5, 50)]).max() < 0


def test_larger_blocks_of_one_slenderness_need_larger_impulses():
    """dV goes with 1/p: with the square root of the size."""
    assert least_impulse(ALPHA, P / 2, KEPT, 3) == pytest.approx(
        2 * least_impulse(ALPHA, P, KEPT, 3)
    )
