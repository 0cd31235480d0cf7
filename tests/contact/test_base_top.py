"""The top of the base: which nodes lie below a point."""

import numpy as np
import pytest

from fecolumn.contact.base_top import BaseTop
from fecolumn.contact.points import node_points
from fecolumn.contact.projection import OFF, ON, UNKNOWN, base_of, nodes_under, project
from fecolumn.contact.unbounded_base import rigid_base


@pytest.fixture
def top():
    x, y = np.array([-0.3, -0.1, 0.0, 0.25]), np.array([0.0, 0.1, 0.4])
    return BaseTop(np.random.default_rng(0).permutation([[a, b, 0.0] for a in x for b in y]))


def test_a_linear_field_is_interpolated_exactly(top):
    rng = np.random.default_rng(1)
    positions = np.column_stack(
        [rng.uniform(-0.3, 0.25, 50), rng.uniform(0.0, 0.4, 50), rng.normal(size=50)]
    )
    nodes, shares = nodes_under(top, positions)
    np.testing.assert_allclose(
        np.einsum("nq,nqa->na", shares, top.points[nodes][:, :, :2]), positions[:, :2], atol=1e-15
    )
    assert shares.min() >= 0 and shares.sum(axis=1) == pytest.approx(1.0)


def test_point_beyond_the_edge_matters_only_where_it_is_wanted(top):
    base = base_of(top.x, top.y, top.number, np.arange(12), np.zeros((36, 36)))
    positions, points = (
        np.array([[0.0, 0.1, 0.0], [0.26, 0.1, 0.0]]),
        node_points(np.zeros((2, 3)), 0.5),
    )
    assert project(base, positions, np.array([0]), points) == ON
    assert project(base, positions, np.array([0, 1]), points) == OFF


@pytest.mark.parametrize("x, y", [(-0.3, 0.0), (-0.3, 0.4), (0.25, 0.0), (0.25, 0.4), (-0.2, 0.4)])
def test_point_beyond_the_edge_by_rounding_stands_on_the_edge(top, x, y):
    """By less than 2e-3 of the brick there, as a foot that is as wide as its plate; by more it is
    off, and so is a place that is not a number.
    """
    base, points = (
        base_of(top.x, top.y, top.number, np.arange(12), np.zeros((36, 36))),
        node_points(np.zeros((1, 3)), 0.5),
    )
    outwards = np.array([[np.sign(x + 0.2), np.sign(y - 0.2), 0.0]])

    def at(way):
        answer = project(base, np.array([[x, y, 0.0]]) + way * outwards, np.array([0]), points)
        return answer, points["below"].copy(), points["shares"].copy()

    _, below, shares = at(0.0)
    for way in (1e-17, 1e-9, 1.9e-4):
        answer, nodes, weights = at(way)
        assert answer == ON and (nodes == below).all() and (weights == shares).all()
    assert at(7e-4)[0] == at(np.nan)[0] == OFF


def test_point_on_another_body_needs_no_base_below_it(top):
    base = base_of(top.x, top.y, top.number, np.arange(12), np.zeros((36, 36)))
    points = node_points(np.zeros((1, 3)), 0.5, master=1)
    assert (
        project(base, np.array([[5.0, 0.1, 0.0]]), np.array([0]), points) == ON
        and not points["shares"].any()
    )


def test_node_whose_compliance_is_not_known_is_asked_for(top):
    slot = np.full(12, -1)
    base, points = (
        base_of(top.x, top.y, top.number, slot, np.zeros((0, 0))),
        node_points(np.zeros((1, 3)), 0.5),
    )
    place = np.array([[-0.2, 0.3, 0.0]])
    assert project(base, place, np.array([0]), points) == UNKNOWN
    slot[top.around(place, 0)] = np.arange(4)
    assert project(base, place, np.array([0]), points) == ON


def test_nodes_around_the_edge_are_those_there(top):
    assert len(top.around(np.array([[0.24, 0.39, 0.0]]), 0)) == 4
    assert len(top.around(np.array([[5.0, 5.0, 0.0]]), 1)) == 9


@pytest.mark.parametrize("across", [(0.005, 2.5), (2.5, 0.005)])
def test_squares_of_a_rigid_base_are_as_wide_as_all_feet_whichever_way_they_lie(across):
    """A row of feet along y takes as few squares as the same row along x."""
    x, y = across
    feet = np.array([[0.0, 0.0, 0.0], [x, 0.0, 0.0], [0.0, y, 0.0], [x, y, 0.0]])
    base = rigid_base(feet)
    assert len(base.grid.x) == len(base.grid.y) < 20
    assert np.diff(base.grid.x) == pytest.approx(2.5)
