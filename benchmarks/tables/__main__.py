"""Keep the tables that a benchmark printed.

    python -m benchmarks.NAME ... > printed.txt
    python -m benchmarks.tables printed.txt TABLE [TABLE ...] [--title T] [--command C]

The last tables of printed.txt, in their order, become benchmarks/tables/TABLE.csv. Version, commit,
date, machine and physics are those of now; title and command are kept of a table that is there.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.tables import FOLDER, from_markdown, read, write


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.tables",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("printed", type=Path)
    parser.add_argument("names", nargs="+", metavar="TABLE")
    parser.add_argument("--title")
    parser.add_argument("--command")
    given = parser.parse_args()
    found = from_markdown(given.printed.read_text(encoding="utf-8"))[-len(given.names) :]
    if len(found) < len(given.names):
        parser.error(f"{given.printed} has {len(found)} tables for {', '.join(given.names)}")
    for name, (columns, *rows) in zip(given.names, found):
        old = read(name).about if (FOLDER / f"{name}.csv").exists() else {}
        title, command = (getattr(given, key) or old.get(key) for key in ("title", "command"))
        if not (title and command):
            parser.error(f"{name} is a new table: state --title and --command")
        write(name, columns, rows, title, command)


if __name__ == "__main__":
    main()
