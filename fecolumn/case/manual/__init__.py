"""The manual: one Markdown file a topic, read as it is or by `fecolumn help TOPIC`."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

MANUAL_FOLDER = Path(__file__).parent
# Sections that a message names, at most
_SECTIONS = 4
# in the order of reading
TOPICS = (
    "quick-start",
    "terms",
    "cases",
    "keys",
    "motions",
    "studies",
    "questions",
    "statistics",
    "commands",
    "outputs",
    "pictures",
    "examples",
    "jobs",
    "python",
    "clusters",
    "structures",
    "rocking",
    "rocking-structures",
    "theory",
    "algorithm",
    "contributing",
    "changelog",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn help`."""
    parser.add_argument(
        "topic",
        nargs="?",
        default="",
        metavar="TOPIC",
        help="topic to print (default: list all topics)",
    )


def main(args: argparse.Namespace) -> int:
    """Print a topic, or what there is; returns 0.

    Raises
    ------
    InputError
        no such topic.
    """
    print(page(args.topic) if args.topic else contents())
    return 0


def page(topic: str) -> str:
    """The Markdown of a topic; the beginning of its name is enough.

    Raises
    ------
    InputError
        no such topic.
    """
    from fecolumn.foundation.schema import InputError

    found = [name for name in TOPICS if name.startswith(topic.lower())]
    if topic.lower() not in TOPICS and len(found) != 1:
        told = f"must be one of {', '.join(TOPICS)}{_sections_on(topic)}"
        raise InputError("fecolumn help", "TOPIC", topic, told)
    return _text(topic.lower() if topic.lower() in TOPICS else found[0])


def _sections_on(word: str) -> str:
    """The end of a message: headings of pages that have the word, else the pages that have it most
    often; "" where none has it.
    """
    texts = {name: _text(name) for name in TOPICS if name != "changelog"}
    found = [
        f"{name} ({heading})"
        for name, text in texts.items()
        for heading in re.findall(r"^#+ ([A-Z`].*)$", text, re.MULTILINE)
        if word.lower() in heading.lower()
    ]
    counts = {name: text.lower().count(word.lower()) for name, text in texts.items()}
    found = found or sorted(filter(counts.get, counts), key=lambda name: -counts[name])
    return f"; it is told of in {', '.join(found[:_SECTIONS])}" if found else ""


def contents() -> str:
    """Topics with their titles."""
    lines = [
        f"  {name:12} {_text(name).partition(chr(10))[0].removeprefix('# ')}" for name in TOPICS
    ]
    return "\n".join(
        [
            "fecolumn help TOPIC, of:",
            *lines,
            "",
            f"The same as files: {MANUAL_FOLDER}",
            "Options of a command: fecolumn COMMAND --help",
        ]
    )


def _text(name: str) -> str:
    return (MANUAL_FOLDER / f"{name}.md").read_text(encoding="utf-8").rstrip()
