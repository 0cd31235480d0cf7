"""Frictional contact of a few points."""

import numpy as np
import pytest

from fecolumn.contact.friction import solve_contact


def _compliance(n, seed):
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(3 * n, 3 * n))
    rigid = np.tile(np.eye(3), (n, 1))
    return B @ B.T * 1e-10 / n + np.eye(3 * n) * 1e-9 + rigid @ rigid.T * 1e-7


def test_one_point_sticks_inside_the_cone():
    """g = -1e-6 m, s = 1e-7 m against 1e-9 m/N: 1000 N and 100 N, inside mu = 0.3."""
    W = 1e-9 * np.eye(3)
    solution = solve_contact(W, np.array([[1e-7, 0.0, -1e-6]]), 0.3, np.zeros((1, 3)))
    np.testing.assert_allclose(solution.forces, [[-100.0, 0.0, 1000.0]], rtol=1e-9)


def test_one_point_slips_on_the_cone_against_the_motion():
    W = 1e-9 * np.eye(3)
    solution = solve_contact(W, np.array([[6e-7, -8e-7, -1e-6]]), 0.3, np.zeros((1, 3)))
    np.testing.assert_allclose(solution.forces, [[-180.0, 240.0, 1000.0]], rtol=1e-9)


@pytest.mark.parametrize("mu", [0.0, 0.05, 0.3, 0.8])
@pytest.mark.parametrize("seed", range(10))
def test_random_problems_satisfy_signorini_and_coulomb(mu, seed):
    n = 5 + 3 * seed
    W, q = _compliance(n, seed), np.random.default_rng(seed).normal(size=(n, 3)) * 1e-5
    solution = solve_contact(W, q, mu, np.zeros((n, 3)))
    relative = (W @ solution.forces.ravel()).reshape(n, 3) + q
    normal, tangential = solution.forces[:, 2], np.linalg.norm(solution.forces[:, :2], axis=1)
    assert normal.min() >= -1e-9
    assert relative[:, 2].min() >= -1e-11
    assert np.abs(normal * relative[:, 2]).max() < 1e-9
    # the residual is a length: 1e-12 m at the 1e9 N/m of a point is 1e-3 N
    assert np.all(tangential <= mu * normal + 3e-3)
    assert np.einsum("na,na->n", solution.forces[:, :2], relative[:, :2]).max() < 1e-8
