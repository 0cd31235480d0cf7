"""Walls of stones in running bond whose head joints touch: equilibrium, and the energy of a wall
that is shaken.
"""

import numpy as np
import pytest
from small_structures import block, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.engines.history_columns import columns_of
from fecolumn.simulation import run
from fecolumn.verification.any_joint_walls import sunk_depth, wall, wall_shaking


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_wall_with_closed_head_joints_stands_and_carries_its_weight(engine):
    made = wall(3, 3, engine)
    on_ground = made.points["master"] == GROUND
    carried = made.motion.contact["force"][on_ground].sum(axis=0)
    weight = made.structure.bodies.body["mass"].sum() * GRAVITY
    # what the last proximal step moves leaves 5e-9 of the weight
    np.testing.assert_allclose(carried, [0.0, 0.0, weight], rtol=2e-8, atol=2e-8 * weight)
    # each stone, too: what joints push it by is its own weight
    push = -made.motion.frames["acceleration"] * made.structure.bodies.body["mass"][:, None]
    np.testing.assert_allclose(
        push, made.structure.bodies.body["mass"][:, None] * [0, 0, GRAVITY], atol=1e-8 * weight
    )


def test_shaken_wall_with_closed_head_joints_keeps_its_energy_and_sinks_nowhere():
    made, closure, moved, depth = wall(3, 3, "rigid"), 0.0, 0.0, 0.0
    for part in np.array_split(wall_shaking(made, 1.5, 0.2), 10):
        columns = columns_of(made.advance(part)[0], made.model)
        closure = max(closure, np.abs(columns["energy/closure"]).max())
        moved, depth = max(moved, columns["energy/kinetic"].max()), max(depth, sunk_depth(made))
    assert moved > 1.0 and closure <= 1e-12 * moved and depth <= 1e-8


WALL = dict(kind="block", length_m=0.2, width_m=1.0, height_m=1.5, element_size_m=0.2, fixed=True)
TIE = dict(
    kind="tendon",
    body="block",
    point_m=[-0.2, 0, 1.1],
    to="wall",
    to_point_m=[-0.5, 0, 1.1],
    stiffness_n_m=1e5,
)


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
@pytest.mark.parametrize("links", [{}, {"tie": TIE}], ids=["scenery", "tied"])
def test_a_fixed_body_needs_no_joint(engine, links, tmp_path):
    tables = block()
    tables["bodies"]["wall"] = WALL | dict(at_m=[-0.6, 0, 0])
    case = structure(**tables, links=links, integration=dict(engine=engine, duration_s=0.02))
    found = run(case, tmp_path / "out", quiet=True)
    assert found["steps"] == 20 and found["energy_closure_rel"] < 1e-9


@pytest.mark.parametrize("fixed", [(1,), (1, 7)])
def test_a_fixed_voussoir_has_no_joint_with_its_ground(fixed, tmp_path):
    """Where both springers are fixed, the joint with the ground has no points at all."""
    arch = dict(kind="arch", mean_radius_m=3.0, thickness_m=0.6, width_m=1.0, voussoirs=7)
    case = structure(
        bodies={"arch": arch | dict(element_size_m=1.0)}
        | {f"arch {number}": dict(fixed=True) for number in fixed},
        joints=dict(ring=dict(between=["arch", "arch"]), feet=dict(between=["arch", "ground"])),
        contact=dict(friction_coefficient=0.7),
        integration=dict(engine="rigid", duration_s=0.1),
    )
    found = run(case, tmp_path / "out", quiet=True)
    assert found["steps"] == 100 and found["u_max_m"] < 1e-4
