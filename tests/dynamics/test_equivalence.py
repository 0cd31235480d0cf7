"""What must not change the answer: kinematics, and contact law as the penalty grows.

Shaken hard enough to rock.
"""

import numpy as np
import pytest
from coarse_column import THICK, coarse_system
from mpi4py import MPI  # noqa: F401  (before petsc4py)

from fecolumn.engines.dynamics.energy import Ledger
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.stepper import Stepper


def _shaken(steps=100, **sections):
    """Path of the highest node (steps, 2) [m] and the deepest penetration [m] under two tones."""
    system = coarse_system(**THICK, **sections)
    state = standing(system)
    ledger = Ledger(system)
    ledger.open(state)
    stepper, top = Stepper(system, ledger), int(np.lexsort(system.body.all_X.T)[-1])
    path, deepest = [], 0.0
    for step in range(1, steps + 1):
        t = 1e-3 * step
        state = stepper.step(state, np.array([4.0 * np.sin(30 * t), 3.0 * np.sin(40 * t), 0.0]))
        path.append(state.x[top, :2] - system.body.X[top, :2])
        deepest = max(deepest, -state.relative[:, 2].min())
    return np.array(path), deepest


@pytest.fixture(scope="module")
def reference():
    return _shaken()


def test_augmented_lagrange_does_not_penetrate(reference):
    path, deepest = reference
    assert np.abs(path).max() > 1e-3
    assert deepest < 1e-9


@pytest.mark.long
def test_total_lagrangian_goes_the_same_way(reference):
    path, _ = _shaken(integration={"kinematics": "total_lagrangian"})
    assert np.abs(path - reference[0]).max() < 1e-4 * np.abs(reference[0]).max()


def test_penalty_converges_to_augmented_lagrange_with_order_one(reference):
    """Order one in the interface's compliance, h / (k E A), from a tenth of a brick's own on."""
    peak = np.abs(reference[0]).max()
    off = [
        np.abs(
            _shaken(contact={"law": "penalty", "penalty_factor": factor})[0] - reference[0]
        ).max()
        for factor in (10, 100, 1000)
    ]
    assert off[0] / off[1] == pytest.approx(10, rel=0.1)
    assert off[1] / off[2] == pytest.approx(10, rel=0.02)
    assert off[2] < 1e-5 * peak
