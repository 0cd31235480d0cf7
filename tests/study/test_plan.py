import pytest
from study_files import SPECIMEN, write_study

from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import read_plan
from fecolumn.study.run import check_motions

# the specimen on a base at rest, which an axis of motions may shake
RESTING = f'[case]\nextends = "{SPECIMEN}"\nintegration.duration_s = 1.0\n'


def _study(tmp_path, text):
    file = tmp_path / "study.toml"
    file.write_text(text)
    return file


def test_axes_are_multiplied_out_in_the_order_of_the_file(tmp_path):
    plan = read_plan(write_study(tmp_path, pulses=range(3)))
    assert len(plan.analyses) == 2 * 2 * 3 == len({a.id for a in plan.analyses})
    assert plan.analyses[0].values == {
        "integration.dt_s": 0.02,
        "integration.alpha_hht": 0,
        "motion.source": "pulse:0",
    }
    last = plan.analyses[-1]
    assert (
        last.case.integration.dt_s,
        last.case.integration.alpha_hht,
        last.case.motion.source,
    ) == (1e-3, -0.2, "pulse:2")
    assert last.combination == {"integration.dt_s": 1e-3, "integration.alpha_hht": -0.2}
    assert last.case.short.column.outer_diameter_m == 0.1016


def test_small_steps_are_the_longest_analyses(tmp_path):
    plan = read_plan(write_study(tmp_path))
    coarse, fine = plan.analyses[0].effort, plan.analyses[-1].effort
    assert coarse < fine < 20 * coarse  # twenty times the steps, but as many landings


def test_all_spellings_of_a_dotted_key_mean_the_same(tmp_path):
    texts = (
        '[axes]\n"integration.dt_s" = [0.02, 1e-3]',
        "[axes]\nintegration.dt_s = [0.02, 1e-3]",
        "[axes.integration]\ndt_s = [0.02, 1e-3]",
    )
    assert len({read_plan(_study(tmp_path, RESTING + text)).id for text in texts}) == 1


def test_inline_tables_override_the_extended_case(tmp_path):
    plan = read_plan(
        _study(
            tmp_path,
            RESTING + '[case.column]\nheight_m = 1.5\n[axes]\n"integration.alpha_hht" = [-0.1]',
        )
    )
    assert (
        plan.analyses[0].case.short.column.height_m == 1.5
        and plan.analyses[0].case.short.column.wall_m == 0.005
    )


def test_axis_of_sections_sets_several_keys_at_once(tmp_path):
    for name in ("ax.AT2", "ay.AT2"):
        (tmp_path / name).touch()
    plan = read_plan(
        _study(
            tmp_path,
            f'case = "{SPECIMEN}"\n[axes]\nmotion = [{{ source = "ax.AT2", source_y = '
            f'"ay.AT2" }}, {{ source = "p:1" }}]',
        )
    )
    assert [a.case.motion.source_y for a in plan.analyses] == [str(tmp_path / "ay.AT2"), ""]


def test_paths_are_relative_to_the_file_that_states_them(tmp_path):
    (tmp_path / "cases").mkdir()
    (tmp_path / "cases" / "record.AT2").touch()
    (tmp_path / "cases" / "case.toml").write_text(
        f'extends = "{SPECIMEN}"\n[motion]\nsource = "record.AT2"\n'
    )
    plan = read_plan(
        _study(tmp_path, 'case = "cases/case.toml"\n[axes]\n"integration.alpha_hht" = [0, -0.1]')
    )
    assert plan.analyses[0].case.motion.source == str(tmp_path / "cases" / "record.AT2")


AXES = '\n[axes]\n"integration.dt_s" = [1e-3]\n'


