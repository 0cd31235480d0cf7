"""Bodies that came through each other are named, with how deep they are."""

import numpy as np
import pytest
from convex_bodies import box, frustum, turned
from scipy.spatial.transform import Rotation

from fecolumn.contact.convex import hull_of, hulls_of, no_hull
from fecolumn.contact.nearby import boxes_for, find_boxes, find_pairs, pair_keys
from fecolumn.contact.through import ThroughCheck


def check(bodies, left_out=()):
    hulls = hulls_of([no_hull() if body is None else hull_of(body) for body in bodies])
    return ThroughCheck(hulls, pair_keys(left_out, len(bodies)))


def test_depth_of_bodies_in_each_other():
    bodies = [box(1, 1, 1), box(2, 2, 1), box(1, 1, 1), box(1, 1, 1)]
    centers = np.array([[0, 0, 0], [0.2, 0, 0.9], [0, 0, 5], [np.sqrt(0.5) + 0.45, 0, 5.0]])
    rotations = np.stack([np.eye(3), np.eye(3), np.eye(3), turned(0, 0, np.pi / 4)])
    assert check(bodies).deepest(centers, rotations) == [
        (0, 1, pytest.approx(0.1, abs=1e-12)),
        (2, 3, pytest.approx(0.05, abs=1e-12)),
    ]
    # bodies that have a joint, and those that are not convex, are in no pair
    assert [pair[:2] for pair in check(bodies, [(1, 0)]).deepest(centers, rotations)] == [(2, 3)]
    bodies[3] = None
    assert [pair[:2] for pair in check(bodies).deepest(centers, rotations)] == [(0, 1)]


def test_bodies_that_only_touch_are_not_named():
    """A thousandth of the thinner body's thickness is the least that is told."""
    bodies, rotations = [box(1, 1, 1), box(1, 1, 0.1)], np.tile(np.eye(3), (2, 1, 1))
    for depth, told in ((-1e-3, 0), (0.0, 0), (0.9e-4, 0), (1.1e-4, 1)):
        centers = np.array([[0, 0, 0], [0, 0, 0.55 - depth]])
        assert len(check(bodies).deepest(centers, rotations)) == told


@pytest.mark.long
@pytest.mark.parametrize("spread", [(1, 1, 1), (8, 1, 1), (0.1, 0.1, 8)])
def test_pairs_whose_boxes_overlap_are_all_found(spread):
    rng = np.random.default_rng(0)
    for count in (2, 30, 200):
        bodies = [
            (box(*rng.uniform(0.1, 1, 3)), frustum(24, 0.3, 0.2, 1.0))[k % 2] for k in range(count)
        ]
        hulls, boxes = hulls_of([hull_of(body) for body in bodies]), boxes_for(count)
        for seed in range(3):
            centers = rng.uniform(-1, 1, (count, 3)) * spread * count ** (1 / 3)
            rotations = Rotation.random(count, random_state=seed).as_matrix()
            margins = rng.uniform(0, 0.1, count)
            find_boxes(hulls, centers, rotations, margins, boxes)
            pairs, left_out = np.zeros((count**2, 2), np.int64), pair_keys([(1, 0)], count)
            found = find_pairs(hulls, boxes, left_out, pairs)
            for k in range(count):
                corners = centers[k] + bodies[k] @ rotations[k].T
                assert (boxes.low[k] <= corners.min(axis=0) - margins[k] + 1e-12).all()
                assert (boxes.high[k] >= corners.max(axis=0) + margins[k] - 1e-12).all()
            overlap = (boxes.low[:, None] <= boxes.high).all(axis=2)
            expected = np.argwhere(np.triu(overlap & overlap.T, 1))
            expected = {(int(a), int(b)) for a, b in expected} - {(0, 1)}
            assert {(int(a), int(b)) for a, b in pairs[:found]} == expected
            # more pairs than there is room for are counted
            assert find_pairs(hulls, boxes, left_out, pairs[: found // 2]) == found


def test_room_grows_with_the_pairs():
    count = 12
    bodies, rotations = [box(1, 1, 1)] * count, np.tile(np.eye(3), (count, 1, 1))
    centers = 0.01 * np.arange(count)[:, None] * [1.0, 0, 0]
    assert len(check(bodies).deepest(centers, rotations)) == count * (count - 1) // 2
