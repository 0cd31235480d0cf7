import dataclasses

import meshio
import numpy as np
import pytest
from small_specimen import small_case

from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import CAP, UPPER
from fecolumn.mesh.column import column_mesh
from fecolumn.mesh.specimen import specimen_mesh

BUILT = small_case(column_fine_height_m=0.0, mesh_coarse_size_m=0.012)


@pytest.fixture(scope="module")
def tube():
    return column_mesh(BUILT)


@pytest.fixture
def with_file(tmp_path):
    """Writes points and cells into a file and returns the case that imports it."""

    def write(points, cells, name="tube.inp", kind="hexahedron"):
        meshio.Mesh(points, [(kind, cells)]).write(tmp_path / name)
        return named(tmp_path / name)

    return write


def named(path):
    return dataclasses.replace(BUILT, column=dataclasses.replace(BUILT.column, mesh_file=str(path)))


def refusal(case):
    with pytest.raises(InputError) as caught:
        specimen_mesh(case)
    message = str(caught.value)
    assert case.column.mesh_file in message and "column.mesh_file" in message
    return message


@pytest.mark.parametrize("name", ["tube.inp", "tube.vtu", "tube.msh", "tube.xdmf", "tube.mesh"])
def test_imported_mesh_gives_the_built_specimen(tube, with_file, name):
    built, imported = specimen_mesh(BUILT), specimen_mesh(with_file(tube.points, tube.cells, name))
    assert imported.body.points == pytest.approx(built.body.points, abs=1e-12)
    assert np.array_equal(imported.body.cells, built.body.cells)
    assert np.array_equal(imported.foot_nodes, built.foot_nodes)
    assert [(t.slave_part, t.master_part) for t in imported.ties] == [(UPPER, CAP)]


def test_foot_is_shifted_to_zero_and_inverted_bricks_are_turned(tube, with_file):
    cells = tube.cells.copy()
    cells[::3] = cells[::3][:, [4, 5, 6, 7, 0, 1, 2, 3]]
    body = specimen_mesh(with_file(tube.points + [0, 0, 5.0], cells)).body
    assert body.points[: len(tube.points)] == pytest.approx(tube.points, abs=1e-12)
    assert np.array_equal(body.cells[: len(cells)], tube.cells)


def test_points_without_bricks_and_shells_on_the_surface_are_left_out(tube, tmp_path):
    points = np.concatenate([[[9.0, 9, 9]], tube.points])
    meshio.Mesh(points, [("quad", tube.cells[:, :4] + 1), ("hexahedron", tube.cells + 1)]).write(
        tmp_path / "mixed.vtu"
    )
    body = specimen_mesh(named(tmp_path / "mixed.vtu")).body
    assert body.points[: len(tube.points)] == pytest.approx(tube.points)


def test_mesh_in_millimetres_is_refused_with_a_hint(tube, with_file):
    assert "millimetres" in refusal(with_file(tube.points * 1e3, tube.cells))


def test_mesh_of_other_dimensions_is_refused(tube, with_file):
    assert "column.height_m = 0.3 m" in refusal(with_file(tube.points * [1, 1, 1.02], tube.cells))
    assert "column.outer_diameter_m = 0.1 m" in refusal(
        with_file(tube.points * [1.02, 1.02, 1], tube.cells)
    )


def test_a_mesh_is_shifted_with_the_middle_of_its_foot_to_the_origin(tube, with_file):
    body = specimen_mesh(with_file(tube.points + [0.3, -0.1, 2.0], tube.cells)).body
    assert body.points[: len(tube.points)] == pytest.approx(tube.points, abs=1e-12)


def test_tetrahedra_carry_no_cap_of_bricks(tube, with_file):
    message = refusal(with_file(tube.points, tube.cells[:, [0, 1, 3, 4]], kind="tetra"))
    assert "tetra" in message


def test_bricks_mixed_with_wedges_are_refused(tube, tmp_path):
    meshio.Mesh(
        tube.points, [("hexahedron", tube.cells[1:]), ("wedge", tube.cells[:1, [0, 1, 2, 4, 5, 6]])]
    ).write(tmp_path / "a.vtu")
    assert "1 x wedge" in refusal(named(tmp_path / "a.vtu"))


def test_folded_torn_and_not_finite_meshes_are_refused(tube, with_file):
    folded = tube.points.copy()
    folded[tube.cells[5, 0]] = folded[tube.cells[5, 6]]
    assert "folded" in refusal(with_file(folded, tube.cells, "folded.vtu"))
    apart = np.unique(tube.cells[:4])
    torn = np.concatenate([tube.points, tube.points[apart]])
    cells = tube.cells.copy()
    cells[:4] = len(tube.points) + np.searchsorted(apart, cells[:4])
    assert "unconnected pieces" in refusal(with_file(torn, cells, "torn.vtu"))
    broken = tube.points.copy()
    broken[3] = np.nan
    assert "finite" in refusal(with_file(broken, tube.cells, "nan.vtk"))


@pytest.mark.parametrize(
    "name, content, said",
    [
        ("empty.inp", b"", "empty"),
        ("text.inp", b"good morning\n", "*NODE"),
        ("noise.msh", bytes(range(256)) * 4, "meshio"),
        ("tube.doc", b"x", "meshio"),
        ("tube.xdmf", b"<Xdmf>", "meshio"),
        ("gap.inp", b"*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n", "refers to 2"),
        ("cut.inp", b"*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D8\n1,1,1,1\n", "data items"),
        ("points.inp", b"*NODE\n1,0,0,0\n", "no elements"),
        (
            "placed.inp",
            b"*Part, name=a\n*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D8\n1,1,1,1,1,1,1,1,1\n*End Part\n"
            b"*Assembly\n*Instance, name=a-1, part=a\n** turned\n 0., 0., 0.\n"
            b" 0., 0., 0., 1., 0., 0., 90.\n*End Instance\n",
            "*INSTANCE with the placement 0., 0., 0.",
        ),
        (
            "continued.inp",
            b"*Part, name=a\n*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D8\n1,1,1,1,1,1,1,1,1\n*End Part\n"
            b"*Assembly\n*Instance, name=a-1,\n part=a\n 0., 0., 2.5\n*End Instance\n",
            "*INSTANCE with the placement 0., 0., 2.5",
        ),
        (
            "comma.inp",
            b"*Part, name=a\n*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D8\n1,1,1,1,1,1,1,1,1\n*End Part\n"
            b"*Assembly\n*Instance, name=a-1, part=a,\n 0., 0., 2.5\n*End Instance\n",
            "*INSTANCE with the placement 0., 0., 2.5",
        ),
        (
            "parts.inp",
            b"*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D8\n1,1,1,1,1,1,1,1,1\n*Node\n1,0,0,0\n*NODE "
            b"OUTPUT\n",
            "2 *NODE blocks",
        ),
    ],
)
def test_unreadable_files_are_refused_naming_file_and_key(tmp_path, capfd, name, content, said):
    (tmp_path / name).write_bytes(content)
    assert said in refusal(named(tmp_path / name))
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("placed", ["0., 0., 0.\n", "0, 0, 0\n0., 0., 0., 0., 0., 1., 0.\n", ""])
def test_an_instance_that_is_placed_where_it_was_drawn_is_read(tube, tmp_path, placed):
    file = tmp_path / "placed.inp"
    meshio.Mesh(tube.points, [("hexahedron", tube.cells)]).write(file)
    file.write_text(
        f"{file.read_text()}*Assembly\n*Instance, name=a-1, part=a\n{placed}*End Instance\n"
    )
    assert len(specimen_mesh(named(file)).body.points) >= len(tube.points)
