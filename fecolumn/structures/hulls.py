"""Corners of convex bodies whose contact is found while they move."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from fecolumn.case.case import Case
from fecolumn.contact.convex import Hulls, hull_of, is_convex_body, no_hull
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.model import FoundContact, HullOutline
from fecolumn.structures.patches import Patch

#: Name of the surface of a body that has the corners of its hull.
HULL = "hull"


def hull_patch(drawing: Drawing) -> Patch:
    """Corners of the hull of a drawing, as a surface of it."""
    corners = hull_of(drawing.points).corners
    low, high = corners.min(axis=0), corners.max(axis=0)
    sides = high - low
    area = 2 * (sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0])
    shared = np.full(len(corners), area / len(corners))
    return Patch(
        None,
        corners,
        corners.mean(axis=0),
        np.eye(3),
        shared,
        np.ones(len(corners), bool),
        np.zeros((0, 3), np.int64),
        shared,
    )


def hulls_of_parts(outlines: Iterable[HullOutline | None]) -> list[Hulls]:
    """Hull of each of `StructureModel.outlines`, none of a part that has no outline or is not
    convex.
    """
    made: dict[int, Hulls] = {}
    for outline in outlines:
        if id(outline) not in made:
            made[id(outline)] = no_hull()
            if outline is not None:
                hull = hull_of(np.array(outline["points"]), outline["volume"])
                made[id(outline)] = hull if is_convex_body(hull)[0] else no_hull()
    return [made[id(outline)] for outline in outlines]


def found_contact(
    case: Case,
    places: dict[tuple[str, int], int],
    outlines: dict[str, HullOutline | None],
    file: Path | str,
) -> FoundContact | None:
    """Contact of a case that is found; None where there is none.

    Parameters
    ----------
    places
        of the parts by body and number of the copy.
    outlines
        of the bodies by name, as of `StructureModel.outlines`.

    Raises
    ------
    InputError
        a body that is not convex.
    """
    if not case.found:
        return None
    chosen = case.contact.between
    for name in dict.fromkeys(name for name, _ in case.found):
        outline = outlines[name]
        assert outline is not None  # matrices, which have none, are refused by the case
        hull = hull_of(np.array(outline["points"]), outline["volume"])
        if not is_convex_body(hull)[0]:
            raise InputError(
                file,
                "contact.between",
                chosen if chosen == "all" else list(chosen),
                f'"{name}" is not convex, it fills {hull.share[0]:.3g} of its hull: name the '
                "bodies that are, or make it of convex ones",
            )
    contact = case.contact
    return FoundContact(
        tuple(places[one] for one in case.found), contact.friction_coefficient, contact.restitution
    )
