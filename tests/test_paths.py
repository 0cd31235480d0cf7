"""Paths are relative to the file that states them, however many files extend one another."""

from pathlib import Path

import numpy as np
import pytest

from fecolumn.case.case import load_case
from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import read_plan

COLUMN = '[column]\nshape = "block"\nlength_m = 0.3\nwidth_m = 0.2\nheight_m = 1.0\n'
BODIES = (
    '[bodies.cube]\nkind = "mesh"\nmesh_file = "cube.vtk"\nrigid = '
    'true\n[joints.foot]\nslave = "cube"\non = "ground"\n'
)


def _write(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def _cube(file):
    import meshio

    file.parent.mkdir(parents=True, exist_ok=True)
    points = (
        np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
        * 0.3
    )
    meshio.Mesh(points, [("hexahedron", [list(range(8))])]).write(file)
    return file


@pytest.fixture
def three(tmp_path):
    """A case that extends one of another folder, which extends one of a third; each says something
    with a path, and files of these names lie elsewhere, too.
    """
    for folder in ("a", "b", "c"):
        _write(
            tmp_path / folder / "motion.csv",
            f"time [s],ax [g]\n0,0\n0.01,0.{ord(folder)}\n0.02,0\n",
        )
    _write(tmp_path / "a" / "case.toml", COLUMN + '[motion]\nsource = "motion.csv"\n')
    _write(tmp_path / "b" / "case.toml", 'extends = "../a/case.toml"\n[motion]\nscale = 0.5\n')
    _write(
        tmp_path / "c" / "case.toml",
        'extends = "../b/case.toml"\n[contact]\nfriction_coefficient = 0.4\n',
    )
    return tmp_path


def test_motion_of_a_chain_over_three_folders_is_that_beside_the_file_that_names_it(three):
    case = load_case(three / "c" / "case.toml")
    assert (
        case.motion.source == str(three / "a" / "motion.csv")
        and case.motion.scale == 0.5
        and case.contact.friction_coefficient == 0.4
    )
    (three / "b" / "motion.csv").unlink()
    (three / "c" / "motion.csv").unlink()
    assert load_case(three / "c" / "case.toml").id == case.id
    _write(
        three / "b" / "case.toml",
        'extends = "../a/case.toml"\n[motion]\nsource = "own/motion.csv"\n',
    )
    assert load_case(three / "c" / "case.toml").motion.source == str(
        three / "b" / "own" / "motion.csv"
    )


def test_names_of_records_and_absolute_paths_stay(three):
    _write(three / "a" / "case.toml", COLUMN + '[motion]\nsource = "lick:12"\n')
    assert load_case(three / "c" / "case.toml").motion.source == "lick:12"
    _write(three / "a" / "case.toml", COLUMN + f'[motion]\nsource = "{three}/b/motion.csv"\n')
    assert load_case(three / "c" / "case.toml").motion.source == str(three / "b" / "motion.csv")


def test_mesh_of_a_column_and_of_a_body_is_that_beside_the_file_that_names_it(tmp_path):
    cube = _cube(tmp_path / "a" / "meshes" / "cube.vtk")
    _write(tmp_path / "a" / "case.toml", '[column]\nmesh_file = "meshes/cube.vtk"\n')
    _write(tmp_path / "b" / "case.toml", 'extends = "../a/case.toml"\n')
    assert load_case(tmp_path / "b" / "case.toml").short.column.mesh_file == str(cube)
    _write(tmp_path / "a" / "meshes" / "bodies.toml", BODIES)
    _write(tmp_path / "b" / "bodies.toml", 'extends = "../a/meshes/bodies.toml"\n')
    _write(tmp_path / "bodies.toml", 'extends = "b/bodies.toml"\n')
    assert load_case(tmp_path / "bodies.toml").bodies["cube"].mesh_file == str(cube)


def test_study_takes_over_a_chain_of_cases_and_another_study(three):
    study = _write(
        three / "studies" / "study.toml",
        'case = "../c/case.toml"\n[axes]\n"contact.friction_coefficient" = [0.3, 0.5]\n',
    )
    wanted = str(three / "a" / "motion.csv")
    assert [analysis.case.motion.source for analysis in read_plan(study).analyses] == [wanted] * 2
    again = _write(
        three / "other" / "deep" / "study.toml",
        'extends = "../../studies/study.toml"\ntitle = "again"\n',
    )
    assert read_plan(again).id == read_plan(study).id
    _write(
        study,
        '[case]\nextends = "../c/case.toml"\nmotion.scale = '
        '2.0\n[axes]\n"motion.source" = ["../b/motion.csv", "../c/motion.csv"]\n',
    )
    assert [
        Path(analysis.case.motion.source).resolve() for analysis in read_plan(again).analyses
    ] == [three / folder / "motion.csv" for folder in "bc"]
    _write(
        study,
        '[case]\nextends = "../c/case.toml"\n[[zip]]\nmotion = [{source = '
        '"../b/motion.csv"}, {source = "lick:1"}]\n"contact.friction_coefficient" = '
        "[0.3, 0.5]\n",
    )
    first, second = (analysis.case.motion.source for analysis in read_plan(again).analyses)
    assert Path(first).resolve() == three / "b" / "motion.csv" and second == "lick:1"


def test_circle_over_folders_is_told(three):
    _write(three / "a" / "case.toml", 'extends = "../c/case.toml"\n')
    with pytest.raises(
        InputError, match="goes in a circle: case.toml -> case.toml -> case.toml -> case.toml"
    ):
        load_case(three / "c" / "case.toml")


def test_a_file_name_may_have_a_colon(tmp_path):
    _write(tmp_path / "a" / "2011:03.csv", "time [s],ax [g]\n0,0\n0.01,0.1\n0.02,0\n")
    _write(tmp_path / "a" / "case.toml", COLUMN + '[motion]\nsource = "2011:03.csv"\n')
    assert load_case(tmp_path / "a" / "case.toml").motion.source == str(
        tmp_path / "a" / "2011:03.csv"
    )
    _cube(tmp_path / "a" / "11:cube.vtk")
    bodies = BODIES.replace("cube.vtk", "11:cube.vtk")
    _write(tmp_path / "a" / "bodies.toml", bodies)
    _write(tmp_path / "b" / "bodies.toml", 'extends = "../a/bodies.toml"\n')
    assert load_case(tmp_path / "b" / "bodies.toml").bodies["cube"].mesh_file == str(
        tmp_path / "a" / "11:cube.vtk"
    )
