"""Ensembles on disk, and their motions as motions of a case and of a study."""

import csv

import h5py
import numpy as np
import pytest
from record_files import motion_hash, write_at2

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import Motion
from fecolumn.foundation.schema import InputError
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import (
    members,
    read_ensemble,
    read_member,
    summary,
    write_ensemble,
    write_summary,
)
from fecolumn.motions.export import write_text_files
from fecolumn.motions.load import load_motion, read_motion
from fecolumn.motions.record import GroundMotion, UnusableRecord
from fecolumn.study.plan import read_plan

SMALL = {
    "column": {"outer_diameter_m": 0.1, "height_m": 1.0, "wall_m": 0.01},
    "base": {"length_m": 0.3, "width_m": 0.3, "thickness_m": 0.05},
}


def ensemble(n=3):
    rng = np.random.default_rng(5)
    motions = tuple(
        GroundMotion(
            np.column_stack([rng.standard_normal((400 + number, 2)), np.zeros(400 + number)]),
            0.005 + 0.001 * number,
            f"noise {number}",
            "made up",
        )
        for number in range(n)
    )
    return Ensemble(
        "noise",
        motions,
        {"pulse_period_s": np.arange(n) + 0.5},
        {"model": "noise", "seed": 5, "arguments": {"n": n}},
    )


@pytest.fixture
def stored(tmp_path):
    write_ensemble(ensemble(), tmp_path / "e.h5")
    return str(tmp_path / "e.h5")


def test_ensemble_is_read_as_it_was_written(stored):
    original, again = ensemble(), read_ensemble(stored)
    assert (again.name, again.provenance) == (original.name, original.provenance)
    assert [motion_hash(motion) for motion in again.motions] == [
        motion_hash(motion) for motion in original.motions
    ]
    assert [(motion.name, motion.source) for motion in again.motions] == [
        (motion.name, motion.source) for motion in original.motions
    ]
    assert again.parameters["pulse_period_s"].tolist() == [0.5, 1.5, 2.5]


def test_same_ensemble_gives_the_same_bytes(stored, tmp_path):
    write_ensemble(ensemble(), tmp_path / "again.h5")
    assert (tmp_path / "again.h5").read_bytes() == (tmp_path / "e.h5").read_bytes()


def test_motions_are_counted_from_one(stored):
    assert motion_hash(read_member(f"{stored}#1")) == motion_hash(ensemble().motions[0])
    assert members(f"{stored}#*") == [f"{stored}#{number}" for number in (1, 2, 3)] and members(
        "a.AT2"
    ) == ["a.AT2"]


def test_motions_beyond_9999_keep_their_order(stored):
    with h5py.File(stored, "r+") as file:
        for number in (1, 2, 3):
            file.move(f"motions/{number:04d}", f"motions/{9998 + number}")
    assert [motion.name for motion in read_ensemble(stored).motions] == [
        "noise 0",
        "noise 1",
        "noise 2",
    ]


@pytest.mark.parametrize("number", ["0", "4", "-1", "x", "1.5", ""])
def test_motion_that_the_ensemble_does_not_have_is_refused(stored, number):
    with pytest.raises(InputError, match="whole number from 1 to 3") as caught:
        read_motion(Motion(f"{stored}#{number}"), "case.toml")
    assert caught.value.key == "motion.source"


@pytest.mark.parametrize(
    "damage, said",
    [
        (lambda data: b"", "is no HDF5 file"),
        (lambda data: data[:2000], "is no HDF5 file"),
        (None, "no such file"),
    ],
)
def test_broken_files_are_refused(stored, tmp_path, damage, said):
    path = tmp_path / "broken.h5"
    if damage:
        path.write_bytes(damage((tmp_path / "e.h5").read_bytes()))
    with pytest.raises(UnusableRecord, match=said):
        read_ensemble(path)


def test_hdf5_of_something_else_is_refused(tmp_path):
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1
    with pytest.raises(UnusableRecord, match="no ensemble of motions"):
        read_ensemble(tmp_path / "other.h5")


def test_motion_of_an_ensemble_is_a_motion_of_a_case(stored, tmp_path):
    ground = load_motion(Motion(f"{stored}#2"), 0.006, "case.toml")
    assert (
        np.array_equal(ground.acceleration, ensemble().motions[1].acceleration)
        and ground.name == "noise 1"
    )
    first, same, other = (
        case_from_tables(SMALL | {"motion": {"source": f"e.h5#{number}"}}, tmp_path / "case.toml")
        for number in (1, 1, 2)
    )
    assert first.motion.source == f"{stored}#1" and first.id == same.id != other.id


def test_case_knows_when_the_ensemble_changed(stored, tmp_path):
    tables = SMALL | {"motion": {"source": "e.h5#1"}}
    before = case_from_tables(tables, tmp_path / "case.toml").id
    write_ensemble(ensemble(2), tmp_path / "e.h5")
    assert case_from_tables(tables, tmp_path / "case.toml").id != before


def test_study_takes_every_motion_of_an_ensemble(stored, tmp_path):
    (tmp_path / "case.toml").write_text(
        "".join(
            f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in table.items())
            for name, table in SMALL.items()
        )
    )
    (tmp_path / "study.toml").write_text(
        'title = "all"\ncase = "case.toml"\n[axes]\n"motion.source" = ["e.h5#*"]\n'
    )
    assert [
        analysis.case.motion.source for analysis in read_plan(tmp_path / "study.toml").analyses
    ] == [f"{stored}#{n}" for n in (1, 2, 3)]
    (tmp_path / "study.toml").write_text(
        'title = "all"\ncase = "case.toml"\n[axes]\n"motion.source" = ["gone.h5#*"]\n'
    )
    with pytest.raises(InputError, match="no such file"):
        read_plan(tmp_path / "study.toml")


def test_table_has_a_row_for_each_motion(tmp_path):
    columns = summary(ensemble())
    write_summary(ensemble(), columns, tmp_path / "e.csv")
    rows = list(csv.DictReader((tmp_path / "e.csv").open()))
    assert [row["name"] for row in rows] == ["noise 0", "noise 1", "noise 2"]
    assert [float(row["parameter_pulse_period_s"]) for row in rows] == [0.5, 1.5, 2.5]
    assert float(rows[1]["pga_m_s2"]) == pytest.approx(columns["pga_m_s2"][1], rel=1e-5)


@pytest.mark.parametrize("kind", ["csv", "at2"])
def test_text_files_are_read_back(tmp_path, kind):
    files = write_text_files(ensemble().motions, tmp_path / "text", kind)
    sources = [str(file) for file in files if file.name.startswith("0002")]
    again = read_motion(Motion(**dict(zip(("source", "source_y", "source_z"), sources))), "")
    original = ensemble().motions[1]
    assert again.acceleration == pytest.approx(
        original.acceleration, rel=1e-6, abs=1e-6
    ) and again.dt == pytest.approx(original.dt)


def test_ensemble_without_motions_or_with_odd_parameters_is_refused():
    with pytest.raises(ValueError, match="at least one"):
        Ensemble("none", (), {}, {})
    with pytest.raises(ValueError, match="pulse_period_s"):
        Ensemble("odd", ensemble().motions, {"pulse_period_s": np.zeros(2)}, {})


def test_at2_files_beside_an_ensemble_are_still_read(tmp_path):
    assert read_motion(Motion(str(write_at2(tmp_path / "a#1.AT2"))), "").dt == 0.01
