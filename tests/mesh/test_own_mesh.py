"""A column of one's own mesh needs no dimensions: all is read from the mesh."""

import warnings

import numpy as np
import pytest
from own_meshes import SIDES, bricks, own_case, tetrahedra, write

from fecolumn.case.case import Case
from fecolumn.case.short_form import short_form
from fecolumn.foundation.content import content
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.estimate import estimate
from fecolumn.mesh.quality import quality_table
from fecolumn.mesh.specimen import specimen_mesh

FORMATS = [
    ("own.inp", {}),
    ("own.msh", {"file_format": "gmsh22"}),
    ("own.msh", {"file_format": "gmsh"}),
    ("own.vtk", {}),
    ("own.vtu", {}),
]


@pytest.mark.parametrize("name, options", FORMATS, ids=["Abaqus", "Gmsh 2", "Gmsh 4", "VTK", "VTU"])
@pytest.mark.parametrize(
    "kind, made", [("hexahedron", bricks), ("tetra", tetrahedra)], ids=["bricks", "tetrahedra"]
)
def test_height_foot_and_weight_are_read_from_the_mesh(tmp_path, name, options, kind, made):
    points, cells = made()
    case = own_case(write(tmp_path, name, kind, points + [3.0, 0, 1.0], cells, **options))
    assert case.column.height_m == pytest.approx(SIDES[2], rel=1e-3)
    specimen = specimen_mesh(case)
    foot = specimen.body.points[specimen.foot_nodes]
    assert np.ptp(foot[:, :2], axis=0) == pytest.approx(SIDES[:2], rel=1e-12) and foot.mean(
        axis=0
    ) == pytest.approx(np.zeros(3), abs=1e-9)
    rows = {row.name: row for row in quality_table(case, specimen)}
    assert (
        rows["column: mass"].mesh == pytest.approx(7850 * np.prod(SIDES), rel=1e-9)
        and rows["column: mass"].exact is None
    )
    assert rows["column: inertia I_xx about the centre of mass"].mesh == pytest.approx(
        7850 * np.prod(SIDES) * (0.1**2 + 0.4**2) / 12, rel=1e-9
    )
    assert rows["tilt with the centre of mass over the foot's nearest side"].mesh == pytest.approx(
        np.arctan(0.05 / 0.2), rel=1e-9
    )
    assert case.mesh.element_order == (2 if kind == "tetra" else 1)
    assert estimate(case).bricks[2] == len(cells)


def test_tilt_over_the_nearest_side_of_a_foot_that_is_turned(tmp_path):
    """A square foot with its corners along x and y: the nearest side is no side of its box."""
    points, cells = bricks((4, 4, 6), (0.4, 0.4, 1.2))
    turn = np.sqrt(0.5) * np.array([[1, -1, 0], [1, 1, 0], [0, 0, np.sqrt(2)]])
    case = own_case(write(tmp_path, "turned.msh", "hexahedron", points @ turn.T, cells))
    rows = {row.name: row for row in quality_table(case, specimen_mesh(case))}
    tilt = rows["tilt with the centre of mass over the foot's nearest side"].mesh
    assert tilt == pytest.approx(np.arctan(0.2 / 0.6), rel=1e-9)


def test_second_order_tetrahedra_of_a_file_are_read_by_their_corners(tmp_path):
    points, cells = tetrahedra((2, 2, 2))
    ends = points[cells[:, [0, 1, 2, 0, 1, 2]]], points[cells[:, [1, 2, 0, 3, 3, 3]]]
    middles, where = np.unique(
        np.round(((ends[0] + ends[1]) / 2).reshape(-1, 3), 12), axis=0, return_inverse=True
    )
    ten = np.hstack([cells, len(points) + where.reshape(-1, 6)])
    case = own_case(write(tmp_path, "ten.vtu", "tetra10", np.vstack([points, middles]), ten))
    assert len(specimen_mesh(case).body.points) == len(points)