@pytest.mark.parametrize(
    "text, message",
    [
        (
            f'case = "{SPECIMEN}"\n[axes]\n"integration.dt" = [0.02]',
            r"axes.integration.dt: unknown key of a case; did you mean integration.dt_s\?",
        ),
        (f'case = "{SPECIMEN}"\n[axes]\n"alpha" = [0.0]', r"did you mean integration.alpha_hht\?"),
        (
            RESTING + '[axes]\n"integration.alpha_hht" = [0, 0.1]',
            r"axes.integration.alpha_hht = 0.1: must lie in \[-0.333333, 0\]",
        ),
        (f'case = "{SPECIMEN}"\n[axes]\n"integration.dt_s" = 0.02', "must be a list"),
        (f'case = "{SPECIMEN}"\n[axes]\n"integration.dt_s" = []', "at least one value"),
        (
            f'case = "{SPECIMEN}"\n[axes]\n"integration.dt_s" = [0.02, 2e-2]',
            "axes.integration.dt_s = 0.02: stands twice",
        ),
        (
            RESTING + '[axes]\n"title" = ["a", "b"]',
            "two combinations are the same analysis: title = 'a' and 'b'",
        ),
        (
            f'case = "{SPECIMEN}"\n[axes]\n"motion.source" = ["gone.AT2"]',
            "axes.motion.source = .*gone.AT2': no such file",
        ),
        (
            RESTING + '[axes]\n"mesh.fine_size_m" = [0.005, 0.5]',
            r"axes.mesh.fine_size_m = 0.5: must be at most the wall",
        ),
        (
            RESTING + '[axes]\n"column.outer_diameter_m" = [0.1016, 0.02]',
            r"case.mesh.coarse_size_m.*with column.outer_diameter_m = 0.02",
        ),
        (f'case = "{SPECIMEN}"', "axes: a table of lists is needed"),
        ('case = "gone.toml"' + AXES, "gone.toml: no such file"),
        ("case = 3" + AXES, "case = 3: must be the path"),
        ("title = 'x'" + AXES, "case: missing"),
        ("column.height_m = 1.5", "is a case, not a study, which has .*: fecolumn run"),
        (
            f'case = "{SPECIMEN}"\n[axes]\n"bodies.stone.width" = [0.1]',
            r"did you mean bodies.stone.width_m\?",
        ),
        (
            f'case = "{SPECIMEN}"\njobs = 2' + AXES,
            "jobs: unknown key; a study has title, case and axes",
        ),
    ],
)
def test_mistakes_name_the_study_file_and_the_key(tmp_path, text, message):
    with pytest.raises(InputError, match=message) as caught:
        read_plan(_study(tmp_path, text))
    assert "study.toml" in str(caught.value) or "gone.toml" in str(caught.value)


def test_study_id_depends_on_the_analyses_only(tmp_path):
    plan = read_plan(write_study(tmp_path / "a"))
    assert read_plan(write_study(tmp_path / "b")).id == plan.id
    assert read_plan(write_study(tmp_path / "b", alpha=(0, -0.1))).id != plan.id


def test_quick_study_is_valid():
    plan = read_plan(SPECIMEN.parents[1] / "benchmarks" / "quick_study.toml")
    assert len(plan.analyses) == 80 and {a.case.motion.source for a in plan.analyses} == {
        f"lick:{k}" for k in range(1, 41)
    }


def test_longer_motions_are_longer_analyses_whatever_their_scale(tmp_path):
    for name, samples in (("short", 100), ("long", 300)):
        rows = "".join(f"{0.01 * k:.2f},{0.1 * (-1) ** (k // 10):.3f}\n" for k in range(samples))
        (tmp_path / f"{name}.csv").write_text("time [s],ax [g]\n" + rows)
    plan = read_plan(
        _study(
            tmp_path,
            f'[case]\nextends = "{SPECIMEN}"\nintegration.duration_s = '
            '0\n[axes]\n"motion.source" = ["short.csv", "long.csv"]\n'
            '"motion.scale" = [0.5, 2]',
        )
    )
    check_motions(plan)
    # a second of free vibration included
    assert [round(a.duration_s, 1) for a in plan.analyses] == [
        2.0,
        2.0,
        4.0,
        4.0,
    ]


@pytest.mark.long
@pytest.mark.parametrize("many", [2, 7])
def test_what_is_told_of_many_motions_is_told_of_three(tmp_path, many):
    names = [f"{k}.csv" for k in range(many)]
    for k, name in enumerate(names):
        rows = f"0,0,0\n0.15,{0.3 + k / 100},0\n0.3,{0.3 + k / 100},0\n"
        (tmp_path / name).write_text("time [s],ax [g],ay [g]\n" + rows)
    axis = ", ".join(f'"{name}"' for name in names)
    study = f'[case]\nextends = "{SPECIMEN}"\n[axes]\n"motion.source" = [{axis}]'
    with pytest.warns() as told:
        check_motions(read_plan(_study(tmp_path, study)))
    texts = [str(warning.message) for warning in told]
    assert sum("between its rows" in text for text in texts) == min(many, 3)
    assert [t for t in texts if "left out here: 4" in t and "motions info" in t] == texts[3:]


def test_motions_are_looked_at_with_their_largest_scale(tmp_path):
    rows = "".join(f"{0.01 * k:.2f},{0.1 * (-1) ** (k // 10):.3f}\n" for k in range(100))
    (tmp_path / "short.csv").write_text("time [s],ax [g]\n" + rows)
    study = (
        f'[case]\nextends = "{SPECIMEN}"\nmotion.source = "short.csv"\n'
        '[axes]\n"motion.scale" = [1, -2000]'
    )
    with pytest.raises(InputError, match="motion.scale = -2000"):
        check_motions(read_plan(_study(tmp_path, study)))
