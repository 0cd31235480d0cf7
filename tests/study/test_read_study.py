"""A study folder is read without its study file."""

import os
import platform

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.store import Store, read_study


def test_a_finished_study_is_read_back_from_its_folder_alone(tmp_path):
    study = write_study(tmp_path / "files", extra="")
    rows = complete_study(
        read_plan(study), tmp_path / "out", entry=ENTRY, stream=open(os.devnull, "w")
    )
    study.unlink()
    found = read_study(tmp_path / "out")
    assert found.title == "study" and found.rows == rows
    assert found.axes == {
        "integration.dt_s": [0.02, 1e-3],
        "integration.alpha_hht": [0, -0.2],
        "motion.source": [f"pulse:{k}" for k in range(4)],
    }


def test_a_study_at_work_is_read_without_disturbing_it(tmp_path):
    with Store(tmp_path / "out", read_plan(write_study(tmp_path)), ENTRY):
        assert {row["state"] for row in read_study(tmp_path / "out").rows} == {"planned"}


def test_a_damaged_ledger_is_told_put_aside_and_made_anew_from_the_results(tmp_path):
    plan = read_plan(write_study(tmp_path))
    before = complete_study(plan, tmp_path / "out", entry=ENTRY, stream=open(os.devnull, "w"))
    ledger = tmp_path / "out" / "study.sqlite"
    damaged = b"no database at all, but long enough" * 100
    ledger.write_bytes(damaged)
    with pytest.raises(InputError, match="cannot be read"):
        read_study(tmp_path / "out")
    with pytest.warns(
        UserWarning, match="study.sqlite was damaged and is made anew from the results"
    ):
        store = Store(tmp_path / "out", plan, ENTRY)
    with store:
        assert [row["summary"] for row in store.rows()] == [row["summary"] for row in before]
    assert (tmp_path / "out" / "study.sqlite.damaged").read_bytes() == damaged
    assert read_study(tmp_path / "out").rows[0]["summary"] == before[0]["summary"]


def test_a_ledger_just_being_made_has_no_rows_yet(tmp_path):
    complete_study(
        plan := read_plan(write_study(tmp_path)),
        tmp_path / "out",
        entry=ENTRY,
        stream=open(os.devnull, "w"),
    )
    (tmp_path / "out" / "study.sqlite").unlink()
    (tmp_path / "out" / "study.sqlite").touch()
    found = read_study(tmp_path / "out")
    assert found.rows == [] and found.analyses == len(plan.analyses)


def test_ledger_tells_where_each_analysis_was_done(tmp_path):
    for row in complete_study(
        read_plan(write_study(tmp_path, pulses=[1, "diverges"])),
        tmp_path / "out",
        entry=ENTRY,
        stream=open(os.devnull, "w"),
    ):
        assert (
            row["machine"].startswith(platform.node())
            and row["started"] > 1e9
            and row["wall_s"] > 0
        )
        assert row["motion"] == row["axes"]["motion.source"]  # no file: its name
        if row["state"] == "failed":
            assert "after 4 cuts" in (tmp_path / "out" / row["log"]).read_text()


@pytest.mark.parametrize(
    "content, message", [(None, "holds no study"), ("{", "is damaged"), ("[]", "is damaged")]
)
def test_what_is_no_study_is_refused(tmp_path, content, message):
    if content:
        (tmp_path / "study.json").write_text(content)
    with pytest.raises(InputError, match=message):
        read_study(tmp_path)


def test_one_worker_does_what_stands_first_in_the_file_and_several_the_longest_first(tmp_path):
    """A study that is stopped has then, of one worker, what its file puts first."""
    from fecolumn.study.plan import read_plan
    from fecolumn.study.store import Store

    plan = read_plan(write_study(tmp_path, dt=[0.02, 0.001], alpha=[0], pulses=range(2)))
    with Store(tmp_path / "out", plan, "none:run") as store:
        alone, together = store.missing(1), store.missing(2)
    assert [one.id for one in alone] == [one.id for one in plan.analyses]
    assert [one.case.integration.dt_s for one in together] == [0.001, 0.001, 0.02, 0.02]
    assert {one.id for one in alone} == {one.id for one in together}
