"""`fecolumn run --profile`: each step is of one kind, its time and counts are the analysis's."""

import csv
import json

import pytest

from fecolumn.cli import main
from fecolumn.engines import step_times
from fecolumn.engines.dynamics.record import Record
from fecolumn.engines.step_times import (
    COUNTS,
    STEP_TIMES_FILE,
    StepTimes,
    kinds_of,
    read_step_times,
    step_table,
)
from fecolumn.engines.summary import SUMMARY_FILE as SUMMARY

BLOCK = """
[bodies.block]
kind = "block"
length_m = 0.3
width_m = 0.3
height_m = 1.0
density_kg_m3 = 2500
youngs_modulus_pa = 30e9
[joints.foot]
between = ["block", "ground"]
[initial.block]
tilt_rad = 0.05
[integration]
engine = "{engine}"
duration_s = 0.8
"""


def _summary(folder) -> dict:
    return json.loads((folder / SUMMARY).read_text())


def test_each_step_is_of_one_kind_and_the_first_that_holds(tmp_path):
    record, times = Record(), StepTimes(Record())
    steps = [
        (2e-6, 4, {}),
        (4e-6, 1, dict(contact_iterations=2)),
        (8e-6, 9, dict(contact_iterations=3, impacts=1, impact_iterations=7)),
        (1e-6, 0, {}),
        (7e-6, 100, dict(contact_iterations=1)),
        (0.0, 5, dict(impacts=1, parts=2)),
    ]
    for number, (wall_s, points, more) in enumerate(steps):
        for name, value in more.items():
            setattr(record, name, getattr(record, name) + value)
        times.note(1e-3 * number, wall_s, points, record)
    times.write(tmp_path)
    rows = read_step_times(tmp_path / STEP_TIMES_FILE)
    assert rows[:, 1] == pytest.approx([2, 4, 8, 1, 7, 0])
    found = {name: len(some) for name, some in kinds_of(rows)}
    assert found == {
        step_times.IN_PARTS: 1,
        step_times.WITH_IMPACT: 1,
        step_times.FLYING: 1,
        step_times.STANDS_STILL: 1,
        "1 to 2 carry": 1,
        "more than 95 points carry": 1,
    }
    assert "| all | 6 | 100% |" in step_table(rows)
    assert "| with an impact | 1 | 36% | 8 | 8 | 8 | 3 | 7 |" in step_table(rows)


def test_what_a_call_takes_is_no_part_of_its_step(tmp_path):
    times = StepTimes(Record(), call_s=3e-6)
    for spent in (8e-6, 2e-6):
        times.note(0.0, spent, 1, Record())
    times.write(tmp_path)
    assert read_step_times(tmp_path / STEP_TIMES_FILE)[:, 1] == pytest.approx([5.0, 0.0])


@pytest.mark.long
@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_profile_of_a_run_has_each_step_and_all_its_counts(engine, tmp_path, capsys):
    case, out = tmp_path / "case.toml", tmp_path / "out"
    text = BLOCK.format(engine=engine)
    case.write_text(text if engine == "rigid" else text.replace("0.8", "0.02"))
    assert main(["run", str(case), "-o", str(out), "-q", "--profile"]) == 0
    printed, summary = capsys.readouterr().out, _summary(out)
    with open(out / STEP_TIMES_FILE, encoding="utf-8") as file:
        header = next(csv.reader(file))
    assert header == ["time [s]", "step [us]", "carrying_points", *COUNTS]
    rows = read_step_times(out / STEP_TIMES_FILE)
    assert len(rows) == summary["steps"] and (rows[:, 1] >= 0).all()
    assert rows[-1, 0] == pytest.approx(summary["duration_s"])
    assert 0 < 1e-6 * rows[:, 1].sum() <= summary["cpu_s"]
    for number, name in enumerate(COUNTS):
        assert rows[:, 3 + number].sum() == summary[name], name
    assert "share of the time" in printed and (out / "step_times.png").stat().st_size > 10_000
    if engine == "rigid":
        assert {step_times.WITH_IMPACT, "9 to 40 carry"} <= {name for name, _ in kinds_of(rows)}


@pytest.mark.long
def test_the_same_motion_with_and_without_profile(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(BLOCK.format(engine="rigid"))
    for name, more in (("with", ["--profile"]), ("without", [])):
        assert main(["run", str(case), "-o", str(tmp_path / name), "-q", *more]) == 0
    timed, plain = (_summary(tmp_path / name) for name in ("with", "without"))
    assert timed["u_max_m"] == plain["u_max_m"] and timed["energy_j"] == plain["energy_j"]
    assert not (tmp_path / "without" / STEP_TIMES_FILE).exists()


@pytest.mark.long
def test_a_folder_analysed_without_profile_says_so(tmp_path, capsys):
    case = tmp_path / "case.toml"
    case.write_text(BLOCK.format(engine="rigid"))
    assert main(["run", str(case), "-o", str(tmp_path / "out"), "-q"]) == 0
    assert main(["run", str(case), "-o", str(tmp_path / "out"), "-q", "--profile"]) == 0
    assert "a new folder is timed" in capsys.readouterr().err


def test_a_rocking_model_has_no_steps_to_profile(tmp_path, capsys):
    case = tmp_path / "case.toml"
    case.write_text(BLOCK.format(engine="housner"))
    assert main(["run", str(case), "-o", str(tmp_path / "out"), "-q", "--profile"]) == 2
    assert "the reduced, the rigid and the full engine can be profiled" in capsys.readouterr().err
