"""No example analyses a part of its motion: what a user copies runs the whole of it."""

import tomllib

import pytest
from documents import PAGES, ROOT, blocks

from fecolumn.foundation.toml_file import read_toml

FILES = sorted(
    file
    for folder in ("meshes", "benchmarks", "fecolumn/case/templates")
    for file in (ROOT / folder).rglob("*.toml")
)
EXAMPLES = [(page, block) for page in PAGES for block in blocks(page) if block.language == "toml"]


def cut(tables: dict) -> bool:
    """Whether a case or the case of a study has a motion and yet a duration of its own, which may
    be shorter.
    """
    case = tables.get("case") if isinstance(tables.get("case"), dict) else tables
    return bool(case.get("motion") or "motion.source" in tables.get("axes", {})) and bool(
        case.get("integration", {}).get("duration_s")
    )


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_files_of_the_repository_run_their_motions_to_the_end(file):
    tables = read_toml(file)
    case = tables.get("case")
    if isinstance(case, dict) and "extends" in case:
        tables["case"] = read_toml(file.parent / case.pop("extends")) | case
    assert not cut(tables)


@pytest.mark.parametrize(
    "page, block", EXAMPLES, ids=[f"{page}-{number}" for number, (page, _) in enumerate(EXAMPLES)]
)
def test_examples_of_readme_and_manual_run_their_motions_to_the_end(page, block):
    assert not cut(tomllib.loads(block.text))


def test_an_example_that_cuts_its_motion_would_be_seen():
    assert cut({"motion": {"source": "lick:1"}, "integration": {"duration_s": 1.0}})
    assert cut(
        {"case": {"integration": {"duration_s": 1.0}}, "axes": {"motion.source": ["lick:*"]}}
    )
