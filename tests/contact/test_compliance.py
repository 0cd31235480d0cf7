"""Compliance of contact points between bodies, against whole matrices and closed forms."""

import numpy as np
import pytest
from plain import poses_on_base
from two_blocks import NO_BASE, Blocks, compliance

from fecolumn.contact.bodies import one_body
from fecolumn.contact.compliance import assemble, even_out
from fecolumn.contact.displacement import static_displacement
from fecolumn.contact.gathered import gather
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.projection import base_of


def found(blocks, nodal, rigid, active=None, factor=0.0):
    active = np.arange(len(blocks.points)) if active is None else np.asarray(active)
    W = np.empty((3 * len(active), 3 * len(active)))
    assemble(
        blocks.bodies,
        NO_BASE,
        blocks.points,
        blocks.points["arm"].copy(),
        active,
        blocks.poses,
        rigid,
        nodal,
        factor,
        blocks.own,
        W,
    )
    return W


@pytest.mark.long
@pytest.mark.parametrize("n", [1, 2, 7, 12])
@pytest.mark.parametrize("mobile", [True, False])
def test_mobility_of_points_between_two_bodies_is_the_sum_over_both(n, mobile):
    """The master's lower nodes are interpolated, its rigid motion too; whether that comes by mass
    and inertia or in the nodal matrix.
    """
    blocks = Blocks(n, mobile)
    np.testing.assert_allclose(
        found(blocks, blocks.bodies.mobility, 1.0),
        blocks.dense(blocks.elastic, 1.0),
        rtol=0,
        atol=1e-13,
    )


def test_compliance_of_chosen_points_is_a_part_of_that_of_all():
    blocks = Blocks(6, True)
    active, whole = [4, 1, 3], blocks.dense(blocks.static, 0.0)
    rows = (3 * np.array(active)[:, None] + np.arange(3)).ravel()
    part = whole[np.ix_(rows, rows)] + np.diag(blocks.own[active].ravel())
    np.testing.assert_allclose(
        found(blocks, blocks.bodies.static, 0.0, active, 1.0), part, rtol=0, atol=1e-21
    )


def test_two_points_on_a_rod_are_coupled_by_its_rotation():
    """Rod of mass m and inertia m l^2 / 12: an impulse at one end moves it by 4 / m, the other by
    -2 / m.
    """
    mass, length = 3.0, 2.0
    arms = np.array([[-length / 2, 0, 0], [length / 2, 0, 0]])
    rod = one_body(
        arms,
        np.zeros((6, 6)),
        np.zeros((6, 6)),
        mass,
        np.diag([1.0, mass * length**2 / 12, mass * length**2 / 12]),
    )
    W = np.empty((6, 6))
    assemble(
        rod,
        NO_BASE,
        node_points(arms, 0.5),
        arms,
        np.arange(2),
        poses_on_base(np.eye(3)[None]),
        1.0,
        rod.mobility,
        0.0,
        np.zeros((2, 3)),
        W,
    )
    assert W[2::3, 2::3] == pytest.approx(np.array([[4, -2], [-2, 4]]) / mass)
    assert W[0::3, 0::3] == pytest.approx(np.full((2, 2), 1 / mass))


@pytest.mark.long
@pytest.mark.parametrize("n", [5, 12])
def test_static_displacement_is_the_compliance_times_the_forces(n):
    blocks, rng = Blocks(n, False), np.random.default_rng(3)
    contact, moved = np.zeros(n, CONTACT), np.empty((n, 3))
    contact["force"][[0, 2, *range(3, n - 1)]] = np.abs(rng.normal(size=(n - 2, 3)))
    listed = np.delete(np.arange(n), 1)
    static_displacement(blocks.bodies, NO_BASE, blocks.points, blocks.poses, contact, listed, moved)
    whole = (blocks.dense(blocks.static, 0.0) @ contact["force"].ravel()).reshape(n, 3)
    np.testing.assert_allclose(moved[listed], whole[listed], rtol=1e-12)


