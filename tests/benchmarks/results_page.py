"""RESULTS.md as its tests read it, and cells of the tables that it prints."""

from benchmarks import tables
from benchmarks.results import RESULTS

PAGE = " ".join(RESULTS.read_text(encoding="utf-8").split())
ROOT = RESULTS.parents[1]


def column(name, head):
    """Cells of a column by the name of their row."""
    table = tables.read(name)
    return {row[0]: row[table.columns.index(head)] for row in table.rows}


def numbers(cell):
    """p-values and others of a cell such as "0.27; <0.001; 0.020"."""
    return [float(one.strip().lstrip("<")) for one in cell.split(";")]


def pairs(name, row):
    """D, p and McNemar's p of a row of pairs of steps, by alpha."""
    table = tables.read(name)
    (found,) = [cells for cells in table.rows if cells[0] == row]
    return {
        head.removeprefix("alpha "): numbers(cell)
        for head, cell in zip(table.columns, found)
        if cell != row
    }


def verdicts(name):
    """What was found of each claim of the paper, by its sign, such as "a2, α"."""
    return {row.partition(", ")[2]: cell for row, cell in column(name, "here").items()}


def manual(name):
    """A page of the manual in one line."""
    text = (ROOT / "fecolumn" / "case" / "manual" / f"{name}.md").read_text(encoding="utf-8")
    return " ".join(text.split())
