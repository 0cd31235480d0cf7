"""Free modes of the tied column: six rigid ones, bending as Timoshenko's beam."""

import numpy as np
import pytest

from fecolumn.case.case import load_case
from fecolumn.fem.modes import elastic_modes, free_modes, modes_below
from fecolumn.fem.whole_groups import with_group
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


def test_modes_of_one_frequency_are_kept_together(specimen):
    """A round tube bends along x and along y at one frequency."""
    body = _body(specimen.replace({"cap": None}))
    two = free_modes(body, 8).frequencies[6:]
    assert two[1] == pytest.approx(two[0], rel=1e-4)
    for asked in (1, 2):
        frequencies, shapes = elastic_modes(body, asked)
        assert len(frequencies) == len(shapes) == 2
    assert modes_below(body, 2 * np.pi * two[0] * 0.99) == 6
    assert modes_below(body, 2 * np.pi * two[1] * 1.01) == 8


@pytest.mark.parametrize(
    "count, kept", [(0, 0), (1, 2), (2, 2), (3, 3), (4, 6), (5, 6), (6, 6), (9, 6)]
)
def test_a_group_of_modes_is_whole(count, kept):
    assert with_group(np.array([1.0, 1.0 + 1e-12, 2.0, 3.0, 3.0, 3.0 + 1e-6]), count) == kept
