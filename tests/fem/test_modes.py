"""Free modes of the tied column: six rigid ones, bending as Timoshenko's beam."""

import numpy as np
import pytest

from fecolumn.case.case import load_case
from fecolumn.fem import modes
from fecolumn.fem.modes import Modes, elastic_modes, free_modes, modes_below
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
    found = free_modes(body, 8)
    assert np.abs(found.frequencies[:6]).max() < 1e-2 < 100 < found.frequencies[6]
    overlap = [
        [body.dot(left, body.apply(body.mass, right)) for left in found.shapes]
        for right in found.shapes
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


def test_a_mode_that_the_solver_misses_is_sought_again(specimen, monkeypatch):
    """As a Krylov method does with one of two equal eigenvalues: others above are in its place."""
    body = _body(specimen.replace({"cap": None}))
    all_of_them = free_modes(body, 30)
    sought = []

    def missing(body, count):
        sought.append(count - 6)
        places = np.arange(30)
        if len(sought) == 1:
            places = np.delete(places, 9)  # the fourth elastic mode, one of a pair
        return Modes(all_of_them.frequencies[places][:count], all_of_them.shapes[places][:count])

    monkeypatch.setattr(modes, "free_modes", missing)
    frequencies, shapes = elastic_modes(body, 5)
    assert sought[0] == 5 and len(sought) == 2 and len(frequencies) == len(shapes) == 5
    assert frequencies == pytest.approx(2 * np.pi * all_of_them.frequencies[6:11], rel=1e-9)
    monkeypatch.setattr(modes, "modes_below", lambda body, frequency: len(sought) + 20)
    with pytest.raises(RuntimeError, match="lowest elastic modes are not found"):
        elastic_modes(body, 5)


def test_twelve_modes_of_a_tube_are_the_lowest(specimen):
    body = _body(specimen.replace({"cap": None}))
    assert elastic_modes(body, 12)[0] == pytest.approx(
        2 * np.pi * free_modes(body, 32).frequencies[6:18], rel=1e-8
    )
