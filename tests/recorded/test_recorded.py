"""Histories keep to the record within 1e-9 of each column's peak, until the third impact; on
another processor within 1e-6. See recording.py. Cases that are not quick are of the verification
suite.
"""

import dataclasses
import os

import numpy as np
import pytest
import recording

from fecolumn.case.case import case_from_tables
from fecolumn.case.short_form import ShortForm
from fecolumn.foundation.schema import build

CASES = recording.cases()
HISTORIES, ABOUT = recording.read()
# What the cases cover together
FEATURES = {
    "column",
    "structure",
    "model",
    "full",
    "reduced",
    "rigid",
    "housner",
    "wobbling",
    "plate",
    "unbounded",
    "pad",
    "penalty",
    "restitution",
    "rolling resistance",
    "tendon",
    "spring",
    "dashpot",
    "restrainer",
    "dome",
    "found contact",
    "rounded edge",
    "storeys",
    "MPI",
    "shaken",
    "release",
    "own mesh",
    "total Lagrangian",
    "literal HHT",
}
# Keys that every case of finite elements states, whatever their defaults are in either form
STATED = {
    "integration": (
        "engine",
        "n_modes",
        "dt_s",
        "alpha_hht",
        "kinematics",
        "substeps",
        "tolerance",
        "max_iterations",
        "max_cuts",
    ),
    "contact": (
        "law",
        "friction_coefficient",
        "penalty_factor",
        "interior_points",
        "impact",
        "restitution",
        "rolling_resistance",
    ),
}
# Keys of bodies and interfaces that follow from others where they are left out
FOLLOW = {
    "bodies": ("modes", "element_size_m", "coarse_size_m", "element_order"),
    "joints": ("allowance_m",),
}


MARKED = [
    pytest.param(name, marks=() if case.quick else pytest.mark.verification)
    for name, case in CASES.items()
]


@pytest.mark.parametrize("name", MARKED)
def test_history_is_the_recorded_one(name):
    assert os.environ["OMP_NUM_THREADS"] == "1", "records are of one thread: OMP_NUM_THREADS=1"
    lines = recording.told(
        name, HISTORIES[name], recording.history(CASES[name]), recording.tolerance_here(ABOUT[name])
    )
    assert not lines, "\n" + "\n".join(lines)


def test_record_has_every_case_and_the_cases_cover_every_feature():
    assert set(HISTORIES) == set(CASES) == set(ABOUT) and len(CASES) >= 40
    assert {feature for case in CASES.values() for feature in case.covers} >= FEATURES
    assert recording.RECORD.stat().st_size < 1e6


@pytest.mark.parametrize("name", CASES)
def test_case_states_what_defaults_decide(name):
    tables = CASES[name].tables
    if "model" in CASES[name].covers:
        return
    missing = [
        f"{section}.{key}"
        for section, keys in STATED.items()
        for key in keys
        if key not in tables[section]
    ]
    case = case_from_tables(tables, recording.CASES[0])
    if "column" in tables:
        open_case = build(ShortForm, tables, recording.CASES[0])
        for section in (
            ("base", "mesh") if case.short.column.mesh_file else ("column", "base", "mesh")
        ):
            whole, left = (
                dataclasses.asdict(getattr(one, section)) for one in (case.short, open_case)
            )
            missing += [f"{section}.{key}" for key in whole if whole[key] != left[key]]
    else:
        missing += [
            f"{section}.{part}.{key}"
            for section, keys in FOLLOW.items()
            for part, one in getattr(case, section).items()
            for key in keys
            if getattr(one, key, 0) is None and not _in_file(one, key)
        ]
    assert not missing


def _in_file(body, key: str) -> bool:
    """Whether a key of a body is an element size, which the body's mesh file has."""
    return getattr(body, "kind", "") == "mesh" and key.endswith("_m")


def test_a_history_that_is_off_is_told_with_case_column_difference_and_time():
    name = next(iter(CASES))
    history = HISTORIES[name]
    assert not recording.told(name, history, history)
    middle = len(history["time"]) // 2
    later = np.arange(len(history["time"])) >= middle
    moved = 1.5e-9 * np.linalg.norm(history["u_top"], axis=1).max() * later[:, None]
    off = history | {"u_top": history["u_top"] + moved}
    (line,) = recording.told(name, history, off)
    assert line.startswith(f"{name}: u_top is off by 1.5e-09 of its peak")
    assert f"from {history['time'][middle]:.4g} s on" in line
    ends = {column: values[:middle] for column, values in history.items()}
    assert len(recording.told(name, history, ends)) == len(history)
    without = {column: values for column, values in history.items() if column != "tilt"}
    (line,) = recording.told(name, history, without)
    assert f"{name}: tilt is off by inf" in line
