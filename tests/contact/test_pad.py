import numpy as np
import pytest

from fecolumn.contact.pad import Pad, dashpot_work, indent


@pytest.mark.parametrize("relaxation", [0.0, 2e-4, 1e-2])
def test_springs_and_dashpots_take_no_more_than_the_forces_give(relaxation):
    """Pressed, eased and let go of, in steps longer and shorter than the relaxation time."""
    pad = Pad(np.full((1, 3), 1e5), relaxation)
    give, kept = pad.give(1e-3)
    held, taken, given = np.zeros((1, 3)), [], 0.0
    for force in (50.0, 120.0, 120.0, 60.0, 1.0, 0.0, 0.0):
        r, after = np.array([[0.1 * force, 0.0, force]]), np.empty((1, 3))
        indent(give, kept, r, held, after)
        taken.append(dashpot_work(pad.stiffness, give, kept, r, held, after))
        given += float(np.sum(r * (give * r + (kept - 1) * held)))
        held = after
    assert min(taken) > -1e-15 and held[0, 2] >= 0
    assert sum(taken) + 0.5e5 * np.sum(held**2) == pytest.approx(given, rel=1e-12)


def test_force_of_a_step_is_that_of_the_midpoint():
    pad = Pad(np.full((1, 3), 2e4), 3e-3)
    give, kept = pad.give(1e-3)
    before, after, force = np.array([[0.0, 0.0, 1e-3]]), np.empty((1, 3)), np.array([[0.0, 0.0, 70.0]])
    indent(give, kept, force, before, after)
    u0, u1 = before[0, 2], after[0, 2]
    assert 2e4 * (u0 + u1) / 2 + 2e4 * 3e-3 * (u1 - u0) / 1e-3 == pytest.approx(70.0, rel=1e-12)
