"""The pace of an analysis is told once it is known, with keys that make it cheaper; slow steps say
why.
"""

import json
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.cli import main
from fecolumn.engines import pace as paces
from fecolumn.engines.dynamics.record import Record
from fecolumn.engines.pace import PACE_FILE, Pace, cheaper, contact_points_of
from fecolumn.foundation.toml_file import merge, nested
from fecolumn.simulation import run

BLOCK = {
    "column": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 1.2},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700},
    "mesh": {"fine_size_m": 0.1, "coarse_size_m": 0.2, "base_size_m": 0.2},
    "initial": {"tilt_rad": 0.05, "direction_deg": 0.0},
    "integration": {"engine": "reduced", "duration_s": 0.2, "dt_s": 1e-3},
    "output": {"states_every_s": 0.0},
}


def _case(*changes):
    tables = BLOCK
    for key, value in changes:
        tables = merge(tables, nested(key, value))
    return case_from_tables(tables, "case")


def _running(tmp_path, steps=10_000, motion_steps=0, until_rest=False):
    """An analysis of two joints whose clock is set by the test."""

    def part(nodes):
        surface = SimpleNamespace(nodes=np.arange(nodes))
        return SimpleNamespace(model=SimpleNamespace(surfaces={"foot": surface}))

    def joint(name, slave, pair=-1):
        return SimpleNamespace(name=name, slave=slave, slave_surface="foot", pair=pair)

    joints = (joint("feet", 0), joint("head", 1), joint("head, other side", 0, pair=1))
    last = {"time": 0.5, "active_nodes": 13}
    last |= {"interface/feet/force": 1.0, "interface/head/force": 0.0}
    return SimpleNamespace(
        case=_case(),
        structure=SimpleNamespace(parts=(part(12), part(30)), joints=joints),
        comm=SimpleNamespace(rank=0),
        folder=tmp_path,
        history=SimpleNamespace(last=lambda: last),
        step=0,
        steps=1 + steps,
        motion=None,
        motion_steps=1 + motion_steps,
        until_rest=until_rest,
        stepping_s=0.0,
        step_times=None,
        made_in_s=lambda: 0.0,
    )


def _begun(analysis, said):
    """The pace of an analysis whose first step is made, which compiled for half a minute."""
    pace = Pace(analysis, said.append, Record())
    assert pace.chunk(500) == 5 and pace.chunk(3) == 3
    _go(analysis, pace, 0, 0.0)
    return pace


def _go(analysis, pace, step, stepping_s, **record):
    """So many steps after the first, and so much later [s]."""
    analysis.step, analysis.stepping_s = 1 + step, 30.0 + stepping_s
    pace.look(Record(**record))


def test_looks_come_as_often_as_steps_are_slow(tmp_path):
    analysis = _running(tmp_path)
    pace = _begun(analysis, [])
    _go(analysis, pace, 20, 20e-6)
    assert pace.chunk(500) == 500
    _go(analysis, pace, 22, 2.0)
    assert pace.chunk(500) == 1


def test_the_time_left_is_told_once_after_a_second_of_steps(tmp_path):
    said = []
    analysis = _running(tmp_path)
    pace = _begun(analysis, said)
    _go(analysis, pace, 50, 0.5)
    assert not said and not (tmp_path / PACE_FILE).exists()
    _go(analysis, pace, 100, 1.0)
    _go(analysis, pace, 300, 3.0)
    (words,) = said
    assert words.startswith("100 steps took 10 ms each: about 1 min 39 s for the rest; 54 contact")
    assert "contact.interior_points = 9" in words and "fecolumn cost" in words
    kept = json.loads((tmp_path / PACE_FILE).read_text())
    assert kept["whole_s"] == pytest.approx(100.0, rel=1e-3) and kept["cheaper"] in words
    pace.end()
    assert not (tmp_path / PACE_FILE).exists()


def test_a_rest_of_seconds_is_not_told_and_one_until_rest_has_two_ends(tmp_path):
    said = []
    analysis = _running(tmp_path, steps=300)
    pace = _begun(analysis, said)
    _go(analysis, pace, 100, 1.0)
    assert not said and not (tmp_path / PACE_FILE).exists()
    analysis = _running(tmp_path, steps=4000, motion_steps=2000, until_rest=True)
    pace = _begun(analysis, said)
    _go(analysis, pace, 100, 1.0)
    assert "about 19 s to the end of the motion, 39 s at most until at rest" in said[0]
    assert json.loads((tmp_path / PACE_FILE).read_text())["whole_s"] == pytest.approx(
        20.0, rel=1e-3
    )


