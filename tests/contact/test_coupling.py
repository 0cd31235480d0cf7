"""Points of bodies that move in few ways, by their levers, against the whole matrix."""

import numpy as np
import pytest

from fecolumn.contact.coupling import (
    coupling_by_levers,
    coupling_of,
    part_of,
    softened,
    stiffnesses,
    times,
    whole_of,
)
from fecolumn.contact.friction import iterate
from fecolumn.contact.newton import newton_step

JOINTS = {"stack": [(0, -1), (1, 0), (2, 1)], "frame": [(0, -1), (1, -1), (2, 0), (2, 1)]}


def points_of(joints, count, own=1e-3, seed=1, modes=0):
    """So many points a joint of bodies of size 1, by random levers of rigid motion and modes."""
    rng = np.random.default_rng(seed)
    bodies = np.repeat(np.array(joints), count, axis=0)
    levers = rng.standard_normal((len(bodies), 3, 12 + 2 * modes))
    levers[bodies[:, 1] < 0, :, 6 + modes :] = 0.0
    return coupling_by_levers(np.full((len(bodies), 3), own), levers, bodies)


@pytest.mark.long
@pytest.mark.parametrize("modes", [0, 3])
@pytest.mark.parametrize("joints", JOINTS)
def test_levers_are_the_whole_matrix(joints, modes):
    coupling = points_of(JOINTS[joints], 5, modes=modes)
    W, n = whole_of(coupling), len(coupling.own)
    forces = np.random.default_rng(2).standard_normal((n, 3))
    assert np.linalg.eigvalsh(W).min() > 0.0
    np.testing.assert_allclose(times(coupling, forces).ravel(), W @ forces.ravel(), rtol=1e-12)
    listed = np.array([0, 3, n - 1])
    rows = (3 * listed[:, None] + np.arange(3)).ravel()
    np.testing.assert_allclose(whole_of(part_of(coupling, listed)), W[np.ix_(rows, rows)])
    give = np.linspace(1.0, 2.0, n)
    np.testing.assert_allclose(whole_of(softened(coupling, give)), W + np.diag(np.repeat(give, 3)))
    dense = coupling_of(W)
    np.testing.assert_allclose(stiffnesses(coupling, False), stiffnesses(dense, False))
    # by products of lengths, no softer than by six columns a body
    together, exact = stiffnesses(coupling, True), stiffnesses(dense, True)
    assert (together <= exact * (1 + 1e-12)).all() and (together > exact / 6).all()


@pytest.mark.long
@pytest.mark.parametrize("joints", JOINTS)
@pytest.mark.parametrize("friction", [0.0, 0.3, 1.0])
def test_a_newton_step_by_levers_is_that_by_the_whole_matrix(joints, friction):
    """Points that stick, slip and open among them; with and without give against change."""
    coupling, rng = points_of(JOINTS[joints], 8), np.random.default_rng(3)
    dense, n = coupling_of(whole_of(coupling)), len(coupling.own)
    q, forces = rng.standard_normal((n, 3)), rng.standard_normal((n, 3))
    forces[:, 2] = np.abs(forces[:, 2])
    relative, rho = times(dense, forces) + q, stiffnesses(dense, False)
    for give in (0.0, 1e-2):
        one, other = (
            newton_step(way, q, forces, relative, np.full(n, friction), rho, give)
            for way in (coupling, dense)
        )
        assert one[1] and other[1]
        assert 0 < (other[0][:, 2] != 0).sum() < n
        np.testing.assert_allclose(one[0], other[0], rtol=0, atol=1e-8 * np.abs(other[0]).max())


@pytest.mark.parametrize("seed", range(5))
def test_forces_by_levers_are_those_by_the_whole_matrix(seed):
    coupling, rng = points_of(JOINTS["stack"], 8, seed=seed), np.random.default_rng(seed)
    q, mu = rng.standard_normal((len(coupling.own), 3)), np.full(len(coupling.own), 0.5)
    start = np.zeros_like(q)
    forces, residual, _, _ = iterate(coupling, q, mu, start, 1e-10, True, 800)
    other, least, _, _ = iterate(coupling_of(whole_of(coupling)), q, mu, start, 1e-10, True, 800)
    assert residual <= 1e-10 and least <= 1e-10
    np.testing.assert_allclose(times(coupling, forces), times(coupling, other), atol=1e-7)