def test_sizes_that_a_mesh_file_makes_idle_are_told(tmp_path):
    file = write(tmp_path, "own.inp", "hexahedron", *bricks())
    for name, key in (
        ("column", "wall_m"),
        ("column", "fine_height_m"),
        ("mesh", "coarse_size_m"),
        ("mesh", "cap_size_m"),
    ):
        tables = dict(column=dict(mesh_file=str(file)), integration=dict(duration_s=0.1))
        tables[name] = tables.get(name, {}) | {key: 0.09}
        with pytest.warns(UserWarning, match=rf"own.toml: {name}.{key} = 0.09 says nothing of the"):
            made = short_form(tables, "own.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = short_form(own_case(file).tables(), "own.toml")  # sizes that it was given itself
    assert again == own_case(file) and made.column == again.column


def test_linear_tetrahedra_are_refused(tmp_path):
    with pytest.raises(InputError, match="mesh.element_order = 1: must be 2 for tetrahedra"):
        own_case(write(tmp_path, "own.vtu", "tetra", *tetrahedra()), mesh={"element_order": 1})


def test_nodes_of_second_order_are_counted_before_anything_is_built(tmp_path):
    from mpi4py import MPI

    from fecolumn.fem.tied_body import tied_body
    from fecolumn.structures.faces import plane_faces
    from fecolumn.structures.patches import whole_face

    for kind, made in (("tetra", tetrahedra), ("hexahedron", bricks)):
        case = own_case(write(tmp_path, "own.vtu", kind, *made()), mesh={"element_order": 2})
        specimen = specimen_mesh(case)
        order = case.mesh.element_order
        body = tied_body(specimen.body, specimen.ties, case.material, order, MPI.COMM_SELF)
        expected = estimate(case)
        assert (
            3 * body.n_nodes == expected.dofs[2]
            and 3 * len(specimen.base.points) == expected.dofs[4]
        )
        lowest = min(plane_faces(specimen.body), key=lambda face: face.corners[:, :, 2].max())
        foot = whole_face(lowest, order)
        assert len(foot.positions) == expected.foot_points
        assert foot.areas.min() > 0 and foot.areas.sum() == pytest.approx(
            SIDES[0] * SIDES[1], rel=1e-12
        )


def test_a_shape_beside_a_mesh_of_ones_own_is_refused(tmp_path):
    file = write(tmp_path, "own.vtu", "hexahedron", *bricks())
    for section, said in (
        ({"flange": {"outer_diameter_m": 1.0, "thickness_m": 0.1}}, "flange"),
        ({"column": {"mesh_file": str(file), "shape": "block"}}, "column.shape"),
        ({"column": {"mesh_file": str(file), "height_m": 0.5}}, "column.height_m = 0.5 m"),
    ):
        with pytest.raises(InputError, match=said):
            own_case(file, **section)


def test_elements_that_stand_in_a_file_twice_are_taken_once(tmp_path):
    points, cells = bricks()
    file = write(tmp_path, "twice.vtu", "hexahedron", points, np.vstack([cells, cells[3:9]]))
    with pytest.warns(UserWarning, match="6 elements stand in it twice"):
        case = own_case(file)
    rows = {row.name: row for row in quality_table(case, specimen_mesh(case))}
    assert rows["column: mass"].mesh == pytest.approx(7850 * np.prod(SIDES), rel=1e-9)


def test_elements_that_overlap_or_meet_at_an_edge_alone_are_refused(tmp_path):
    points, cells = bricks((2, 1, 1))
    first, n = cells[0], len(points)
    foot = points[first[4:]] * [1, 1, 0.5]  # half as high on the foot of the first
    side = points[first[[1, 2, 5, 6]]] + [0.02, 0, 0]  # on the side that the two share
    for name, new, added in (
        ("foot.vtu", foot, [*first[:4], n, n + 1, n + 2, n + 3]),
        ("side.vtu", side, [first[1], n, n + 1, first[2], first[5], n + 2, n + 3, first[6]]),
    ):
        file = write(
            tmp_path, name, "hexahedron", np.vstack([points, new]), np.vstack([cells, added])
        )
        with pytest.raises(InputError, match=r"\d faces with elements that overlap"):
            own_case(file)
    points, cells = bricks((2, 1, 2))
    middle = points[cells].mean(axis=1)
    hinged = cells[(middle[:, 0] > 0) == (middle[:, 2] > 0.2)]
    with pytest.raises(InputError, match="2 unconnected pieces"):
        own_case(write(tmp_path, "hinge.vtu", "hexahedron", points, hinged))


@pytest.mark.parametrize("size, unit, told", [(90, "", True), (90, "m", False), (9, "", False)])
def test_a_body_of_many_metres_without_a_unit_is_told_of(tmp_path, size, unit, told):
    points, cells = bricks(sides=(size / 3, size / 3, size))
    file = write(tmp_path, "vase.vtu", "hexahedron", points, cells)
    column = {"mesh_file": str(file)} | ({"mesh_unit": unit} if unit else {})
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        own_case(file, column=column)
    texts = [str(one.message) for one in said]
    assert any('state mesh_unit = "mm" if it is 0.09 m' in text for text in texts) == told


def test_a_mesh_whose_arrays_are_in_another_file_is_told_apart_by_these(tmp_path):
    heights = []
    for stretch in (1.0, 2.0):
        points, cells = bricks()
        file = write(tmp_path, "own.xdmf", "hexahedron", points * [1, 1, stretch], cells)
        assert (tmp_path / "own.h5").is_file()
        case = own_case(file)
        heights.append((case.column.height_m, Case.of_column(case).id))
    assert heights[1][0] == pytest.approx(2 * heights[0][0]) and heights[0][1] != heights[1][1]


def test_a_script_is_told_apart_by_what_it_includes(tmp_path):
    (tmp_path / "own.geo").write_text('Include "inner.geo";\n')
    (tmp_path / "inner.geo").write_text('Merge "part.step";\nInclude "own.geo";\nh = 1;\n')
    found = [content(str(tmp_path / "own.geo"))]
    (tmp_path / "part.step").write_text("x")
    found.append(content(str(tmp_path / "own.geo")))
    (tmp_path / "inner.geo").write_text('Merge "part.step";\nh = 2;\n')
    found.append(content(str(tmp_path / "own.geo")))
    assert len(set(found)) == 3
