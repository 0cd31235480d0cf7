"""Keys of a study file beside those of a case: what each means, its range and its default."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fecolumn.foundation.schema import parameter


@dataclass(frozen=True, slots=True)
class StudyKeys:
    """What a study file holds; its axes are keys of the case, such as
    "contact.friction_coefficient".
    """

    case: str = parameter(
        doc="path of a case file; or a table [case] of keys of a case, with extends = "
        '"case.toml" for the other keys'
    )
    title: str = parameter("", doc="title of tables and figures; left out: the file's name")
    axes: dict[str, Any] = parameter(
        "",
        doc="table of lists, each with each: a key of the case and its values; of "
        "motion.source, lick:* and lick:1-40 or "
        "ensemble.h5#* and ensemble.h5#1-40 are lists of motions, too",
    )
    zip: list[Any] = parameter(
        "",
        doc="[[zip]], as often as needed: a table of lists of one length whose values go "
        "together, one factor of the product",
    )
    latin_hypercube: dict[str, Any] = parameter(
        "",
        doc='table of samples, seed and ranges [low, high] or [low, high, "log"] of '
        "numbers, evenly spread at "
        "random: one factor of the product",
    )


@dataclass(frozen=True, slots=True)
class LatinHypercube:
    """Keys of a study's [latin_hypercube] beside its ranges."""

    samples: int = parameter(doc="number of samples", low=1, high=10**6)
    seed: int = parameter(
        0,
        doc="of the random numbers; the same seed gives the same samples on any machine",
        low=0,
        high=10**6,
    )
