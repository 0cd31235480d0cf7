"""Compliance of contact points between bodies, against whole matrices and closed forms."""

import numpy as np
import pytest
from two_blocks import NO_BASE, Blocks, compliance

from fecolumn.contact.projection import base_of
from fecolumn.contact.bodies import one_body
from fecolumn.contact.compliance import assemble, static_displacement
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.pose import poses_on_base


def found(blocks, nodal, rigid, active=None, factor=0.0):
    active = np.arange(len(blocks.points)) if active is None else np.asarray(active)
    W = np.empty((3 * len(active), 3 * len(active)))
    assemble(blocks.bodies, NO_BASE, blocks.points, blocks.points["arm"].copy(), active, blocks.poses, rigid, nodal, factor, blocks.own, W)
    return W


@pytest.mark.parametrize("n", [1, 2, 7])
@pytest.mark.parametrize("mobile", [True, False])
def test_mobility_of_points_between_two_bodies_is_the_sum_over_both(n, mobile):
    """The master's lower nodes are interpolated, its rigid motion too; whether that comes by mass and inertia or in the nodal matrix."""
    blocks = Blocks(n, mobile)
    np.testing.assert_allclose(found(blocks, blocks.bodies.mobility, 1.0), blocks.dense(blocks.elastic, 1.0), rtol=0, atol=1e-13)


def test_compliance_of_chosen_points_is_a_part_of_that_of_all():
    blocks = Blocks(6, True)
    active, whole = [4, 1, 3], blocks.dense(blocks.static, 0.0)
    rows = (3 * np.array(active)[:, None] + np.arange(3)).ravel()
    part = whole[np.ix_(rows, rows)] + np.diag(blocks.own[active].ravel())
    np.testing.assert_allclose(found(blocks, blocks.bodies.static, 0.0, active, 1.0), part, rtol=0, atol=1e-21)


def test_two_points_on_a_rod_are_coupled_by_its_rotation():
    """Rod of mass m and inertia m l^2 / 12: an impulse at one end moves it by 4 / m, the other by -2 / m."""
    mass, length = 3.0, 2.0
    arms = np.array([[-length / 2, 0, 0], [length / 2, 0, 0]])
    rod = one_body(arms, np.zeros((6, 6)), np.zeros((6, 6)), mass, np.diag([1.0, mass * length**2 / 12, mass * length**2 / 12]))
    W = np.empty((6, 6))
    assemble(rod, NO_BASE, node_points(arms, 0.5), arms, np.arange(2), poses_on_base(np.eye(3)[None]), 1.0, rod.mobility, 0.0, np.zeros((2, 3)), W)
    assert W[2::3, 2::3] == pytest.approx(np.array([[4, -2], [-2, 4]]) / mass)
    assert W[0::3, 0::3] == pytest.approx(np.full((2, 2), 1 / mass))


def test_static_displacement_is_the_compliance_times_the_forces():
    blocks, rng = Blocks(5, False), np.random.default_rng(3)
    contact, moved = np.zeros(5, CONTACT), np.empty((5, 3))
    contact["force"][[0, 2, 3]] = np.abs(rng.normal(size=(3, 3)))
    listed = np.array([0, 2, 3, 4])
    static_displacement(blocks.bodies, NO_BASE, blocks.points, blocks.poses, contact, listed, moved)
    whole = (blocks.dense(blocks.static, 0.0) @ contact["force"].ravel()).reshape(5, 3)
    np.testing.assert_allclose(moved[listed], whole[listed], rtol=1e-12)


def test_base_gives_way_below_the_points():
    """Two points on one facet: the base's compliance between the points by their shares in its nodes."""
    rng = np.random.default_rng(4)
    C, arms = compliance(rng, 4), np.zeros((2, 3))
    body, points = one_body(arms, np.zeros((6, 6)), np.zeros((6, 6))), node_points(arms, 0.5)
    points["below"], points["shares"] = np.arange(4), rng.dirichlet(np.ones(4), 2)
    base, W = base_of(np.zeros(2), np.zeros(2), np.zeros((2, 2), np.int64), np.zeros(4, np.int64), C), np.empty((6, 6))
    assemble(body, base, points, arms, np.arange(2), poses_on_base(np.eye(3)[None]), 0.0, body.static, 1.0, np.zeros((2, 3)), W)
    H = np.kron(points["shares"], np.eye(3))
    np.testing.assert_allclose(W, H @ C @ H.T, rtol=1e-12)
