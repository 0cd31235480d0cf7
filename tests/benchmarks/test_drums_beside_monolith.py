"""The benchmark of fragilities: motions, structures, and what it tells of rows that are known."""

import numpy as np
import pytest

from benchmarks import tables
from benchmarks.fragility import velocity_classes
from benchmarks.fragility.__main__ import main
from benchmarks.fragility.check import HEAD, line
from benchmarks.fragility.motions import PGV, drawn_motion, ensemble_file, parameters, peak_velocity
from benchmarks.fragility.report import (
    beside,
    half_intervals,
    half_lost,
    lost,
    markdown,
    pairs_of,
    surface,
)
from benchmarks.fragility.run import kept_name
from benchmarks.fragility.structures import COLUMN, NAMES, case_of
from benchmarks.tables.runs import read_runs, write_runs
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.store import FAILED


def test_a_motion_depends_on_its_number_alone_and_has_its_drawn_peak_velocity(tmp_path):
    motion, drawn = drawn_motion(3)
    again = parameters(ensemble_file(tmp_path, 3))
    assert again["pgv_m_s"][2] == pytest.approx(drawn["pgv_m_s"])
    assert peak_velocity(motion) == pytest.approx(drawn["pgv_m_s"])
    assert PGV[0] <= drawn["pgv_m_s"] <= PGV[1]
    other, _ = drawn_motion(3, seed=2)
    assert len(other.acceleration) != len(motion.acceleration)


@pytest.mark.parametrize("name", NAMES)
def test_structures_have_their_bodies_and_one_height(name):
    case = case_of(name, dict(integration=dict(duration_s=1.0)))
    assert case.integration.engine == ("reduced" if name.startswith("elastic") else "rigid")
    if "frame" in name or "trilith" in name:
        assert set(case.bodies) == {"column", "slab"}
        assert case.bodies["column"].copies_m and case.bodies["column"].height_m == COLUMN[1]
        return
    drum = case.bodies["drum"]
    assert drum.height_m * len(drum.copies_m) == pytest.approx(COLUMN[1])
    assert drum.outer_diameter_m == COLUMN[0]


def rows_of(structure, half, count=400, seed=1):
    """Rows whose P(lost) is Phi(3 ln(PGV / half)), half of it at a pulse of 1 s, less at longer."""
    random = np.random.default_rng(seed)
    rows = []
    for number in range(1, count + 1):
        pgv, period = np.exp(random.uniform(np.log(0.15), np.log(2.5))), random.uniform(0.5, 4.0)
        lost = random.normal() < 3 * np.log(pgv / (half * period**-0.5))
        rows.append(
            dict(
                structure=structure,
                motion=number,
                pgv_m_s=pgv,
                pulse_period_s=period,
                outcome="overturned" if lost else "still rocking",
                shift_m=0.01 * pgv,
                cpu_s=1.0,
            )
        )
    return rows


def test_the_surface_finds_the_pgv_that_loses_half():
    fit = surface(rows_of("monolith", 0.8))
    assert half_lost(fit, [1.0, 2.0]) == pytest.approx([0.8, 0.8 / np.sqrt(2)], rel=0.12)
    assert surface([row | dict(outcome="at rest") for row in rows_of("monolith", 0.8)]) is None
    assert np.isnan(half_lost(np.array([0.0, -1.0, 0.0, 0.0]), 1.0))


def test_pairs_are_counted_in_the_same_motions():
    one = [dict(motion=n, outcome=word) for n, word in enumerate(["overturned"] * 6 + ["at rest"])]
    other = [dict(motion=n, outcome="at rest") for n in range(6)]
    other += [dict(motion=6, outcome=FAILED)]
    assert beside(one, other) == [6, 6, 0, f"{2 / 2**6:.2g}"]
    assert pairs_of(["monolith", "2 drums", "trilith", "elastic trilith"]) == [
        ("monolith", "2 drums"),
        ("trilith", "elastic trilith"),
    ]


def test_tables_tell_shares_shifts_and_failures():
    rows = rows_of("monolith", 0.8)
    rows[0]["outcome"] = FAILED
    said = markdown({"monolith": rows, "2 drums": rows_of("2 drums", 1.2)})
    lost = sum(row["outcome"] == "overturned" for row in rows[1:])
    assert f"| monolith | 399 | {lost / 399:.3f} |" in said and "| 1 | 1.00 |" in said
    assert "| monolith and 2 drums | 399 |" in said


def test_shares_and_shifts_by_pgv():
    """Seven of ten in the weakest class at rest, all of the strongest lost, none in between."""
    rows = [dict(pgv_m_s=0.2, outcome="overturned" if n < 3 else "at rest") for n in range(10)]
    rows += [dict(pgv_m_s=pgv, outcome="slid off") for pgv in (1.2, 2.5)]
    rows = [row | dict(shift_m=0.01 * n) for n, row in enumerate(rows)]
    line = velocity_classes.table({"block": rows}, lost).splitlines()[-1]
    low, high = proportion_interval(3, 10)
    weak = f"0.300 ({low:.3f} to {high:.3f}; 10)"
    low, high = proportion_interval(2, 2)
    assert f"| block | {weak} | - | - | 1.000 ({low:.3f} to {high:.3f}; 2) | 0.06 | - |" in line


