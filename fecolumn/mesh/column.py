"""Bricks of the column: a finely meshed lower and a coarser upper part, and a flange; not connected
to each other.
"""

from __future__ import annotations

import math

import numpy as np

from fecolumn.mesh.bricks import FLANGE, LOWER, UPPER, BrickMesh, merged_mesh
from fecolumn.mesh.gmsh_section import extruded
from fecolumn.mesh.outline import is_solid
from fecolumn.mesh.section import Annulus, Disc, Rectangle
from fecolumn.mesh.upright import Upright


def column_mesh(case: Upright) -> BrickMesh:
    """Tube, solid cylinder or block, on its flange if it has one; its foot at z = 0 and its axis on
    z.

    The number of bricks around is a multiple of 4, so the mesh has the column's symmetry about the
    planes x = 0 and y = 0 and prefers no direction of fall. The lower part has a multiple of the
    upper part's bricks around, so that every corner of the upper part's lower ring is near a point
    of the lower part's upper ring.

    Round sections are polygons of the true area, so that mass, inertia and bending stiffness are
    those of the circle at any brick size. Only the foot's own nodes lie on the true circles, since
    the column rolls on them and its critical tilt is theirs; the part above makes up for what its
    lowest layer lacks. Where the lower part meets the upper one it takes its polygon.
    """
    parts, layout = [], part_layers(case)
    for place, (part, bottom, height, layers) in enumerate(layout):
        plane = section(case, part)
        mesh = extruded(plane, bottom, height, layers, part)
        z, corners = mesh.points[:, 2], plane.equal_area
        meets = part == LOWER and place + 1 < len(layout)
        factor = np.full(
            len(z), corners if place else _spread(corners, layers, corners if meets else None)
        )
        if not place:
            factor[z == 0] = 1.0
        if meets:
            at_joint = z > bottom + height * (1 - 0.5 / layers)
            above = section(case, UPPER)
            factor[at_joint] = above.outline(mesh.points[at_joint]) * above.equal_area
        mesh.points[:, :2] *= factor[:, None]
        parts.append(mesh)
    return merged_mesh(parts)


def part_layers(case: Upright) -> list[tuple[int, float, float, int]]:
    """Part, bottom [m], height [m] and layers of bricks of the built parts, from the foot
    upwards.
    """
    column, mesh, seat = case.column, case.mesh, case.seat_m
    lower = column.fine_height_m
    upper = column.height_m - lower
    # A sliver of a part would be an uncalled-for row of flat bricks.
    if upper < 1e-6 * column.height_m:
        lower, upper = column.height_m, 0.0
    elif lower < 1e-6 * column.height_m:
        lower, upper = 0.0, column.height_m
    found = [(FLANGE, 0.0, seat, divisions(seat, mesh.fine_size_m))] if case.flange else []
    if lower:
        found.append((LOWER, seat, lower, divisions(lower, mesh.fine_size_m)))
    if upper:
        found.append((UPPER, seat + lower, upper, divisions(upper, mesh.coarse_size_m)))
    return found


def _spread(equal_area: float, layers: int, top: float | None) -> float:
    """Factor s on the radii between foot and top of a part by which its volume is that of the
    circle, the foot's factor being 1.

    Each layer has the mean (p^2 + p q + q^2) / 3 of the factors p, q of its ends; the top's is s
    too unless it is given.
    """
    if top is None:
        a, b, c = layers - 2 / 3, 1 / 3, 1 / 3 - layers * equal_area**2
    elif layers == 1:
        return top
    else:
        a, b, c = layers - 4 / 3, (1 + top) / 3, (1 + top**2) / 3 - layers * equal_area**2
    return (-b + math.sqrt(b * b - 4 * a * c)) / (2 * a)


def section(case: Upright, part: int) -> Annulus | Disc | Rectangle:
    """Section of the flange, the lower or the upper part, its circles the true ones."""
    column, fine, coarse = case.column, case.mesh.fine_size_m, case.mesh.coarse_size_m
    if part == FLANGE or column.shape != "block":
        return round_section(case, part)
    counts = [divisions(side, coarse) for side in (column.length_m, column.width_m)]
    if part == LOWER:
        counts = [
            n * divisions(side / n, fine)
            for side, n in zip((column.length_m, column.width_m), counts)
        ]
    return Rectangle(column.length_m, column.width_m, *counts)


def round_section(case: Upright, part: int) -> Annulus | Disc:
    """As `section`, of the flange or of a round column."""
    column, fine, coarse = case.column, case.mesh.fine_size_m, case.mesh.coarse_size_m
    if part == FLANGE:
        outer, inner = case.flange.outer_diameter_m / 2, case.flange.inner_diameter_m / 2
        n_around = 4 * max(2, round(2 * math.pi * outer / (4 * fine)))
        return (
            Annulus(inner, outer, n_around, divisions(outer - inner, fine))
            if inner
            else Disc(outer, n_around, divisions(outer / 2, fine))
        )
    radius = column.outer_diameter_m / 2
    solid = is_solid(case.column)
    around = 2 * math.pi * (radius if solid else case.mean_radius_m)
    n_upper = 4 * max(2, round(around / (4 * coarse)))
    n_around = n_upper * divisions(around / n_upper, fine) if part == LOWER else n_upper
    if solid:
        # The ring between the O-grid's square and the circle is half a radius wide on average.
        return Disc(radius, n_around, divisions(radius / 2, fine if part == LOWER else coarse))
    return Annulus(radius - column.wall_m, radius, n_around, divisions(column.wall_m, fine))


def divisions(length: float, size: float) -> int:
    """Whole number of bricks, at least one, whose size [m] is nearest to `size` along `length`
    [m].
    """
    return max(1, round(length / size))
