"""Hulls of bodies: corners, plane faces, edges, what is not convex."""

import numpy as np
import pytest
from convex_bodies import box, frustum, prism

from fecolumn.contact.convex import hull_of, hulls_of, is_convex_body, no_hull


def grid(x, y, z, nodes=5):
    """Nodes of a box of bricks."""
    lines = [np.linspace(-side / 2, side / 2, nodes) for side in (x, y, z)]
    return np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 3)


@pytest.mark.parametrize(
    "points, counts, thickness",
    [
        (grid(1, 2, 0.5), (8, 6, 12), 0.5),
        (frustum(24, 0.5, 0.5, 0.7), (48, 26, 72), 0.7),
        (frustum(24, 0.5, 0.4, 0.7), (48, 26, 72), 0.7),
        (frustum(3, 0.5, 0.5, 2.0), (6, 5, 9), 0.75),
    ],
)
def test_nodes_inside_faces_and_edges_are_no_corners(points, counts, thickness):
    hull = hull_of(points)
    assert tuple(hull.first[1]) == counts
    assert hull.thickness == pytest.approx([thickness], rel=1e-12)


@pytest.mark.parametrize("digits", [6, 9, None])
def test_faces_of_an_inexact_mesh_are_whole(digits):
    rotation = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    points = grid(1, 0.7, 0.4, 9) @ rotation.T
    hull = hull_of(points if digits is None else points.round(digits + 1))
    assert tuple(hull.first[1]) == (8, 6, 12)


def test_hull_of_a_slender_column_with_a_finer_foot_closes():
    """As of the default mesh of a pole of 0.1 x 4 m: faces are in one plane all but 1e-6 of it."""
    rings = []
    for height, sides, radius, turn in (
        (0.0, 32, 0.05, 0.0),
        (0.01, 32, 0.05018, 0.0),
        (0.04, 16, 0.05018, 0.5),
        (0.05, 16, 0.05065, 0.0),
        (4.0, 16, 0.05065, 0.0),
    ):
        angle = 2 * np.pi * (np.arange(sides) + turn) / sides
        rings.append(
            np.column_stack(
                [radius * np.cos(angle), radius * np.sin(angle), np.full(sides, height)]
            )
        )
    points = np.vstack(rings)
    hull = hull_of(points)
    corners, faces, edges = hull.first[1]
    assert corners - edges + faces == 2
    heights = points @ hull.normals.T - hull.offsets
    assert heights.max() < 1e-6 * 4.0
    assert hull.thickness == pytest.approx([0.1], rel=0.01)


def test_loops_edges_and_normals_belong_together():
    rng = np.random.default_rng(4)
    for points in (box(1, 2, 3), frustum(24, 0.5, 0.3, 1.0), prism(rng, 7, 0.5)):
        hull = hull_of(points)
        # seen from outside, whole faces
        heights = hull.corners @ hull.normals.T - hull.offsets
        assert heights.max() < 1e-12
        for f in range(len(hull.normals)):
            rows = slice(hull.loop_first[f], hull.loop_first[f + 1])
            loop, edges = hull.loop[rows], hull.loop_edge[rows]
            assert set(loop) == set(np.flatnonzero(np.abs(heights[:, f]) < 1e-9))
            sides = np.roll(hull.corners[loop], -1, axis=0) - hull.corners[loop]
            turns = np.cross(sides, np.roll(sides, -1, axis=0)) @ hull.normals[f]
            assert turns.min() > 0
            assert all(f in hull.sides[edge] for edge in edges)
            for start, end, edge in zip(loop, np.roll(loop, -1), edges):
                assert {start, end} == set(hull.ends[edge])
            assert np.linalg.det(hull.axes[f]) == pytest.approx(1.0, rel=1e-12)
            assert hull.axes[f][:, 2] == pytest.approx(hull.normals[f], abs=1e-12)
        # the first face is to the left of its edge
        across = np.cross(hull.normals[hull.sides[:, 0]], hull.normals[hull.sides[:, 1]])
        assert np.einsum("ea,ea->e", across, hull.ways).min() > 0


def test_a_body_that_is_not_convex_says_so():
    corner = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2.0]])
    points = np.vstack([np.column_stack([corner, np.full(6, z)]) for z in (0.0, 1.0)])
    hulls = hulls_of([hull_of(points, 3.0), hull_of(box(1, 1, 1), 1.0), hull_of(box(1, 1, 1))])
    assert hulls.share == pytest.approx([3 / 3.5, 1.0, 1.0], rel=1e-12)
    assert list(is_convex_body(hulls)) == [False, True, True]


def test_hulls_of_several_bodies_count_from_each_first():
    one, two = hull_of(box(1, 2, 3)), hull_of(frustum(6, 1.0, 0.5, 1.0))
    both = hulls_of([one, no_hull(), two])
    assert both.first.tolist() == [[0, 0, 0], [8, 6, 12], [8, 6, 12], [20, 14, 30]]
    assert (both.corners[8:] == two.corners).all() and (both.ends[12:] == two.ends).all()
    assert (both.loop_first[6:] - both.loop_first[6] == two.loop_first).all()
    assert both.half[1].tolist() == [0, 0, 0]


def test_points_in_a_plane_have_no_hull():
    flat = box(1, 1, 1)
    flat[:, 2] = 0.0
    with pytest.raises(ValueError, match="lie in one plane"):
        hull_of(flat)
