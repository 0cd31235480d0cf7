"""The reduced engine behind the interface of the verification cases."""

import numpy as np
import pytest

from fecolumn.contact.tolerances import SOLVED
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.fem.modes import free_modes
from fecolumn.verification.bar_impact import FORCE, SPEED, strike
from fecolumn.verification.models import block_system, box
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.trial import afloat


@pytest.fixture(scope="module")
def system():
    return block_system(
        "reduced",
        box([-0.1, 0, 0.1], [-0.1, 0.1], [0, 0.1, 0.3]),
        box([-1, 1], [-1, 1], [-0.1, 0]),
        HHT(1e-4, 0.0),
    )


def moving(system):
    """Turned and vibrating in its second elastic mode, flying and spinning."""
    column, shape = system.body, free_modes(system.body, 9).shapes[7]
    arm = column.X - column.center
    turn = np.array([[np.cos(0.3), -np.sin(0.3), 0], [np.sin(0.3), np.cos(0.3), 0], [0, 0, 1.0]])
    moved = (arm + 1e-5 * shape) @ turn.T - arm + [0.02, 0.0, 0.0]
    return afloat(
        system,
        moved,
        (np.cross([1.0, 2.0, -0.5], arm) + 0.3 * shape) @ turn.T + [0.1, 0.2, 0.3],
        np.tile(system.gravity, (len(arm), 1)),
        0.5,
    )


def test_projection_keeps_energy_and_place_of_a_state_within_its_modes(system):
    """Kinetic, strain and gravity energy as in full order, and the nodes back where they were."""
    full, reduced = begin_trial("corotated", system, moving), begin_trial("reduced", system, moving)
    for term in ("kinetic", "strain", "gravity"):
        assert reduced.energy()[term] == pytest.approx(full.energy()[term], rel=1e-7), term
    np.testing.assert_allclose(reduced.state.x, full.state.x, atol=1e-12)
    # spin times elastic displacement is left out of the reduced motion: 2.3 rad/s x 1e-5 m x the
    # shape's 0.3
    np.testing.assert_allclose(reduced.state.v, full.state.v, atol=1e-5)


def test_gravity_equilibrium_is_that_of_the_full_order(system):
    """Found by the reduced engine itself or projected: the same contact forces."""
    own, projected = (
        begin_trial("reduced", system),
        begin_trial("reduced", system, lambda system: standing(system)),
    )
    # laws of contact hold to SOLVED of the foot's width, across a point's stiffness
    compliance = system.interface.static_compliance(np.array([0]))
    np.testing.assert_allclose(
        own.state.forces,
        projected.state.forces,
        atol=SOLVED * system.interface.interfaces["width"][0] / compliance[0, 0],
    )
    np.testing.assert_allclose(own.state.x, projected.state.x, atol=1e-12)


def test_a_copied_state_starts_the_same_trial(system):
    first = begin_trial("reduced", system, moving)
    first.step()
    second = begin_trial("reduced", system, lambda _: first.state.copy())
    for _ in range(5):
        first.step(), second.step()
    np.testing.assert_allclose(second.state.x, first.state.x, atol=1e-12)


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_with_all_modes_a_bar_strikes_a_wall_as_in_full_order(alpha):
    """Eight bricks: contact force at every step, rebound and loss are those of the corotated
    engine.
    """
    full, reduced = (strike(engine, 8, alpha, "plastic") for engine in ("corotated", "reduced"))
    np.testing.assert_allclose(reduced.force, full.force, atol=1e-6 * FORCE)
    assert reduced.rebound == pytest.approx(full.rebound, abs=1e-6 * SPEED)
    assert reduced.contact == pytest.approx(full.contact, rel=1e-5)
