"""Which settings of a study are compared, and how they are named."""

import numpy as np
import pytest
from study_files import write_study

from fecolumn.foundation.schema import InputError
from fecolumn.study.conclusion import conclusion
from fecolumn.study.plan import read_plan
from fecolumn.study.sequential import Rule, stages
from fecolumn.study.setting_pairs import (
    MOST_PAIRS,
    axes_together,
    pair_count,
    pairs_of,
    setting_name,
)

HEIGHT, WIDTH, DT = "column.height_m", "column.outer_diameter_m", "integration.dt_s"


def tables(settings, motions=8):
    """Settings with runs, whose peaks are larger in later settings."""
    rng = np.random.default_rng(0)
    return [
        (
            values,
            {
                (str(motion),): dict(u_max_m=0.01 * (1 + place) + 1e-3 * rng.random(), lost=False)
                | dict(overturned=False, slid_off=False)
                for motion in range(motions)
            },
        )
        for place, values in enumerate(settings)
    ]


def records(motions=8):
    return {(str(motion),): str(motion) for motion in range(motions)}


def grid(*levels):
    """All combinations of so many levels of axes a.x, b.x, ..."""
    keys = [f"{letter}.x" for letter in "abcdefg"[: len(levels)]]
    return [dict(zip(keys, (int(one) for one in place))) for place in np.ndindex(*levels)]


def test_axes_of_one_zip_are_compared_as_one():
    zipped = [{HEIGHT: h, WIDTH: d, DT: dt} for h, d in ((1, 0.1), (2, 0.2)) for dt in (1e-3, 1e-4)]
    assert axes_together(zipped) == [(HEIGHT, WIDTH), (DT,)]
    found = pairs_of(tables(zipped), records())
    assert [pair.axis for pair in found] == [f"{HEIGHT} with {WIDTH}"] * 2 + [DT] * 2
    assert found[0].names == (
        "height_m = 1, outer_diameter_m = 0.1, dt_s = 0.001",
        "height_m = 2, outer_diameter_m = 0.2, dt_s = 0.001",
    )


def test_axes_of_a_product_are_not_taken_together():
    assert axes_together(grid(2, 2)) == [("a.x",), ("b.x",)]
    assert axes_together([{"a.x": 1, "b.x": 2}]) == [("a.x",), ("b.x",)]
    assert axes_together(grid(3, 1)) == [("a.x",), ("b.x",)]
    assert axes_together([]) == []


def test_pairs_of_many_settings_are_of_all_axes_in_turn():
    settings = tables(grid(6, 6, 6), 6)
    assert pair_count(settings) == 3 * 36 * 15
    found = pairs_of(settings, records(6))
    assert len(found) == MOST_PAIRS
    assert {axis: sum(pair.axis == axis for pair in found) for axis in ("a.x", "b.x", "c.x")} == {
        "a.x": 20,
        "b.x": 20,
        "c.x": 20,
    }


def test_five_motions_can_tell_nothing_apart_and_are_not_compared():
    settings = tables(grid(2), 5)
    assert pairs_of(settings, records(5)) == []
    (pair,) = pairs_of(tables(grid(2), 6), records(6))
    assert pair.p < 0.05 and pair.distance == 1


def test_names_tell_keys_of_several_bodies_apart():
    values = {"bodies.a.height_m": 1.0, "bodies.b.height_m": 2.0, DT: 1e-3}
    assert setting_name(values) == "a.height_m = 1.0, b.height_m = 2.0, dt_s = 0.001"
    assert setting_name(values, (DT,)) == "dt_s = 0.001"
    assert setting_name({"scale": 2, "motion.scale": 3}) == "scale = 2, motion.scale = 3"


def zipped_study(tmp_path, motions):
    """Two heights, each with a diameter of its own."""
    extra = f'[[zip]]\n"{HEIGHT}" = [1.0, 1.2]\n"{WIDTH}" = [0.1, 0.12]\n'
    return read_plan(
        write_study(tmp_path, dt=(1e-3,), alpha=(0,), pulses=range(motions), extra=extra)
    )


def test_a_study_of_one_zip_is_concluded_and_can_be_decided(tmp_path):
    plan = zipped_study(tmp_path, 40)
    assert stages(plan, Rule()) == [40]
    done = [
        dict(
            id=one.id,
            state="done",
            axes=one.values,
            summary=dict(
                u_max_m=0.01 * (1 + number % 40) * one.values[HEIGHT] ** 20,
                overturned=False,
                slid_off=False,
            ),
        )
        for number, one in enumerate(plan.analyses)
    ]
    assert "apart for height_m = 1.0, outer_diameter_m = 0.1 and" in conclusion(plan, done)


def test_a_study_whose_settings_differ_in_several_axes_is_not_decided(tmp_path):
    extra = (
        f'[[zip]]\n"{HEIGHT}" = [1.0, 1.1, 1.2, 1.3]\n"{WIDTH}" = [0.1, 0.1, 0.12, 0.12]\n'
        '"contact.friction_coefficient" = [0.3, 0.4, 0.4, 0.3]\n'
    )
    file = write_study(tmp_path, dt=(1e-3,), alpha=(0,), pulses=range(40), extra=extra)
    with pytest.raises(
        InputError, match=r"no two settings that differ in one axis, or one \[\[zip"
    ):
        stages(read_plan(file), Rule())


def test_samples_of_several_axes_are_no_pairs():
    """All samples of a Latin hypercube differ in all of its axes, as do the rows of a [[zip]]."""
    rows = [{HEIGHT: 1.0 + 0.01 * k, WIDTH: 0.1 + 0.003 * k} for k in range(20)]
    assert pair_count(tables(rows)) == 190
    sampled = dict(sampled=(HEIGHT, WIDTH))
    assert pair_count(tables(rows), **sampled) == 0
    assert not pairs_of(tables(rows), records(), **sampled)


@pytest.mark.parametrize("levels", [3, 9])
def test_the_plan_says_which_axes_are_sampled(tmp_path, levels):
    """However many they are, rows of a [[zip]] are compared, and samples are not."""
    zipped = (
        f'[[zip]]\n"{HEIGHT}" = {[1 + 0.1 * k for k in range(levels)]}\n'
        f'"{WIDTH}" = {[0.06 + 0.01 * k for k in range(levels)]}\n'
    )
    sampled = (
        f'[latin_hypercube]\nsamples = {levels}\nseed = 1\n"{HEIGHT}" = [1.0, 2.0]\n'
        f'"{WIDTH}" = [0.06, 0.14]\n'
    )
    for name, extra in (("zip", zipped), ("samples", sampled)):
        (tmp_path / name).mkdir()
        plan = read_plan(
            write_study(tmp_path / name, dt=(1e-3,), alpha=(0,), pulses=range(40), extra=extra)
        )
        settings = [
            (dict(one), {})
            for one in {repr(a.combination): a.combination for a in plan.analyses}.values()
        ]
        count = pair_count(settings, plan.sampled)
        assert (plan.sampled, count) == (
            ((), levels * (levels - 1) // 2) if name == "zip" else ((HEIGHT, WIDTH), 0)
        )


@pytest.mark.parametrize("steps, told", [(12, "has 66 pairs of settings"), (11, "")])
def test_more_pairs_than_are_compared_are_not_decided_on(tmp_path, steps, told):
    dt = [round(1e-3 * (1 + 0.1 * k), 5) for k in range(steps)]
    plan = read_plan(write_study(tmp_path, dt=dt, alpha=(0,), pulses=range(40)))
    if told:
        with pytest.raises(InputError, match=told):
            stages(plan, Rule())
    else:
        assert stages(plan, Rule()) == [40]
