"""A step that is long for the motion is said to be so, and by how much."""

import numpy as np
import pytest
from small_structures import block, structure

from fecolumn.cli import main
from fecolumn.engines.joined_landings import joined_landings
from fecolumn.engines.step_doubt import step_doubt
from fecolumn.simulation import run


def _rows(between, dt, end=2.0):
    """A block that lands every so often [s], each time taking 1 J."""
    time = np.arange(round(end / dt) + 1) * dt
    took = -np.floor(time / between + 1e-9)
    return {"time": time, "tilt": np.full_like(time, 0.1), "energy/impact": took}


def test_landings_a_few_steps_apart_are_told_with_their_error_and_a_step():
    said = step_doubt(_rows(0.08, 0.02), 0.02, 1.0, 100.0, 0.3, True, False)
    # four steps between landings: (pi / 4)^2 / 12 = 5.1 %
    assert "less than 4 steps after" in said and "off by some 5.1 %" in said
    step = float(said.split("at most ")[1].split(" s")[0])
    assert (np.pi * step / 0.08) ** 2 / 12 < 0.01
    assert step_doubt(_rows(0.08, step), step, 1.0, 100.0, 0.3, True, False) is None


def test_landings_a_few_short_steps_apart_are_told_as_those_of_long_ones_are():
    """At the usual step, too, at which they are nearer than 20 ms."""
    for every in (4, 8):
        rows = _rows(every * 1e-3, 1e-3)
        said = step_doubt(rows, 1e-3, 1.0, 100.0, 0.3, True, False)
        assert f"less than {every} steps after" in said
    assert step_doubt(_rows(0.01, 1e-3), 1e-3, 1.0, 100.0, 0.3, True, False) is None
    # an impact that takes three steps in a row is one landing
    rows = _rows(0.1, 1e-3)
    rows["energy/impact"] = -sum(
        np.floor((rows["time"] - late) / 0.1 + 1e-9) for late in (0.0, 1e-3, 2e-3)
    )
    assert step_doubt(rows, 1e-3, 1.0, 100.0, 0.3, True, False) is None


def test_impacts_that_take_more_than_rigid_bodies_lose_are_told():
    rows = _rows(0.4, 1e-3)
    assert "impacts took 1.4 of what rigid bodies lose" in step_doubt(
        rows, 1e-3, 1.4, 100.0, 0.3, True, False
    )
    assert "in short steps they take just that" in step_doubt(
        rows, 1e-3, 1.4, 100.0, 0.3, True, True
    )
    assert step_doubt(rows, 1e-3, 1.1, 100.0, 0.3, True, False) is None


def test_nothing_is_said_of_what_hardly_rocks_or_of_bodies_that_land_by_turns():
    rows = _rows(0.08, 0.02)
    assert step_doubt(rows, 0.02, 1.0, 100.0, 10.0, True, False) is None
    assert step_doubt(rows, 0.02, 1.0, 100.0, 0.3, False, False) is None
    assert (
        step_doubt({**rows, "energy/impact": 0 * rows["time"]}, 0.02, None, 100.0, 0.3, True, False)
        is None
    )


def _columns(apart, dt):
    """Two columns that rock at 1 Hz, one of them `apart` [s] later; each passage takes 1 J."""
    time = np.arange(round(3.1 / dt) + 1) * dt
    turns = [
        np.outer(0.1 * np.sin(2 * np.pi * (time - 0.1003 - late)), [0.0, 1.0, 0.0])
        for late in (0.0, apart)
    ]
    beam = np.outer(1e-6 * np.cos(300 * time), [0.0, 1.0, 0.0])
    took = -np.floor(2 * (time - 0.1003)) - np.floor(2 * (time - 0.1003 - apart))
    names = ("body/left/rotation", "body/right/rotation", "body/beam/rotation")
    return {"time": time, "energy/impact": took, **dict(zip(names, (*turns, beam)))}


def test_columns_that_land_one_after_another_within_a_step_are_told_with_a_step():
    said = joined_landings(_columns(2e-4, 1e-3), 1e-3)
    assert "0.0002 s apart" in said and "100 % of what impacts took" in said
    assert float(said.split("dt_s = ")[1].split(" s")[0]) == pytest.approx(4e-5)
    assert joined_landings(_columns(2e-4, 4e-5), 4e-5) is None


def test_columns_that_land_together_or_apart_and_one_body_are_as_the_step_has_them():
    assert joined_landings(_columns(0.0, 1e-3), 1e-3) is None
    assert joined_landings(_columns(0.1, 1e-3), 1e-3) is None
    one = {name: rows for name, rows in _columns(2e-4, 1e-3).items() if "right" not in name}
    assert joined_landings(one, 1e-3) is None


@pytest.mark.long
@pytest.mark.parametrize("dt, told", [(0.05, True), (1e-3, False)])
def test_summary_says_of_a_released_block_whether_its_step_is_long(tmp_path, dt, told):
    """Half periods of rocking from 0.05 rad of 0.32 are 0.3 s and less."""
    case = structure(
        **block(rigid=True),
        initial={"block": {"tilt_rad": 0.01}},
        integration={"engine": "rigid", "duration_s": 2.0, "dt_s": dt},
    )
    summary = run(case, tmp_path / "run", quiet=True)
    assert (summary["step_doubt"] is not None) == told
    (tmp_path / "case.toml").write_text(case.to_toml())
    assert main(["run", str(tmp_path / "case.toml"), "-o", str(tmp_path / "run"), "-q"]) == 0
