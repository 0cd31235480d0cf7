"""Pages of the manual as a reader follows them: files to write, commands to run."""

from __future__ import annotations

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

MANUAL = Path(__file__).parents[1] / "fecolumn" / "case" / "manual"
_FENCE = re.compile(
    r"^(?:<!-- (?P<mark>\w+) -->\n)?```(?P<language>\w+)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)


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


def blocks_in(text: str) -> list[Block]:
    """Blocks of a Markdown text in their order."""
    return [
        Block(found["language"], found["text"], found["mark"] or "")
        for found in _FENCE.finditer(text)
    ]


def sections(page: str) -> dict[str, list[Block]]:
    """Blocks of a page by the heading above them."""
    text = (MANUAL / f"{page}.md").read_text(encoding="utf-8")
    return {part.partition("\n")[0]: blocks_in(part) for part in text.split("\n## ")[1:]}


def folder_given() -> Path:
    """The folder of the command line, or a new one; --help is answered."""
    parser = argparse.ArgumentParser(
        description=sys.modules["__main__"].__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", nargs="?", metavar="DIR")
    folder = Path(parser.parse_args().folder or tempfile.mkdtemp()).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def follow(block: Block, folder: Path) -> str:
    """Write a file or run what a block says, in a folder; what its commands answer.

    Raises
    ------
    subprocess.CalledProcessError
        a command failed.
    """
    if block.language in ("toml", "csv"):
        (folder / block.name).write_text(block.text)
        return ""
    if block.language == "python":
        return _answer([sys.executable, "-c", block.text], folder)
    answers = []
    for command in block.commands:
        print(f"$ {command}", flush=True)
        words = [sys.executable, "-m", "fecolumn.cli", *shlex.split(command)[1:]]
        answers.append(_answer(words, folder))
    return "".join(answers)


def _answer(words: list[str], folder: Path) -> str:
    """Standard output of a command, which is shown, too."""
    environment = os.environ | {"PYTHONPATH": str(MANUAL.parents[2])}
    done = subprocess.run(
        words,
        cwd=folder,
        check=True,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=environment,
    )
    print(done.stdout, end="", flush=True)
    return done.stdout
