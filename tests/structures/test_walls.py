"""Walls of stones in running bond whose head joints touch: equilibrium, and the energy of a wall
that is shaken.
"""

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.engines.history_columns import columns_of
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
