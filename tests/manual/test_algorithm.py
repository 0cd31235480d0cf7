"""The algorithm page names what the code has: its tolerances with their values, its functions, its
figure.
"""

import importlib
import re

import pytest
from documents import PAGES, listed

from fecolumn.contact import tolerances

TEXT = PAGES["algorithm"].read_text(encoding="utf-8")
VALUES = {name: value for name, value in vars(tolerances).items() if name.isupper()}


def test_the_table_of_tolerances_has_every_name_with_its_value_and_no_other():
    told = {
        name: tuple(map(float, value.split(", ")))
        for name, value in listed("algorithm", "8. Tolerances").items()
    }
    assert told == {
        name: value if isinstance(value, tuple) else (value,) for name, value in VALUES.items()
    }


def test_every_tolerance_has_a_scale_a_meaning_and_an_origin():
    rows = [
        row.strip("|").split("|")
        for row in re.findall(r"^\| `[A-Z_]+` \|.*\|$", TEXT, re.MULTILINE)
    ]
    assert len(rows) == len(VALUES) and all(
        len(row) == 5 and all(cell.strip() for cell in row) for row in rows
    )


@pytest.mark.parametrize(
    "place",
    sorted(
        set(
            re.findall(
                r"`((?:contact|fem|engines\.(?:dynamics|reduced))\.[a-z_]+(?:\.\w+)*)`", TEXT
            )
        )
    ),
)
def test_every_function_it_names_exists(place):
    folder, module, *names = place.removeprefix("engines.").split(".")
    inner = "engines." if place.startswith("engines.") else ""
    found = importlib.import_module(f"fecolumn.{inner}{folder}.{module}")
    for name in names:
        found = getattr(found, name)


def test_tolerances_and_steps_in_the_text_are_those_of_the_tables():
    words = set(re.findall(r"(?<![`\w])[A-Z]{4,}(?:_[A-Z]+)*\b", TEXT))
    assert words <= set(VALUES) | {"HHT"}
    steps = [int(number) for number in re.findall(r"^\| (\d+) \|", TEXT, re.MULTILINE)]
    assert steps == list(range(1, len(steps) + 1)) and len(steps) > 20
