"""Cases that pages show beside their commands can be analysed as they stand."""

import tomllib

import pytest
from documents import PAGES, blocks

from fecolumn.case.case import load_case
from fecolumn.simulation import run

# Files of a user's own that an example names
_FILES = ("scan.stl",)
CASES = [
    (page, block)
    for page in PAGES
    for block in blocks(page)
    if block.language == "toml"
    and block.name
    and tomllib.loads(block.text).keys() & {"bodies", "column"}
    and not any(file in block.text for file in _FILES)
]


@pytest.mark.long
@pytest.mark.parametrize("page, block", CASES, ids=[f"{page}-{one.name}" for page, one in CASES])
def test_a_case_of_a_page_takes_steps(page, block, tmp_path):
    (tmp_path / block.name).write_text(block.text)
    case = load_case(tmp_path / block.name)
    steps = 5 * case.integration.shortest_s
    part = case.replace({"integration.duration_s": steps})
    assert run(part, tmp_path / "out", quiet=True)["steps"] == 5


def test_structures_are_among_them():
    assert {"gate.toml", "damped.toml", "waxed.toml"} <= {block.name for _, block in CASES}
