"""What the commands of the manual's pages quick-start and questions answer.

    ./containers/run python -m benchmarks.examples [DIR]

Follows the pages in DIR (default: a new folder) and prints the sentences that they quote, as two
tables; some minutes of the processor.
"""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.beside import markdown
from benchmarks.page import folder_given, follow, sections

#: Page and heading of each example, and how the answer begins.
EXAMPLES = {
    "my-tube": ("quick-start", "A column", "my-tube/run: "),
    "design": ("questions", "How large must it be?", "P(overturn) < "),
    "risk": ("questions", "How often does it happen?", "overturn has a mean "),
    "screen": ("questions", "Which of many is in danger?", "Most endangered of "),
}
FITTED = ("questions", "Which parameters fit a test?")
KEYS = {
    "restitution": "block.restitution = ",
    "tilt": "initial.tilt_rad = ",
    "trade": "block.restitution and initial.tilt_rad trade",
    "fit": "The fit leaves ",
}


def answers(page: str, heading: str, folder: Path) -> list[str]:
    """Lines that the commands below a heading print."""
    return "".join(follow(block, folder) for block in sections(page)[heading]).splitlines()


def first(lines: list[str], begin: str) -> str:
    """The first line that begins so, without a full stop at its end; one blank between its words.

    Raises
    ------
    ValueError
        there is none.
    """
    for line in lines:
        if line.startswith(begin):
            return " ".join(line.split()).removesuffix(".")
    raise ValueError(f"no line of the answer begins with {begin!r}")


def main() -> int:
    """Follow the pages and print the tables."""
    folder = folder_given()
    rows = [
        (name, first(answers(page, heading, folder), begin))
        for name, (page, heading, begin) in EXAMPLES.items()
    ]
    fitted = answers(*FITTED, folder)
    print("\n" + markdown(("example", "says"), rows))
    rows = [(key, first(fitted, begin)) for key, begin in KEYS.items()]
    print("\n" + markdown(("key", "says"), rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
