"""Contact that is found between elastic bodies: they pivot on the right edges, and contact takes
energy.
"""

import json

import pytest

from fecolumn.cli import main

TABLE = """
[materials.wood]
youngs_modulus_pa = 12e9
poissons_ratio = 0.3
density_kg_m3 = 700
[bodies.leg]
kind = "block"
length_m = 0.06
width_m = 0.06
height_m = 0.7
material = "wood"
copies_m = [[-0.5, -0.3, 0], [0.5, -0.3, 0], [0.5, 0.3, 0], [-0.5, 0.3, 0]]
[bodies.top]
kind = "plate"
length_m = 1.2
width_m = 0.8
thickness_m = 0.04
material = "wood"
at_m = [0, 0, 0.7]
[joints.feet]
between = ["leg", "ground"]
[joints.heads]
between = ["leg", "top"]
[contact]
friction_coefficient = 0.6
between = "all"
[integration]
engine = "reduced"
dt_s = 0.001
duration_s = 0.5
[initial.leg]
tilt_rad = 0.02
"""
STONES = """
[materials.stone]
youngs_modulus_pa = 40e9
poissons_ratio = 0.2
density_kg_m3 = 2500
[bodies.p]
kind = "block"
length_m = 0.5
width_m = 0.4
height_m = 0.3
material = "stone"
copies_m = [[-0.26, 0, 0], [0.26, 0, 0], [0, 0, 0.3]]
[joints.beds]
between = ["p", "p"]
open = false
[joints.feet]
between = ["p", "ground"]
[contact]
friction_coefficient = 0.8
between = "all"
[motion]
source = "lick:12"
[integration]
duration_s = 5.0
"""


def _summary(text, tmp_path):
    case, out = tmp_path / "case.toml", tmp_path / "out"
    case.write_text(text)
    assert main(["run", str(case), "-o", str(out), "-q"]) == 0
    return json.loads((out / "summary.json").read_text())


@pytest.mark.long
def test_a_table_rocks_to_the_other_side_and_no_further(tmp_path):
    """Within half a second it has passed upright, and leans by no more than it was let go from."""
    found = _summary(TABLE, tmp_path)
    assert 0.019 < found["bodies"]["leg 1"]["tilt_max_rad"] < 0.0201
    assert found["energy_j"]["contact"] < 0.0


@pytest.mark.long
def test_a_stone_on_two_others_stands(tmp_path):
    """Their points move by fewer ways than they have."""
    assert _summary(STONES, tmp_path)["u_max_m"] < 1e-5
