"""No share, ratio or cost stands in the manual that nobody can trace."""

import csv
import re

import pytest
from results_page import ROOT
from stated_in_manual import DEFINED, DERIVED, TESTED

from benchmarks import tables

MANUAL = ROOT / "fecolumn" / "case" / "manual"
#: History, and keys whose limits are those of the code
OTHERS = ("changelog", "keys")
with (tables.FOLDER / f"{tables.QUOTED}.csv").open(encoding="utf-8", newline="") as file:
    QUOTED = list(csv.DictReader(file))
PAGES = sorted(path.stem for path in MANUAL.glob("*.md") if path.stem not in OTHERS)
#: A number in per cent, as a ratio, in parts of a second, of so many; a p-value
NUMBER = re.compile(
    r"(?<![\w.])\d[\d.,]*(?:e-?\d+)? ?"
    r"(?:%(?! interval| confidence| bands| damping)|times\b|µs|ms\b|of \d)|\bp [<=] ?\d[\d.]*"
)


def words(page):
    """A page in one line, without code and without what is printed."""
    text = re.sub(r"```.*?```", "", (MANUAL / f"{page}.md").read_text("utf-8"), flags=re.DOTALL)
    return " ".join(" ".join(line for line in text.split("\n") if line[:4] != "    ").split())


def listed(page):
    return [one for kind in (DEFINED, TESTED, DERIVED) for one in kind.get(page, ())]


@pytest.mark.parametrize("page", PAGES)
def test_no_number_of_the_manual_is_there_that_nobody_listed(page):
    """Each is of a table, or is given, tested or derived."""
    text = words(page)
    traced = [
        quote["fragment"] for quote in QUOTED if quote["page"] == f"{page}.md" and quote["fragment"]
    ]
    for fragment in sorted({*traced, *listed(page)}, key=len, reverse=True):
        text = text.replace(" ".join(fragment.split()), " @ ")
    assert [text[max(0, m.start() - 60) : m.end() + 20] for m in NUMBER.finditer(text)] == []


@pytest.mark.parametrize("page", PAGES)
def test_what_is_listed_is_on_its_page(page):
    assert [one for one in listed(page) if one not in words(page)] == []
