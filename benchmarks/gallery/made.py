"""Which code made each figure of README and manual: `benchmarks/tables/figures.csv`."""

from __future__ import annotations

import hashlib
from datetime import date

from benchmarks import tables
from benchmarks.gallery.figures import FIGURES, ROOT
from fecolumn import __version__
from fecolumn.foundation.sources import PHYSICS

TABLE = "figures"
_COLUMNS = "figure", "SHA-256, first digits", "version", "commit", "date", "physics"
_TITLE = "Figures of README and manual: the code that each was made by."


def digest(place: str) -> str:
    """Of the file of a figure: the first twelve digits of its SHA-256."""
    return hashlib.sha256((ROOT / place).read_bytes()).hexdigest()[:12]


def note(name: str) -> None:
    """Keep in the table that today's code has made a figure in its place."""
    place, _ = FIGURES[name]
    there = (tables.FOLDER / f"{TABLE}.csv").exists()
    rows = {row[0]: row for row in tables.read(TABLE).rows} if there else {}
    today = date.today().isoformat()
    rows[place] = [place, digest(place), __version__, tables.commit(), today, str(PHYSICS)]
    known = [rows[one] for one, _ in FIGURES.values() if one in rows]
    tables.write(TABLE, _COLUMNS, known, _TITLE, "python -m benchmarks.gallery")
