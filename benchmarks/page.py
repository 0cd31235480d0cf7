"""Pages of the manual as a reader follows them: files to write, commands to run."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

MANUAL = Path(__file__).parents[1] / "fecolumn" / "case" / "manual"
_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def sections(page: str) -> dict[str, list[tuple[str, str]]]:
    """Blocks of a page, language and text, by the heading above them."""
    text = (MANUAL / f"{page}.md").read_text(encoding="utf-8")
    return {part.partition("\n")[0]: _BLOCK.findall(part) for part in text.split("\n## ")[1:]}


def follow(language: str, text: str, folder: Path) -> str:
    """Write a file or run what a block says, in a folder; what its commands answer.

    A file has its name in its first line, before a colon.

    Raises
    ------
    subprocess.CalledProcessError
        a command failed.
    """
    if language in ("toml", "csv"):
        (folder / text.partition("\n")[0].strip("# ").partition(":")[0]).write_text(text)
        return ""
    if language == "python":
        return _answer([sys.executable, "-c", text], folder)
    answers = []
    for command in text.splitlines():
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
