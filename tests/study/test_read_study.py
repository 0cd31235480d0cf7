"""A study folder is read without its study file."""

import os

import pytest
from rocking_block import ENTRY
from study_files import write_study

from fecolumn.schema import InputError
from fecolumn.study.plan import read_plan
from fecolumn.study.run import run_study
from fecolumn.study.store import Store, read_study


def test_a_finished_study_is_read_back_from_its_folder_alone(tmp_path):
    study = write_study(tmp_path / "files", extra="")
    rows = run_study(read_plan(study), tmp_path / "out", entry=ENTRY, stream=open(os.devnull, "w"))
    study.unlink()
    found = read_study(tmp_path / "out")
    assert found.title == "study" and found.rows == rows
    assert found.axes == {"integration.dt_s": [0.02, 1e-3], "integration.alpha_hht": [0, -0.2],
                          "motion.source": [f"pulse:{k}" for k in range(4)]}


def test_a_study_at_work_is_read_without_disturbing_it(tmp_path):
    with Store(tmp_path / "out", read_plan(write_study(tmp_path)), ENTRY):
        assert {row["state"] for row in read_study(tmp_path / "out").rows} == {"planned"}


@pytest.mark.parametrize("content, message", [(None, "holds no study"), ("{", "is damaged"), ("[]", "is damaged")])
def test_what_is_no_study_is_refused(tmp_path, content, message):
    if content:
        (tmp_path / "study.json").write_text(content)
    with pytest.raises(InputError, match=message):
        read_study(tmp_path)
