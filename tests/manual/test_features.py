"""The table of features in the contributing page names tests that exist."""

import re
from pathlib import Path

from fecolumn.case import manual

TESTS = Path(__file__).parents[1]


def test_each_feature_has_a_test_of_one_body_and_of_several():
    named = re.findall(r"`([\w/]+\.py)::(test_\w+)`", manual.page("contributing"))
    assert len(named) >= 38
    missing = [
        f"{file}::{name}"
        for file, name in named
        if not (TESTS / file).is_file()
        or not re.search(rf"^def {name}\b", (TESTS / file).read_text(encoding="utf-8"), re.M)
    ]
    assert missing == []
