"""What a study analyses, in words: a report of a podium must not speak of a column."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Subject:
    """What a report calls the thing that may overturn.

    Attributes
    ----------
    noun
        what overturns.
    article
        the noun as it is introduced.
    top
        what u_max is the displacement of.
    """

    noun: str
    article: str
    top: str


_COLUMN = Subject("column", "a free-standing column", "the top of the column")
# by the table of the case, the first that it has
_OTHERS = {
    "bodies": Subject(
        "structure", "a structure of free-standing bodies", "the top of the structure"
    ),
    "frame": Subject("frame", "a rocking frame", "the beam of the frame"),
    "wobbling_frame": Subject("frame", "a wobbling frame", "the slab of the frame"),
    "podium": Subject("podium", "a building on a rocking storey", "the roof of the building"),
    "block": Subject("block", "a rocking block", "the top of the block"),
}


def subject_of(case: dict[str, Any]) -> Subject:
    """Of the tables of a study's case."""
    return next((subject for name, subject in _OTHERS.items() if case.get(name)), _COLUMN)
