"""README and manual as the tests see them: their blocks of commands and files."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = {
    path.stem: path
    for path in [ROOT / "README.md", *sorted((ROOT / "fecolumn" / "case" / "manual").glob("*.md"))]
}
_FENCE = re.compile(
    r"^(?:<!-- (?P<mark>\w+) -->\n)?```(?P<language>\w+)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
_SETUP = ("./containers/run ",)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, and its mark in a comment above: long, root, or ""
    for one that runs in the tests.
    """

    language: str
    text: str
    mark: str

    @property
    def name(self) -> str:
        """The file that a block is, by the comment in its first line."""
        first = self.text.partition("\n")[0]
        return first.removeprefix("# ").partition(":")[0].strip() if first.startswith("# ") else ""

    @property
    def commands(self) -> list[str]:
        """Commands without comments, continued lines joined."""
        lines = self.text.replace("\\\n", " ").splitlines()
        return [
            line
            for line in (re.sub(r"\s#\s.*$", "", line).strip() for line in lines)
            if line and not line.startswith("#")
        ]


def blocks(page: str) -> list[Block]:
    """Blocks of a page in their order."""
    return [
        Block(found["language"], found["text"], found["mark"] or "")
        for found in _FENCE.finditer(PAGES[page].read_text(encoding="utf-8"))
    ]


def listed(page: str, heading: str) -> dict[str, str]:
    """Names and units of the table below a heading."""
    text = PAGES[page].read_text(encoding="utf-8")
    section = re.split(
        r"^#+ ", text.partition(f"# {heading}\n")[2], maxsplit=1, flags=re.MULTILINE
    )[0]
    return dict(re.findall(r"^\| `([^`]+)` \| ([^|]+?) \|", section, re.MULTILINE))
