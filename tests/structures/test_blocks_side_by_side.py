"""Blocks beside each other on the ground, whose vertical faces touch: at the bottom edge they share
each slip is the sum of two others, which costs the solver of contact nothing.
"""

import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.simulation import run

BLOCK = dict(kind="block", length_m=0.4, width_m=0.3, height_m=0.8, element_size_m=0.15) | STONE


def shaken(folder, places, joints, direction, engine="reduced"):
    """Summary of two blocks at 0.1 g for 20 steps: they stand, slip by micrometres and press on one
    another.
    """
    times = np.arange(0, 0.101, 1e-3)
    np.savetxt(
        folder / "pulse.csv",
        np.column_stack([times, np.outer(0.981 * np.sin(10 * np.pi * times), direction)]),
        delimiter=",",
        header="time,x,y,z",
        comments="",
    )
    case = structure(
        bodies=dict(left=BLOCK | dict(at_m=places[0]), right=BLOCK | dict(at_m=places[1])),
        joints=joints,
        contact=dict(friction_coefficient=0.7, interior_points=0),
        motion=dict(source=str(folder / "pulse.csv"), units="m/s2", free_vibration_s=0),
        integration=dict(dt_s=1e-3, duration_s=0.02, engine=engine),
    )
    return run(case, folder / "run", quiet=True)


@pytest.mark.filterwarnings("ignore:.*cuts the motion short")
@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0)])
@pytest.mark.parametrize("engine", ["reduced", "rigid"])
def test_two_blocks_beside_each_other_take_as_few_iterations_as_any(tmp_path, engine, direction):
    """Up to 1,250 iterations of the contact solver were spent in these steps, where forces without
    bound came from a singular compliance.
    """
    joints = dict(
        left=dict(between=["left", "ground"]),
        right=dict(between=["right", "ground"]),
        side=dict(between=["left", "right"]),
    )
    beside = shaken(tmp_path, [(-0.2, 0, 0), (0.2, 0, 0)], joints, direction, engine)
    assert (
        beside["steps"] == 20
        and beside["cuts"] == 0
        and beside["iterations"] <= 60
        and beside["contact_iterations"] <= 4 * beside["iterations"]
    )
    assert beside["energy_closure_rel"] < 1e-10 and 0 < beside["penetration_max_m"] < 1e-10
    # of a vertical joint, too, the tilt is that from where it was closed
    assert max(values["tilt_max_rad"] for values in beside["interfaces"].values()) < 1e-5
