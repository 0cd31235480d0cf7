import signal
import subprocess
import sys
from pathlib import Path

import gmsh
import numpy as np
import pytest
from scipy.spatial import cKDTree
from small_specimen import TABLES, small_case

from fecolumn.case.case import load_case
from fecolumn.case.short_form import short_form
from fecolumn.contact.rim import Rim
from fecolumn.mesh import gmsh_section
from fecolumn.mesh.base_plate import GROWTH, base_mesh, growing_steps
from fecolumn.mesh.bricks import CAP, FLANGE, LOWER, UPPER, boundary_faces, brick_mesh, outer_faces
from fecolumn.mesh.cap_plate import cap_mesh
from fecolumn.mesh.column import column_mesh
from fecolumn.mesh.gmsh_section import extruded
from fecolumn.mesh.jacobian import corner_jacobians, scaled_jacobian
from fecolumn.mesh.mass import mass_properties
from fecolumn.mesh.quality import exact_cap, exact_column, exact_flange
from fecolumn.mesh.section import Annulus, Disc
from fecolumn.mesh.specimen import specimen_mesh

ODD_CASES = {
    "tube": {},
    "solid cylinder": {"column_wall_m": 0.05, "mesh_coarse_size_m": 0.018},
    "nearly solid": {"column_wall_m": 0.049, "mesh_coarse_size_m": 0.018},
    "no cap": {"cap": False},
    "all coarse": {"column_fine_height_m": 0.0},
    "all fine": {"column_fine_height_m": 0.3},
    "upper part lower than a brick": {"column_fine_height_m": 0.299},
    "cap as wide as the column": {"cap_length_m": 0.1, "cap_width_m": 0.1},
    "cap thicker than the column is high": {"cap_thickness_m": 0.4},
    "base no larger than the fine zone": {"base_length_m": 0.14, "base_width_m": 0.1400001},
    "base thinner than a brick": {"base_thickness_m": 0.002},
    "one size everywhere": {"mesh_coarse_size_m": 0.01, "mesh_base_size_m": 0.01},
    "odd numbers": {
        "column_wall_m": 0.0137,
        "column_height_m": 0.2777,
        "mesh_fine_size_m": 0.0061,
        "mesh_coarse_size_m": 0.0193,
    },
    "solid with odd numbers": {
        "column_wall_m": 0.05,
        "mesh_fine_size_m": 0.0083,
        "mesh_coarse_size_m": 0.0177,
    },
}


BLOCK = {
    "column": {"shape": "block", "length_m": 0.4, "width_m": 0.2, "height_m": 1.2},
    "integration": {"duration_s": 1.0},
}


@pytest.mark.parametrize("keys", ODD_CASES.values(), ids=ODD_CASES)
def test_every_brick_of_any_specimen_has_positive_volume_at_each_corner(keys):
    case = small_case(**keys)
    specimen = specimen_mesh(case)
    for mesh in (specimen.body, specimen.base):
        assert corner_jacobians(mesh).min() > 0
        assert scaled_jacobian(mesh).min() > 0.2
    z = specimen.body.points[:, 2]
    assert z.min() == 0 and z.max() == pytest.approx(case.top_m, rel=1e-14)
    assert np.ptp(specimen.base.points, axis=0) == pytest.approx(
        [case.base.length_m, case.base.width_m, case.base.thickness_m], rel=1e-14
    )
    assert np.all(specimen.body.points[specimen.foot_nodes, 2] == 0)
    assert specimen.base.points[:, 2].max() == 0


@pytest.mark.parametrize(
    "keys", [{}, {"column_wall_m": 0.05, "mesh_coarse_size_m": 0.018}], ids=["tube", "solid"]
)
def test_the_rim_of_the_foot_lies_on_the_true_circle(keys):
    specimen = specimen_mesh(small_case(**keys))
    rim = Rim.find(specimen.body.points[specimen.foot_nodes])
    assert rim.radius == pytest.approx(0.05, rel=1e-14)


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"column_fine_height_m": 0.0, "mesh_coarse_size_m": 0.018},
        {"column_fine_height_m": 0.3},
        {"column_fine_height_m": 0.01},
        {"column_wall_m": 0.05, "mesh_coarse_size_m": 0.018},
    ],
    ids=["tube", "all coarse", "all fine", "one fine layer", "solid"],
)
def test_a_coarse_column_has_the_weight_of_the_true_one(keys):
    """Polygons of the true area: inscribed ones of 8 corners are a tenth too light."""
    case = small_case(**keys)
    found, exact = (
        mass_properties(specimen_mesh(case).body, 7850.0),
        exact_column(case) + exact_cap(case),
    )
    assert found.mass == pytest.approx(exact.mass, rel=1e-3)
    assert found.centre[2] == pytest.approx(exact.centre[2], rel=1e-3)
    assert np.diag(found.inertia) == pytest.approx(np.diag(exact.inertia), rel=3e-3)


