"""Measured numbers of RESULTS.md, README and manual are those of benchmarks/tables."""

import csv
import dataclasses
import re
from pathlib import Path

import pytest
from stated_numbers import DERIVED, GIVEN, VERIFIED

from benchmarks import tables
from benchmarks.results import RESULTS, filled, results
from benchmarks.tables import changes
from benchmarks.tables.__main__ import main as keep
from benchmarks.tables.again import measure_again, printed_as

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", RESULTS, *sorted((ROOT / "fecolumn/case/manual").glob("*.md"))]
TEXT = {page.name: page.read_text(encoding="utf-8") for page in PAGES}
with (tables.FOLDER / f"{tables.QUOTED}.csv").open(encoding="utf-8", newline="") as file:
    QUOTED = list(csv.DictReader(file))


def holds(number: str, text: str) -> bool:
    """Whether a text has a number, and not as a part of a longer one."""
    pattern = re.escape(number).replace("<", "< ?")
    return re.search(rf"(?<![\d.]){pattern}(?!\d|[.,]\d)", text) is not None


def test_results_are_what_the_tables_give():
    assert TEXT["RESULTS.md"] == results(), "python -m benchmarks.results makes it anew"
    assert len(TEXT["RESULTS.md"].splitlines()) <= 250


@pytest.mark.parametrize("name", tables.names())
def test_a_table_tells_where_it_comes_from(name):
    """Rows are named once, and the table is printed somewhere, quoted, or linked as a file."""
    table = tables.read(name)
    first = [cells[0] for cells in table.rows]
    assert len(set(first)) == len(first) and re.fullmatch("none|[0-9]+", table.about["physics"])
    assert "dirty" not in table.about["commit"], "made by code that no commit holds"
    used = {quote["table"] for quote in QUOTED}
    page = TEXT["RESULTS.md"]
    assert name in used or table.about["title"] in page or f"(tables/{name}.csv)" in page


@pytest.mark.parametrize("quote", QUOTED, ids=lambda quote: f"{quote['page']}: {quote['fragment']}")
def test_pages_print_the_numbers_of_the_tables(quote):
    """A fragment is in its page and has the number; row *: the page has the whole table."""
    table, page = tables.read(quote["table"]), TEXT[quote["page"]]
    if quote["row"] == "*":
        assert table.markdown() in page, f"the table is now\n{table.markdown()}"
    else:
        number = table.cell(quote["row"], quote["column"], quote["format"])
        assert quote["fragment"] in " ".join(page.split())
        assert holds(number, quote["fragment"]), f"the number is now {number}"
    assert quote["page"] != "README.md" or table.current, "a number of other motions"


def test_the_front_page_has_no_number_that_nobody_listed():
    """Each stands in a fragment that is traced to a table, or is given, verified or derived."""
    page = re.sub(r"```.*?```", "", TEXT["README.md"], flags=re.DOTALL)
    page = re.sub(r"\]\([^)]*\)", "]", " ".join(page.split()))
    traced = [quote["fragment"] for quote in QUOTED if quote["page"] == "README.md"]
    for fragment in sorted({*traced, *GIVEN, *VERIFIED, *DERIVED}, key=len, reverse=True):
        words = re.sub(r"\]\([^)]*\)", "]", fragment)
        page = page.replace(words, " @ ")
    left = [match[0] for match in re.finditer(r".{0,30}(?<![\w.])\d.{0,30}", page)]
    assert left == []


@pytest.mark.parametrize("fragment", [*GIVEN, *VERIFIED, *DERIVED])
def test_what_is_listed_is_on_the_front_page(fragment):
    page = re.sub(r"\]\([^)]*\)", "]", " ".join(TEXT["README.md"].split()))
    assert fragment in page


def test_no_number_is_left_over_from_an_older_version():
    history = "changelog.md"
    assert [name for name in TEXT if "not measured again" in TEXT[name] and name != history] == []


