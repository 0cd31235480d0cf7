"""The pages of the manual whose answers are measured are followed as a reader would."""

import pytest

from benchmarks import tables
from benchmarks.examples import EXAMPLES, FITTED, answers, first
from benchmarks.page import Block, follow, sections


@pytest.mark.parametrize("page, heading", [(*one[:2],) for one in EXAMPLES.values()] + [FITTED])
def test_a_section_that_is_followed_has_commands(page, heading):
    assert any(block.language == "sh" for block in sections(page)[heading])


@pytest.mark.long
def test_an_example_answers_what_is_kept(tmp_path):
    """Seismic risk: no motion of this program enters, so that today's answer is the table's."""
    page, heading, begin = EXAMPLES["risk"]
    said = first(answers(page, heading, tmp_path), begin)
    assert said == tables.read("examples").cell("risk", "says")
    with pytest.raises(ValueError, match="no line of the answer begins"):
        first([said], "Underflow")


def test_a_block_is_written_under_the_name_in_its_first_line(tmp_path):
    assert follow(Block("toml", '# case.toml: a block\ntitle = "Block"\n', ""), tmp_path) == ""
    assert (tmp_path / "case.toml").read_text().endswith('title = "Block"\n')
