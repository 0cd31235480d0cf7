"""Rows of single analyses that come with the repository, one file a set: the work of hours goes on
from them in any clone, and its tables can be made again without it.
"""

from __future__ import annotations

from typing import Any

from benchmarks import tables

#: Names the row
MOTION = "motion"


def read_runs(name: str) -> dict[int, dict[str, Any]]:
    """Rows by motion of benchmarks/tables/NAME.csv; none where there is no such file, or what it
    holds is of other physics.
    """
    if not (tables.FOLDER / f"{name}.csv").exists():
        return {}
    found = tables.read(name)
    if not found.current:
        return {}
    columns = found.columns[1:]
    return {int(row[0]): dict(zip(columns, map(_value, row[1:]))) for row in found.rows}


def write_runs(
    name: str, runs: dict[int, dict[str, Any]], title: str, command: str, **more
) -> None:
    """Write rows by motion, all of the same keys; rows of other motions that are there, as of
    `read_runs`, stay. more: as of `tables.write`.
    """
    before = read_runs(name)
    runs = before | runs
    columns = list(next(iter(runs.values())))
    cells = {motion: list(map(_cell, runs[motion].values())) for motion in sorted(runs)}
    rows = [[motion, *row] for motion, row in cells.items()]
    if any(cells[motion] == list(map(_cell, one.values())) for motion, one in before.items()):
        more["machines"] = (*tables.read(name).machines, tables.this_machine())
    tables.write(name, [MOTION, *columns], rows, title, command, **more)


def _cell(value) -> str:
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def _value(text: str):
    if text in ("True", "False", "None"):
        return {"True": True, "False": False, "None": None}[text]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text
