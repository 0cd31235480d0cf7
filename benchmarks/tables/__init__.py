"""Measured numbers: CSV files, each with a header that tells what made it.

A file begins with one comment line for each of `HEADER`, one of "rows" where it is made of rows
that were measured before: their commits and dates, and one of "changed" where some rows were
measured again: `CHANGED`. Then come the names of the columns, with their units, then the rows.
Cells are kept as they were printed. The first column names the row.
"""

from __future__ import annotations

import csv
import io
import re
import subprocess
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from benchmarks.tables.changes import holds
from fecolumn import __version__
from fecolumn.foundation.sources import PHYSICS

FOLDER = Path(__file__).parent
#: Not a table of measurements: which sentences of which pages print which numbers.
QUOTED = "quoted"
# of /proc/cpuinfo, beside the processor's name
_WHICH = "cpu family", "model"
#: physics: PHYSICS of the code; "none": no motion computed by fecolumn enters.
HEADER = ("title", "command", "version", "commit", "date", "machine", "physics")
#: How many rows of a table were measured again, by which code, when, where, and why
CHANGED = re.compile(
    r"(?P<rows>\d+) rows?, commits? (?P<commits>[0-9a-f]+(?: and [0-9a-f]+)*), "
    r"(?P<date>\d{4}-\d\d-\d\d), (?P<machine>[^:]+): (?P<why>.+)"
)


@dataclass(frozen=True)
class Table:
    """Columns and rows of text, and `about`, the header."""

    name: str
    about: dict[str, str]
    columns: list[str]
    rows: list[list[str]]

    def cell(self, row: str, column: str, form: str = "") -> str:
        """A cell; as a number where `form`, such as ".2f", tells how to print it.

        Raises
        ------
        ValueError
            there is no such row or column.
        """
        found = [cells for cells in self.rows if cells[0] == row]
        if len(found) != 1 or column not in self.columns:
            raise ValueError(f"{self.name}.csv has {len(found)} rows {row!r}, or no {column!r}")
        text = found[0][self.columns.index(column)]
        return format(float(text), form) if form else text

    def markdown(self) -> str:
        """The table as Markdown, numbers at the right."""
        columns = list(zip(*self.rows))
        right = ["---:" if all(map(_is_number, cells)) else "---" for cells in columns]
        lines = [self.columns, right, *self.rows]
        return "\n".join(f"| {' | '.join(line)} |" for line in lines)

    @property
    def machines(self) -> list[str]:
        """That measured it."""
        again = [one["machine"]] if (one := self.changed) else []
        return [*self.about["machine"].split("; "), *again]

    @property
    def changed(self) -> re.Match[str] | None:
        """As of CHANGED; None where no row was measured again."""
        return CHANGED.fullmatch(self.about.get("changed", ""))

    @property
    def made_by(self) -> set[tuple[str, str]]:
        """Dates and commits that measured its rows."""
        again = self.changed
        more = [(again["date"], one) for one in again["commits"].split(" and ")] if again else []
        return {(self.about["date"], self.about["commit"]), *more}

    @property
    def current(self) -> bool:
        """Whether what this code computes is what was measured."""
        return holds(self.name, self.about["physics"])


def _is_number(text: str) -> bool:
    try:
        float(text.lstrip("<").replace(",", "") or 0)
    except ValueError:
        return text == "-"
    return True