def test_the_time_left_is_told_again_where_it_has_become_much_longer(tmp_path):
    said = []
    analysis = _running(tmp_path, steps=10_000, motion_steps=10_000)
    quiet = np.full((10_001, 3), 0.1)
    quiet[5000] = 2.0
    analysis.motion = SimpleNamespace(acceleration=quiet)
    pace = _begun(analysis, said)
    _go(analysis, pace, 1000, 1.0)  # 1 ms
    (words,) = said
    assert words.startswith("1,000 steps took 1 ms each: about 9 s for the rest, more when bodies")
    assert words.endswith("moved by 0.1 m/s2 so far, later by 2") and "cheaper" not in words
    _go(analysis, pace, 2000, 3.0)
    _go(analysis, pace, 2500, 6.1)  # 3.4 ms: 25 s are left
    assert len(said) == 1
    _go(analysis, pace, 5100, 40.0)  # 13 ms
    assert len(said) == 2 and said[1].startswith("the last 2,600 steps took 13 ms each:")
    assert (
        "about 1 min 04 s for the rest, if all take as long; 54 contact points; cheaper may be"
        in said[1]
    )
    _go(analysis, pace, 5200, 43.0)  # 30 ms, of too few steps
    _go(analysis, pace, 5500, 47.0)  # 18 ms: 1 min 19 s
    assert len(said) == 2


def test_slow_steps_say_which_joint_and_how_many_iterations(tmp_path):
    said = []
    analysis = _running(tmp_path, steps=20)
    pace = _begun(analysis, said)
    _go(analysis, pace, 10, 0.4, iterations=20)  # 40 ms
    assert not said
    spent = dict(iterations=50, contact_iterations=200, impacts=5, impact_iterations=100)
    _go(analysis, pace, 14, 0.72, **spent)
    (words,) = said
    assert words == (
        'steps take 80 ms each around t = 0.500 s: joint "feet" has 12 of 54 contact points, '
        "13 carry in all, 7.5 iterations, 50 of contact problems, 1.25 impacts with 25 iterations "
        "a step"
    )
    _go(analysis, pace, 17, 1.0)  # 93 ms: hardly slower
    _go(analysis, pace, 19, 1.4)  # 200 ms
    assert len(said) == 2 and "200 ms" in said[1]


def test_one_slow_step_alone_is_not_told(tmp_path):
    said = []
    analysis = _running(tmp_path, steps=5)
    pace = _begun(analysis, said)
    _go(analysis, pace, 1, 4.0)
    _go(analysis, pace, 2, 4.01)
    assert not said
    _go(analysis, pace, 3, 4.2)
    _go(analysis, pace, 4, 4.4)
    assert len(said) == 1 and "195 ms" in said[0]


def test_points_of_both_sides_are_those_of_one_joint(tmp_path):
    points = contact_points_of(_running(tmp_path).structure)
    assert points == {"feet": 12, "head": 30 + 12}


@pytest.mark.parametrize(
    "changes, keys",
    [
        ([], ["interior_points", "integration.n_modes", "integration.engine", "integration.dt_s"]),
        (
            [("contact.interior_points", 4), ("integration.n_modes", 3)],
            ["integration.engine", "integration.dt_s"],
        ),
        ([("integration.engine", "rigid")], ["interior_points", "integration.dt_s"]),
        (
            [("integration.engine", "full"), ("contact.interior_points", 9)],
            ["integration.engine", "integration.dt_s"],
        ),
    ],
)
def test_keys_that_are_named_can_be_set(changes, keys):
    case = _case(*changes)
    found = cheaper(case)
    assert list(found) == keys
    for one in found.values():
        assert case.replace(one).id != case.id


@pytest.mark.parametrize(
    "dt, duration, named", [(0.05, 1.0, True), (0.06, 1.0, False), (0.05, 0.06, False)]
)
def test_a_longer_step_is_named_where_it_may_be_stated(dt, duration, named):
    case = _case(("integration.dt_s", dt), ("integration.duration_s", duration))
    assert ("integration.dt_s" in cheaper(case)) == named


def test_joints_with_points_of_their_own_are_named(tmp_path):
    stone = dict(youngs_modulus_pa=50e9, density_kg_m3=2700.0, element_size_m=0.2)
    block = dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.8) | stone
    tables = dict(
        bodies=dict(low=block, high=block | dict(at_m=[0, 0, 0.8])),
        joints=dict(
            foot=dict(between=["low", "ground"], interior_points=25),
            bed=dict(between=["high", "low"]),
        ),
        contact=dict(friction_coefficient=0.7, interior_points=16),
        integration=dict(duration_s=0.1, dt_s=1e-3),
    )
    case = case_from_tables(tables, "case")
    changes = cheaper(case)["interior_points"]
    assert changes == {"joints.foot.interior_points": 9, "contact.interior_points": 9}
    fewer = case.replace(changes)
    assert fewer.joints["foot"].interior_points == fewer.contact.interior_points == 9


