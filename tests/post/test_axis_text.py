"""Keys of a case in figures and tables, with their units."""

import pytest

from fecolumn.pictures.figures.axis_text import axis_text, axis_unit


@pytest.mark.parametrize(
    "key, unit",
    [
        ("integration.dt_s", "s"),
        ("bodies.slab.length_m", "m"),
        ("bodies.column.outer_diameter_m", "m"),
        ("bodies.column.cap.thickness_m", "m"),
        ("links.tendon.stiffness_n_m", "N/m"),
        ("initial.slab.tilt_rad", "rad"),
        ("materials.granite.density_kg_m3", "kg/m3"),
        ("podium.period_s", "s"),
        ("podium.impact", "-"),
        ("title", "-"),
    ],
)
def test_a_key_has_the_unit_of_its_declaration(key, unit):
    assert axis_unit(key) == unit


def test_axes_of_structures_and_models_are_written_with_number_and_unit():
    assert (
        axis_text("bodies.slab.length_m", 3.0) == "length = 3 m"
        and axis_text("podium.impact", "CRV") == "law of impact = CRV"
    )
