"""Studies until their question is decided: what comes with the repository is not computed again."""

from pathlib import Path

import pytest

from benchmarks import tables
from benchmarks.decided import __main__ as decided
from benchmarks.tables.study_rows import OUTCOME, keep_rows, kept_rows, number_of
from fecolumn.study.plan import read_plan
from fecolumn.study.sequential import Rule, until_decided
from fecolumn.study.store import DONE

CASE = Path(__file__).parents[2] / "meshes" / "stout.toml"


@pytest.fixture
def plan(tmp_path):
    names = ", ".join(f'"lick:{number}"' for number in range(1, 116))
    (tmp_path / "two.toml").write_text(
        f'title = "Two steps"\ncase = "{CASE}"\n[axes]\n"motion.source" = [{names}]\n'
        '"integration.dt_s" = [1e-3, 1e-4]\n'
    )
    return read_plan(tmp_path / "two.toml")


def peak(analysis):
    """Motion by motion larger; one in four is lost at 1e-3 s, one in two at 1e-4 s."""
    number = number_of(analysis.values)
    often = 4 if analysis.values["integration.dt_s"] == 1e-3 else 2
    return {
        "u_max_m": number / 1000,
        "overturned": number % often == 0,
        "slid_off": False,
        "cpu_s": 1.0,
    }


@pytest.fixture
def rows(plan):
    return [{"id": one.id, "state": DONE, "summary": peak(one)} for one in plan.analyses]


def test_rows_that_are_kept_are_those_that_were_computed(plan, rows, tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "FOLDER", tmp_path)
    assert kept_rows("decided/two", plan) == {}
    half = [
        row | {"state": "planned", "summary": None} if n % 2 else row for n, row in enumerate(rows)
    ]
    keep_rows("decided/two", plan, half, "none")
    assert len(kept_rows("decided/two", plan)) == len(rows) // 2
    keep_rows("decided/two", plan, rows[len(rows) // 2 :], "none")
    keep_rows("decided/two", plan, rows, "none")
    kept = kept_rows("decided/two", plan)
    wanted = {row["id"]: {key: row["summary"][key] for key in OUTCOME} for row in rows}
    assert {name: row["summary"] for name, row in kept.items()} == wanted
    assert sorted(file.name for file in (tmp_path / "decided").glob("*.csv")) == [
        "two-0.0001.csv",
        "two-0.001.csv",
    ]


def test_table_tells_the_motions_by_which_a_pair_is_judged(plan, rows):
    looks = list(until_decided(plan, Rule(), lambda _: rows))
    motions, verdicts, _ = looks[-1]
    head, _, line = decided.table(plan, rows, verdicts, Rule()).splitlines()
    cells = dict(zip(decided.HEAD, (cell.strip() for cell in line.strip("|").split("|"))))
    lost = [motions // often for often in (4, 2)]
    assert cells["motions"] == str(motions) and cells["verdict"] == "differ"
    assert [cells["overturned at the first"], cells["at the second"]] == list(map(str, lost))
    assert cells["at the first alone"] == "0"
    assert cells["at the second alone"] == str(lost[1] - lost[0])


def test_rows_that_come_with_the_repository_are_of_studies_that_are_there():
    names = {f"decided/{file.stem}" for file in (tables.FOLDER / "decided").glob("*.csv")}
    assert names and all(tables.read(name).current for name in names)
    assert {name.partition("/")[2].partition("-")[0] for name in names} <= set(decided.STUDIES)