def test_a_history_does_not_depend_on_how_often_it_was_looked_at(tmp_path, monkeypatch):
    run(_case(), tmp_path / "often", quiet=True)
    monkeypatch.setattr(paces.Pace, "chunk", lambda self, most: 3)
    run(_case(), tmp_path / "seldom", quiet=True)
    with (
        h5py.File(tmp_path / "often" / "history.h5") as often,
        h5py.File(tmp_path / "seldom" / "history.h5") as seldom,
    ):
        assert np.array_equal(often["u_top"][:], seldom["u_top"][:])
        assert np.array_equal(often["energy/kinetic"][:], seldom["energy/kinetic"][:])
    assert not (tmp_path / "often" / PACE_FILE).exists()


def test_cost_measures_the_case_and_what_makes_it_cheaper(tmp_path, capsys):
    file = tmp_path / "block.toml"
    file.write_text(
        'column.shape = "block"\ncolumn.length_m = 0.4\ncolumn.width_m = 0.4\n'
        "column.height_m = 1.2\nmaterial.youngs_modulus_pa = 50e9\n"
        "material.density_kg_m3 = 2700\nmesh.fine_size_m = 0.1\nmesh.coarse_size_m = 0.2\n"
        "mesh.base_size_m = 0.2\ninitial.tilt_rad = 0.05\nintegration.duration_s = 0.5\n"
        "integration.dt_s = 1e-3\n"
    )
    assert main(["cost", str(file), "--seconds", "0.1"]) == 0
    told = capsys.readouterr()
    lines = told.out.splitlines()
    assert lines[0].split()[:4] == ["setting", "ms", "a", "step"] and len(lines) == 6
    assert lines[1].startswith("as it is") and lines[1].split()[-3] == "1"
    for line, key in zip(lines[2:], ("contact.interior_points = 9", "n_modes", "engine", "dt_s")):
        assert key in line and line.endswith(" mm")
    assert told.err.count("measuring: ") == 5
    assert [one.name for one in tmp_path.iterdir()] == ["block.toml"]


def test_cost_measures_where_the_motion_is_strong(tmp_path, capsys):
    """A block stands through a quiet minute, then a sine lifts it."""
    times = np.arange(0.0, 64.0, 0.01)
    ground = np.where(times < 60.0, 0.01, 6.0) * np.sin(2 * np.pi * 2.0 * times)
    rows = [f"{t:.2f},{a:.5f}" for t, a in zip(times, ground)]
    (tmp_path / "ground.csv").write_text("\n".join(["time [s],ax [m/s2]", *rows]))
    file = tmp_path / "case.toml"
    file.write_text(
        """
        column = { shape = "block", length_m = 0.4, width_m = 0.4, height_m = 1.2 }
        material = { youngs_modulus_pa = 50e9, density_kg_m3 = 2700 }
        mesh = { fine_size_m = 0.1, coarse_size_m = 0.2, base_size_m = 0.2 }
        motion.source = "ground.csv"
        integration = { engine = "rigid", dt_s = 1e-3 }
        """
    )
    assert main(["cost", str(file), "--seconds", "0.1"]) == 0
    quiet, head, row = capsys.readouterr().out.splitlines()[:3]
    assert quiet.startswith("a step of the quiet first 60.") and " ms; then, where" in quiet
    assert head.endswith(" s of it") and row.startswith("as it is")
    assert float(row.split()[-2]) > 10.0  # mm: it rocks


@pytest.mark.parametrize(
    "text, options, told",
    [
        ("", ["--seconds", "0"], "--seconds = 0.0: must lie between 0.1 and 3600"),
        ("", ["--seconds", "nan"], "--seconds = nan: must lie between 0.1 and 3600"),
        (
            'integration.engine = "housner"\n',
            [],
            "integration.engine = 'housner': is a model of rigid bodies",
        ),
        ("", [], "integration.duration_s = 0: must be greater than 0 s"),
    ],
)
def test_what_has_no_cost_to_measure_is_one_line(tmp_path, capsys, text, options, told):
    file = tmp_path / "block.toml"
    file.write_text(
        text + 'column.shape = "block"\ncolumn.length_m = 0.4\ncolumn.width_m = 0.4\n'
        "column.height_m = 1.2\nmaterial.youngs_modulus_pa = 50e9\n"
        "material.density_kg_m3 = 2700\ninitial.tilt_rad = 0.05\n"
    )
    assert main(["cost", str(file), *options]) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1
