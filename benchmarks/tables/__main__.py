"""Keep the tables that benchmarks print.

    python -m benchmarks.tables                          which are of an older physics
    python -m benchmarks.tables --again [TABLE ...]      measure them again, or those named
    python -m benchmarks.tables printed.txt TABLE [TABLE ...] [--title T] [--command C] [--rows R]

The first names the tables that today's code may not measure any more, and their commands. The
second runs the commands that can be run as they stand, one after the other, and keeps what they
print; a benchmark that was stopped goes on where it was. The third keeps the last tables of
printed.txt, in their order, as benchmarks/tables/TABLE.csv. Version, commit, date, machine and
physics are those of now; title and command are kept of a table that is there. With --rows the
machines are those of the rows in benchmarks/tables/R, of which the tables are made, and the header
has their commits and dates, too.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.tables import FOLDER, from_markdown, names, read, write
from benchmarks.tables.again import RUNS_AS_IT_STANDS, by_command, measure_again, older


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.tables",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("printed", nargs="?")
    parser.add_argument("names", nargs="*", metavar="TABLE")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--title")
    parser.add_argument("--command")
    parser.add_argument("--rows", metavar="R")
    given = parser.parse_args()
    if given.again:
        _again(parser, [given.printed, *given.names] if given.printed else [])
    elif not given.printed:
        for command, tables in by_command(older()).items():
            listed = ", ".join(f"{one.name} ({one.about['physics']})" for one in tables)
            print(f"{command}\n    {listed}")
    elif not given.names:
        parser.error("which tables does it hold? give their names")
    else:
        _keep(parser, given)


def _again(parser: argparse.ArgumentParser, wanted: list[str]) -> None:
    """Measure the tables named again, or all older ones."""
    if unknown := sorted(set(wanted) - set(names())):
        parser.error(f"{', '.join(unknown)}: no such table; there are {', '.join(names())}")
    for command, tables in by_command(map(read, wanted) if wanted else older()).items():
        if not RUNS_AS_IT_STANDS.match(command):
            print(f"by hand: {command}")
            continue
        print(f"{command}", flush=True)
        try:
            measure_again(command, tables)
        except ValueError as error:
            parser.exit(1, f"{error}\n")


def _keep(parser: argparse.ArgumentParser, given: argparse.Namespace) -> None:
    """Keep the last tables of a file of printed ones."""
    found = from_markdown(Path(given.printed).read_text(encoding="utf-8"))[-len(given.names) :]
    if len(found) < len(given.names):
        parser.error(f"{given.printed} has {len(found)} tables for {', '.join(given.names)}")
    for name, (columns, *rows) in zip(given.names, found):
        old = read(name).about if (FOLDER / f"{name}.csv").exists() else {}
        title, command = (getattr(given, key) or old.get(key) for key in ("title", "command"))
        if not (title and command):
            parser.error(f"{name} is a new table: state --title and --command")
        write(name, columns, rows, title, command, rows_of=given.rows or "")


if __name__ == "__main__":
    main()
