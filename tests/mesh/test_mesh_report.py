"""`fecolumn mesh` of columns and of structures: the same files, and closed forms of every body."""

import sys
from pathlib import Path

import meshio
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.pictures.mesh_report import FILES, mesh_report

sys.path.insert(0, str(Path(__file__).parents[1] / "render"))
from rocking_analyses import BLOCK
from rocking_structures import GATE


@pytest.mark.parametrize(
    "tables, bodies, masses",
    [
        (GATE, 3, {"column": 0.2 * 0.4 * 0.8 * 2700, "lintel": 1.3 * 0.44 * 0.2 * 2700}),
        (BLOCK, 2, {"column": 0.4 * 0.4 * 1.2 * 2700}),
    ],
    ids=["gate", "block on its plate"],
)
def test_every_body_stands_beside_its_closed_form_and_in_the_files(
    tables, bodies, masses, tmp_path
):
    told = []
    text = mesh_report(case_from_tables(tables, "case"), "case", tmp_path, told.append)
    assert {file.name for file in tmp_path.iterdir()} == set(FILES)
    assert all(" GB, " in line and "ms a step" in line for line in (told[0], text.splitlines()[0]))
    for name, mass in masses.items():
        row = next(line for line in text.splitlines() if line.startswith(f"{name}: mass "))
        assert [float(word) for word in row.split()[3:5]] == pytest.approx([mass] * 2, rel=1e-5)
    mesh = meshio.read(tmp_path / "specimen.xdmf")
    assert set(map(int, sum((part.tolist() for part in mesh.cell_data["body"]), []))) == set(
        range(1, bodies + 1)
    )
