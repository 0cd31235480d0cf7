"""Bodies on domes and rounded edges, on soil, on plates and on other bodies."""

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.schema import InputError
from fecolumn.structures.barrier import feet_on_springs
from fecolumn.structures.structure import standing_of, structure_model
from fecolumn.verification.structures_feet import BLOCK as WIDE
from fecolumn.verification.structures_feet import (
    CLOSED,
    MARBLE,
    PLATE,
    Rolling,
    alone_on_ground,
    case_of,
    closure_over_kinetic,
    columns_and_rows,
    passages,
)

RADIUS = 0.9
DOMED = WIDE | dict(foot_radius_m=RADIUS)
SOIL = dict(kind="pad", stiffness_n_m3=1e8, damping_ratio=0.05)


def domed_on(ground: dict, engine: str = "rigid", **initial):
    return alone_on_ground(DOMED, engine, 1e-3, ground=ground, **initial)


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_a_dome_on_soil_has_the_stiffness_of_a_sphere_on_springs(engine):
    """F = pi k R d^2, and dF/dd at the weight."""
    model = structure_model(domed_on(SOIL, engine))
    weight, stiffness = model.parts[0].model.mass * GRAVITY, SOIL["stiffness_n_m3"]
    depth = np.sqrt(weight / (np.pi * stiffness * RADIUS))
    joint = model.joints[0]
    assert joint.pad.stiffness[0, 2] == pytest.approx(2 * np.pi * stiffness * RADIUS * depth)
    # no stiffness of Hertz in series: the soil spreads the force
    assert not joint.law.any()


def test_a_dome_that_sinks_in_up_to_its_edge_is_refused():
    with pytest.raises(InputError, match="grounds.ground.stiffness_n_m3.*up to its edge"):
        structure_model(domed_on(SOIL | dict(stiffness_n_m3=2e6)))
    with pytest.raises(InputError, match="grounds.ground.yield_pa.*dome"):
        structure_model(domed_on(SOIL | dict(yield_pa=1e7)))


def test_on_soil_a_dome_is_overturned_over_its_edge():
    """The spring of the lowest place carries the weight at any tilt: the energy is that on rigid
    ground.
    """
    case = domed_on(SOIL)
    structure = structure_model(case)
    (foot,) = feet_on_springs(structure, standing_of(case, structure)).values()
    rolling = Rolling(structure.parts[0].model, RADIUS, 0.2)
    tilts = np.linspace(0.0, 1.0, 2001)
    energy = [rolling.potential(tilt) for tilt in tilts]
    assert foot.barrier == pytest.approx(max(energy), rel=1e-3)
    assert foot.critical == pytest.approx(tilts[int(np.argmax(energy))], abs=5e-3)


@pytest.mark.long
@pytest.mark.parametrize("ground", [SOIL, PLATE])
def test_a_rounded_edge_stands_and_rolls_on_ground_that_gives(ground):
    rows, columns = columns_and_rows(
        alone_on_ground(
            WIDE | dict(edge_radius_m=0.05), "rigid", 5e-4, ground=ground, tilt_rad=0.1
        ),
        2.0,
    )
    assert closure_over_kinetic(columns) < 1e-10
    assert 0 < np.abs(rows["body/body/tilt"][-200:]).max() < 0.1


PLINTH = dict(kind="block", length_m=1.2, width_m=1.0, height_m=0.4, element_size_m=0.2) | MARBLE


def on_plinth(engine: str, at: tuple[float, float] = (0.0, 0.0), joint=None, **initial):
    """Case of a block on a dome on a block on the ground."""
    return case_of(
        dict(plinth=PLINTH, body=DOMED | dict(at_m=[*at, PLINTH["height_m"]])),
        dict(
            base=dict(between=["plinth", "ground"]),
            foot=dict(between=["body", "plinth"]) | (joint or {}),
        ),
        engine,
        1e-3,
        dict(body=initial) if initial else None,
    )


@pytest.mark.parametrize("joint", [{}, dict(stiffness_n_m3=1e9)])
def test_a_dome_swings_on_another_body_and_on_a_pad_between_them(joint):
    still = structure_model(on_plinth("rigid", joint=joint))
    rolling = Rolling(still.parts[1].model, RADIUS)
    spin = [0.0, rolling.spin(rolling.potential(0.05)), 0.0]
    rows, columns = columns_and_rows(on_plinth("rigid", joint=joint, spin_rad_s=spin), 3.5)
    found = passages(rows)
    assert 2 * (found[1] - found[0]) == pytest.approx(4 * rolling.quarter(0.05), rel=5e-4)
    assert closure_over_kinetic(columns) < CLOSED


@pytest.mark.parametrize("joint", [{}, dict(stiffness_n_m3=1e9)])
def test_a_dome_away_from_the_middle_of_an_elastic_body_rests(joint):
    """What it stands on leans by a millionth: it has to roll a little, which only its own weight
    resists.
    """
    rows, _ = columns_and_rows(on_plinth("reduced", (0.3, 0.2), joint), 0.05)
    assert rows["body/body/tilt"].max() < 1e-4


def test_a_dome_that_begins_above_the_ground_falls_and_lands():
    case = alone_on_ground(DOMED | dict(at_m=[0.0, 0.0, 0.02]), "reduced", 1e-3)
    rows, columns = columns_and_rows(case, 0.3)
    assert rows["body/body/displacement"][-1, 2] == pytest.approx(-0.02, abs=1e-4)
    assert closure_over_kinetic(columns) < CLOSED
