"""Bodies from matrices are those that made the matrices."""

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sparse
from small_structures import block, structure

from fecolumn.foundation.schema import InputError
from fecolumn.structures import matrices as module
from fecolumn.structures.structure import structure_model


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """Files of the matrices of a small block, and the block reduced from its mesh."""
    from mpi4py import MPI

    from fecolumn.case.sections import Material
    from fecolumn.fem.body import Body
    from fecolumn.structures.bodies import drawing

    case = structure(**block(element_size_m=0.2, coarse_size_m=0.2))
    folder, shape = tmp_path_factory.mktemp("matrices"), drawing(case, "block", "small.toml").shape
    body = Body(
        MPI.COMM_SELF,
        shape.mesh,
        Material(youngs_modulus_pa=50e9, poissons_ratio=0.0, density_kg_m3=2700.0),
    )
    for name in ("mass", "stiffness"):
        rows, columns, values = getattr(body, name).getValuesCSR()
        matrix = sparse.csr_matrix((values, columns, rows))
        scipy.io.mmwrite(folder / f"{name}.mtx", matrix)
        sparse.save_npz(folder / f"{name}.npz", matrix)
    shell = np.flatnonzero(
        (np.abs(body.all_X[:, 2]) < 1e-9) | (np.abs(body.all_X[:, 2] - 1.2) < 1e-9)
    )
    np.savez(
        folder / "nodes.npz", dofs=3 * shell[:, None] + np.arange(3), coordinates=body.all_X[shell]
    )
    np.savetxt(
        folder / "nodes.csv",
        np.column_stack([3 * shell[:, None] + np.arange(3), body.all_X[shell]]),
        delimiter=",",
        fmt="%.17g",
    )
    return folder, structure_model(case).parts[0].model


def _case(folder, kind, **files):
    body = dict(
        kind="matrices",
        mass_file=str(folder / f"mass.{kind}"),
        stiffness_file=str(folder / f"stiffness.{kind}"),
        nodes_file=str(folder / ("nodes.npz" if kind == "npz" else "nodes.csv")),
    )
    return structure(
        **block()
        | dict(bodies=dict(block=body | {key: str(folder / name) for key, name in files.items()}))
    )


@pytest.mark.parametrize("kind, dense", [("npz", True), ("mtx", False)])
def test_body_of_matrices_is_the_body_that_made_them(system, kind, dense, monkeypatch):
    folder, made = system
    monkeypatch.setattr(module, "_DENSE", 10**6 if dense else 0)
    found = structure_model(_case(folder, kind)).parts[0].model
    assert found.mass == pytest.approx(made.mass, rel=1e-9) and found.center == pytest.approx(
        made.center, abs=1e-9
    )
    assert found.inertia == pytest.approx(made.inertia, rel=1e-9, abs=1e-9)
    assert found.frequencies[:20] == pytest.approx(made.frequencies[:20], rel=1e-6)
    one, other = (model.arms[model.surfaces["foot"].nodes] for model in (found, made))
    order = [int(np.argmin(np.linalg.norm(other - arm, axis=1))) for arm in one]
    rows, others = found.surfaces["foot"].nodes, made.surfaces["foot"].nodes[order]
    assert found.flexibility[np.ix_(rows, rows)] == pytest.approx(
        made.flexibility[np.ix_(others, others)],
        rel=1e-6,
        abs=1e-7 * np.abs(made.flexibility).max(),
    )
    assert found.surfaces["foot"].areas.sum() == pytest.approx(0.4 * 0.2, rel=1e-9)


def test_matrices_of_a_held_body_are_refused(system):
    folder, _ = system
    held = sparse.load_npz(folder / "stiffness.npz") + 1e9 * sparse.eye(
        sparse.load_npz(folder / "stiffness.npz").shape[0]
    )
    sparse.save_npz(folder / "held.npz", held.tocsr())
    with pytest.raises(InputError, match="nothing may hold the body") as error:
        structure_model(_case(folder, "npz", stiffness_file="held.npz"))
    assert error.value.key == "bodies.block.stiffness_file"


def test_matrices_of_a_body_held_at_one_row_are_refused(system):
    """Whichever it is, also one of the six that are held to find rigid motions."""
    folder, _ = system
    free = sparse.load_npz(folder / "stiffness.npz").tolil()
    for row in np.load(folder / "nodes.npz")["dofs"].ravel():
        held = free.copy()
        held[row, row] += 1e9
        sparse.save_npz(folder / "held.npz", held.tocsr())
        with pytest.raises(InputError, match="nothing may hold the body"):
            structure_model(_case(folder, "npz", stiffness_file="held.npz"))


@pytest.mark.parametrize(
    "file, said", [("mass.mtx", "symmetric|cannot be read"), ("nodes.npz", "cannot be read")]
)
def test_files_of_another_content_are_refused(system, file, said):
    folder, _ = system
    (folder / "text.npz").write_text("no matrix")
    key = "nodes_file" if file == "nodes.npz" else "mass_file"
    with pytest.raises(InputError, match=said) as error:
        structure_model(_case(folder, "npz", **{key: "text.npz"}))
    assert error.value.key == f"bodies.block.{key}"


@pytest.mark.parametrize(
    "triangle, said",
    [
        ([0, 1, 1], "1 of its triangles have no area, the first one of nodes \\[0, 1, 1\\]"),
        ([0, 1, 10_000], "its triangles must be of nodes 0 to"),
        ([0, 1, -1], "its triangles must be of nodes 0 to"),
    ],
)
def test_triangles_that_are_none_are_refused(system, triangle, said, tmp_path):
    folder, _ = system
    known = np.load(folder / "nodes.npz")
    triangles = np.array([[0, 1, 2], triangle])
    np.savez(tmp_path / "nodes.npz", **known, triangles=triangles)
    with pytest.raises(InputError, match=said):
        structure_model(_case(folder, "npz", nodes_file=tmp_path / "nodes.npz"))


def test_massless_degrees_of_freedom_are_refused(system, tmp_path):
    folder, _ = system
    mass = sparse.load_npz(folder / "mass.npz").tolil()
    mass[12:15, :], mass[:, 12:15] = 0.0, 0.0  # of one node
    sparse.save_npz(tmp_path / "mass.npz", mass.tocsr())
    with pytest.raises(InputError, match="must have inertia in every degree of freedom"):
        structure_model(_case(folder, "npz", mass_file=tmp_path / "mass.npz"))


def test_matrices_in_tonnes_and_millimetres_are_told_of(system, tmp_path):
    folder, _ = system
    for name in ("mass", "stiffness"):
        matrix = sparse.load_npz(folder / f"{name}.npz")
        sparse.save_npz(tmp_path / f"{name}.npz", matrix / 1e3)
    nodes = np.load(folder / "nodes.npz")
    np.savez(tmp_path / "nodes.npz", dofs=nodes["dofs"], coordinates=1e3 * nodes["coordinates"])
    with pytest.warns(UserWarning, match="mass_file: .* kg/m3 .* masses are in kg"):
        structure_model(_case(tmp_path, "npz"))
