"""Keys of a study file beside those of a case: what each means, its range and its default."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fecolumn.foundation.schema import parameter


@dataclass(frozen=True, slots=True)
class StudyKeys:
    """Keys of a study file; its axes are keys of the case, such as
    "contact.friction_coefficient".
    """

    case: str = parameter(
        doc="path of a case file; or a table [case] with keys of a case, and extends = "
        '"case.toml" for the other keys'
    )
    title: str = parameter("", doc="title of tables and figures; left out: the file's name")
    axes: dict[str, Any] = parameter(
        "",
        doc="table of keys of the case, each with a list of values; every value of one key is "
        "combined with every value of the others; in motion.source, lick:*, lick:1-40, "
        "ensemble.h5#*, ensemble.h5#1-40 and fema-p695:far_field/* also stand for lists of motions",
    )
    zip: list[Any] = parameter(
        "",
        doc="[[zip]], as often as needed: a table of keys with lists of one length, whose values "
        "change together; combined with every value of the other axes",
    )
    latin_hypercube: dict[str, Any] = parameter(
        "",
        doc='table of samples, seed and ranges [low, high] or [low, high, "log"] of keys with '
        "numbers, sampled by a Latin hypercube; combined with every value of the other axes",
    )


@dataclass(frozen=True, slots=True)
class LatinHypercube:
    """Keys of [latin_hypercube] of a study, besides the keys of the case and their ranges."""

    samples: int = parameter(doc="number of samples", low=1, high=10**6)
    seed: int = parameter(
        0,
        doc="seed of the random numbers; the same seed makes the same samples on every machine",
        low=0,
        high=10**6,
    )
