"""The Lick ensemble by name."""

import numpy as np
import pytest

from fecolumn.case.sections import Motion
from fecolumn.foundation.schema import InputError
from fecolumn.motions.chosen import chosen_motions
from fecolumn.motions.lick import COUNT
from fecolumn.motions.load import read_motion
from fecolumn.motions.processing import scale_time
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.seeded import LICK, read_model, seeded_acceleration


def test_motion_by_name_is_that_of_the_recipe_at_test_scale():
    model = read_model(LICK)
    recipe = seeded_acceleration(model, "fixed", 810, 11)
    ground = read_motion(Motion("lick:12"), "case.toml")
    full = GroundMotion(recipe, 2 * ground.dt, "", "")
    assert ground.acceleration == pytest.approx(scale_time(full, 0.5).acceleration, abs=1e-12)
    assert np.abs(ground.acceleration[:, :2]).max() > 1


@pytest.mark.parametrize("number", ("0", "116", "first", ""))
def test_number_the_ensemble_does_not_have_is_refused(number):
    with pytest.raises(InputError, match="whole number from 1 to 115") as told:
        read_motion(Motion(f"lick:{number}"), "case.toml")
    assert told.value.value == f"lick:{number}"


def test_all_motions_of_it_are_an_axis(tmp_path):
    assert chosen_motions("lick:*", "axes", tmp_path / "study.toml") == [
        f"lick:{number}" for number in range(1, COUNT + 1)
    ]
