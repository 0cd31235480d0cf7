"""What the page draws between points of its parts: tendons and other links, and the columns of
buildings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.pictures.render.page.parts import RigidPart
from fecolumn.pictures.render.result import Result


@dataclass(frozen=True, slots=True)
class Rod:
    """A rod between two points, each fixed to a part.

    Attributes
    ----------
    name
        of the link; "" of a column.
    parts
        numbers of the two parts, -1 of the ground.
    arms
        (2, 3) [m] the points from the places of their parts; of the ground from its origin.
    tension
        (t,) [N], nan where it has broken; None of a column.
    """

    name: str
    parts: tuple[int, int]
    arms: np.ndarray
    tension: np.ndarray | None = None


def rods_of_links(result: Result, parts: list[RigidPart], times: np.ndarray) -> list[Rod]:
    """The links of a structure at `times` (t,) [s]."""
    first: dict[int, int] = {}
    for k, part in enumerate(parts):
        first.setdefault(part.body, k)
    first[GROUND] = -1
    rows = np.minimum(np.searchsorted(result.time, times - 1e-9), len(result.time) - 1)
    found = []
    for one in result.scene.links:
        broken = result.history[f"link/{one.name}/broken"][rows] > 0
        tension = np.where(broken, np.nan, result.history[f"link/{one.name}/tension"][rows])
        arms = np.array([one.arm_a, one.arm_b])
        found.append(Rod(one.name, (first[one.a], first[one.b]), arms, tension))
    return found


def rods_of_storeys(result: Result, parts: list[RigidPart]) -> list[Rod]:
    """The columns of buildings, from the slab or a floor to the floor above."""
    found = []
    for body, piece in enumerate(result.scene.bodies):
        own = [k for k, part in enumerate(parts) if part.body == body]
        firm = len(piece.points) - piece.carried
        for strut in piece.struts:
            levels = [0 if point < firm else 1 + (point - firm) // 8 for point in strut]
            a, b = (own[level] for level in levels)
            found.append(Rod("", (a, b), piece.upright[strut] - parts[a].rest))
    return found
