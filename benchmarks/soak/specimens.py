"""Specimens: tubes, solid cylinders and blocks from 20 mm to 2 m across, of wood to steel, on
plates, flats without edges and pads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchmarks.soak.hypercube import Draw, hypercube

# Each has a model of its own, which takes seconds to make; many analyses share one
COUNT = 60
SEED = 1
NAMES = (
    "shape",
    "width",
    "slenderness",
    "wall",
    "aspect",
    "modulus",
    "density",
    "poisson",
    "base",
    "base_modulus",
    "cap",
    "flange",
    "points",
)


@dataclass(frozen=True, slots=True)
class Specimen:
    """A standing column.

    Attributes
    ----------
    tables
        of a case, but for its analysis.
    width_m
        smaller side of what it stands on, height_m: of the whole.
    density_kg_m3
        of the column.
    """

    tables: dict[str, dict]
    width_m: float
    height_m: float
    density_kg_m3: float

    @property
    def shape(self) -> str:
        return self.tables["column"]["shape"]

    @property
    def base(self) -> str:
        return self.tables["base"]["kind"]

    @property
    def slenderness_rad(self) -> float:
        """Critical tilt of a uniform body of this width and height [rad]."""
        return math.atan(self.width_m / self.height_m)


def specimens(count: int = COUNT) -> list[Specimen]:
    """Always the same ones."""
    return [_specimen(draw) for draw in hypercube(NAMES, count, SEED)]


def _specimen(draw: Draw) -> Specimen:
    shape = draw.one_of("shape", {"tube": 4, "solid": 3, "block": 3})
    side = draw.log("width", 0.02, 2.0)
    height = _short(side * draw.log("slenderness", 1.5, 15))
    other = _short(side * draw.even("aspect", 0.6, 1.0)) if shape == "block" else side
    column = {"shape": shape, "height_m": height}
    column |= (
        {"length_m": side, "width_m": other} if shape == "block" else {"outer_diameter_m": side}
    )
    if shape == "tube":
        column["wall_m"] = _short(side * draw.even("wall", 0.04, 0.3))
    column["fine_height_m"] = _short(min(0.1 * side, height))
    density = draw.even("density", 500, 8000)
    tables = {
        "column": column,
        "material": {
            "youngs_modulus_pa": draw.log("modulus", 1e9, 2.1e11),
            "poissons_ratio": draw.even("poisson", 0, 0.45),
            "density_kg_m3": density,
        },
        "base": {
            "kind": draw.one_of("base", {"plate": 2, "unbounded": 1, "pad": 1}),
            "youngs_modulus_pa": draw.log("base_modulus", 1e9, 2.1e11),
        },
    }
    tables["mesh"] = _mesh(column)
    tables["contact"] = {"interior_points": draw.one_of("points", {0: 4, 16: 3, 64: 1})}
    width, whole = min(side, other), height
    if times := draw.rarely("cap", 0.3, lambda one: one.even("cap", 1.05, 2.0)):
        tables["cap"] = {
            "length_m": _short(side * times),
            "width_m": _short(side * times),
            "thickness_m": _short(0.1 * side),
        }
        whole += tables["cap"]["thickness_m"]
    if times := draw.rarely("flange", 0.2, lambda one: one.even("flange", 1.05, 1.6)):
        width = _short(math.hypot(side, other) * times if shape == "block" else side * times)
        tables["flange"] = {"outer_diameter_m": width, "thickness_m": _short(0.08 * side)}
        whole += tables["flange"]["thickness_m"]
    return Specimen(tables, width, whole, density)


def _mesh(column: dict) -> dict:
    """Bricks as coarse as a study may have them: a model is to take seconds."""
    if column["shape"] == "block":
        side = min(column["length_m"], column["width_m"])
        fine, coarse = side / 6, side / 3
    else:
        around = math.pi * (column["outer_diameter_m"] - column.get("wall_m", 0.0))
        fine, coarse = (
            (around / 48, around / 10) if column["shape"] == "tube" else (around / 20, around / 10)
        )
    return {
        "fine_size_m": _short(0.999 * fine),
        "coarse_size_m": _short(coarse),
        "base_size_m": _short(12 * fine),
    }


def _short(length: float) -> float:
    return float(f"{length:.4g}")
