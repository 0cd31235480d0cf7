"""Contact points of a solid foot: its outlines and a few inside stand for all of its nodes."""

import numpy as np
import pytest
from mpi4py import MPI

from fecolumn.case.short_form import short_form
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.fem.tied_body import column_body
from fecolumn.mesh.specimen import specimen_mesh
from fecolumn.verification.one_column import build_system, footprint_of

SHAPES = {
    "drum": {"shape": "solid", "outer_diameter_m": 0.5, "height_m": 0.8},
    "block": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 0.6},
}
MARBLE = {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700.0}


def marble(shape, interior, **tables):
    return short_form(
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
    specimen = specimen_mesh(case)
    column = column_body(case, specimen, MPI.COMM_SELF)
    return footprint_of(case, specimen, column), column


@pytest.mark.parametrize("shape, outline", [("drum", 32), ("block", 48)])
def test_outlines_are_kept_whole_and_points_inside_prefer_no_direction(shape, outline):
    found, column = foot(marble(shape, 20))
    places = column.all_X[found.nodes, :2]
    assert np.sum(~found.inner) == outline and 20 <= found.inner.sum() < 24
    for mirror in ([-1, 1], [1, -1]):
        assert {tuple(one) for one in np.round(places * mirror, 9) + 0.0} == {
            tuple(one) for one in np.round(places, 9) + 0.0
        }
    assert (
        found.areas.sum() == pytest.approx(found.all_areas.sum(), rel=1e-12)
        and found.areas.min() > 0
    )


def test_a_tube_of_one_brick_keeps_every_node():
    case = short_form(
        {
            "column": {"outer_diameter_m": 0.1, "wall_m": 0.005, "height_m": 0.5},
            "contact": {"interior_points": 0},
            "integration": {"duration_s": 1.0},
        },
        "tube.toml",
    )
    found, _ = foot(case)
    assert np.array_equal(found.nodes, found.all_nodes) and not found.inner.any()


@pytest.mark.parametrize("shape", ["drum", "block"])
def test_few_points_carry_the_weight_and_sink_a_little_deeper_than_all(shape):
    """Forces on single nodes press deeper than the pressure that they stand for."""
    sunk = []
    for interior in (64, 10_000):
        system = build_system(marble(shape, interior), MPI.COMM_SELF)
        state = standing(system)
        assert state.forces[:, 2].sum() == pytest.approx(system.weight, rel=1e-8)
        assert state.forces[:, 2].min() >= 0
        sunk.append(
            system.body.node_mass @ (state.x - system.body.X)[:, 2] / system.body.total_mass
        )
    assert sunk[1] > sunk[0] > 1.25 * sunk[1]  # downwards is negative, tens of nanometres
