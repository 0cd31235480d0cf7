import numpy as np
import pytest
from small_specimen import small_case

from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import CAP, LOWER, UPPER, merged_mesh
from fecolumn.mesh.cap_plate import cap_mesh
from fecolumn.mesh.column import column_mesh
from fecolumn.mesh.specimen import specimen_mesh
from fecolumn.mesh.tie import adjust, project_to_quads, shape_functions, tie


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"column_wall_m": 0.05, "mesh_coarse_size_m": 0.018},
        {"column_fine_height_m": 0.0},
        {"cap_length_m": 0.1},
        {"column_wall_m": 0.0137, "mesh_fine_size_m": 0.0061, "mesh_coarse_size_m": 0.0193},
    ],
)
def test_tied_points_follow_rigid_motion_exactly(keys):
    specimen = specimen_mesh(small_case(**keys))
    points = specimen.body.points
    assert specimen.ties
    for one in specimen.ties:
        nodes, weights, distance = one.masters(points)
        assert abs(weights.sum(axis=1) - 1).max() < 1e-14
        assert weights.min() > -1e-14
        # Sum of weights 1 and sum of weights x = x: translations and linearised rotations of slave
        # and masters agree.
        assert (
            abs(np.einsum("na,nai->ni", weights, points[nodes]) - points[one.slave_nodes]).max()
            < 1e-14
        )
        assert distance.max() < 1e-14


def test_the_lower_part_ends_in_the_polygon_of_the_upper_one():
    case = small_case()
    column = column_mesh(case)
    joint = tie(column, LOWER, UPPER, 0.05, 1e-9, 1e-12, "mesh")
    # 8 upper bricks around, 32 lower ones
    assert len(joint.master_quads) == 8
    assert joint.masters(column.points)[2].max() < 1e-15


def test_points_off_the_surface_are_moved_onto_it():
    case = small_case(cap_length_m=0.1, cap_width_m=0.1)
    raw = merged_mesh([column_mesh(case), cap_mesh(case)])
    joint = tie(raw, UPPER, CAP, 0.3, 1e-9, 0.01, "cap")
    # corners of the equal-area polygon stand over the edge of a cap as wide as the column
    assert joint.masters(raw.points)[2].max() > 1e-4
    assert joint.masters(adjust(raw, [joint]).points)[2].max() < 1e-15


def test_adjustment_moves_slaves_only():
    case = small_case(cap_length_m=0.1, cap_width_m=0.1)
    raw = merged_mesh([column_mesh(case), cap_mesh(case)])
    specimen = specimen_mesh(case)
    moved = np.flatnonzero(np.any(raw.points != specimen.body.points, axis=1))
    slaves = np.concatenate([one.slave_nodes for one in specimen.ties])
    assert len(moved) and set(moved) <= set(slaves)
    assert [(one.slave_part, one.master_part) for one in specimen.ties] == [
        (LOWER, UPPER),
        (UPPER, CAP),
    ]


def test_parts_that_do_not_meet_are_refused():
    case = small_case()
    apart = merged_mesh([column_mesh(case), cap_mesh(case).shifted(0.001)])
    with pytest.raises(InputError, match="cap has no faces"):
        tie(apart, UPPER, CAP, 0.3, 1e-6, 0.01, "column.height_m")
    aside = cap_mesh(case)
    aside.points[:, 0] += 0.1
    with pytest.raises(InputError, match="off the surface"):
        tie(merged_mesh([column_mesh(case), aside]), UPPER, CAP, 0.3, 1e-6, 0.01, "column.height_m")


def test_point_on_a_warped_quadrilateral_is_found_again():
    random = np.random.default_rng(1)
    quads = np.array([[[0, 0, 0], [1, 0.1, 0.2], [1.2, 1, -0.1], [-0.1, 0.9, 0.3]]]) + np.arange(5)[
        :, None, None
    ] * [3.0, 0, 0]
    xi, quad = random.uniform(-1, 1, (300, 2)), random.integers(0, 5, 300)
    points = np.einsum("na,nai->ni", shape_functions(xi), quads[quad])
    found, local, projected, distance = project_to_quads(points, quads)
    assert np.array_equal(found, quad)
    assert abs(local - xi).max() < 1e-12
    assert distance.max() < 1e-14 and abs(projected - points).max() < 1e-14


def test_closest_point_agrees_with_brute_force():
    random = np.random.default_rng(2)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    # Slender and wide quadrilaterals side by side: the nearest centre is not the nearest
    # quadrilateral.
    quads = np.concatenate(
        [square[None] * [0.1, 5, 1] + [[0.1 * i, 0, 0]] for i in range(3)]
        + [square[None] * [4, 5, 1] + [[0.3, 0, 0]]]
    ) + random.normal(0, 0.01, (4, 4, 3))
    points = random.uniform([-1, -1, -0.5], [5, 6, 0.5], (60, 3))
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 401)] * 2), axis=-1).reshape(-1, 2)
    samples = np.einsum("ga,qai->qgi", shape_functions(grid), quads)
    _, xi, projected, distance = project_to_quads(points, quads)
    brute = np.array([np.linalg.norm(samples - p, axis=2).min() for p in points])
    assert np.all(distance <= brute + 1e-12) and np.all(distance > brute - 0.02)
    assert abs(xi).max() <= 1


def test_points_beyond_an_edge_and_a_corner_land_on_them():
    square = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]])
    _, xi, projected, distance = project_to_quads([[3, 0.25, 1], [-2, 4, 0], [1, 1, 0]], square)
    assert np.allclose(projected, [[1, 0.25, 0], [-1, 1, 0], [1, 1, 0]], atol=1e-15)
    assert np.allclose(xi, [[1, 0.25], [-1, 1], [1, 1]], atol=1e-15)
    assert np.allclose(distance, [5**0.5, 10**0.5, 0], atol=1e-15)
