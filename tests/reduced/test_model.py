"""The reduced model keeps the statics of the finite elements exactly, and their inertia."""

import numpy as np
import pytest
from pair import reduced, system_of, with_modes

from fecolumn.engines.reduced.model import scheme
from fecolumn.engines.reduced.structure import structure_of
from fecolumn.fem.free_body import FreeBody


@pytest.fixture(scope="module")
def system():
    return system_of(integration={"dt_s": 1e-3, "alpha_hht": -0.1})


@pytest.fixture(scope="module")
def model(system):
    return with_modes(system, 40).parts[0].model


def test_flexibility_is_that_of_the_filtered_foot_at_any_step(system, model):
    """U^T K^+ U + C = K^+, whatever the step's filter moves from one to the other."""
    foot, n = system.interface.foot.each[0], len(model.arms)
    response = (
        (foot.unit_push().T @ FreeBody(system.body).response(foot.unit_push()))
        .reshape(n, 3, n, 3)
        .transpose(0, 2, 1, 3)
    )
    assert (
        np.abs(response + foot.static - model.flexibility).max()
        < 1e-8 * np.abs(model.flexibility).max()
    )


def test_compliance_within_a_step_is_that_of_all_finite_elements(system, model):
    """Rigid motion, 40 modes and static rest against B A^-1 B^T; what is left is the inertia of the
    modes above.
    """
    interface = system.interface
    structure, points = structure_of(with_modes(system, 40), system.hht, system.gravity)
    mine, n = scheme(structure, points, system.hht), len(model.arms)
    skew = np.array([np.cross(np.eye(3), arm) for arm in model.arms])
    rigid = np.eye(3) / model.mass + np.einsum(
        "iab,bc,jdc->ijad", skew, np.linalg.inv(model.inertia), skew
    )
    W = mine.half * rigid.transpose(0, 2, 1, 3).reshape(3 * n, 3 * n) + mine.dynamic
    full = (
        system.operators(system.hht.mass_factor, system.hht.stiffness_factor).response.compliance[0]
        / (2 * system.hht.beta)
        + interface.foot.static[0]
    )
    full = full.transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)
    assert np.abs(W - full).max() < 1e-5 * np.abs(interface.foot.static[0]).max()


def test_column_stands_with_the_full_engines_contact_forces(system):
    from fecolumn.engines.dynamics.gravity import standing

    engine, state = reduced(system), standing(system)
    assert np.abs(engine.motion.forces - state.forces).max() < 1e-6 * system.weight
