"""Links of a structure from those of its case."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.link import PULLING, PUSHING
from fecolumn.contact.points import GROUND
from fecolumn.structures.model import LinkModel
from fecolumn.structures.standing import Standing
from fecolumn.structures.store import (
    shape_at,
)


def links_at_copies(
    case: Case, name: str, places: dict[tuple[str, int], int], standing: list[Standing]
) -> Iterator[LinkModel]:
    """The links of a name, one at each copy of its body; points as the bodies stand."""
    keys = case.links[name]
    body, numbers = case.meant_by(keys.body)
    for number in numbers:
        a = places[body, number]
        origin = np.array(case.bodies[body].places[number])
        other = GROUND
        if keys.to not in case.grounds:
            other_body, (other_number,) = case.meant_by(keys.to)
            other = places[other_body, other_number]
        start, end = origin + keys.point_m, origin + keys.to_point_m
        ground = list(case.grounds).index(keys.to) if other == GROUND else 0
        if standing[a].held >= 0:
            a, other, start, end = other, a, end, start
        # what a fixed body holds, its ground holds
        if other != GROUND and standing[other].held >= 0:
            other, ground = GROUND, standing[other].held
        pulls, pushes = keys.kind in PULLING, keys.kind in PUSHING
        yield LinkModel(
            name if len(numbers) == 1 else f"{name} {number + 1}",
            keys.kind,
            a,
            start - standing[a].center,
            other,
            end if other == GROUND else end - standing[other].center,
            keys.stiffness_n_m,
            keys.damping_n_s_m,
            0.0 - keys.prestress_n if pushes and not pulls else keys.prestress_n,
            keys.slack_m + keys.gap_m,
            pushes,
            pulls,
            keys.yield_n or keys.slip_n or math.inf,
            keys.breaking_n or math.inf,
            ground,
            keys.hardening,
            keys.yield_exponent or math.inf,
            keys.damping_exponent,
            keys.linear_below_m_s if keys.damping_exponent < 1 else 0.0,
        )


def with_shapes(
    link: LinkModel,
    copies: Sequence[tuple[str, int]],
    standing: list[Standing],
    keys: dict[str, str],
) -> LinkModel:
    """A link with the shapes of the modes at its ends; keys: of the bodies in `store`."""

    def shape(place: int, arm: NDArray[Any]) -> NDArray[Any] | None:
        if place == GROUND or not len(standing[place].model.frequencies):
            return None
        key = keys.get(copies[place][0])
        found = shape_at(key, arm) if key else None
        return None if found is None else found[:, : len(standing[place].model.frequencies)]

    return replace(link, shape_a=shape(link.a, link.arm_a), shape_b=shape(link.b, link.arm_b))
