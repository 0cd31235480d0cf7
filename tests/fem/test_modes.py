"""Free modes of the tied column: six rigid ones, bending as Timoshenko's beam."""

import numpy as np
import pytest

from fecolumn.case.case import load_case
from fecolumn.fem.modes import free_modes
from fecolumn.mesh.bending import free_free_bending_frequency
from fecolumn.structures.bodies import drawing
from fecolumn.structures.reduction import body_of


@pytest.fixture(scope="module")
def specimen():
    return load_case("meshes/stout.toml")


def _body(case):
    column = drawing(case, "column", "stout.toml")
    return body_of(column.shape, column.material)


def test_tied_column_with_cap_has_six_rigid_modes(specimen):
    body = _body(specimen)
    modes = free_modes(body, 8)
    assert np.abs(modes.frequencies[:6]).max() < 1e-2 < 100 < modes.frequencies[6]
    overlap = [
        [body.dot(left, body.apply(body.mass, right)) for left in modes.shapes]
        for right in modes.shapes
    ]
    np.testing.assert_allclose(overlap, np.eye(8), atol=1e-8)


def test_tube_bends_as_timoshenko_says(specimen):
    found = free_modes(_body(specimen.replace({"cap": None})), 8).frequencies[6:]
    column, steel = specimen.bodies["column"], specimen.materials["column"]
    outer = column.outer_diameter_m / 2
    exact = free_free_bending_frequency(
        outer,
        outer - column.wall_m,
        column.height_m,
        steel.youngs_modulus_pa,
        steel.poissons_ratio,
        steel.density_kg_m3,
    )
    assert found == pytest.approx([exact, exact], rel=0.02)
