"""A column that stands still stays still."""

import numpy as np
import pytest
from coarse_column import THICK, coarse_system

from fecolumn.engines.dynamics.energy import Ledger
from fecolumn.engines.dynamics.gravity import NoEquilibrium, iterate_to_rest, standing
from fecolumn.engines.dynamics.stepper import Stepper


@pytest.mark.parametrize("alpha", [0.0, -0.2, -0.333])
@pytest.mark.parametrize("dt", [0.02, 1e-3, 1e-4])
def test_standing_column_neither_drifts_nor_gains_energy(dt, alpha):
    system = coarse_system(**THICK, integration={"dt_s": dt, "alpha_hht": alpha})
    state = start = standing(system)
    assert start.forces[:, 2].sum() == pytest.approx(system.weight, rel=1e-6)
    ledger = Ledger(system)
    ledger.open(start)
    stepper = Stepper(system, ledger)
    for _ in range(100):
        state = stepper.step(state, np.zeros(3))
    assert np.abs(state.x - start.x).max() < 1e-8
    energy = sum(ledger.state_terms(state).values()) - ledger.start
    assert abs(energy) < 1e-6 * system.weight * 1.01


def contracting(ratio):
    """Proximal steps that move a structure by 1 m times a power of `ratio`: 0.87 is a tube on a pad
    that tilts under five times its own moment.
    """
    moved = 1.0

    def proximal_step():
        nonlocal moved
        moved *= ratio
        return moved

    return proximal_step


@pytest.mark.parametrize("ratio", [1e-4, 0.87, 0.97])
def test_a_soft_pad_only_takes_more_iterations_to_equilibrium(ratio):
    iterate_to_rest(contracting(ratio), 1.0)


@pytest.mark.parametrize("ratio", [0.99, 1.0, 1.1])
def test_a_column_that_hardly_comes_to_rest_has_no_equilibrium(ratio):
    with pytest.raises(NoEquilibrium, match="still moving by"):
        iterate_to_rest(contracting(ratio), 1.0)
