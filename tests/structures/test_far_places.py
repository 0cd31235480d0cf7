"""Survey coordinates: how far from the origin bodies may be."""

import warnings

import pytest
from small_structures import structure

from fecolumn.simulation import run
from fecolumn.structures.structure import structure_model


def released(size, at, engine="rigid"):
    """A block, let go from a tilt."""
    side = 0.2 * size
    block = dict(kind="block", length_m=side, width_m=side, height_m=3 * side)
    block |= dict(element_size_m=side / 2, at_m=[at, at, 0.0])
    return structure(
        bodies=dict(block=block),
        joints=dict(foot=dict(between=["block", "ground"])),
        initial=dict(block=dict(tilt_rad=0.1)),
        integration=dict(engine=engine, duration_s=0.02, dt_s=1e-3 * size**0.5),
        contact=dict(interior_points=0),
    )


@pytest.mark.parametrize(
    "size, at, engine, farthest",
    [
        (0.1, 1e3, "rigid", "9e+02 m"),
        (0.001, 10.0, "reduced", "9 m"),
        (1.0, 1e3, "full", "46 m"),
        (0.1, 2.0, "full", "0.46 m"),
    ],
)
def test_a_body_too_far_away_is_warned_of_with_its_limit(size, at, engine, farthest):
    with pytest.warns(UserWarning, match=f'"block" is .* it may be {farthest}'.replace("+", r"\+")):
        structure_model(released(size, at, engine))


def test_a_tall_body_at_the_origin_is_not_told_to_be_nearer():
    tower = released(1.0, 0.0, "full").replace(
        {
            "bodies.block.height_m": 5.0,
            "integration.tolerance": 1e-11,
        }
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        structure_model(tower)
    with pytest.warns(UserWarning, match=r'"block" is 10 m from the origin'):
        structure_model(tower.replace({"bodies.block.at_m": [10.0, 0.0, 0.0]}))


@pytest.mark.parametrize("size, at, engine", [(0.1, 800.0, "rigid"), (1.0, 40.0, "full")])
def test_within_it_nothing_is_said_and_it_moves_as_at_the_origin(size, at, engine, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        far = run(released(size, at, engine), tmp_path / "far", quiet=True)
        near = run(released(size, 0.0, engine), tmp_path / "near", quiet=True)
    assert far["u_max_m"] == pytest.approx(near["u_max_m"], rel=1e-6)


def test_stiff_mortar_is_told_of_where_its_rounding_stops_steps():
    """A stone of 0.3 x 0.3 x 0.25 m on mortar of 8e10 N/m3 goes on at 10 m and stops at 30 m."""
    stone = dict(kind="block", length_m=0.3, width_m=0.3, height_m=0.25, element_size_m=0.1)
    stone |= dict(mass_kg=54)
    mortar = dict(bond_tension_pa=2e5, bond_cohesion_pa=3e5, bond_stiffness_n_m3=8e10)

    def told(at, **bond):
        case = structure(
            bodies=dict(stone=stone | dict(at_m=[at, 0, 0])),
            joints=dict(foot=dict(between=["stone", "ground"]) | bond),
            integration=dict(engine="rigid", dt_s=5e-5, duration_s=0.1),
        )
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            structure_model(case)
        return [str(one.message) for one in said if "from the origin" in str(one.message)]

    assert told(30, **mortar) and not told(0, **mortar) and not told(30)