def test_a_printed_table_is_kept_and_quoted(tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "FOLDER", tmp_path)
    monkeypatch.setattr("benchmarks.tables.__main__.FOLDER", tmp_path)
    printed = tmp_path / "printed.txt"
    printed.write_text("words\n| a | b [m] |\n|---|---:|\n| x: y | 0.25 |\n\nmore\n")
    command = ["tables", str(printed), "one", "--title", "T.", "--command", "python -m x"]
    monkeypatch.setattr("sys.argv", command)
    keep()
    assert tables.read("one").rows == [["x: y", "0.25"]] and tables.read("one").current
    assert filled("{{one:x: y:b [m]:.1f}} m") == "0.2 m"
    monkeypatch.setattr("sys.argv", command[:3])  # title and command as they were
    keep()
    (tmp_path / "one.csv").write_text((tmp_path / "one.csv").read_text().replace("# date", "# day"))
    with pytest.raises(ValueError, match="header without date"):
        tables.read("one")


@pytest.mark.parametrize("text, there", [("24 of", 1), ("124", 0), ("2.24", 0), ("24.5", 0)])
def test_a_number_is_found_whole(text, there):
    assert holds("24", text) == bool(there)
    assert holds("<0.001", "p < 0.001)")


def test_a_table_is_measured_again_by_its_command(tmp_path, monkeypatch):
    """The rows are those of today's code; where another table is printed, it says so."""
    kept = tables.read("design_slenderness")
    monkeypatch.setattr(tables, "FOLDER", tmp_path)
    measure_again(kept.about["command"], [kept])
    again = tables.read("design_slenderness")
    assert again.current and (again.columns, again.rows) == (kept.columns, kept.rows)
    with pytest.raises(ValueError, match="no printed table has the columns"):
        printed_as(kept, [[["p T_p", "another"], ["2", "1.0"]]])
    longer = dataclasses.replace(kept, rows=[*kept.rows, kept.rows[0]])
    with pytest.raises(ValueError, match="5 rows are printed where 6 are kept"):
        measure_again(kept.about["command"], [longer])
    with pytest.raises(ValueError, match="exit code 2"):
        measure_again("python -m benchmarks.substeps.paper --unknown", [kept])


def test_tables_of_older_motions_are_named(capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["tables"])
    keep()
    told = capsys.readouterr().out
    for name in tables.names():
        assert (f"{name} (" in told) is not tables.read(name).current


def test_rows_that_were_measured_again_are_told_of_in_what_is_made_of_them():
    frame = tables.read("fragility/frame")
    assert frame.changed and frame.changed["commits"].split(" and ")[0] in frame.about["changed"]
    assert len(frame.made_by) == 3 and frame.changed["machine"] in tables.machines_of("fragility")
    assert all(commit in tables.measured_when("fragility") for _, commit in frame.made_by)
    assert tables.measured_when("fragility").endswith(", physics 12 and 13")
    for file in tables.FOLDER.glob("*/*.csv"):
        table = tables.read(f"{file.parent.name}/{file.stem}")
        assert bool(table.changed) == ("changed" in table.about), file


def test_what_a_count_of_physics_touches_is_no_longer_of_today(monkeypatch):
    monkeypatch.setattr(changes, "PHYSICS", 14)
    monkeypatch.setattr(changes, "TOUCHED", {13: ("one", "some/*"), 14: ("two",)})
    assert [changes.holds(name, "12") for name in ("one", "two", "three", "some/rows")] == [
        False,
        False,
        True,
        False,
    ]
    assert changes.holds("one", "13") and not changes.holds("two", "13")
    assert changes.holds("one", "none") and not changes.holds("three", "11")


def test_what_is_listed_as_touched_is_there():
    for listed in changes.TOUCHED.values():
        for pattern in listed:
            found = [*tables.FOLDER.glob(f"{pattern}.csv"), *ROOT.glob(pattern)]
            assert found, pattern