def read(name: str) -> Table:
    """The table of benchmarks/tables/NAME.csv.

    Raises
    ------
    ValueError
        a line of the header is missing or empty, or a row is longer or shorter than the columns.
    """
    lines = (FOLDER / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    head = [line[2:].partition(": ") for line in lines if line.startswith("# ")]
    about = {key: value for key, _, value in head}
    if missing := [key for key in HEADER if not about.get(key)]:
        raise ValueError(f"{name}.csv: header without {', '.join(missing)}")
    columns, *rows = csv.reader(line for line in lines if not line.startswith("# "))
    if wrong := [row for row in rows if len(row) != len(columns)]:
        raise ValueError(f"{name}.csv: {wrong[0]} has not {len(columns)} cells")
    return Table(name, about, columns, rows)


def machines_of(folder: str) -> tuple[str, ...]:
    """That measured the rows kept in a folder of benchmarks/tables, each once."""
    found = [read(f"{folder}/{file.stem}") for file in sorted((FOLDER / folder).glob("*.csv"))]
    return tuple(dict.fromkeys(one for table in found for one in table.machines))


def measured_when(folder: str) -> str:
    """Commits, dates and physics of the rows kept in a folder of benchmarks/tables, of the first
    measured first.
    """
    found = [read(f"{folder}/{file.stem}") for file in (FOLDER / folder).glob("*.csv")]
    made = sorted(set().union(*(table.made_by for table in found)))
    commits = ", ".join(dict.fromkeys(commit for _, commit in made))
    physics = sorted({table.about["physics"] for table in found} - {"none"}, key=int)
    told = f", physics {' and '.join(physics)}" if physics else ""
    return f"commits {commits}, {made[0][0]} to {made[-1][0]}{told}"


def names() -> list[str]:
    """Of all tables."""
    return sorted(file.stem for file in FOLDER.glob("*.csv") if file.stem != QUOTED)


def write(
    name: str,
    columns,
    rows,
    title: str,
    command: str,
    physics: int | str = PHYSICS,
    machines: tuple[str, ...] = (),
    rows_of: str = "",
) -> None:
    """Write a table as measured by this code, now; machines: that measured it, else this one;
    rows_of: folder of the kept rows that it is made of, whose machines, commits, dates and physics
    it tells.
    """
    machines = machines_of(rows_of) if rows_of else machines
    machine = "; ".join(dict.fromkeys(machines or [this_machine()]))
    about = (title, command, __version__, commit(), date.today().isoformat(), machine, physics)
    text = io.StringIO()
    text.writelines(f"# {key}: {value}\n" for key, value in zip(HEADER, about))
    if rows_of:
        text.write(f"# rows: {measured_when(rows_of)}\n")
    csv.writer(text, lineterminator="\n").writerows([columns, *rows])
    file = FOLDER / f"{name}.csv"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text.getvalue(), encoding="utf-8")


def from_markdown(text: str) -> list[list[list[str]]]:
    """Tables that a program printed as Markdown: rows of cells, the names of the columns first."""
    found: list[list[list[str]]] = [[]]
    for line in text.splitlines():
        if line.startswith("|"):
            found[-1].append([cell.strip() for cell in line.strip().strip("|").split("|")])
        elif found[-1]:
            found.append([])
    return [[head, *rows] for head, _, *rows in (one for one in found if len(one) > 2)]


def commit() -> str:
    """Of this checkout; "-dirty" where anything but kept tables and figures differs from it."""
    git = ["git", "-C", str(FOLDER)]
    try:
        found = subprocess.run(
            [*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True
        )
        csv_files = "benchmarks/tables/*.csv", "benchmarks/tables/*/*.csv"
        kept = *csv_files, "benchmarks/RESULTS.md", "*.png", "*.gif"
        others = [":/", *(f":(exclude,top){one}" for one in kept)]
        changed = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", *others]).returncode
    except FileNotFoundError:
        # without git
        return "unknown"
    return found.stdout.strip() + "-dirty" * bool(changed) if found.stdout else "unknown"


def this_machine() -> str:
    """Processor, by its family and model, too, which decide how libraries round; number of
    cores.
    """
    told: dict[str, list[str]] = {}
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        key, _, value = line.partition(":")
        told.setdefault(key.strip(), []).append(value.strip())
    names = told.get("model name", [])
    which = [f"{key.removeprefix('cpu ')} {told[key][0]}" for key in _WHICH if key in told]
    name = " ".join([names[0] if names else "unknown processor", *which])
    return f"{name}, {len(names)} cores"
