"""Bodies whose mass, centre and inertia were measured, in every engine alike."""

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bodies import drawing
from fecolumn.structures.layout import layout_of

INERTIA = [20.0, 22.0, 6.0, 0.4, -0.3, 0.2]
TENSOR = np.array([[20.0, 0.4, -0.3], [0.4, 22.0, 0.2], [-0.3, 0.2, 6.0]])


def case(**keys):
    stele = {"kind": "block", "length_m": 0.4, "width_m": 0.3, "height_m": 1.2} | keys
    return case_from_tables(
        {
            "bodies": {"stele": stele},
            "joints": {"foot": {"between": ["stele", "ground"]}},
            "integration": {"duration_s": 0.1},
        },
        "weighed.toml",
    )


WEIGHED = dict(mass_kg=150.0, centre_m=[0.01, -0.02, 0.5], inertia_kg_m2=INERTIA)


@pytest.mark.parametrize("keys", [{}, {"rigid": True}], ids=["elements", "rigid"])
def test_a_weighed_body_moves_as_it_was_measured(keys):
    one = case(**WEIGHED, **keys)
    layout = layout_of(one, "weighed.toml")
    model, _ = layout.drawings["stele"].model(layout.patches["stele"], 4)
    assert model.mass == pytest.approx(150.0, rel=1e-9)
    assert model.center == pytest.approx([0.01, -0.02, 0.5], rel=1e-8)
    assert model.inertia == pytest.approx(TENSOR, rel=1e-7)


def test_a_rocking_model_takes_what_was_measured():
    from fecolumn.engines.rocking.column import rigid_body

    found = rigid_body(case(**WEIGHED), "stele", "weighed.toml")
    assert found.mass == 150.0 and 0.5 in vars_of(found) and (20.0, 22.0, 6.0) in vars_of(found)


def vars_of(found):
    return [getattr(found, name) for name in type(found).__dataclass_fields__]


def test_what_no_body_of_this_outline_has_is_refused():
    with pytest.raises(InputError, match="bodies.stele.centre_m .*no matter within its outline"):
        drawing(case(centre_m=[0.3, 0, 0.6]), "stele", "weighed.toml")
    with pytest.raises(InputError, match="inertia_kg_m2 .*must be less than the other two"):
        case(inertia_kg_m2=[1.0, 1.0, 3.0])
    with pytest.raises(InputError, match="centre_m .*three numbers"):
        case(centre_m=[1.0])
    for keys in ({"mass_kg": 1e-50}, {"density_kg_m3": 1e-50}):
        with pytest.raises(InputError, match="at least 1e-06 kg/m3"):
            drawing(case(**keys), "stele", "weighed.toml")
    with pytest.raises(InputError, match="mesh_unit"):
        case(mesh_unit="mm")
