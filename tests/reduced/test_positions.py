"""Positions of the contact points at the end of a step."""

from __future__ import annotations

import numpy as np
import pytest

from fecolumn.contact.interface import rims_at_rest
from fecolumn.engines.reduced import positions as module
from fecolumn.engines.reduced.positions import no_positions


def _turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """Matrix (3, 3) of a rotation by an angle [rad]."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


@pytest.mark.parametrize("seed", range(20))
def test_no_point_comes_down_by_more_than_the_bound(seed):
    """A high point is placed once in a step only if it cannot come low: the bound of its way holds
    for any small change of two bodies' places, and most points stay above it.
    """
    chance = np.random.default_rng(seed)
    positions = no_positions(50, 2, 2)
    arms = chance.uniform(-1.0, 1.0, (50, 3))
    heights = []
    start = [(_turned(chance.normal(size=3), 0.3), chance.normal(size=3)) for _ in range(2)]
    small = 10.0 ** chance.uniform(-8, -2)
    for when in range(2):
        for k, (turn, place) in enumerate(start):
            if when:
                turn = _turned(chance.normal(size=3), small * chance.normal()) @ turn
                place = place + small * chance.normal(size=3)
            positions.frames[when, k, :, :3], positions.frames[when, k, :, 3] = turn, place
        heights.append(
            [positions.frames[when, i % 2, 2] @ np.append(arms[i], 1.0) for i in range(len(arms))]
        )
    positions.most[0] = np.linalg.norm(arms, axis=1).max()
    moved = module._most_moved(positions, rims_at_rest(2))
    came_down = np.array(heights[0]) - np.array(heights[1])
    assert came_down.max() <= moved <= 20 * small
    positions.above[:] = chance.uniform(0.0, 2 * moved, 50)
    positions.above[7] = -np.inf
    low = module._list_low(positions, np.arange(50), moved)
    assert 7 in low and set(low) == set(np.flatnonzero(positions.above <= moved))
    # one that may have carried since stays among them when it rises again
    assert set(module._list_low(positions, np.arange(50), 0.0)) == set(low)


def test_a_growing_bend_lowers_points_by_their_share():
    """Where the modes' energy grows, a node may come down by the growth times its share."""
    positions = no_positions(1, 1, 2)
    positions.frames[:, 0, :, :3] = np.eye(3)
    positions.reach[:] = [[1e-3, 2e-3], [4e-3, 1e-3]]
    positions.most[1] = 2.5
    assert module._most_moved(positions, rims_at_rest(1)) == pytest.approx(2.5 * 3e-3)
