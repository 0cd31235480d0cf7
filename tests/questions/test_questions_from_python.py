"""Questions by the names of their commands, from a script."""

import contextlib
import io
import signal
import threading

import numpy as np
import pandas
import pytest

import fecolumn
from fecolumn.cli import main

CABINET = {
    "title": "Cabinet",
    "block": {"width_m": 0.3, "height_m": 2.0},
    "motion": {"source": "lick:1", "scale": 3.0},
    "integration": {"dt_s": 0.01},
}
WHAT = dict(vary=("block.width_m", 0.2, 0.6), motions="lick:1-6", limit="P(overturn) < 0.5")


@pytest.fixture(scope="module")
def designed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("designed")
    case = fecolumn.case_from_tables(CABINET)
    before = signal.getsignal(signal.SIGTERM)
    answer = fecolumn.design(case, folder / "d", **WHAT, steps=4)
    assert signal.getsignal(signal.SIGTERM) == before
    return case, answer


def test_a_design_is_that_of_the_command(designed):
    case, answer = designed
    case_file = answer.folder.with_name("d-case.toml")
    assert fecolumn.load_case(case_file) == case
    words = "--vary block.width_m 0.2:0.6 --motions lick:1-6 --steps 4 --limit".split()
    with contextlib.redirect_stdout(io.StringIO()) as said:
        folder = str(answer.folder)
        assert main(["design", str(case_file), *words, WHAT["limit"], "-o", folder]) == 0
    assert said.getvalue().splitlines()[0] == answer.text
    assert list(answer.table)[:3] == ["key", "value", "n"] and (answer.table.n == 6).all()
    assert repr(answer) == answer.text
    page = answer._repr_html_()
    assert "data:image/png;base64," in page and 'class="dataframe"' in page


def test_a_design_runs_in_a_thread_and_takes_what_is_there(designed):
    case, answer = designed
    found = []
    thread = threading.Thread(
        target=lambda: found.append(fecolumn.run_study(case, answer.folder.parent / "s", axes=AXES))
    )
    thread.start()
    thread.join()
    assert found and found[0].done == 4


AXES = {"motion.scale": np.array([1.0, 2.0]), "motion.source": ("lick:1", "lick:2")}


def test_a_study_of_a_case_is_a_table_of_its_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fecolumn.motion_file("own.csv", 4.0 * np.sin(np.arange(0, 6, 0.05)), 0.05)
    case = fecolumn.case_from_tables(CABINET)
    study = fecolumn.run_study(
        case, "deep/study", quiet=True, axes={"motion.source": ["own.csv"], "motion.scale": [1, 2]}
    )
    assert study.title == "Cabinet" and study.done == 2
    assert list(study.data["motion.scale"]) == [1, 2]
    assert study.data["u_max_m"].notna().any() or study.data["lost"].any()
    assert (tmp_path / "deep" / "study-study.toml").exists()


def test_a_list_of_objects_is_a_table_too(tmp_path):
    objects = pandas.DataFrame(
        {
            "name": ["slender", "stout"],
            "width_cm": [10, 80],
            "depth_cm": [10, 80],
            "height_cm": [150, 100],
            "mass_kg": [10, 100],
            "friction": [0.6, 0.6],
        }
    )
    answer = fecolumn.screen(
        objects, tmp_path / "m", motions="lick:1-5", limit="overturn", scale=3, engine="housner"
    )
    assert list(answer.table["name"]) == ["slender", "stout"]
    assert "Most endangered of 2 is 'slender'" in answer.text and "wrote" not in answer.text


def test_a_calibration_and_a_risk(tmp_path):
    time = np.arange(0, 1.5, 0.05)
    truth = fecolumn.case_from_tables(
        {
            "block": {"width_m": 0.25, "height_m": 1.0, "restitution": 0.92},
            "initial": {"tilt_rad": 0.12},
            "integration": {"dt_s": 0.005, "duration_s": 1.6},
        }
    )
    fecolumn.run(truth, tmp_path / "truth", quiet=True)
    result = fecolumn.load(tmp_path / "truth")
    tilt = np.interp(time, result.time, result["tilt"])
    pandas.DataFrame({"time_s": time, "tilt_rad": tilt}).to_csv(tmp_path / "t.csv", index=False)
    block = fecolumn.case_from_tables(
        {"block": {"width_m": 0.25, "height_m": 1.0}, "integration": {"dt_s": 0.005}}
    )
    answer = fecolumn.calibrate(
        block, tmp_path / "c", test=tmp_path / "t.csv", fit={"block.restitution": (0.85, 1)}
    )
    assert answer.table["value"][0] == pytest.approx(0.92, abs=1e-3)
    (tmp_path / "h.csv").write_text("pga_g,annual_frequency\n0.05,0.02\n0.4,0.00025\n3.2,1e-7\n")
    (tmp_path / "f.csv").write_text(
        "setting,n,records,overturned,median_pga_m_s2,median_low,median_high,beta,"
        "beta_low,beta_high\n"
        "all,120,40,37,7.8,6.9,8.9,0.41,0.28,0.60\n"
    )
    risk = fecolumn.risk(tmp_path / "f.csv", tmp_path / "r", hazard=tmp_path / "h.csv", years=100)
    assert "in 100 years" in risk.text and len(risk.table) == 1


WRONG = [
    (dict(vary="block.width_m"), "must be key, low and high"),
    (dict(vary=("block.width_m", 0.6, 0.2)), "must be a range LO:HI that rises"),
    (dict(vary=("block.width_m", "a", "b")), "range"),
    (dict(vary=("block.width", 0.2, 0.6)), "block.width"),
    (dict(limit="P(fall) < 0.1"), "fall"),
    (dict(motions="lick:1-2"), "at least 5 motions"),
    (dict(jobs=0), "must be at least 1"),
    (dict(jobs="two"), "invalid int value: 'two'"),
    (dict(steps=1), "must lie in [2, 1024]"),
]


@pytest.mark.parametrize("change, words", WRONG, ids=[words for _, words in WRONG])
def test_a_wrong_question_is_told_as_by_the_command(change, words, tmp_path):
    case = fecolumn.case_from_tables(CABINET)
    with pytest.raises(fecolumn.InputError) as caught:
        fecolumn.design(case, tmp_path / "d", **WHAT | change)
    assert words in str(caught.value) and str(caught.value).startswith("fecolumn design")


def test_a_study_of_a_case_needs_axes(tmp_path):
    case = fecolumn.case_from_tables(CABINET)
    for axes, words in ((None, "axes: missing"), ([1], "must be lists by key")):
        with pytest.raises(fecolumn.InputError, match=words):
            fecolumn.run_study(case, tmp_path / "s", axes=axes)
    with pytest.raises(fecolumn.InputError, match="motion.scal"):
        fecolumn.run_study(case, tmp_path / "s", axes={"motion.scal": [1.0]})