@pytest.mark.long
def test_two_motions_of_a_monolith_are_kept_and_told(tmp_path, capsys, monkeypatch):
    """Motions of few seconds; the command tells them again without computing, from its folder or
    from the rows that come with the repository.
    """
    monkeypatch.setattr(tables, "FOLDER", tmp_path / "tables")
    command = ["monolith", "-n", "2", "-j", "1", "-o"]
    here, elsewhere = str(tmp_path / "here"), str(tmp_path / "elsewhere")
    assert main([*command, here, "--report"]) == 0
    assert "| monolith | 0 |" in capsys.readouterr().out
    assert main([*command, here]) == 0
    said = capsys.readouterr().out
    assert "| monolith | 2 | 0.000 |" in said
    assert main([*command, here, "--report", "--keep"]) == 0
    assert capsys.readouterr().out == said
    assert (tmp_path / "here/fragility.png").stat().st_size > 10_000
    assert main([*command, elsewhere]) == 0
    assert capsys.readouterr().out.replace("elsewhere", "here") == said
    assert not list(tmp_path.glob("**/history.h5"))
    assert not list(tmp_path.glob("elsewhere/**/summary.json"))
    with pytest.raises(SystemExit):
        main(["9 drums"])
    with pytest.raises(SystemExit):
        main([*command, here, "--dt", "1e-3", "--keep"])


def test_rows_that_come_with_the_repository_are_of_these_structures_and_physics():
    kept = {f"fragility/{file.stem}" for file in (tables.FOLDER / "fragility").glob("*.csv")}
    assert kept and kept <= {kept_name(name) for name in NAMES}
    assert all(tables.read(name).current for name in kept)
    drawn = drawn_motion(7)[1]
    row = read_runs(kept_name("monolith"))[7]
    assert {key: row[key] for key in drawn} == pytest.approx(drawn)


def test_rows_of_other_physics_are_not_taken(tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "FOLDER", tmp_path)
    runs = {2: dict(u=0.25, lost=True, word="at rest", none=None), 1: dict(u=1e-9, lost=False)}
    runs[1] |= dict(word="overturned", none=3)
    write_runs("set/one", runs, "T.", "python -m x")
    assert read_runs("set/one") == runs and read_runs("set/other") == {}
    write_runs("set/one", {1: runs[1]}, "T.", "python -m x")  # of fewer motions
    assert read_runs("set/one") == runs
    write_runs("set/one", runs, "T.", "python -m x", physics="none")
    assert read_runs("set/one") == runs
    write_runs("set/one", runs, "T.", "python -m x", physics=1)
    assert read_runs("set/one") == {}


def test_the_header_names_the_machines_of_all_rows(tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "FOLDER", tmp_path)

    def machines(runs, here):
        monkeypatch.setattr(tables, "this_machine", lambda: here)
        write_runs("set", runs, "T.", "python -m x")
        return tables.read("set").about["machine"]

    first = {1: dict(u=0.1), 2: dict(u=1 / 3)}
    assert machines(first, "A, 2 cores") == "A, 2 cores"
    assert machines(first | {3: dict(u=0.3)}, "B, 2 cores") == "A, 2 cores; B, 2 cores"
    assert machines({4: dict(u=0.4)}, "A, 2 cores") == "A, 2 cores; B, 2 cores"
    again = {motion: dict(u=0.5 + motion) for motion in (1, 2, 3, 4)}
    assert machines(again, "C, 2 cores") == "C, 2 cores"
    write_runs("rows/one", first, "T.", "python -m x", machines=("B, 2 cores", "A, 2 cores"))
    write_runs("rows/two", again, "T.", "python -m x")
    assert tables.machines_of("rows") == ("B, 2 cores", "A, 2 cores", "C, 2 cores")


def test_the_pgv_that_loses_half_lies_within_its_interval():
    """Half are lost at 0.8 m/s and a pulse of 1 s, so at 0.8 / sqrt(T) at a period T."""
    found = half_intervals(rows_of("4 drums", 0.8, 300))
    for (value, interval), period in zip(found, (0.7, 1.5, 3.0)):
        low, high = map(float, interval.split(" to "))
        assert low < float(value) < high < 2 * low
        assert low < 0.8 * period**-0.5 < high


def test_a_check_tells_whose_fate_it_changes():
    before = rows_of("4 drums", 0.8, 50)
    after = [dict(row) for row in before]
    stands = next(row for row in after if row["outcome"] == "still rocking")
    stands |= dict(outcome="overturned")
    another = [row for row in after if row["outcome"] == "still rocking"][:2]
    another[0] |= dict(outcome="at rest", shift_m=2 * another[0]["shift_m"])
    another[1] |= dict(outcome=FAILED)
    told = dict(zip(HEAD, line("4 drums, a change", before, after)))
    assert told["motions"] == 49
    assert told["lost with the change"] == told["lost before"] + 1
    assert (told["lost before alone"], told["lost with it alone"]) == (0, 1)
    assert told["still rocking before"] == told["still rocking with it"] + 2
    assert told["shift that differs by more than a tenth"] == 1
