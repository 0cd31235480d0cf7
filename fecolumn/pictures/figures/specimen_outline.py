"""Outline of a specimen from the tables of its case: what figures draw of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class OutlinePart:
    """A part of the specimen in elevation: name, half its width along x, heights of bottom and top
    [m], and whether it is hollow (wall [m]).
    """

    name: str
    half_width_m: float
    bottom_m: float
    top_m: float
    wall_m: float | None = None


@dataclass(frozen=True, slots=True)
class Outline:
    """A specimen.

    Attributes
    ----------
    foot
        (k, 2) closed outline of its foot [m], in plan.
    round
        whether it is a circle.
    parts
        in elevation, base plate first; the base's top is at height 0.
    words
        dimensions in a line, such as "tube 76.1 x 5 mm, height 1500 mm".
    """

    foot: NDArray[Any]
    round: bool
    parts: tuple[OutlinePart, ...]
    words: str


def specimen_outline(case: dict[str, Any]) -> Outline | None:
    """The outline from the tables of a case (`case.json`); None of a specimen whose shape the case
    does not tell, as of an own mesh.
    """
    column, flange, cap, base = (
        case.get(name) or {} for name in ("column", "flange", "cap", "base")
    )
    if column.get("mesh_file") or not column.get("height_m"):
        return None
    bottom, parts, words = 0.0, [], []
    if column.get("shape") == "block":
        if not (column.get("length_m") and column.get("width_m")):
            return None
        half, wall, round_ = (column["length_m"] / 2, column["width_m"] / 2), None, False
        words.append(f"block {_mm(column['length_m'])} × {_mm(column['width_m'])} mm")
    elif column.get("outer_diameter_m"):
        radius, wall, round_ = column["outer_diameter_m"] / 2, column.get("wall_m"), True
        wall = (
            wall if wall and wall < radius * (1 - 1e-9) and column.get("shape") != "solid" else None
        )
        half = radius, radius
        words.append(
            f"tube {_mm(2 * radius)} × {_mm(wall)} mm"
            if wall
            else f"solid cylinder {_mm(2 * radius)} mm"
        )
    else:
        return None
    foot = half
    if flange.get("outer_diameter_m"):
        foot, round_ = (flange["outer_diameter_m"] / 2,) * 2, True
        parts.append(OutlinePart("foot plate", foot[0], 0.0, bottom := flange["thickness_m"]))
        words.append(f"foot plate {_mm(2 * foot[0])} mm")
    parts.append(OutlinePart("column", half[0], bottom, bottom + column["height_m"], wall))
    words.append(f"height {_mm(column['height_m'])} mm")
    if cap.get("length_m"):
        parts.append(
            OutlinePart(
                "cap", cap["length_m"] / 2, parts[-1].top_m, parts[-1].top_m + cap["thickness_m"]
            )
        )
        words.append(
            f"cap {_mm(cap['length_m'])} × {_mm(cap['width_m'])} × {_mm(cap['thickness_m'])} mm"
        )
    thickness = base.get("thickness_m") or 0.25 * min(foot)
    parts.insert(0, OutlinePart("base", (base.get("length_m") or 5 * foot[0]) / 2, -thickness, 0.0))
    return Outline(_edge(*foot, round_), round_, tuple(parts), ", ".join(words))


def _edge(half_x: float, half_y: float, round_: bool) -> NDArray[Any]:
    if round_:
        angle = np.linspace(0, 2 * np.pi, 181)
        return half_x * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) * [half_x, half_y]


def _mm(length_m: float) -> str:
    return f"{1e3 * length_m:.4g}"
