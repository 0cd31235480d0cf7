"""Contact points that are left out: many in the foot of one body, few in each joint of several."""

import numpy as np
import pytest

import fecolumn
from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.first_impacts import landings


def block(side, height, at, **keys):
    return fecolumn.Block(
        length_m=side,
        width_m=side,
        height_m=height,
        at_m=(0, 0, at),
        density_kg_m3=2400,
        youngs_modulus_pa=30e9,
        poissons_ratio=0.2,
        **keys,
    )


BODIES = {
    "plinth": block(0.7, 0.15, 0.0),
    "pedestal": block(0.36, 1.0, 0.15),
    "figure": block(0.18, 0.9, 1.15),
}
JOINTS = {
    "floor": fecolumn.Joint(between=("plinth", "ground"), friction_coefficient=0.6),
    "bed": fecolumn.Joint(between=("pedestal", "plinth"), friction_coefficient=0.6),
    "foot": fecolumn.Joint(between=("figure", "pedestal"), friction_coefficient=0.6),
}


def exhibit(points=None, **keys):
    """Plinth, pedestal and a figure."""
    return fecolumn.Case(
        bodies=BODIES, joints=JOINTS, contact=fecolumn.Contact(interior_points=points), **keys
    )


def test_what_is_left_out_is_9_in_joints_of_several_bodies_and_64_of_one():
    alone = fecolumn.Case(bodies={"plinth": BODIES["plinth"]}, joints={"floor": JOINTS["floor"]})
    assert (exhibit().interior_points, alone.interior_points) == (9, 64)
    assert exhibit(25).interior_points == 25
    assert "interior_points" not in exhibit().to_toml()


def test_a_case_of_several_bodies_is_not_taken_for_that_of_64_points():
    assert len({exhibit(points).id for points in (None, 9, 64)}) == 3


@pytest.mark.verification
def test_an_exhibit_swings_as_with_four_times_the_points_until_its_third_impact(tmp_path):
    """Largest tilt of the figure between the first three landings, within 1 %."""
    time = 0.005 * np.arange(121)
    ground = np.where(time < 0.4, 2.6 * np.sin(2 * np.pi * 2.5 * time), 0.0)
    source = str(fecolumn.motion_file(tmp_path / "pulse.csv", ground, 0.005))
    plan = fecolumn.Integration(dt_s=1e-3, duration_s=1.3)
    found = []
    for points in (None, 36):
        folder = tmp_path / str(points)
        case = exhibit(points, motion=fecolumn.Motion(source), integration=plan)
        fecolumn.run(case, folder, quiet=True)
        rows = read_history(folder / "history.h5")
        begins = landings(rows, 100.0)[0]
        tilt, edges = rows["body/figure/tilt"], [0.0, *begins[:3]]
        found.append(
            [
                tilt[(rows["time"] >= a) & (rows["time"] <= b)].max()
                for a, b in zip(edges[:-1], edges[1:], strict=True)
            ]
        )
    few, many = np.array(found)
    assert len(many) == 3 and many.max() > 0.05
    assert np.abs(few - many).max() < 0.01 * many.max()
