"""A study with both engines in worker processes: its table, its figure, and what it does a second
time.
"""

import csv
import json

import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.engines.dynamics.history import read_history

STUDY = """
title = "Two motions, two engines"
[case]
extends = "{specimen}"
[case.column]
wall_m = 0.02
height_m = 0.5
fine_height_m = 0.02
[case.base]
slide_allowance_m = 0.01
[case.mesh]
fine_size_m = 0.02
coarse_size_m = 0.03
cap_size_m = 0.05
base_size_m = 0.05
[case.integration]
duration_s = 0.15
[case.motion]
source = "strong.csv"
[axes]
"integration.engine" = ["full", "reduced"]
"motion.source" = ["strong.csv", "weak.csv"]
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    from study_files import SPECIMEN

    folder = tmp_path_factory.mktemp("study")
    for name, scale in (("strong", 0.5), ("weak", 0.2)):
        rows = "".join(
            f"{0.005 * k:.4f},{scale if k % 20 < 10 else -scale:.3f}\n" for k in range(100)
        )
        (folder / f"{name}.csv").write_text("time [s],ax [g]\n" + rows)
    file = folder / "study.toml"
    file.write_text(STUDY.format(specimen=SPECIMEN))
    assert main(["study", str(file), "-o", str(folder / "out"), "-j", "2"]) == 0
    return file, folder / "out"


def test_each_analysis_has_its_result_and_the_strong_motion_moves_the_top_more(study):
    _, out = study
    with open(out / "analyses.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4
    assert (out / "cdf.png").is_file()
    summaries = [json.loads(path.read_text()) for path in out.glob("analyses/*/summary.json")]
    assert len(summaries) == 4 and all(one["energy_closure_rel"] < 1e-4 for one in summaries)
    by_motion = {
        name: [one["u_max_m"] for one in summaries if one["motion"].startswith(name)]
        for name in ("strong", "weak")
    }
    assert min(by_motion["strong"]) > max(by_motion["weak"]) > 0
    assert sorted(one["engine"] for one in summaries) == ["full", "full", "reduced", "reduced"]


def test_histories_of_a_study_have_a_row_in_five_milliseconds_but_the_peak_of_every_step(study):
    _, out = study
    for path in out.glob("analyses/*/summary.json"):
        history, summary = read_history(path.with_name("history.h5")), json.loads(path.read_text())
        assert len(history["time"]) == 31 and history["time"][-1] == pytest.approx(0.15)
        assert np.hypot(*history["u_top"][:, :2].T).max() <= summary["u_max_m"]


def test_a_second_time_nothing_is_left_to_do(study):
    file, out = study
    before = {path: path.stat().st_mtime_ns for path in out.glob("analyses/*/summary.json")}
    assert main(["study", str(file), "-o", str(out), "-j", "2"]) == 0
    assert {path: path.stat().st_mtime_ns for path in out.glob("analyses/*/summary.json")} == before
