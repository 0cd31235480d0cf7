"""Every kind of column stands, rocks and closes its ledger: solid, without cap, second order,
imported, literal HHT.
"""

import numpy as np
import pytest
from coarse_column import coarse_case

from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.energy import Ledger
from fecolumn.engines.dynamics.gravity import standing, tilted
from fecolumn.engines.dynamics.stepper import Stepper
from fecolumn.foundation.toml_file import merge, read_toml
from fecolumn.mesh.column import column_mesh
from fecolumn.verification.models import system_of

SPECIMEN = "meshes/stout.toml"


def _without_cap():
    tables = read_toml(SPECIMEN)
    del tables["cap"]
    return case_from_tables(
        merge(
            tables,
            {
                "column": {"fine_height_m": 0.03},
                "base": {"slide_allowance_m": 0.01},
                "mesh": {"coarse_size_m": 0.03},
            },
        ),
        SPECIMEN,
    )


def _imported(folder):
    """The coarse column through an Abaqus file written by meshio."""
    import meshio

    # a polygon of true area is wider than the circle
    mesh = column_mesh(
        coarse_case(column={"fine_height_m": 0.0}, mesh={"coarse_size_m": 0.0133}).short
    )
    meshio.Mesh(mesh.points, [("hexahedron", mesh.cells)]).write(folder / "column.inp")
    return coarse_case(column={"mesh_file": str(folder / "column.inp")})


CASES = {
    "solid": lambda folder: coarse_case(
        column={"wall_m": 0.0508, "fine_height_m": 0.02},
        mesh={"fine_size_m": 0.0125, "coarse_size_m": 0.019},
    ),
    "no cap": lambda folder: _without_cap(),
    "order 2": lambda folder: coarse_case(
        mesh={"element_order": 2, "coarse_size_m": 0.03}, column={"fine_height_m": 0.0}
    ),
    "imported": _imported,
    "all fine": lambda folder: coarse_case(
        column={"fine_height_m": 0.0}, mesh={"coarse_size_m": 0.02}
    ),
}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow) if name == "order 2" else name for name in CASES],
)
def test_stands_still_and_rocks_without_creating_energy(name, tmp_path):
    system = system_of(CASES[name](tmp_path))
    state = start = standing(system)
    ledger = Ledger(system)
    ledger.open(start)
    stepper = Stepper(system, ledger)
    for _ in range(20):
        state = stepper.step(state, np.zeros(3))
    assert np.abs(state.x - start.x).max() < 1e-8
    assert state.forces[:, 2].sum() == pytest.approx(system.weight, rel=1e-6)

    state = tilted(system, 2e-3, 0.3)
    ledger = Ledger(system)
    ledger.open(state)
    stepper = Stepper(system, ledger)
    for _ in range(120):
        state = stepper.step(state, np.zeros(3))
    assert stepper.record.impacts > 0
    row, moved = ledger.row(state), abs(ledger.start)
    assert abs(row[-1]) < 1e-4 * moved
    assert row[:3].sum() < ledger.start + 1e-6 * moved