@pytest.mark.parametrize("keys", [{}, {"inner_diameter_m": 0.06}], ids=["full", "with a hole"])
def test_a_flange_carries_the_column_and_weighs_what_it_should(keys):
    case = short_form(
        TABLES | {"flange": {"outer_diameter_m": 0.16, "thickness_m": 0.012} | keys}, "flange.toml"
    )
    specimen = specimen_mesh(case)
    body, exact = specimen.body, exact_flange(case) + exact_column(case) + exact_cap(case)
    assert [(one.slave_part, one.master_part) for one in specimen.ties] == [
        (LOWER, FLANGE),
        (LOWER, UPPER),
        (UPPER, CAP),
    ]
    assert mass_properties(body, 7850.0).mass == pytest.approx(exact.mass, rel=1e-3)
    assert body.points[:, 2].max() == pytest.approx(case.top_m, rel=1e-14)
    assert np.hypot(*body.points[specimen.foot_nodes, :2].T).max() == pytest.approx(0.08, rel=1e-14)


def test_a_block_has_its_own_sides_and_finer_bricks_below():
    case = short_form(BLOCK, "block.toml")
    specimen = specimen_mesh(case)
    assert np.ptp(specimen.body.points, axis=0) == pytest.approx([0.4, 0.2, 1.2], rel=1e-14)
    found, exact = mass_properties(specimen.body, 7850.0), exact_column(case)
    assert found.mass == pytest.approx(
        0.4 * 0.2 * 1.2 * 7850, rel=1e-12
    ) and found.inertia == pytest.approx(exact.inertia, rel=1e-10, abs=1e-9)
    assert len(specimen.ties) == 1
    below, above = (len(boundary_faces(specimen.body, part, 0.1, 1e-9)) for part in (LOWER, UPPER))
    assert below == 4 * above


def test_tube_of_the_study_is_one_brick_thick_with_three_fine_bricks_on_a_coarse_one():
    mesh = column_mesh(load_case(Path(__file__).parents[2] / "meshes/stout.toml").short)
    foot, joint = boundary_faces(mesh, LOWER, 0, 1e-9), boundary_faces(mesh, UPPER, 0.05, 1e-9)
    # Mean circumference 303.5 mm: 20 bricks of 15 mm, 60 of 5 mm.
    assert (len(foot), len(joint)) == (60, 20)
    assert np.sum(mesh.part == LOWER) == 60 * 10
    # 950 mm in bricks of 15 mm: 63 layers.
    assert np.sum(mesh.part == UPPER) == 20 * 63


def test_column_is_symmetric_about_both_vertical_planes():
    for wall in (0.01, 0.05):
        points = column_mesh(small_case(column_wall_m=wall, mesh_coarse_size_m=0.018)).points
        for mirrored in (points * [-1, 1, 1], points * [1, -1, 1]):
            away = cKDTree(points).query(mirrored)[0]
            rim = np.hypot(points[:, 0], points[:, 1]) > 0.045
            assert away.max() < 1e-9 and away[rim].max() < 1e-15


def test_ring_of_any_number_of_bricks_closes():
    for n_around in (5, 7, 13):
        mesh = extruded(Annulus(0.5, 1.0, n_around, 2), 0.0, 1.0, 1, UPPER)
        assert len(mesh.points) == n_around * 3 * 2
        exact = n_around / 2 * np.sin(2 * np.pi / n_around) * 0.75
        for z in (0.0, 1.0):
            quads = mesh.points[boundary_faces(mesh, UPPER, z, 1e-9)][:, :, :2]
            d = quads[:, 2:] - quads[:, :2]
            # Positive areas at top and bottom: boundary quads run counter-clockwise in plan.
            assert (d[:, 0, 0] * d[:, 1, 1] - d[:, 0, 1] * d[:, 1, 0]).sum() / 2 == pytest.approx(
                exact, rel=1e-12
            )


def test_solid_foot_has_bricks_of_about_the_fine_size_everywhere():
    case = small_case(column_wall_m=0.05, mesh_coarse_size_m=0.018, mesh_fine_size_m=0.005)
    quads = boundary_faces(mesh := column_mesh(case), LOWER, 0, 1e-9)
    edges = (
        np.linalg.norm(mesh.points[quads] - mesh.points[np.roll(quads, 1, axis=1)], axis=2) / 0.005
    )
    # The O-grid's square is inscribed in the ring, so its bricks are smaller than those of the rim.
    assert edges.max() < 1.35 and edges.min() > 0.5


def grid_lines(mesh):
    """Lines x, y, z [m] of which the points are the product, x fastest."""
    x, y, z = (np.unique(coordinate) for coordinate in mesh.points.T)
    product = np.stack(np.meshgrid(z, y, x, indexing="ij")[::-1], axis=-1).reshape(-1, 3)
    assert np.array_equal(product, mesh.points)
    return x, y, z


