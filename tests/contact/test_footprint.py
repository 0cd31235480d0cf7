"""Contact points of a solid foot: its outlines and a few inside stand for all of its nodes."""

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.structures.layout import layout_of
from fecolumn.structures.patches import whole_face
from fecolumn.verification.models import system_of

SHAPES = {
    "drum": {"shape": "solid", "outer_diameter_m": 0.5, "height_m": 0.8},
    "block": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 0.6},
}
MARBLE = {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700.0}


def marble(shape, interior, **tables):
    return case_from_tables(
        {
            "column": SHAPES[shape],
            "material": MARBLE,
            "base": {"thickness_m": 0.05},
            "integration": {"duration_s": 1.0},
            "contact": {"interior_points": interior},
        }
        | tables,
        "marble.toml",
    )


def foot(case):
    """The contact points of a column's foot, and all of its nodes, as Patches."""
    layout = layout_of(case, "marble.toml")
    column = layout.drawings["column"]
    lowest = min(column.faces, key=lambda face: face.corners[:, :, 2].max())
    return layout.patches["column"]["foot"], whole_face(lowest, column.order)


@pytest.mark.parametrize("shape, outline", [("drum", 32), ("block", 48)])
def test_outlines_are_kept_whole_and_points_inside_prefer_no_direction(shape, outline):
    found, whole = foot(marble(shape, 20))
    places, inner = found.positions[:, :2], ~found.outlines
    assert np.sum(~inner) == outline and 20 <= inner.sum() < 24
    for mirror in ([-1, 1], [1, -1]):
        assert {tuple(one) for one in np.round(places * mirror, 9) + 0.0} == {
            tuple(one) for one in np.round(places, 9) + 0.0
        }
    assert (
        found.areas.sum() == pytest.approx(whole.areas.sum(), rel=1e-12) and found.areas.min() > 0
    )


def test_a_tube_of_one_brick_keeps_every_node():
    case = case_from_tables(
        {
            "column": {"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 0.5},
            "contact": {"interior_points": 0},
            "integration": {"duration_s": 1.0},
        },
        "tube.toml",
    )
    found, whole = foot(case)
    assert np.array_equal(found.positions, whole.positions) and found.outlines.all()


@pytest.mark.long
@pytest.mark.parametrize("shape", ["drum", "block"])
def test_few_points_carry_the_weight_and_sink_a_little_deeper_than_all(shape):
    """Forces on single nodes press deeper than the pressure that they stand for."""
    sunk = []
    for interior in (64, 10_000):
        system = system_of(marble(shape, interior))
        state = standing(system)
        assert state.forces[:, 2].sum() == pytest.approx(system.weight, rel=1e-8)
        assert state.forces[:, 2].min() >= 0
        sunk.append(
            system.body.node_mass @ (state.x - system.body.X)[:, 2] / system.body.total_mass
        )
    assert sunk[1] > sunk[0] > 1.25 * sunk[1]  # downwards is negative, tens of nanometres
