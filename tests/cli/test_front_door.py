"""What a newcomer meets first: keys, new, help, completion, version."""

import argparse
import dataclasses
import subprocess
import sys
import tomllib
import typing

import pytest
import pyvista

from fecolumn import __version__, cli
from fecolumn.case import manual, templates
from fecolumn.case.case import load_case
from fecolumn.case.short_form import ShortForm
from fecolumn.cli import main
from fecolumn.study import key_tables as keys
from fecolumn.study.plan import read_plan


def dotted_keys(section=ShortForm, prefix=""):
    """Every key of a case by its dotted name, from the dataclasses themselves."""
    kinds = typing.get_type_hints(section)
    for name in (field.name for field in dataclasses.fields(section)):
        kind = kinds[name]
        inner = [k for k in (kind, *typing.get_args(kind)) if dataclasses.is_dataclass(k)]
        yield from dotted_keys(inner[0], f"{prefix}{name}.") if inner else [prefix + name]


def test_keys_lists_every_key_of_a_case_and_of_a_study():
    listed = {
        f"{table.name}.{key.name}".lstrip(".") for table in keys.tables() for key in table.keys
    }
    assert set(dotted_keys()) <= listed
    assert {
        "case",
        "axes",
        "zip",
        "latin_hypercube",
        "title",
        "extends",
        "latin_hypercube.samples",
        "latin_hypercube.seed",
    } <= listed
    assert all(
        key.meaning and key.allowed and key.default for table in keys.tables() for key in table.keys
    )


def test_manual_has_the_table_of_keys_as_it_is_now():
    table = manual.page("keys").partition("\n\n## ")
    assert "## " + table[2] == keys.markdown(keys.tables()), (
        "run: fecolumn keys --markdown, below the first lines of fecolumn/case/manual/keys.md"
    )


@pytest.mark.parametrize(
    "name, words",
    [
        (
            "contact.friction_coefficient",
            ["friction_coefficient: in [0, 10]; default 0.3", "Coulomb"],
        ),
        (
            "dt_s",
            [
                "[integration]",
                'dt_s [s]: greater than 0 and at most 0.1 or "auto"; default 0.001',
                "[motion]",
            ],
        ),
        (
            "integration.engine",
            [
                "one of full, reduced, rigid, housner, wobbling, rocking_frame, "
                "wobbling_frame, podium; default reduced"
            ],
        ),
        ("study", ["samples: whole number, in [1, 1000000]; required", "[[zip]]"]),
    ],
)
def test_keys_of_a_section_tell_range_unit_and_default(name, words, capsys):
    assert main(["keys", name]) == 0
    text = capsys.readouterr().out
    assert all(word in text for word in words), text


def test_keys_of_an_unknown_section_name_the_nearest(capsys):
    assert main(["keys", "contct"]) == 2
    assert "did you mean contact?" in capsys.readouterr().err


@pytest.mark.parametrize("kind", templates.TEMPLATES)
def test_new_writes_a_case_and_a_study_that_are_accepted_and_overwrites_nothing(
    kind, tmp_path, capsys
):
    folder, more = tmp_path / "mine", []
    if kind == "statue":
        box = pyvista.Box((0, 0.4, 0, 0.3, 0, 1.2)).triangulate()
        box.save(tmp_path / "box.stl")
        more = ["--from", str(tmp_path / "box.stl")]
    assert main(["new", kind, str(folder), *more]) == 0
    load_case(folder / "case.toml")
    assert len(read_plan(folder / "study.toml").analyses) == 20
    before = {file: file.read_bytes() for file in folder.iterdir()}
    (folder / "study.toml").unlink()
    assert main(["new", kind, str(folder), *more]) == 2
    assert "not overwritten" in capsys.readouterr().err
    assert all(file.read_bytes() == before[file] for file in folder.iterdir())


@pytest.mark.long
def test_new_statue_needs_a_shape_and_a_foot(tmp_path, capsys):
    assert main(["new", "statue", str(tmp_path / "a")]) == 2
    assert "must name the file with the statue's shape" in capsys.readouterr().err
    pyvista.Sphere(0.5, (0, 0, 0)).save(tmp_path / "ball.stl")
    assert main(["new", "statue", str(tmp_path / "a"), "--from", str(tmp_path / "ball.stl")]) == 2
    assert "no flat foot" in (said := capsys.readouterr().err) and "cut_foot_m" in said
    pyvista.Cube(center=(0, 0, 31), x_length=20, y_length=20, z_length=62).triangulate().save(
        tmp_path / "scan.stl"
    )
    for unit, asked in (((), True), (("--units", "cm"), False)):
        words = ["new", "statue", str(tmp_path / f"b{asked}"), "--from", str(tmp_path / "scan.stl")]
        assert main([*words, *unit]) == 0
        assert ("--unit mm, cm, in or ft says another" in capsys.readouterr().out) == asked
    assert main(["new", "statu", str(tmp_path / "a")]) == 2
    assert "did you mean statue?" in capsys.readouterr().err


def test_new_takes_options_between_its_words(tmp_path, capsys):
    pyvista.Box((0, 0.4, 0, 0.3, 0, 1.2)).triangulate().save(tmp_path / "box.stl")
    words = ["--from", str(tmp_path / "box.stl"), "--unit", "m", str(tmp_path / "a")]
    assert main(["new", "statue", *words]) == 0
    assert 'mesh_unit = "m"' in (tmp_path / "a" / "case.toml").read_text()


