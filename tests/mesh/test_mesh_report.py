"""`fecolumn mesh` of columns and of structures: the same files, and closed forms of every body."""

import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from small_specimen import small_case

from fecolumn.case.case import Case, case_from_tables
from fecolumn.pictures.mesh_report import FILES, mesh_report

sys.path.insert(0, str(Path(__file__).parents[1] / "render"))
from rocking_analyses import BLOCK
from rocking_structures import GATE


@pytest.mark.long
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


@pytest.mark.long
def test_a_body_alone_is_drawn_in_the_colours_of_its_parts_without_an_x_server(
    tmp_path, monkeypatch
):
    """Reddish (lower), bluish (upper), yellowish (cap) and neutral grey (plate) areas."""
    from matplotlib.image import imread

    monkeypatch.delenv("DISPLAY", raising=False)
    mesh_report(Case.of_column(small_case()), "case", tmp_path)
    image = imread(tmp_path / "mesh.png")[:, :, :3]
    whole, foot = np.split(image, [image.shape[1] * 2 // 3], axis=1)
    whole, foot = whole.reshape(-1, 3), foot.reshape(-1, 3)
    red, blue = foot[:, 0] - foot[:, 2], whole[:, 2] - whole[:, 0]
    assert np.mean(red > 0.2) > 0.02
    assert np.mean(blue > 0.05) > 0.01
    assert np.mean(-blue > 0.15) > 0.005
    grey = np.ptp(foot, axis=1) + (foot.mean(axis=1) > 0.9) < 0.05
    assert np.mean(grey) > 0.05
