"""A study that is gone on with by other code keeps its results, says so in one line, and its audit
lists both.
"""

import io
import json
import shutil

import pytest

from fecolumn.foundation import sources
from fecolumn.study.plan import read_plan
from fecolumn.study.report.audit import audit
from fecolumn.study.report.document import Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.sweep import read_sweep
from fecolumn.study.run import complete_study

STUDY = """
title = "Three tilts"
[case.column]
shape = "block"
length_m = 0.4
width_m = 0.4
height_m = 1.2
[case.mesh]
fine_size_m = 0.1
coarse_size_m = 0.2
base_size_m = 0.2
[case.integration]
engine = "rigid"
duration_s = 0.01
[axes]
"initial.tilt_rad" = [0.01, 0.02, 0.03]
"""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mixture")
    (folder / "study.toml").write_text(STUDY)
    plan, stream = read_plan(folder / "study.toml"), io.StringIO()
    complete_study(plan, folder / "out", workers=1, stream=stream)
    return plan, folder / "out", stream.getvalue()


def _again(plan, folder):
    stream = io.StringIO()
    return complete_study(plan, folder, workers=1, stream=stream), stream.getvalue()


def test_study_of_one_code_says_nothing_of_it_and_its_audit_names_it(finished, tmp_path):
    plan, folder, said = finished
    assert "code" not in said and "code" not in _again(plan, folder)[1]
    present = sources.code_text(**sources.code())
    assert f"All that is done was done by {present}." in _audited(folder, tmp_path)


@pytest.mark.long
def test_results_of_other_code_are_kept_told_and_listed(finished, tmp_path):
    plan, folder = finished[0], tmp_path / "out"
    shutil.copytree(finished[1], folder)
    other, lost, _ = (folder / "analyses" / analysis.id for analysis in plan.analyses)
    summary = json.loads((other / "summary.json").read_text())
    for entry in ("sources", "digest"):  # as the versions before wrote it
        del summary[entry]
    (other / "summary.json").write_text(
        json.dumps(summary | {"version": "0.1.0", "u_max_m": 0.123})
    )
    shutil.rmtree(lost)
    rows, said = _again(plan, folder)
    present = sources.code_text(**sources.code())
    assert said.splitlines()[0] == (
        "1 of 3 analyses were done by other code and are kept: 1 of fecolumn 0.1.0 "
        "(sources not recorded); "
        f"this is {present}; a new folder takes all anew"
    )
    assert [row["summary"].get("sources") for row in rows] == [
        None,
        *[sources.package_digest()] * 2,
    ]
    assert rows[0]["summary"]["u_max_m"] == 0.123
    assert f"2 of {present}, 1 of fecolumn 0.1.0 (sources not recorded)" in _audited(
        folder, tmp_path
    )


def _audited(folder, place) -> str:
    return " ".join(
        block.text
        for block in audit(read_sweep(folder), Gallery(place, paper=False)).blocks
        if isinstance(block, Paragraph)
    )
