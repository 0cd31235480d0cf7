"""A case's id names what is computed: content, not place."""

import dataclasses
import hashlib
import json
import shutil
from pathlib import Path

from fecolumn.case import read_case

SPECIMEN = Path("meshes/stout.toml").resolve()


def _folder(path, acceleration="0.1"):
    path.mkdir()
    (path / "motion.csv").write_text(f"time [s],ax [g]\n0,0\n0.01,{acceleration}\n0.02,0\n")
    (path / "case.toml").write_text(f'extends = "{SPECIMEN}"\n[motion]\nsource = "motion.csv"\n')
    return path


def test_id_outlives_a_move_and_sees_a_changed_motion(tmp_path):
    here = _folder(tmp_path / "here")
    first = read_case(here / "case.toml").id
    shutil.copytree(here, tmp_path / "there")
    assert read_case(tmp_path / "there" / "case.toml").id == first
    assert read_case(_folder(tmp_path / "changed", "0.2") / "case.toml").id != first


def test_id_ignores_title_and_output_but_no_number(tmp_path):
    folder = _folder(tmp_path / "case")
    file = folder / "case.toml"
    first, text = read_case(file).id, file.read_text()
    file.write_text('title = "other"\n' + text + "[output]\nfields_every_s = 0.1\n")
    assert read_case(file).id == first
    file.write_text(text + "[contact]\nfriction_coefficient = 0.31\n")
    assert read_case(file).id != first


def test_studies_older_than_younger_keys_keep_the_names_of_their_results(tmp_path):
    file = _folder(tmp_path / "case") / "case.toml"
    case = read_case(file)
    tables = dataclasses.asdict(case)
    del tables["title"], tables["output"], tables["motion"]["delay_s"], tables["flange"], tables["mesh"]["limit_dofs"], tables["contact"]["interior_points"]
    for key in ("shape", "length_m", "width_m"):
        del tables["column"][key]
    tables["motion"]["source"] = hashlib.sha256((tmp_path / "case" / "motion.csv").read_bytes()).hexdigest()
    assert case.id == hashlib.sha256(json.dumps(tables, sort_keys=True).encode()).hexdigest()[:12]
    file.write_text(file.read_text() + "delay_s = 1e-12\n")
    assert read_case(file).id != case.id


def test_ids_of_the_specimens_stay():
    """Sizes that are stated are taken as stated; keys that came later say nothing at their default."""
    assert [read_case(SPECIMEN.with_name(name)).id for name in ("specimen.toml", "stout.toml")] == ["3ec6b3a13db8", "101fc7698144"]
