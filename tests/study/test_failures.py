"""What is said of analyses that failed: how many at each setting, why, and what helps."""

import csv

import pytest
from study_files import write_study

from fecolumn.engines.dynamics.cuts import Stop
from fecolumn.engines.left_part import OVER_EDGE
from fecolumn.study.conclusion import conclusion, records_of, settings_of
from fecolumn.study.failures import may_be_biased, what_to_do, why_failed
from fecolumn.study.plan import read_plan
from fecolumn.study.setting_pairs import pairs_of
from fecolumn.study.table import table_text, write_tables

LEFT = (
    f"AnalysisFailed: t = 0.99 s: {Stop.OFF_PATCH.value}: vase: vase on plinth; "
    "joints.vase.allowance_m (left out: 0.04 m) must be larger than the slide, 0 to 1000 m: more "
    "of the face is then prepared; state saved in out/checkpoint.npz"
)
STEP = (
    "AnalysisFailed: t = 2.1 s: no convergence within max_iterations (step cut 4 times to 1e-4 s)"
)
KILLED = "worker killed by SIGKILL (out of memory?)"


def failed(*reasons):
    return [{"state": "failed", "reason": reason} for reason in reasons]


@pytest.mark.parametrize(
    "reason, helps, retry",
    [
        (LEFT, "joints.vase.allowance_m a value larger than the slides", False),
        (
            LEFT.replace(Stop.OFF_PATCH.value, OVER_EDGE),
            "joints.vase.allowance_m a value larger than the slides",
            False,
        ),
        (STEP, "a shorter integration.dt_s", False),
        (
            "InputError: case.toml: motion.source = 'a': no such file",
            "what the reason names",
            False,
        ),
        (KILLED, "add --retry-failed to run what failed again", True),
        ("OSError: [Errno 28] No space left on device", "add --retry-failed", True),
        (None, "add --retry-failed", True),
    ],
)
def test_only_what_a_machine_stopped_is_advised_to_be_run_again(reason, helps, retry):
    told = what_to_do(failed(reason))
    assert helps in told
    assert ("add --retry-failed" in told) == retry
    assert ("--retry-failed does not help" in told) != retry


def test_keys_of_all_joints_that_were_left_are_named_once():
    other = LEFT.replace("joints.vase", "joints.cup")
    told = what_to_do(failed(LEFT, LEFT, other, KILLED))
    assert "joints.vase.allowance_m and joints.cup.allowance_m" in told
    assert told.count("allowance_m") == 2 and "add --retry-failed" in told


def test_commonest_reason_is_told_without_its_instant():
    rows = failed(LEFT, LEFT.replace("0.99", "1.25"), KILLED)
    reason = f"{Stop.OFF_PATCH.value}: vase: vase on plinth"
    told = f"Reason of the failures (2 of them): {reason}. What to do: "
    assert why_failed(rows).startswith(told) and "t = " not in why_failed(rows)
    assert why_failed([]) == "" and may_be_biased([]) == ""


def test_of_many_settings_the_worst_is_told():
    told = may_be_biased([(f"at x = {number}", number + 1, 16) for number in range(9)])
    assert "analyses of 9 settings, most 9 of 16 analyses at x = 8" in told


@pytest.fixture
def biased(tmp_path):
    """A study of two steps and twelve motions, of which seven and four failed by their slides."""
    plan = read_plan(write_study(tmp_path, alpha=(0,), pulses=range(12)))
    rows = []
    for number, analysis in enumerate(plan.analyses):
        motion = int(analysis.values["motion.source"].partition(":")[2])
        fails = motion < 7 if analysis.values["integration.dt_s"] == 0.02 else motion >= 10
        row = dict(id=analysis.id, axes=analysis.values, state="done", reason=None)
        row["summary"] = dict(
            u_max_m=0.01 * (1 + number % 12),
            overturned=False,
            slid_off=False,
            energy_closure_rel=1e-9,
            s_per_step=1e-3,
            wall_s=1.0,
            residual_slide_m=0.0,
            steps=10,
        )
        rows.append(row | dict(state="failed", summary=None, reason=LEFT) if fails else row)
    return plan, rows


def test_conclusion_says_how_many_failed_at_each_setting(biased):
    plan, rows = biased
    said = conclusion(plan, rows[:])
    assert "P(overturn) is the same at every setting" not in said
    assert "P(overturn) of the analyses that are done is the same at every setting" in said
    assert "7 of 12 analyses at dt_s = 0.02" in said and "2 of 12 analyses at dt_s = 0.001" in said
    assert "may be biased" in said and "joints.vase.allowance_m" in said
    assert "failed); in brackets the 95 % interval of all, whatever the failed ones" in said


def test_bound_of_a_distance_is_told_with_the_motions_of_its_pair(biased):
    plan, rows = biased
    done = next(row["summary"] for row in rows if row["state"] == "done")
    for row in rows:  # 6 motions in common, although one setting has twelve
        of_coarse_step = row["axes"]["motion.source"].endswith(":6")
        if row["axes"]["integration.dt_s"] == 0.001 or of_coarse_step:
            row |= dict(state="done", summary=row["summary"] or done)
    (pair,) = pairs_of(settings_of(plan, rows), records_of(plan))
    assert pair.n == 6
    said = conclusion(plan, rows)
    assert f"with 6 motions a distance up to {pair.bound:.2f} cannot be excluded" in said
    assert "with 12 motions" not in said


def test_failed_are_counted_in_the_table_of_each_setting(tmp_path, biased):
    plan, rows = biased
    header, first, second = table_text(plan, rows).splitlines()
    assert header.split()[:3] == ["dt_s", "n", "failed"]
    assert first.split()[:3] == ["0.02", "5/12", "7"]
    assert second.split()[:3] == ["0.001", "10/12", "2"]
    write_tables(plan, rows, tmp_path)
    with open(tmp_path / "table.csv") as file:
        assert [row["failed"] for row in csv.DictReader(file)] == ["7", "2"]


def test_nothing_is_said_where_none_failed(biased):
    plan, rows = biased
    done = [row for row in rows if row["state"] == "done"]
    assert "ailed" not in conclusion(plan, done)
    assert "failed" not in table_text(
        plan, [row | dict(state="done", summary=done[0]["summary"]) for row in rows]
    )