def test_base_a_little_wider_than_the_fine_zone_gets_no_sliver():
    case = small_case(base_length_m=0.14, base_width_m=0.1400001)
    for line in grid_lines(base_mesh(case))[:2]:
        assert np.diff(line) == pytest.approx(0.01, rel=0.01)


def test_outer_faces_enclose_the_volume():
    mesh = cap_mesh(small_case())
    corners = mesh.points[outer_faces(mesh, CAP)]
    areas = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2
    assert areas.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-15)
    assert np.einsum("fi,fi->", corners.mean(axis=1), areas) / 3 == pytest.approx(
        0.15 * 0.12 * 0.01, rel=1e-12
    )


def test_exchanged_bottom_and_top_are_turned_back():
    mesh = cap_mesh(small_case())
    turned = brick_mesh(mesh.points, mesh.cells[:, [4, 5, 6, 7, 0, 1, 2, 3]], CAP)
    assert np.array_equal(turned.cells, mesh.cells)


@pytest.mark.parametrize(
    "keys", [{}, {"base_length_m": 3.0, "base_width_m": 0.14}, {"mesh_fine_size_m": 0.0037}]
)
def test_base_is_a_tensor_grid_fine_below_the_column_and_growing_gently(keys):
    case = small_case(**keys)
    mesh = base_mesh(case)
    x, y, z = grid_lines(mesh)
    fine = case.mesh.fine_size_m
    for line in (x, y):
        step = np.diff(line)
        below = np.abs((line[1:] + line[:-1]) / 2) < 0.07
        assert step[below] == pytest.approx(fine, rel=0.03)
        assert np.maximum(step[1:] / step[:-1], step[:-1] / step[1:]).max() < GROWTH * 1.03
        assert step.max() <= case.mesh.base_size_m * (1 + 1e-12)
        assert line == pytest.approx(-line[::-1], abs=1e-15)
    assert np.diff(z)[-1] == pytest.approx(fine)
    # The number of a brick's first corner follows from its place in the grid.
    i, j, k = 3, 5, 1
    n_x, n_y = len(x), len(y)
    corner = i + n_x * (j + n_y * k)
    assert np.array_equal(mesh.points[corner], [x[i], y[j], z[k]])
    assert np.any(mesh.cells.min(axis=1) == corner)


@pytest.mark.parametrize("length", [0.004, 0.0101, 0.05, 0.3, 7.0])
def test_growing_steps_fill_the_length_without_a_jump(length):
    step = growing_steps(length, 0.005, 0.03)
    assert step.sum() == pytest.approx(length, rel=1e-13)
    assert step.max() <= 0.03 * (1 + 1e-12)
    assert (step[1:] / step[:-1]).max(initial=1) <= GROWTH + 1e-9


def test_a_callers_gmsh_session_survives():
    gmsh.initialize(readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.ElementOrder", 2)
        gmsh.model.add("callers own")
        gmsh.model.geo.addPoint(1, 2, 3)
        cells = [column_mesh(small_case()).cells for _ in range(2)]
        assert np.array_equal(*cells)
        assert gmsh.model.getCurrent() == "callers own"
        assert gmsh.option.getNumber("Mesh.ElementOrder") == 2
        gmsh.model.geo.synchronize()
        assert gmsh.model.getEntities(0) == [(0, 1)]
    finally:
        gmsh.finalize()


def test_sessions_of_gmsh_end_until_there_were_many(monkeypatch):
    """Each session leaves some memory behind: of thousands of bodies one stays open."""
    monkeypatch.setattr(gmsh_section, "_begun", 0)
    monkeypatch.setattr(gmsh_section, "_SESSIONS", 2)
    disc = Disc(0.5, 12, 2)
    meshes, open_after = [], []
    for _ in range(5):
        meshes.append(extruded(disc, 0.0, 1.0, 3, 0))
        open_after.append(gmsh_section._is_running(gmsh))
    assert open_after == [False, False, True, True, True] and gmsh_section._begun == 3
    for mesh in meshes[1:]:
        assert np.array_equal(mesh.points, meshes[0].points)
        assert np.array_equal(mesh.cells, meshes[0].cells)
    gmsh_section.end_session(gmsh)
    assert not gmsh_section._is_running(gmsh)


def test_meshing_leaves_ctrl_c_to_the_program():
    def stop_gently(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, stop_gently)
    try:
        column_mesh(small_case())
        assert signal.getsignal(signal.SIGINT) is stop_gently
    finally:
        signal.signal(signal.SIGINT, before)


def test_meshes_are_made_in_any_thread_of_a_process_that_has_not_met_gmsh():
    program = (
        "import threading; from fecolumn.mesh.gmsh_section import extruded; from "
        "fecolumn.mesh.section import Annulus; made = []\n"
        "thread = threading.Thread(target=lambda: made.append(extruded(Annulus(0.5, "
        "1.0, 8, 2), 0.0, 1.0, 1, 0)))\n"
        "thread.start(); thread.join(); assert made[0].cells.shape == (16, 8)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