def test_new_cylinder_is_the_solid_column(tmp_path, capsys):
    for kind in ("cylinder", "solid"):
        assert main(["new", kind, str(tmp_path / kind)]) == 0
    cases = [load_case(tmp_path / kind / "case.toml") for kind in ("cylinder", "solid")]
    assert cases[0].id == cases[1].id
    assert main(["new", "cylinder"]) == 2


def commands(parser):
    """A parser and those of its commands and actions."""
    yield parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                yield from commands(below)


def test_help_tells_of_every_command_and_argument():
    for one in commands(cli._parser()):
        assert one.description and one.description[0].isupper() and one.description[-1] == "."
        mute = [
            action.dest
            for action in one._actions
            if not action.help and not isinstance(action, argparse._SubParsersAction)
        ]
        assert not mute, one.prog


def test_help_of_doctor_is_a_sentence(capsys):
    with pytest.raises(SystemExit):
        main(["doctor", "--help"])
    assert "and known problems of this machine." in " ".join(capsys.readouterr().out.split())


def test_verify_tells_the_cases_of_the_engines_that_are_asked_for(tmp_path, capsys):
    for words in (["--name", "none"], ["--case", "none"]):
        assert main(["verify", "--engine", "full", *words, "-o", str(tmp_path / "out")]) == 2
        told = capsys.readouterr().err
        assert "-k = 'none': must be part of the name of a case of engine full: patch, " in told
        assert "full_structures" in told and "several_bodies" not in told
        assert ("--case is an older name of --name" in told) == (words[0] == "--case")
    assert not (tmp_path / "out").exists()


def test_colour_of_pictures_is_read_in_both_spellings():
    for option in ("--colour", "--color"):
        assert cli._parser().parse_args(["render", "d", option, "none"]).color == "none"


def test_resumed_analysis_is_timed_too():
    assert cli._parser().parse_args(["resume", "d", "--profile"]).profile


def test_new_into_a_file_is_refused(tmp_path, capsys):
    (tmp_path / "mine").write_text("")
    assert main(["new", str(tmp_path / "mine")]) == 2
    assert "cannot be written" in capsys.readouterr().err


@pytest.mark.long
def test_a_studys_commented_lines_are_keys_too(tmp_path):
    """What a newcomer takes out of its comment must work."""
    main(["new", str(tmp_path)])
    lines = (tmp_path / "study.toml").read_text().splitlines()
    bare = [
        line.removeprefix("# ") if line.startswith(("# [", '# "', "# samples")) else line
        for line in lines
    ]
    (tmp_path / "study.toml").write_text("\n".join(bare))
    assert len(tomllib.loads("\n".join(bare))) == 5
    assert len(read_plan(tmp_path / "study.toml").analyses) == 20 * 4 * 2 * 20


@pytest.mark.parametrize("topic", manual.TOPICS)
def test_help_shows_every_topic_by_the_beginning_of_its_name(topic, capsys):
    assert main(["help", topic]) == 0
    assert capsys.readouterr().out.startswith("# ")


def test_help_lists_its_topics_and_refuses_others(capsys):
    assert main(["help"]) == 0
    text = capsys.readouterr().out
    assert all(topic in text for topic in manual.TOPICS)
    assert main(["help", "weather"]) == 2
    assert "quick-start" in capsys.readouterr().err
    assert {f"{topic}.md" for topic in manual.TOPICS} == {
        path.name for path in manual.MANUAL_FOLDER.glob("*.md")
    }


def test_help_names_the_sections_on_a_word_that_is_no_topic(capsys):
    assert main(["help", "fragility"]) == 2
    assert "rocking (Fragility)" in capsys.readouterr().err
    assert main(["help", "sliding"]) == 2
    assert "it is told of in theory" in capsys.readouterr().err


def test_version_is_the_packages(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0 and capsys.readouterr().out == f"fecolumn {__version__}\n"


@pytest.mark.parametrize(
    "typed, offered",
    [
        ("fecolumn ", {"run", "study", "help"}),
        ("fecolumn st", {"study"}),
        ("fecolumn motions make ", {"seeded", "pulses"}),
        ("fecolumn study x.toml --arr", {"--array-index", "--array-size"}),
        ("fecolumn new ", {"tube", "block"}),
        ("fecolumn run my_", {"my_case.toml"}),
        ("fecolumn motions make pulses ", {"half_sine", "type_c"}),
        ("fecolumn verify --engine ", {"reduced", "rigid"}),
    ],
)
def test_bash_completes_commands_options_choices_and_files(typed, offered, tmp_path, capsys):
    assert main(["completion", "bash"]) == 0
    words = typed.split(" ")
    (tmp_path / "my_case.toml").touch()
    asked = (
        f"COMP_WORDS=({' '.join(word or chr(39) * 2 for word in words)}); "
        f"COMP_CWORD={len(words) - 1}; _shtab_fecolumn fecolumn {words[-1] or chr(39) * 2}; "
        f"printf '%s\\n' \"${{COMPREPLY[@]}}\""
    )
    result = subprocess.run(
        ["bash", "-c", capsys.readouterr().out + asked],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert offered <= set(result.stdout.split()) and result.stderr == ""


@pytest.mark.parametrize("shell, begins", [("zsh", "#compdef fecolumn"), ("fish", "#")])
def test_other_shells_get_a_script_of_their_own(shell, begins, capsys):
    assert main(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert text.startswith(begins) and all(
        word in text for word in ("array-index", "half_sine", "doctor")
    )


def test_a_reader_that_stops_early_is_no_error():
    command = f"{sys.executable} -m fecolumn.cli keys | head -n 1; echo ${{PIPESTATUS[0]}}"
    result = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert result.stdout.splitlines()[-1] == "0" and result.stderr == ""
