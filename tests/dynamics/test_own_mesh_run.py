"""A column of tetrahedra goes the whole way: equilibrium, steps, fields."""

import sys
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from mpi4py import MPI

from fecolumn.case.case import Case, case_from_tables
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.fem.modes import free_modes
from fecolumn.simulation import run
from fecolumn.verification.models import system_of

sys.path.insert(0, str(Path(__file__).parents[1] / "mesh"))
from own_meshes import bricks, own_case, tetrahedra, write  # noqa: E402


@pytest.mark.long
def test_tetrahedra_and_bricks_of_one_block_stand_and_vibrate_alike(tmp_path):
    found = []
    for kind, made in (("tetra", tetrahedra), ("hexahedron", bricks)):
        own = own_case(write(tmp_path, "own.vtu", kind, *made()), mesh={"element_order": 2})
        system = system_of(Case.of_column(own))
        state = standing(system)
        assert (
            state.forces[:, 2].sum() == np.float64(system.weight).round(9)
            or abs(state.forces[:, 2].sum() / system.weight - 1) < 1e-8
        )
        modes = free_modes(system.body, 8).frequencies
        assert np.abs(modes[:6]).max() < 1e-2
        found.append((system.weight, modes[6]))
    assert abs(found[0][0] / found[1][0] - 1) < 1e-9 and abs(found[0][1] / found[1][1] - 1) < 0.02


def test_fields_of_tetrahedra_open_in_a_reader_of_xdmf(tmp_path):
    case = own_case(
        write(tmp_path, "own.vtu", "tetra", *tetrahedra((2, 1, 3))),
        output={"fields_every_s": 1e-3},
        integration={"duration_s": 0.002, "engine": "full"},
    )
    summary = run(
        case_from_tables(case.tables(), "test"), tmp_path / "run", comm=MPI.COMM_SELF, quiet=True
    )
    assert summary["steps"] == 2 and not summary["overturned"]
    with meshio.xdmf.TimeSeriesReader(tmp_path / "run" / "fields" / "fields.xdmf") as reader:
        points, blocks = reader.read_points_cells()
        time, at_points, of_cells = reader.read_data(reader.num_steps - 1)
    assert (
        reader.num_steps == 3
        and [block.type for block in blocks] == ["tetra", "hexahedron"]
        and len(blocks[0].data) == 36
    )
    assert at_points["displacement [m]"].shape == (len(points), 3)
    with h5py.File(next((tmp_path / "run" / "fields").glob("frame_*2000.h5"))) as frame:
        assert frame["pressure"][:].max() > 0 and np.isfinite(frame["von_mises"][:]).all()
