"""A column on its base is a structure of one body on a ground: the same histories, until the third
impact, on each kind of base.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.history import read_history
from fecolumn.simulation import run

sys.path.insert(0, str(Path(__file__).parents[1] / "mesh"))
from own_meshes import bricks, write  # noqa: E402

STONE = dict(youngs_modulus_pa=20e9, poissons_ratio=0.2, density_kg_m3=2500.0)
LAYER = dict(youngs_modulus_pa=5e9, poissons_ratio=0.25, density_kg_m3=2000.0, thickness_m=0.1)
PLATE = LAYER | dict(length_m=0.6, width_m=0.5, slide_allowance_m=0.05)
SOIL = dict(stiffness_n_m3=1e9, damping_ratio=0.1)
GROUNDS = dict(plate=PLATE, unbounded=LAYER | dict(slide_allowance_m=0.05), pad=SOIL)
FINE, COARSE = 0.05, 0.15
IMPACTS, TOLERANCE = 3, 1e-9


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    return str(write(tmp_path_factory.mktemp("mesh"), "own.vtu", "hexahedron", *bricks()))


def histories(folder, kind, mesh, modes):
    """History of the column and of the structure, and the step after the third impact."""
    common = dict(
        contact=dict(
            friction_coefficient=0.5,
            interior_points=1000,
            restitution=0.0 if kind == "pad" else 0.2,
        ),
        overturn={},
        title=kind,
    )
    plan = dict(
        n_modes=max(modes, 0),
        dt_s=5e-4,
        alpha_hht=-0.1,
        duration_s=0.3,
        engine="reduced" if modes else "rigid",
    )
    start = dict(velocity_m_s=[0.4, 0.35, 0.0])
    keys = GROUNDS[kind]
    column = case_from_tables(
        common
        | dict(
            column=dict(mesh_file=mesh),
            material=STONE,
            base=keys | dict(kind=kind),
            mesh=dict(fine_size_m=FINE, base_size_m=COARSE, element_order=1),
            integration=plan,
            initial=start,
        ),
        "column.toml",
    )
    sizes = {} if kind == "pad" else dict(element_size_m=FINE, coarse_size_m=COARSE)
    structure = case_from_tables(
        common
        | dict(
            bodies=dict(column=dict(kind="mesh", mesh_file=mesh, element_order=1) | STONE),
            joints=dict(foot=dict(between=["column", "ground"])),
            grounds=dict(ground=keys | sizes | dict(kind=kind)),
            integration=plan,
            initial=dict(column=start),
        ),
        "structure.toml",
    )
    found = []
    for name, case in (("column", column), ("structure", structure)):
        run(case, folder / name, quiet=True)
        found.append(read_history(folder / name / "history.h5"))
    return found


def until(rows):
    """Rows until the third impact: a step in which impacts or dashpots take a thousandth of what
    has been lifted.
    """
    taken = -np.diff(rows["energy/impact"] + rows["energy/contact"])
    hits = np.flatnonzero(taken > 1e-3 * np.ptp(rows["energy/gravity"])) + 1
    return hits[IMPACTS - 1] if len(hits) >= IMPACTS else len(rows["time"])


@pytest.mark.parametrize("kind", GROUNDS)
@pytest.mark.parametrize("modes", [0, 12])
def test_a_column_on_its_base_is_a_structure_of_one_body(tmp_path, mesh, kind, modes):
    column, structure = histories(tmp_path, kind, mesh, modes)
    last = until(column)
    assert last > 100 and column["tilt"][:last].max() > 0.02
    # where a foot bends, its middle is that of its nodes in one form, of its areas in the other
    for name in ("u_top", "tilt", "contact_force", "energy/strain") + ("slide",) * (not modes):
        one, other = column[name][:last], structure[name][:last]
        assert np.abs(one - other).max() < TOLERANCE * np.abs(one).max(), name
