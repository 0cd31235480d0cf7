"""Tables of an older physics, and the commands that measure them again."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from collections.abc import Iterable

from benchmarks.tables import Table, from_markdown, names, read, write

#: A command that can be run as it stands: of this folder, without a place to be filled in.
RUNS_AS_IT_STANDS = re.compile(r"python -m benchmarks\.(?!.*\b[A-Z]{3,}\b)")


def older() -> list[Table]:
    """Tables that today's code may not measure any more, by name."""
    return [table for table in map(read, names()) if not table.current]


def by_command(tables: Iterable[Table]) -> dict[str, list[Table]]:
    """Tables by the command that prints them."""
    found: dict[str, list[Table]] = {}
    for table in tables:
        found.setdefault(table.about["command"], []).append(table)
    return found


def printed_as(table: Table, printed: list[list[list[str]]]) -> list[list[str]]:
    """Of the printed tables the one with the columns of a kept one: the last, if there are several.

    Raises
    ------
    ValueError
        there is none.
    """
    for one in reversed(printed):
        if one[0] == table.columns:
            return one
    raise ValueError(f"{table.name}: no printed table has the columns {', '.join(table.columns)}")


def measure_again(command: str, tables: Iterable[Table]) -> None:
    """Run a command, whose output is shown as it comes, and keep its tables.

    Raises
    ------
    ValueError
        the command failed, does not print one of the tables, or prints one with fewer rows.
    """
    run = subprocess.Popen(
        [sys.executable, *shlex.split(command)[1:]], stdout=subprocess.PIPE, text=True
    )
    assert run.stdout
    lines = []
    for line in run.stdout:
        print(line, end="", flush=True)
        lines.append(line)
    if code := run.wait():
        raise ValueError(f"{command}: ended with exit code {code}")
    printed = from_markdown("".join(lines))
    found = [(table, printed_as(table, printed)) for table in tables]
    for table, (_, *rows) in found:
        if len(rows) < len(table.rows):
            raise ValueError(
                f"{table.name}: {len(rows)} rows are printed where {len(table.rows)} are kept"
            )
    for table, (columns, *rows) in found:
        write(table.name, columns, rows, table.about["title"], command)