@pytest.mark.parametrize("n", [2, 12])
def test_base_gives_way_below_the_points(n):
    """Points on two facets: the base's compliance between the points by their shares in its
    nodes.
    """
    rng = np.random.default_rng(4)
    C, arms = compliance(rng, 6), np.zeros((n, 3))
    body, points = (
        one_body(arms, np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n))),
        node_points(arms, 0.5),
    )
    points["below"], points["shares"] = (
        np.arange(4) + 2 * (np.arange(n)[:, None] % 2),
        rng.dirichlet(np.ones(4), n),
    )
    base, W, poses = (
        base_of(np.zeros(2), np.zeros(2), np.zeros((2, 2), np.int64), np.zeros(6, np.int64), C),
        np.empty((3 * n, 3 * n)),
        poses_on_base(np.eye(3)[None]),
    )
    H = np.zeros((3 * n, 18))
    for row, (below, shares) in enumerate(zip(points["below"], points["shares"])):
        for node, share in zip(below, shares):
            H[3 * row : 3 * row + 3, 3 * node : 3 * node + 3] += share * np.eye(3)
    contact, moved = np.zeros(n, CONTACT), np.empty((n, 3))
    contact["force"] = 1.0
    # what has been gathered is taken from then on
    for _ in range(2):
        assemble(
            body,
            base,
            points,
            arms,
            np.arange(n),
            poses,
            0.0,
            body.static,
            1.0,
            np.zeros((n, 3)),
            W,
        )
        np.testing.assert_allclose(W, H @ C @ H.T, rtol=1e-12)
        static_displacement(body, base, points, poses, contact, np.arange(n), moved)
        np.testing.assert_allclose(moved.ravel(), H @ C @ H.T @ np.ones(3 * n), rtol=1e-12)
    assert base.gathered.number[0] == 6


def test_what_a_foot_has_left_behind_is_not_gathered_for_ever():
    """Ten points that go over two hundred nodes: what is gathered stays below what they could need
    at once, and is right.
    """
    rng = np.random.default_rng(5)
    n, slots = 10, 200
    half = rng.normal(size=(3 * slots, 3 * slots))
    C, points = half @ half.T, node_points(np.zeros((n, 3)), 0.5)
    base = base_of(
        np.zeros(2), np.zeros(2), np.zeros((2, 2), np.int64), np.zeros(slots, np.int64), C
    )
    points["shares"] = 0.25
    for step in range(45):
        points["below"] = 4 * step + np.arange(4) + np.arange(n)[:, None]
        gather(base, points, np.arange(n))
        number = base.gathered.number[0]
        assert number <= 8 * n + 4 * n
        below = points["below"].ravel()
        places = base.gathered.place[below]
        assert (places >= 0).all()
        rows = (3 * places[:, None] + np.arange(3)).ravel()
        np.testing.assert_array_equal(
            base.gathered.matrix[np.ix_(rows, rows)],
            C[np.ix_(*2 * [(3 * below[:, None] + np.arange(3)).ravel()])],
        )


def test_a_point_on_an_edge_gives_no_more_just_off_a_node_than_at_it():
    """Outlines that slide over one another bring points from their nodes and back: a step in what
    a point gives alone would be a jump of its force.
    """
    blocks = Blocks(6, True)
    point = blocks.points[2]

    def gives(weights):
        point["count"], point["carriers"][:2], point["weights"][:2] = len(weights), [2, 3], 0.0
        point["weights"][: len(weights)] = weights
        even_out(blocks.bodies, NO_BASE, blocks.points, 2, blocks.poses)
        return np.abs(point["uneven"]).max()

    between = gives([0.5, 0.5])
    assert gives([1.0]) == 0.0 < between
    for share in (1e-3, 1e-6):
        assert gives([1 - share, share]) < 8 * share * between
