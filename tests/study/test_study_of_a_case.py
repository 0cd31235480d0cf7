"""A study of a `Case` is that of its file: what the case states is kept, what it leaves open is the
study's.
"""

import pytest

import fecolumn
from fecolumn.study.plan import read_plan
from fecolumn.study.results.script import _study_file

AXES = {"motion.source": ["lick:1"]}
STATED = fecolumn.Output(history_every_s=0.0, states_every_s=0.04)
COLUMN = fecolumn.Column(shape="solid", outer_diameter_m=0.5, height_m=1.6)


def cases(output):
    """A case in the full form, in the short one, and of a table of its own."""
    return [
        fecolumn.Case(
            bodies={"block": fecolumn.Block(length_m=0.3, width_m=0.3, height_m=1.2)},
            joints={"foot": fecolumn.Joint(between=("block", "ground"))},
            output=output,
        ),
        fecolumn.Case.of_column(fecolumn.ShortForm(column=COLUMN, output=output)),
        fecolumn.Case.of_model(fecolumn.BlockModel(width_m=0.3, height_m=1.2), output=output),
    ]


def planned(case, folder):
    """Output and id of the one analysis of a study of this case."""
    (analysis,) = read_plan(_study_file(case, folder / "study", AXES)).analyses
    return analysis.case.output, analysis.id


def test_intervals_that_a_case_states_are_kept_whatever_they_are(tmp_path):
    for stated, open_ in zip(cases(STATED), cases(fecolumn.Output())):
        output, name = planned(stated, tmp_path)
        assert (output.history_every_s, output.states_every_s) == (0.0, 0.04)
        output, other = planned(open_, tmp_path)
        assert (output.history_every_s, output.states_every_s) == (0.005, 0.0)
        assert name == other and stated.id == open_.id


def test_they_are_kept_by_a_case_that_is_made_of_another_or_of_a_file(tmp_path):
    for case in cases(STATED):
        (tmp_path / "case.toml").write_text(case.to_toml())
        for again in (case.replace(title="other"), fecolumn.load_case(tmp_path / "case.toml")):
            assert again.output == STATED
    assert cases(fecolumn.Output())[0].replace(title="other").output == fecolumn.Output()


def test_one_analysis_takes_every_row_and_states_in_pictures_where_nothing_is_said():
    left_open = fecolumn.Output()
    assert (left_open.row_interval_s, left_open.state_interval_s) == (0.0, 0.04)
    stated = fecolumn.Output(history_every_s=0.1, states_every_s=0.0)
    assert (stated.row_interval_s, stated.state_interval_s) == (0.1, 0.0)


@pytest.mark.parametrize("folder, name", [(".", "work-study"), ("..", "outer-study")])
def test_the_study_is_beside_a_folder_without_a_name(tmp_path, monkeypatch, folder, name):
    work = tmp_path / "outer" / "work"
    work.mkdir(parents=True)
    monkeypatch.chdir(work)
    path = _study_file(cases(STATED)[0], folder, AXES)
    assert path.parent == (work / folder).resolve().parent and path.stem == name
    with pytest.raises(fecolumn.InputError, match="/: is no folder of results: give it a name"):
        _study_file(cases(STATED)[0], "/", AXES)


BLOCK = {"block": {"width_m": 0.3, "height_m": 1.2}, "motion": {"source": "lick:1"}}


@pytest.mark.filterwarnings("ignore")
def test_a_key_that_moves_from_the_axes_to_the_case_is_the_same_study(tmp_path):
    tables = BLOCK | {"integration": {"dt_s": 0.005, "duration_s": 0.5}}
    case, axes = fecolumn.case_from_tables(tables), {"motion.source": ["lick:1", "lick:2"]}
    more = axes | {"block.restitution": [0.9]}
    first = fecolumn.run_study(case, tmp_path / "out", axes=more, jobs=1, quiet=True)
    assert first.axes.keys() == more.keys()
    stated = case.replace({"block.restitution": 0.9}, title="Stated")
    again = fecolumn.run_study(stated, tmp_path / "out", axes=axes, jobs=1, quiet=True)
    assert again.axes.keys() == axes.keys() and again.title == "Stated" and again.done == 2
    assert {row["id"] for row in first.rows} == {row["id"] for row in again.rows}


def test_a_motion_that_cannot_be_read_is_refused_before_anything_runs(tmp_path):
    (tmp_path / "bad.AT2").write_text("no record\n")
    axes = {"motion.source": [str(tmp_path / "bad.AT2")], "block.restitution": [0.8, 0.9]}
    case = fecolumn.case_from_tables(BLOCK)
    with pytest.raises(fecolumn.InputError, match="bad.AT2"):
        fecolumn.run_study(case, tmp_path / "out", axes=axes, jobs=1, quiet=True)
    assert not (tmp_path / "out").exists()
