"""Studies of structures: their bodies' keys are axes like any other."""

import pytest

from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import read_plan

STUDY = """
[case]
bodies.block = {kind = "block", length_m = 0.4, width_m = 0.2, height_m = 1.2, rigid = true}
joints.foot = {between = ["block", "ground"]}
integration.duration_s = 0.1
[axes]
%s
"""


def _plan(tmp_path, axes):
    (tmp_path / "study.toml").write_text(STUDY % axes)
    return read_plan(tmp_path / "study.toml")


def test_keys_of_bodies_interfaces_and_starts_are_axes(tmp_path):
    plan = _plan(
        tmp_path,
        '"bodies.block.height_m" = [1.2, 1.6]\n"joints.foot.friction_coefficient" '
        '= [0.3, 0.5]\n"initial.block.tilt_rad" = [0.0, 0.1]\n',
    )
    assert len({analysis.id for analysis in plan.analyses}) == 8
    last = plan.analyses[-1].case
    assert (
        last.bodies["block"].height_m,
        last.joints["foot"].friction_coefficient,
        last.initial["block"].tilt_rad,
    ) == (1.6, 0.5, 0.1)
    assert last.integration.engine == "reduced" and plan.analyses[-1].id == last.id


def test_ranges_of_a_bodys_key_are_sampled(tmp_path):
    plan = _plan(
        tmp_path,
        '"contact.friction_coefficient" = [0.3]\n[latin_hypercube]\nsamples = '
        '4\n"bodies.block.height_m" = [1.0, 2.0]\n',
    )
    assert (
        all(1.0 <= analysis.case.bodies["block"].height_m <= 2.0 for analysis in plan.analyses)
        and len(plan.analyses) == 4
    )


@pytest.mark.parametrize(
    "axis, said",
    [
        ('"bodies.block.heigth_m" = [1.0]', "unknown key"),
        ('"bodies.block.height_m" = [-1.0]', "greater than 0"),
        ('"initial.slab.tilt_rad" = [0.1]', "no such body"),
    ],
)
def test_wrong_axes_of_a_structure_are_refused(tmp_path, axis, said):
    with pytest.raises(InputError, match=said) as error:
        _plan(tmp_path, axis + "\n")
    assert axis.split('"')[1].startswith(error.value.key.partition(".")[2])
