"""A body that is the same along x and along y moves the same along both: of modes of one frequency
none is kept alone.
"""

import numpy as np
import pytest
import scipy.sparse as sparse
from small_structures import block, structure

from fecolumn.engines.dynamics.history import read_history
from fecolumn.pictures.mesh_report import mesh_report
from fecolumn.simulation import run
from fecolumn.structures import matrices as module
from fecolumn.structures.structure import structure_model

SQUARE = dict(length_m=0.4, width_m=0.4, element_size_m=0.2)


def _square(modes, **more):
    """A square block of so many modes."""
    return structure(**block(**SQUARE), integration=dict(n_modes=modes, dt_s=2e-5), **more)


@pytest.mark.parametrize("asked, kept", [(0, 0), (1, 2), (2, 2), (4, 4), (9, 10), (10, 10)])
def test_pairs_are_whole(asked, kept):
    assert len(structure_model(_square(asked)).parts[0].model.frequencies) == kept


def test_a_square_block_falls_alike_along_x_and_y(tmp_path):
    """Half of the pair that nine modes would end in is along one of them."""
    tops = []
    for direction, axis in ((0.0, 0), (90.0, 1)):
        case = _square(9, initial=dict(block=dict(tilt_rad=0.02, direction_deg=direction)))
        case = case.replace({"integration.duration_s": 0.03})
        run(case, tmp_path / str(axis), file="square.toml", quiet=True)
        tops.append(read_history(tmp_path / str(axis) / "history.h5")["u_top"][:, axis])
    assert np.ptp(tops[0]) > 1e-4
    np.testing.assert_allclose(tops[0], tops[1], rtol=0, atol=1e-9 * np.ptp(tops[0]))


@pytest.mark.parametrize("dense", [True, False])
def test_pairs_of_a_body_of_matrices_are_whole(dense, tmp_path, monkeypatch):
    from mpi4py import MPI

    from fecolumn.case.sections import Material
    from fecolumn.fem.body import Body
    from fecolumn.structures.bodies import drawing

    monkeypatch.setattr(module, "_DENSE", 10**6 if dense else 0)
    shape = drawing(_square(1), "block", "small.toml").shape
    stone = Material(youngs_modulus_pa=50e9, poissons_ratio=0.0, density_kg_m3=2700.0)
    body = Body(MPI.COMM_SELF, shape.mesh, stone)
    for name in ("mass", "stiffness"):
        rows, columns, values = getattr(body, name).getValuesCSR()
        sparse.save_npz(tmp_path / f"{name}.npz", sparse.csr_matrix((values, columns, rows)))
    ends = np.flatnonzero(np.isin(np.round(body.all_X[:, 2], 9), (0.0, 1.2)))
    np.savez(
        tmp_path / "nodes.npz", dofs=3 * ends[:, None] + np.arange(3), coordinates=body.all_X[ends]
    )
    files = {
        f"{name}_file": str(tmp_path / f"{name}.npz") for name in ("mass", "stiffness", "nodes")
    }
    for asked, kept in ((1, 2), (2, 2), (9, 10)):
        tables = block() | dict(bodies=dict(block=dict(kind="matrices", modes=asked) | files))
        assert len(structure_model(structure(**tables)).parts[0].model.frequencies) == kept


def test_the_mesh_report_prints_the_modes_that_a_body_has(tmp_path):
    lines = mesh_report(_square(9), "square.toml", tmp_path / "mesh").splitlines()
    head = next(line for line in lines if line.startswith("body ") and "modes" in line)
    (row,) = [line for line in lines if line.startswith("block ")]
    end = head.index("modes") + len("modes")
    assert row[end - 7 : end].split() == ["10"]
