"""Cases that cannot be: from files everything wrong is told at once, from Python nothing invalid
can be made.
"""

import dataclasses
import math
import os
import re
from pathlib import Path

import numpy as np
import pytest

from fecolumn.case.case import load_case
from fecolumn.case.sections import Contact
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import read_toml
from fecolumn.simulation import run
from fecolumn.study.plan import read_plan

STOUT = str(Path("meshes/stout.toml").resolve())


def _write(folder, text, name="case.toml"):
    (folder / name).write_text(text)
    return folder / name


def test_missing_unknown_and_impossible_keys_are_told_together(tmp_path):
    path = _write(
        tmp_path,
        "[column]\nouter_diameter_m = 0.1\nheigth_m = 1.0\n[cap]\nlength_m = "
        "0.2\n[contact]\nfriction_coefficient = -1\n[base]\nlength_m = 'wide'\n",
    )
    with pytest.raises(InputError) as caught:
        load_case(path)
    lines = str(caught.value).split("\n")
    assert all(line.startswith(f"{path}: ") for line in lines)
    assert {error.key for error in caught.value.all} == {
        "column.heigth_m",
        "cap.width_m",
        "cap.thickness_m",
        "base.length_m",
        "contact.friction_coefficient",
    }
    text = str(caught.value)
    assert (
        len(lines) == 5
        and "did you mean column.height_m" in text
        and "cap.thickness_m: missing" in text
        and "[0, 10]" in text
    )


def test_study_tells_every_wrong_value_of_its_case_by_its_own_keys(tmp_path):
    path = _write(
        tmp_path,
        f'[case]\nextends = "{STOUT}"\ncontact.friction_coefficient = '
        "-1\nmaterial.poissons_ratio = 2\n"
        '[axes]\n"integration.dt_s" = [0.02]\n',
        "study.toml",
    )
    with pytest.raises(InputError) as caught:
        read_plan(path)
    assert [error.key for error in caught.value.all] == [
        "case.material.poissons_ratio",
        "case.contact.friction_coefficient",
    ]


@pytest.mark.parametrize("files", [1, 2, 3])
def test_files_that_extend_one_another_in_a_circle_are_told(tmp_path, files):
    for number in range(files):
        _write(tmp_path, f'extends = "{(number + 1) % files}.toml"\n', f"{number}.toml")
    with pytest.raises(
        InputError, match="itself" if files == 1 else "in a circle: 0.toml -> 1.toml -> "
    ) as caught:
        load_case(tmp_path / "0.toml")
    assert caught.value.key == "extends" and "\n" not in str(caught.value)


def test_endless_chain_of_files_is_refused(tmp_path):
    for number in range(200):
        _write(tmp_path, f'extends = "{number + 1}.toml"\n', f"{number}.toml")
    with pytest.raises(InputError, match="at most 50 files"):
        load_case(tmp_path / "0.toml")


def test_section_set_to_false_takes_away_what_extends_brought(tmp_path):
    bare = load_case(
        _write(tmp_path, f'extends = "{STOUT}"\ncap = false\nmotion = false\nmaterial = false\n')
    ).short
    whole = load_case(STOUT).short
    assert (
        whole.cap
        and bare.cap is None
        and bare.motion is None
        and bare.top_m == whole.column.height_m
    )
    # what must be there is as if the file said nothing of it
    assert bare.material == type(whole.material)()
    again = load_case(
        _write(
            tmp_path,
            'extends = "case.toml"\n[cap]\nlength_m = 0.2\nwidth_m = 0.2\nthickness_m = 0.02\n',
            "again.toml",
        )
    ).short
    assert again.cap.length_m == 0.2


def test_study_varies_a_column_with_cap_and_without(tmp_path):
    path = _write(
        tmp_path,
        f'case = {{extends = "{STOUT}", integration.duration_s = 1.0}}\n[axes]\n"cap" = '
        f"[false, {{length_m = 0.2, width_m = 0.2, thickness_m = 0.01}}]\n",
        "study.toml",
    )
    assert [analysis.case.short.cap is None for analysis in read_plan(path).analyses] == [
        True,
        False,
    ]


@pytest.mark.parametrize(
    "section, key, value",
    [
        ("contact", "friction_coefficient", -1),
        ("contact", "friction_coefficient", math.nan),
        ("contact", "law", "glue"),
        ("integration", "dt_s", 0),
        ("integration", "n_modes", 3.5),
        ("integration", "max_iterations", 10**400),
        ("column", "height_m", "1"),
        ("column", "height_m", 10**400),
        ("material", "poissons_ratio", None),
    ],
)
def test_no_invalid_section_can_be_made_from_python(section, key, value):
    case = load_case(STOUT)
    with pytest.raises(InputError, match=f"^case: {section}.{key}"):
        dataclasses.replace(getattr(case.short, section), **{key: value})


def test_the_mesh_of_a_structure_is_named_as_in_its_file():
    with pytest.raises(InputError, match="^case: mesh.limit_dofs = 3"):
        dataclasses.replace(load_case(STOUT).mesh, limit_dofs=3)


