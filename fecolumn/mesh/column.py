"""Bricks of the column: a finely meshed lower and a coarser upper part, not connected to each other."""

from __future__ import annotations

import math

from fecolumn.case import Case
from fecolumn.mesh.bricks import LOWER, UPPER, BrickMesh, merge
from fecolumn.mesh.gmsh_section import Annulus, Disc, extruded


def column_mesh(case: Case) -> BrickMesh:
    """Tube or solid cylinder with its foot at z = 0 and its axis on z.

    The number of bricks around is a multiple of 4, so the mesh has the column's symmetry about the planes x = 0
    and y = 0 and prefers no direction of fall. The lower part has a multiple of the upper part's bricks
    around, so that every corner of the upper part's lower ring is a point of the lower part's upper ring.
    """
    column = case.column
    lower_height = column.fine_height_m
    upper_height = column.height_m - lower_height
    # A sliver of a part would be an uncalled-for row of flat bricks.
    if upper_height < 1e-6 * column.height_m:
        lower_height, upper_height = column.height_m, 0.0
    elif lower_height < 1e-6 * column.height_m:
        lower_height, upper_height = 0.0, column.height_m
    parts = []
    if lower_height:
        parts.append(extruded(section(case, LOWER), 0.0, lower_height, divisions(lower_height, case.mesh.fine_size_m), LOWER))
    if upper_height:
        parts.append(extruded(section(case, UPPER), lower_height, upper_height,
                              divisions(upper_height, case.mesh.coarse_size_m), UPPER))
    return merge(parts)


def is_solid(case: Case) -> bool:
    """Whether the wall reaches the axis."""
    return case.column.wall_m >= case.column.outer_diameter_m / 2 * (1 - 1e-6)


def section(case: Case, part: int) -> Annulus | Disc:
    """Section of the lower or upper part."""
    fine, coarse = case.mesh.fine_size_m, case.mesh.coarse_size_m
    radius = case.column.outer_diameter_m / 2
    solid = is_solid(case)
    around = 2 * math.pi * (radius if solid else case.mean_radius_m)
    n_upper = 4 * max(2, round(around / (4 * coarse)))
    n_around = n_upper * divisions(around / n_upper, fine) if part == LOWER else n_upper
    if solid:
        # The ring between the O-grid's square and the circle is half a radius wide on average.
        return Disc(radius, n_around, divisions(radius / 2, fine if part == LOWER else coarse))
    return Annulus(radius - case.column.wall_m, radius, n_around, divisions(case.column.wall_m, fine))


def divisions(length: float, size: float) -> int:
    """Whole number of bricks, at least one, whose size [m] is nearest to `size` along `length` [m]."""
    return max(1, round(length / size))
