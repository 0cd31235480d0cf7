"""Bodies of matrices, of tetrahedra and of bricks in one picture and in one file for ParaView."""

import meshio
import numpy as np
import pytest
import scipy.sparse as sparse
from rocking_structures import STONE, analysed

from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.frames import Frames
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result


@pytest.fixture(scope="module")
def row(tmp_path_factory):
    """Three bodies side by side on the ground: a brick block, a cube of five tetrahedra, and a
    block known by its matrices.
    """
    from mpi4py import MPI

    from fecolumn.case.sections import Material
    from fecolumn.fem.body import Body
    from fecolumn.mesh.bricks import UPPER
    from fecolumn.mesh.gmsh_section import swept_grid

    folder = tmp_path_factory.mktemp("row")
    corners = np.array([[x, y, z] for z in (0.0, 0.4) for y in (-0.2, 0.2) for x in (-0.2, 0.2)])
    meshio.write(
        folder / "cube.vtk",
        meshio.Mesh(
            corners,
            [
                (
                    "tetra",
                    np.array(
                        [[0, 1, 3, 5], [0, 3, 2, 6], [0, 5, 6, 4], [3, 6, 5, 7], [0, 3, 6, 5]]
                    ),
                )
            ],
        ),
    )
    body = Body(
        MPI.COMM_SELF,
        swept_grid(
            np.linspace(-0.2, 0.2, 3), np.linspace(-0.2, 0.2, 3), np.linspace(0, 0.8, 4), UPPER
        ),
        Material(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0),
    )
    for name in ("mass", "stiffness"):
        rows, columns, values = getattr(body, name).getValuesCSR()
        sparse.save_npz(folder / f"{name}.npz", sparse.csr_matrix((values, columns, rows)))
    ends = np.flatnonzero((body.all_X[:, 2] < 1e-9) | (body.all_X[:, 2] > 0.8 - 1e-9))
    np.savez(
        folder / "nodes.npz", dofs=3 * ends[:, None] + np.arange(3), coordinates=body.all_X[ends]
    )
    files = {f"{name}_file": str(folder / f"{name}.npz") for name in ("mass", "stiffness", "nodes")}
    bodies = dict(
        brick=dict(
            kind="block",
            length_m=0.4,
            width_m=0.4,
            height_m=0.8,
            element_size_m=0.2,
            at_m=[-1, 0, 0],
        )
        | STONE,
        cube=dict(kind="mesh", mesh_file=str(folder / "cube.vtk"), rigid=True) | STONE,
        foreign=dict(kind="matrices", at_m=[1, 0, 0], **files),
    )
    return analysed(
        folder / "run",
        dict(
            bodies=bodies,
            joints={name: dict(between=[name, "ground"]) for name in bodies},
            contact=dict(friction_coefficient=0.7, interior_points=0),
            initial=dict(foreign=dict(tilt_rad=0.1)),
            integration=dict(duration_s=0.04, dt_s=1e-3),
            output=dict(states_every_s=0.02),
        ),
    )


def test_all_kinds_of_bodies_are_drawn_and_those_without_elements_are_grey(row):
    result = read_result(row)
    frame = Frames(result, np.array([0.02]), 0.04).frame(0)
    surface, part = result.scene.surface, result.scene.surface.part
    assert np.isfinite(frame.colour[part == 0]).all() and np.isnan(frame.colour[part > 0]).all()
    assert [
        np.ptp(
            result.scene.points[surface.nodes[np.unique(surface.faces[part == k])]], axis=0
        ).tolist()
        for k in range(3)
    ] == [pytest.approx([0.4, 0.4, height]) for height in (0.8, 0.4, 0.8)]
    leaning = frame.points[result.scene.first[2] :]
    assert leaning[:, 0].max() > 1.2 + 0.05 and leaning[:, 2].min() == pytest.approx(0.0, abs=1e-4)
    assert render(row, RenderOptions(only="movie", size=(360, 240), fps=25.0), quiet=True)


def test_paraview_opens_elements_of_all_kinds(row):
    import pyvista

    (script,) = render(row, RenderOptions(paraview=True), quiet=True)
    reader = pyvista.get_reader(str(script.parent / "fields" / "fields.xdmf"))
    grid = reader.read()
    kinds = [set(grid.celltypes[grid.cell_data["body"] == number]) for number in (1, 2, 3)]
    assert kinds == [
        {pyvista.CellType.HEXAHEDRON},
        {pyvista.CellType.TETRA},
        {pyvista.CellType.TRIANGLE},
    ]
    assert grid.n_cells == len(grid.cell_data["von Mises stress [Pa]"])
