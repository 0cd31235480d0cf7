"""Questions by the names of their commands, from a script."""

import contextlib
import io
import shutil
import signal
import threading
from pathlib import Path

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


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
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
        objects,
        tmp_path / "m",
        motions="lick:1-5",
        event="overturn",
        scale=[3, 1],
        engine="housner",
    )
    assert list(answer.table["name"]) == ["slender", "stout"]
    assert "Most endangered of 2 is 'slender'" in answer.text and "wrote" not in answer.text


@pytest.mark.parametrize("scale", ["1:2", (1, 2, 3), (1, "2"), [1]])
def test_a_screen_needs_one_scale_or_two(tmp_path, scale):
    with pytest.raises(fecolumn.InputError, match=r"scale = .*must be a number, or two"):
        fecolumn.screen("objects.csv", tmp_path / "m", motions="lick:1-5", scale=scale)


def test_a_list_that_cannot_be_written_leaves_the_older_one(tmp_path):
    class Broken:
        def to_csv(self, path=None, index=True):
            if path is not None:
                Path(path).write_text("name,wid")
            raise OSError("no room")

    (tmp_path / "m-list.csv").write_text("older")
    with pytest.raises(OSError, match="no room"):
        fecolumn.screen(Broken(), tmp_path / "m", motions="lick:1-5")
    assert (tmp_path / "m-list.csv").read_text() == "older"


@pytest.mark.long
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
    (dict(vary=("block.width_m", -0.2, -0.6)), "did you mean -0.6:-0.2"),
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


def test_a_range_is_given_as_that_of_a_fit(designed, tmp_path):
    case, answer = designed
    shutil.copytree(answer.folder, tmp_path / "d")
    again = fecolumn.design(
        case, tmp_path / "d", **WHAT | {"vary": {"block.width_m": (0.2, 0.6)}}, steps=4
    )
    assert again.text == answer.text and again.failed == answer.failed == 0
    with pytest.raises(fecolumn.InputError, match="must be key, low and high of one key"):
        two = {"block.width_m": (0.2, 0.6), "block.height_m": (1, 2)}
        fecolumn.design(case, tmp_path / "e", **WHAT | {"vary": two})


def block_analyses(folder, number=None):
    """Put files where analyses of a study are written, so that they fail; the files."""
    kept = sorted((folder / "analyses").iterdir())[:number]
    for one in kept:
        shutil.rmtree(one)
        one.write_text("in the way")
    return kept


def test_an_answer_counts_what_failed_and_is_given_all_the_same(designed, tmp_path):
    case, answer = designed
    shutil.copytree(answer.folder, tmp_path / "d")
    block_analyses(tmp_path / "d", 1)
    again = fecolumn.design(case, tmp_path / "d", **WHAT, steps=4)
    assert again.failed == 1 and again.text and again.table.n.sum() == answer.table.n.sum() - 1
    study = fecolumn.load(tmp_path / "d")
    assert study.failed == 1 and "1 failed" in repr(study)
    assert [row["reason"] for row in study.rows if row["state"] == "failed"] != [""]


@pytest.mark.long
def test_where_nothing_is_done_there_is_no_answer_but_a_reason(tmp_path):
    asked = dict(motions="lick:1-5", event="overturn", scale=3, engine="housner")
    objects = pandas.DataFrame(
        {"name": ["slender"], "width_cm": [10], "depth_cm": [10], "height_cm": [150]}
        | {"mass_kg": [10], "friction": [0.6]}
    )
    assert fecolumn.screen(objects, tmp_path / "m", **asked).failed == 0
    block_analyses(tmp_path / "m")
    with pytest.raises(fecolumn.StudyError, match="m.logs"):
        fecolumn.screen(objects, tmp_path / "m", **asked)


@pytest.mark.long
def test_a_study_counts_what_failed_and_tries_it_again_where_asked(tmp_path):
    case = fecolumn.case_from_tables(CABINET)

    def again(**how):
        return fecolumn.run_study(case, tmp_path / "s", quiet=True, axes=AXES, **how)

    study = again()
    assert (study.done, study.failed, study.finished) == (4, 0, True)
    (file,) = block_analyses(tmp_path / "s", 1)
    study = again(jobs=1)
    assert (study.done, study.failed, study.finished) == (3, 1, True)
    file.unlink()
    assert again().failed == 1
    assert again(retry_failed=True).done == 4


@pytest.mark.parametrize("retry", [True, False])
def test_a_question_tells_its_command_whether_to_try_again(monkeypatch, tmp_path, retry):
    from fecolumn.study.questions import design_command

    given = []
    monkeypatch.setattr(design_command, "main", lambda args: given.append(args) or 130)
    with pytest.raises(KeyboardInterrupt):
        fecolumn.design(
            fecolumn.case_from_tables(CABINET), tmp_path / "d", **WHAT, retry_failed=retry
        )
    assert [args.retry_failed for args in given] == [retry]
    assert given[0].jobs is None  # one a core


def test_what_is_no_case_is_told_by_function_and_argument(tmp_path):
    wrong = {"block": {"width_m": 0.3}}
    for ask, words in (
        (lambda: fecolumn.design(wrong, tmp_path / "d", **WHAT), "fecolumn design: case = "),
        (lambda: fecolumn.calibrate(3, tmp_path / "c", test="t"), "fecolumn calibrate: case = 3"),
        (lambda: fecolumn.run_study(wrong, tmp_path / "s"), "run_study: study = "),
        (lambda: fecolumn.run_study(3, tmp_path / "s", axes=AXES), "run_study: study = 3"),
    ):
        with pytest.raises(fecolumn.InputError, match=words) as caught:
            ask()
        assert "must be a Case or the path of a file" in str(caught.value)


@pytest.mark.parametrize("jobs", [0, "two", 1.5])
def test_jobs_of_a_study_are_a_number_or_left_out(jobs, tmp_path):
    with pytest.raises(fecolumn.InputError, match="run_study: jobs = .*must be a whole number"):
        case = fecolumn.case_from_tables(CABINET)
        fecolumn.run_study(case, tmp_path / "s", axes=AXES, jobs=jobs)


def test_a_study_is_asked_for_as_in_earlier_versions(tmp_path):
    case = fecolumn.case_from_tables(CABINET)
    wrong = pytest.raises(fecolumn.InputError, match="jobs = 0")
    with wrong, pytest.warns(DeprecationWarning, match="jobs of run_study is read by position"):
        fecolumn.run_study(case, tmp_path / "s", 0, axes=AXES)
    wrong = pytest.raises(fecolumn.InputError, match="missing.toml")
    with wrong, pytest.warns(DeprecationWarning, match="file of run_study .* write study"):
        fecolumn.run_study(file="missing.toml", folder=tmp_path / "s")


def test_a_study_of_a_case_needs_axes(tmp_path):
    case = fecolumn.case_from_tables(CABINET)
    for axes, words in ((None, "axes: missing"), ([1], "must be lists by key")):
        with pytest.raises(fecolumn.InputError, match=words):
            fecolumn.run_study(case, tmp_path / "s", axes=axes)
    with pytest.raises(fecolumn.InputError, match="motion.scal"):
        fecolumn.run_study(case, tmp_path / "s", axes={"motion.scal": [1.0]})
