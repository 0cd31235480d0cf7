"""The round rim: points of the circle carried by nodes of the polygon."""

import numpy as np
import pytest

from fecolumn.contact.rim import Rim, lowest, on_circle


def foot(n, radius=0.05, center=(0.3, -0.1), start=0.2):
    """Two rings of n nodes, shuffled."""
    angles = start + 2 * np.pi * np.arange(n) / n
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)])
    points = np.vstack([radius * ring, 0.9 * radius * ring]) + [*center, 0.0]
    return np.random.default_rng(1).permutation(points)


def carriers(rim, angle):
    """Number of the point at `angle`, how far it is past its node in sectors, carriers (n, 4) among
    the rim's nodes and their weights (4,).
    """
    n, offsets, weights = len(rim.nodes), np.empty(4, np.int64), np.empty(4)
    index, phase = on_circle(angle, rim.first, rim.sector, n, offsets, weights)
    return index, phase, rim.nodes[(np.arange(n)[:, None] + offsets) % n], weights


@pytest.mark.parametrize("n", [12, 13, 60])
def test_points_lie_on_the_circle_and_follow_any_rigid_motion(n):
    reference = foot(n)
    rim = Rim.find(reference)
    assert len(rim.nodes) == n and rim.radius == pytest.approx(0.05, rel=1e-12)
    for angle in np.linspace(-7, 7, 23):
        index, _, nodes, weights = carriers(rim, angle)
        places = np.einsum("q,pqa->pa", weights, reference[nodes])
        assert np.linalg.norm(places[:, :2] - [0.3, -0.1], axis=1) == pytest.approx(0.05, rel=1e-9)
        asked = np.array([0.3, -0.1]) + 0.05 * np.array([np.cos(angle), np.sin(angle)])
        assert places[index, :2] == pytest.approx(asked, abs=1e-12)
        # no farther than half a sector from the node whose place each takes
        assert np.linalg.norm(places - reference[rim.nodes], axis=1).max() <= 2 * 0.05 * np.sin(
            np.pi / n / 2
        ) * (1 + 1e-9)
        assert weights.sum() == pytest.approx(1.0, abs=1e-12)


def test_lowest_point_of_a_tilted_plane():
    """A body that leans towards azimuth 0.7 touches there."""
    from fecolumn.fem.rotation import rotation_matrix

    angle, tilt = lowest(rotation_matrix(0.02 * np.array([-np.sin(0.7), np.cos(0.7), 0.0])))
    assert angle == pytest.approx(0.7, abs=1e-12) and tilt == pytest.approx(np.sin(0.02), rel=1e-12)


def test_a_square_and_a_distorted_ring_have_no_round_rim():
    square = np.array([[x, y, 0.0] for x in np.linspace(0, 1, 7) for y in np.linspace(0, 1, 7)])
    assert Rim.find(square) is None
    ring = foot(24)
    ring[Rim.find(ring).nodes[3], :2] += 1e-4
    assert Rim.find(ring) is None
