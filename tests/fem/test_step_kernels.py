"""What every step of the full-order engine asks for, against plain formulas: nearest rotation,
momentum, solution of one load.
"""

from __future__ import annotations

import numpy as np
import pytest

from fecolumn.fem.rotation import polar_rotation, rotation_matrix


def by_singular_values(moment):
    left, _, right = np.linalg.svd(moment)
    return left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right


@pytest.mark.parametrize("size", [1e-12, 1.0, 1e12])
def test_the_nearest_rotation_is_that_of_the_singular_values_of_stout_and_of_slender_bodies(size):
    random = np.random.default_rng(3)
    for stretch in ((1.0, 1.0, 1.0), (1.0, 2.0, 3.0), (1.0, 1.0, 3e3), (1.0, 3e3, 3e3)):
        turn, axes = rotation_matrix(random.normal(size=3)), rotation_matrix(random.normal(size=3))
        moment = size * turn @ axes @ np.diag(stretch) @ axes.T
        assert polar_rotation(moment) == pytest.approx(turn, abs=1e-12)


def test_a_mirrored_or_a_flat_body_gets_a_rotation_and_no_reflection():
    turn = rotation_matrix([0.3, -0.2, 0.5])
    for stretch in ((2.0, 1.0, -0.5), (2.0, 1.0, 0.0)):
        moment = turn @ np.diag(stretch)
        found = polar_rotation(moment)
        assert np.linalg.det(found) == pytest.approx(1.0)
        assert found == pytest.approx(by_singular_values(moment), abs=1e-14)


@pytest.fixture(scope="module")
def tied_body():
    """A tube with its cap tied on."""
    from fecolumn.case.case import case_from_tables
    from fecolumn.structures.bodies import drawing
    from fecolumn.structures.reduction import body_of

    case = case_from_tables(
        {
            "column": {"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 0.3},
            "cap": {"length_m": 0.15, "width_m": 0.15, "thickness_m": 0.02},
            "mesh": {"coarse_size_m": 0.035, "cap_size_m": 0.05},
        },
        "case",
    )
    column = drawing(case, "column", "case")
    return body_of(column.shape, column.material)


def test_the_momentum_of_a_tied_body_is_its_mass_times_velocity(tied_body):
    velocity = np.random.default_rng(5).normal(size=(tied_body.n_owned, 3))
    plain = tied_body.apply(tied_body.mass, velocity)
    assert tied_body.constraint.projection is not None
    assert tied_body.momentum(velocity) == pytest.approx(plain, abs=1e-14 * np.abs(plain).max())
    # a second product does not write into the first
    first = tied_body.momentum(velocity)
    tied_body.momentum(2 * velocity)
    assert first == pytest.approx(plain, abs=1e-14 * np.abs(plain).max())


def test_one_load_and_many_at_once_have_the_same_solution_and_leave_no_residual(tied_body):
    from fecolumn.engines.dynamics.hht import HHT
    from fecolumn.fem.effective import effective_factor

    hht = HHT(1e-3, -0.2)
    factor = effective_factor(tied_body, hht.mass_factor, hht.stiffness_factor)
    loads = tied_body.apply(
        tied_body.mass, np.random.default_rng(6).normal(size=(tied_body.n_owned, 3))
    )
    solution = factor.solve(loads)
    residual = (
        hht.mass_factor * tied_body.momentum(solution)
        + hht.stiffness_factor * tied_body.apply(tied_body.stiffness, solution)
        - loads
    )
    assert np.abs(residual).max() < 1e-9 * np.abs(loads).max()
    both = factor.solve(np.stack([loads, -2 * loads]))
    assert both[0] == pytest.approx(solution, abs=1e-12 * np.abs(solution).max())
    assert both[1] == pytest.approx(-2 * solution, abs=2e-12 * np.abs(solution).max())


def test_a_tangent_that_is_not_definite_is_factored_too(tied_body):
    """As that of a strained body, where an iteration is far from its answer: K less as much inertia
    as its lowest elastic modes have.
    """
    from fecolumn.fem.effective import effective_factor
    from fecolumn.fem.modes import free_modes

    between = -np.mean((2 * np.pi * free_modes(tied_body, 9).frequencies[6:9]) ** 2)
    factor = effective_factor(tied_body, between, 1.0, tied_body.stiffness)
    loads = tied_body.apply(
        tied_body.mass, np.random.default_rng(7).normal(size=(tied_body.n_owned, 3))
    )
    for solution, load in (
        (factor.solve(loads), loads),
        (factor.solve(np.stack([loads, -loads]))[1], -loads),
    ):
        residual = (
            between * tied_body.momentum(solution)
            + tied_body.apply(tied_body.stiffness, solution)
            - load
        )
        assert np.abs(residual).max() < 1e-9 * np.abs(load).max()
