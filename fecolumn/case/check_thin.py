"""Dimensions of a body that are too small beside its largest one to be meshed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from fecolumn.case.bodies import Arch, Prism, Tube
from fecolumn.case.body_keys import WithMaterial
from fecolumn.case.checked import Refuse
from fecolumn.case.column_keys import ColumnSections
from fecolumn.case.polygon import signed_area
from fecolumn.case.sections import Cap, Flange
from fecolumn.foundation.schema import Section
from fecolumn.mesh.outline import is_solid

#: Least dimension of a body over its largest one. Gmsh takes points nearer than 1e-8 of its model
#: for one; faces and hulls of bodies are found to 1e-6 of their size.
THINNEST = 1e-5
_DIMENSIONS = (
    "length_m",
    "width_m",
    "height_m",
    "thickness_m",
    "outer_diameter_m",
    "wall_m",
    "bottom_diameter_m",
    "top_diameter_m",
    "mean_radius_m",
)


class Dimension(NamedTuple):
    """A length of a body.

    key, value: that decide it, as the file has them. metres: the length [m]. made: how the key
    makes it, such as "leaves a bore of"; empty where it is the value itself.
    """

    key: str
    value: object
    metres: float
    made: str = ""


def check_thin(key: str, body: WithMaterial, refuse: Refuse) -> None:
    """Refuse a body of which a dimension is less than THINNEST of its largest."""
    found = _stated(key, body)
    if isinstance(body, Tube):
        found.append(_bore(key, body.outer_diameter_m, body.wall_m))
    if isinstance(body, Prism):
        found += _of_outline(key, body)
    if isinstance(body, Arch):
        inside = body.mean_radius_m - body.thickness_m / 2
        made = "leaves an inner radius of"
        found.append(Dimension(f"{key}.thickness_m", body.thickness_m, inside, made))
    for name in ("flange", "cap"):
        found += _of_plate(f"{key}.{name}", getattr(body, name, None))
    refuse_thin(found, refuse)


def check_thin_column(case: ColumnSections, refuse: Refuse) -> None:
    """As `check_thin`, of the column of a short form, its flange and cap; a column of one's own
    mesh has the dimensions of the mesh.
    """
    column = case.column
    found = [] if column.mesh_file else _stated("column", column)
    if found and column.shape == "tube" and not is_solid(column):
        assert column.outer_diameter_m is not None and column.wall_m is not None
        found.append(_bore("column", column.outer_diameter_m, column.wall_m))
    refuse_thin(found + _of_plate("flange", case.flange) + _of_plate("cap", case.cap), refuse)


def refuse_thin(dimensions: Sequence[Dimension], refuse: Refuse) -> None:
    """Refuse the smallest of a body's dimensions if it is less than THINNEST of the largest."""
    if not dimensions:
        return
    smallest = min(dimensions, key=lambda one: one.metres)
    largest = max(dimensions, key=lambda one: one.metres)
    least = THINNEST * largest.metres
    if smallest.metres < least * (1 - 1e-6):
        made = smallest.made and f"{smallest.made} {smallest.metres:.3g} m, which "
        refuse(
            smallest.key,
            smallest.value,
            f"{made}must be at least {least:.6g} m, {THINNEST:g} of the largest dimension, "
            f"{largest.metres:g} m ({largest.key}): less cannot be meshed",
        )


def _stated(key: str, section: Section) -> list[Dimension]:
    values = ((name, getattr(section, name, None)) for name in _DIMENSIONS)
    return [Dimension(f"{key}.{name}", value, value) for name, value in values if value is not None]


def _bore(key: str, outer: float, wall: float) -> Dimension:
    return Dimension(f"{key}.wall_m", wall, outer - 2 * wall, "leaves a bore of")


def _of_plate(key: str, plate: Flange | Cap | None) -> list[Dimension]:
    if plate is None:
        return []
    found = _stated(key, plate)
    if isinstance(plate, Flange) and (hole := plate.inner_diameter_m):
        ring = (plate.outer_diameter_m - hole) / 2
        found.append(Dimension(f"{key}.inner_diameter_m", hole, hole))
        found.append(Dimension(f"{key}.inner_diameter_m", hole, ring, "leaves a ring of"))
    return found


def _of_outline(key: str, body: Prism) -> list[Dimension]:
    """Extent of a polygon, its shortest side, and its area over its extent."""
    outline, told = body.outline_m, [list(corner) for corner in body.outline_m]
    sides = [math.dist(*ends) for ends in zip(outline, outline[1:] + outline[:1])]
    extent = max(max(axis) - min(axis) for axis in zip(*outline))
    across = abs(signed_area(outline)) / extent
    return [
        Dimension(f"{key}.outline_m", told, extent, "has an extent of"),
        Dimension(f"{key}.outline_m", told, min(sides), "has a side of"),
        Dimension(f"{key}.outline_m", told, across, "has a mean thickness of"),
    ]
