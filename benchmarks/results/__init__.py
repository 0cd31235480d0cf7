"""benchmarks/RESULTS.md, made of `text.md` and of the tables of `benchmarks.tables`."""

from __future__ import annotations

import re
from pathlib import Path

from benchmarks.tables import Table, read
from fecolumn.foundation.sources import PHYSICS

FOLDER = Path(__file__).parent
RESULTS = FOLDER.parent / "RESULTS.md"
#: {{table:NAME}} is a table with its source, {{NAME:row:column}} or {{NAME:row:column:.2f}} a cell,
#: {{physics}} the number of today. Names of rows and columns may hold colons before spaces.
PLACE = re.compile(r"\{\{([^{}]+)\}\}")


def source(table: Table) -> str:
    """Title of a table, and what made it."""
    about = table.about
    return (
        f"**{about['title']}** `{about['command']}`; {about['version']} ({about['commit']}), "
        f"{about['date']}, {about['machine']}, physics {about['physics']}."
    )


def filled(text: str) -> str:
    """Text with a table or a number in each place."""

    def content(found: re.Match) -> str:
        first, *rest = re.split(r":(?! )", found[1])
        if first == "physics":
            return str(PHYSICS)
        if first == "table":
            table = read(rest[0])
            return f"{source(table)}\n\n{table.markdown()}"
        return read(first).cell(*rest)

    return PLACE.sub(content, text)


def results() -> str:
    """The text of RESULTS.md."""
    return filled((FOLDER / "text.md").read_text(encoding="utf-8"))
