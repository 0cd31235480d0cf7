"""README and manual as the tests see them: their blocks of commands and files."""

from __future__ import annotations

import csv
import re
from pathlib import Path

from benchmarks.page import Block, blocks_in

ROOT = Path(__file__).parents[2]
PAGES = {
    path.stem: path
    for path in [ROOT / "README.md", *sorted((ROOT / "fecolumn" / "case" / "manual").glob("*.md"))]
}


def blocks(page: str) -> list[Block]:
    """Blocks of a page in their order."""
    return blocks_in(PAGES[page].read_text(encoding="utf-8"))


def listed(page: str, heading: str) -> dict[str, str]:
    """Names and units of the table below a heading."""
    text = PAGES[page].read_text(encoding="utf-8")
    section = re.split(
        r"^#+ ", text.partition(f"# {heading}\n")[2], maxsplit=1, flags=re.MULTILINE
    )[0]
    return dict(re.findall(r"^\| `([^`]+)` \| ([^|]+?) \|", section, re.MULTILINE))


def header(file: Path) -> list[str]:
    """Names of the columns of a CSV file."""
    with open(file, newline="", encoding="utf-8") as rows:
        return next(csv.reader(rows))
