"""Programs beside each other: one ensemble for all, what is measured, and each program on it."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from benchmarks import tables
from benchmarks.peers import peer as peers
from benchmarks.planar import ensembles
from benchmarks.planar.bodies import GRAVITY
from benchmarks.planar.structures import leaning_frame
from benchmarks.programs import __main__ as command
from benchmarks.programs import analysis, structures, table, trial
from benchmarks.programs.course import Course, fed_in, in_plane, tilts, way_of_top
from benchmarks.programs.programs import BY_NAME, PLANE, PROGRAMS
from benchmarks.tables import from_markdown
from fecolumn.case.case import case_from_tables

BLOCK = structures.rigid_bodies("block")


def there(name):
    try:
        peers.version(next(one for one in peers.PEERS if one.name == name))
    except peers.Missing as error:
        pytest.skip(f"{name}: {error}")


def case_of(name, program, number, folder):
    rest, source = structures.motion_table(name, folder)
    tables = structures.case_tables(name, program.engine, program.dt)
    return case_from_tables(tables | dict(motion=rest | dict(source=f"{source}{number}")), "test")


@pytest.mark.long
@pytest.mark.parametrize("name", PLANE)
def test_every_program_has_the_motion_of_the_planar_program(name, tmp_path):
    for program in (BY_NAME["judge"], BY_NAME["mujoco-defaults"], BY_NAME["rigid"]):
        case = case_of(name, program, 7, tmp_path)
        given = ensembles.motion(structures.planar_of(name), 7, program.dt)
        ground = structures.ground_of(case, "test")
        assert ground[:, 0] == pytest.approx(given, abs=1e-9) and not ground[:, 1:].any()


def test_the_kept_settings_are_those_of_the_programs():
    kept = {row[0]: row[2:] for row in tables.read("programs_settings").rows}
    assert set(kept) == {program.label for program in PROGRAMS}
    for program in PROGRAMS:
        step, said, reason = kept[program.label]
        assert float(step) == program.dt and reason == program.reason
        assert said.startswith(program.said)


def test_bodies_of_the_block_are_those_of_its_formulas():
    width, height = structures.MONOLITH
    mass = 2500 * width * width * height
    assert BLOCK.mass == pytest.approx([mass])
    across = mass * (width**2 + height**2) / 12
    assert BLOCK.inertia[0] == pytest.approx([across, across, mass * width**2 / 6])
    rise = math.hypot(width, height) / 2 - height / 2
    assert BLOCK.barrier == pytest.approx(mass * GRAVITY * rise)


@pytest.mark.parametrize("name", structures.NAMES)
def test_package_and_peers_have_the_same_masses(name, tmp_path):
    from fecolumn.structures.structure import structure_model

    case = case_of(name, BY_NAME["rigid"], 1, tmp_path)
    parts = structure_model(case).parts
    found = sorted(part.model.mass for part in parts)
    assert found == pytest.approx(sorted(structures.rigid_bodies(name).mass), rel=1e-6)


def slid(share):
    """The block slides without friction while the ground shakes; share: of its energy that is put
    on top.
    """
    time = np.arange(0, 1, 1e-3)
    ground = np.zeros((len(time), 3))
    ground[:, 0] = 3 * np.sin(20 * time)
    speed = -3 / 20 * (1 - np.cos(20 * time))
    way = -3 / 20 * (time - np.sin(20 * time) / 20)
    zero = np.zeros_like(time)
    place = np.stack([way, zero + 0.6, zero], axis=-1)[:, None]
    velocity = np.stack([speed * np.sqrt(1 + share), zero, zero], axis=-1)[:, None]
    return Course(**in_plane(place, velocity), ground=ground, row_s=1e-3, cpu_s=1.0, steps=1)


def test_study_of_two_steps_has_the_tube_of_the_programs():
    file = Path(table.__file__).parents[1] / "decided" / "tube_steps.toml"
    study = tomllib.loads(file.read_text(encoding="utf-8"))["case"]
    motion, _ = structures.motion_table("tube", file.parent)
    assert {key: study["motion"][key] for key in motion} == motion
    given = dict(motion=dict(source="lick:1"))
    one = case_from_tables(study | given, file).tables()
    other = case_from_tables(structures.case_tables("tube", "rigid", 1e-3) | given, file).tables()
    for name in ("contact", "grounds", "joints", "overturn"):
        assert one[name] == other[name]
    bodies = one["bodies"]["column"], other["bodies"]["column"]
    for key in ("kind", "outer_diameter_m", "wall_m", "height_m", "cap", "coarse_size_m"):
        assert bodies[0][key] == bodies[1][key]
    assert other["materials"]["column"]["density_kg_m3"] == 7850  # steel, the default


def test_energy_fed_in_is_what_the_ground_has_not_done():
    rise, off = fed_in(BLOCK, slid(0.0))
    most = BLOCK.mass[0] * 0.3**2 / 2
    assert rise < 2e-4 * most and off < 2e-4 * most
    assert fed_in(BLOCK, slid(0.1))[0] == pytest.approx(0.1 * most, rel=0.02)


def test_top_and_tilt_of_a_block_that_leans():
    place = np.array([[[0.0, 0.6, -0.1]]])
    course = Course(
        **in_plane(place, np.zeros_like(place)),
        ground=np.zeros((1, 3)),
        row_s=1e-3,
        cpu_s=1.0,
        steps=1,
    )
    assert tilts(course)[0, 0] == pytest.approx(0.1)
    assert way_of_top(BLOCK, course)[0] == pytest.approx([0.6 * math.sin(0.1), 0.0])


@pytest.mark.long
def test_planar_program_and_housner_agree_and_what_is_done_is_kept(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(tables, "FOLDER", tmp_path / "tables")
    given = ["--structure", "block", "--program", "housner", "judge", "--motions", "2"]
    given += ["-o", str(tmp_path), "-j", "1"]
    assert command.main(given) == 0
    results, settings, pairs = from_markdown(capsys.readouterr().out)
    rows = [dict(zip(results[0], row)) for row in results[1:]]
    assert [row["structure and program"] for row in rows] == [
        "block: Housner's block, exact",
        "block: planar program",
    ]
    assert rows[0]["overturned"] == rows[1]["overturned"] and rows[0]["motions"] == "2"
    assert float(rows[1]["energy fed in, median [%]"]) < 0.05
    assert len({row[0] for row in settings[1:]}) == 2
    assert [row[:2] for row in pairs[1:]] == [
        ["block: Housner's block, exact and planar program", "2"]
    ]
    files = sorted(tmp_path.rglob("summary.json"))
    before = [file.stat().st_mtime_ns for file in files]
    assert len(files) == 4 and command.main(given) == 0
    assert [file.stat().st_mtime_ns for file in files] == before
    capsys.readouterr()
    assert command.main([*given, "--report", "--keep"]) == 0
    said = capsys.readouterr().out
    assert command.main([*given[:-3], str(tmp_path / "elsewhere")]) == 0
    assert capsys.readouterr().out == said and not (tmp_path / "elsewhere").exists()


@pytest.mark.parametrize("name", ["mujoco", "siconos"])
def test_peer_lets_the_trilith_go_as_the_planar_program(name):
    there(name)
    structure, bodies = (
        structures.planar_of("trilith").structure,
        structures.rigid_bodies("trilith"),
    )
    place = leaning_frame(structure, 0.4 * bodies.critical)
    still = np.zeros((8001, 3))
    exact = way_of_top(bodies, analysis.by_judge("trilith", still, 1e-4, place=place))[:, 0]
    begin = dict(place=place) if name == "siconos" else dict(start=trial.start_of(place))
    program = BY_NAME[name]
    course = analysis.RUNS[name]("trilith", still, 1e-4, program.settings, **begin)
    assert np.abs(way_of_top(bodies, course)[:, 0] - exact).max() < 0.01 * np.abs(exact).max()
    assert course.steps == 8000 and 0 < course.cpu_s < 60


@pytest.mark.parametrize("name", ["mujoco", "siconos"])
def test_peer_lets_the_tube_swing_as_its_closed_form(name):
    """Let go from a small tilt: over a tenth of a second the tilt falls as
    alpha - (alpha - tilt) cosh(p t).
    """
    there(name)
    bodies = structures.rigid_bodies("tube")
    radius, centre = bodies.sizes[0, 0], bodies.place[0, 2]
    tilt, arm = 0.4 * bodies.critical, math.hypot(radius, centre)
    about = bodies.inertia[0, 1] + bodies.mass[0] * arm**2
    p = math.sqrt(bodies.mass[0] * GRAVITY * arm / about)
    place = [[radius - arm * math.sin(bodies.critical - tilt), 0.0]]
    place[0].append(arm * math.cos(bodies.critical - tilt))
    turn = [[math.cos(tilt / 2), 0.0, math.sin(tilt / 2), 0.0]]
    still = np.zeros((1001, 3))
    start = np.array(place), np.array(turn)
    chosen = BY_NAME["siconos-tube" if name == "siconos" else name].settings
    course = analysis.RUNS[name]("tube", still, 1e-4, chosen, start=start)
    time = 1e-3 * np.arange(len(course.place))
    exact = bodies.critical - (bodies.critical - tilt) * np.cosh(p * time)
    assert tilts(course)[:, 0] == pytest.approx(exact, abs=2e-3 * tilt)


def runs(peaks, fallen):
    return {
        number: dict(
            u_max_m=peak,
            overturned=number in fallen,
            fed_in=1e-3 * number,
            energy_closure_rel=1e-4,
            cpu_s=2.0,
            unsolved=1,
        )
        for number, peak in enumerate(peaks)
    }


def test_table_sets_each_program_beside_the_reference():
    found = dict(block=dict(judge=runs([0.01] * 4, {3}), mujoco=runs([0.02] * 4, {2, 3})))
    text = table.tables(found, dict(block="judge"), dict(judge="1", mujoco="4.0.0"))
    head, judge, mujoco = from_markdown(text)[0]
    assert len(judge) == len(mujoco) == len(head)
    row = dict(zip(head, mujoco))
    assert row["overturn here alone"] == "1" and row["in the reference alone"] == "0"
    assert row["D"] == "0.750" and row["peaks off, median"] == "1"
    assert row["energy fed in, median [%]"] == "0.15" and row["most [%]"] == "0.3"
    assert judge[head.index("D")] == "-" and "block: planar program" in text
    assert [line[0] for line in from_markdown(text)[1]][1:] == ["planar program", "MuJoCo, best"]
    pair = dict(zip(*from_markdown(text)[2]))
    assert pair["motions"] == "4" and pair["D"] == "0.750"
    assert [pair["overturned in the first"], pair["in the second"]] == ["1", "2"]
    assert [pair["in the first alone"], pair["in the second alone"]] == ["0", "1"]


def test_settings_are_named_once_and_full_order_runs_where_it_is_named():
    labels = [program.label for program in PROGRAMS]
    assert len(set(labels)) == len(labels) and all(one.reason for one in PROGRAMS)
    assert "full" not in command.arguments([]).program
    assert command.arguments(["--program", "full"]).program == ["full"]


def test_peer_that_is_missing_is_said_and_left_out(monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "nowhere"))
    assert list(command.versions(["judge", "mujoco"])) == ["judge"]
    assert "MuJoCo, best is left out: cannot run" in capsys.readouterr().err


def test_other_settings_have_another_folder(tmp_path):
    best, defaults = (command.folder_of(BY_NAME[one], tmp_path) for one in ("mujoco", "siconos"))
    assert best != defaults and best == command.folder_of(BY_NAME["mujoco"], tmp_path)


def test_rows_that_come_with_the_repository_are_of_these_scripts_and_settings():
    names = {
        command.kept_name(structure, program)
        for program in PROGRAMS
        for structure in program.structures
    }
    kept = {f"programs/{file.stem}" for file in (tables.FOLDER / "programs").glob("*.csv")}
    assert kept and kept <= names, "others are of older scripts: run their programs again"
    assert all(tables.read(name).current for name in kept)


def test_history_of_the_package_tells_what_contact_fed_in(tmp_path):
    import h5py

    with h5py.File(tmp_path / "history.h5", "w") as file:
        for term, values in (
            ("kinetic", [0.0, 2.0, 1.0, 1.5]),
            ("strain", [0.0] * 4),
            ("gravity", [1.0] * 4),
            ("base_work", [0.0, 2.0, 2.0, 2.0]),
        ):
            file[f"energy/{term}"] = values
    assert table.fed_in_of_history(tmp_path / "history.h5", 5.0) == pytest.approx(0.1)
    assert math.isnan(table.fed_in_of_history(tmp_path / "none.h5", 5.0))


def test_kept_rows_of_peers_are_reported_without_the_peers(monkeypatch):
    def missing(_):
        raise peers.Missing("is not installed")

    monkeypatch.setattr(peers, "version", missing)
    assert command.versions(["mujoco", "rigid"], report=True).keys() == {"mujoco", "rigid"}
    assert command.versions(["mujoco", "rigid"]).keys() == {"rigid"}