def test_case_takes_only_sections_of_their_kind():
    with pytest.raises(InputError, match="contact.*must be a Contact"):
        dataclasses.replace(load_case(STOUT), contact=0.3)


def test_numbers_of_numpy_and_whole_numbers_make_the_same_case():
    case = load_case(STOUT)
    ids = {
        dataclasses.replace(case, contact=Contact(friction_coefficient=value)).id
        for value in (1, 1.0, np.float64(1), np.float32(1), np.int64(1))
    }
    assert len(ids) == 1


def test_run_checks_what_no_single_key_can_know(tmp_path):
    case = load_case(STOUT)
    wrong = dataclasses.replace(case.bodies["column"], wall_m=1.0)
    with pytest.raises(InputError, match="bodies.column.wall_m.*outer radius"):
        run(dataclasses.replace(case, bodies={"column": wrong}), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_run_takes_a_path_as_it_takes_a_case_and_says_what_else_it_was_given(tmp_path):
    with pytest.raises(InputError, match="absent.toml: no such file"):
        run(tmp_path / "absent.toml", tmp_path / "out")
    with pytest.raises(InputError, match="engine"):  # read, checked and refused by its own name
        run(
            str(_write(tmp_path, f'extends = "{STOUT}"\nintegration.engine = "none"')),
            tmp_path / "out",
        )
    with pytest.raises(TypeError, match="a Case or the path of a case file, not dict"):
        run({}, tmp_path / "out")


HUGE = "9" * 5000


@pytest.mark.parametrize(
    "text, said",
    [
        (f"[column]\nheight_m = {HUGE}", "line 3: a whole number of more than 4300 digits"),
        (
            "[column]\nheight_m = 1" + "0" * 400,
            "column.height_m = 1e400 or so: must be greater than 0 and at most 1000",
        ),
        ("[column]\nheight_m = -1" + "0" * 400, "column.height_m = -1e400 or so"),
        (
            "[integration]\nmax_iterations = 1" + "0" * 400,
            "integration.max_iterations = 1e400 or so: must lie in",
        ),
        (
            "[integration]\nduration_s = 1e5\ndt_s = 1e-50",
            "integration.dt_s = 1e-50: must be at least 0.001 s",
        ),
        ('[column]\nmesh_file = "' + "x" * 300 + '"', "column.mesh_file.*no such file"),
        ('[column]\nmesh_file = "' + "x" * 9000 + '"', "column.mesh_file.*at most 4096 characters"),
        ('[column]\nmesh_file = "a\\u0000b"', "column.mesh_file.*without control characters"),
        ('[motion]\nsource = "' + "x" * 300 + '.h5#1"', "motion.source.*File name too long"),
        ("a" + ".a" * 3000 + " = 1", "deep; at most 20"),
        ("a = " + "[" * 3000 + "]" * 3000, "nested too deeply|deep; at most 20"),
        ("[column]\nheight_m = 1979-05-27", "column.height_m.*must be a number"),
    ],
)
def test_dirt_in_a_case_is_one_line(tmp_path, text, said):
    with pytest.raises(InputError) as caught:
        case = load_case(_write(tmp_path, f'extends = "{STOUT}"\n{text}\n'))
        from fecolumn.motions.load import load_motion

        load_motion(case.motion, 1e-3, "case.toml")
    message = str(caught.value)
    assert re.search(said, message) and "\n" not in message and len(message) < 2000


@pytest.mark.parametrize(
    "text, said",
    [
        (f'"integration.dt_s" = [1{"0" * 400}, 1e-3]', "integration.dt_s = 1e400 or so"),
        (f'"integration.max_iterations" = [1{"0" * 400}, 1{"0" * 400}]', "stands twice"),
        (
            '[latin_hypercube]\nsamples = 3\n"contact.friction_coefficient" = [0.1, 1'
            + "0" * 400
            + "]",
            "must be a range",
        ),
        (
            '[latin_hypercube]\nsamples = 1000000\n"contact.friction_coefficient" = [0.1, 1.0]\n',
            "at most 1,000,000",
        ),
    ],
)
def test_dirt_in_a_study_is_one_line(tmp_path, text, said):
    path = _write(
        tmp_path,
        f'case = "{STOUT}"\n[axes]\n"integration.alpha_hht" = [0, -0.1]\n{text}\n',
        "study.toml",
    )
    with pytest.raises(InputError, match=said) as caught:
        read_plan(path)
    assert "\n" not in str(caught.value)


@pytest.mark.timeout(20)
@pytest.mark.parametrize(
    "make, said",
    [
        (os.mkfifo, "is a device or a pipe"),
        (os.mkdir, "is a directory"),
        (lambda path: os.symlink("/dev/zero", path), "is a device or a pipe"),
        (lambda path: os.symlink("absent", path), "no such file"),
        (lambda path: os.symlink(path.name, path), "cannot be read"),
    ],
)
def test_what_is_no_file_holds_nobody_up(tmp_path, make, said):
    make(tmp_path / "x.toml")
    for read in (read_toml, read_plan):
        with pytest.raises(InputError, match=said):
            read(tmp_path / "x.toml")
