"""Elements of a round body: tube, cylinder or cone, with its flange and its cap."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Cone
from fecolumn.case.sections import Cap, Flange
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import CAP, FLANGE, UPPER, BrickMesh, merged_mesh
from fecolumn.mesh.column import divisions
from fecolumn.mesh.gmsh_section import extruded, swept_grid
from fecolumn.mesh.section import Annulus, Disc
from fecolumn.mesh.tie import adjust, tie
from fecolumn.structures.lines import fine_at_ends
from fecolumn.structures.shape import Round, Shape, coarse_size, element_size


def round_sections(body: Round, size: float) -> list[Annulus | Disc]:
    """Sections of a round body, and of its flange if it has one."""
    radius, wall = body.outer_diameter_m / 2, getattr(body, "wall_m", None)
    n_around = 4 * max(3, round(2 * math.pi * (radius - (wall or 0.0) / 2) / (4 * size)))
    planes = [
        Annulus(radius - wall, radius, n_around, divisions(wall, size))
        if wall
        else Disc(radius, n_around, divisions(radius / 2, size))
    ]
    if flange := plates_of(body)[0]:
        outer, inner = flange.outer_diameter_m / 2, flange.inner_diameter_m / 2
        n_flange = 4 * max(3, round(2 * math.pi * outer / (4 * size)))
        planes.append(
            Annulus(inner, outer, n_flange, divisions(outer - inner, size))
            if inner
            else Disc(outer, n_flange, divisions(outer / 2, size))
        )
    return planes


def plates_of(body: Round) -> tuple[Flange | None, Cap | None]:
    """Flange and cap of a round body, None where it has none."""
    return (None, None) if isinstance(body, Cone) else (body.flange, body.cap)


def flange_layers(flange: Flange, size: float) -> int:
    """Elements through a flange."""
    return max(2, divisions(flange.thickness_m, size))


def round_shape(key: str, body: Round, file: Path | str) -> Shape:
    """Tube, cylinder or cone, on its flange and below its cap if it has them, tied; element sizes
    are those of the body's ends.
    """
    size = element_size(body)
    flange, cap = plates_of(body)
    planes = round_sections(body, size)
    levels = fine_at_ends(body.height_m, size, coarse_size(body, size))
    seat = flange.thickness_m if flange else 0.0
    parts, joints = (
        [_swept(planes[0], seat + levels, UPPER, (not flange, not cap), _taper(body, levels))],
        [],
    )
    if flange:
        parts.insert(
            0,
            _swept(
                planes[1],
                np.linspace(0.0, seat, flange_layers(flange, size) + 1),
                FLANGE,
                (True, False),
            ),
        )
        joints.append((FLANGE, seat, f"{key}.flange, {key}.element_size_m"))
    if cap:
        top = seat + body.height_m
        x, y = (
            np.linspace(-side / 2, side / 2, divisions(side, size) + 1)
            for side in (cap.length_m, cap.width_m)
        )
        parts.append(
            swept_grid(
                x,
                y,
                top + np.linspace(0.0, cap.thickness_m, divisions(cap.thickness_m, size) + 1),
                CAP,
            )
        )
        joints.append((CAP, top, f"{key}.cap, {key}.element_size_m"))
    mesh = merged_mesh(parts)
    # how far a slave may be moved: the sagittas of the chords, and a tenth of an element
    reach = (
        sum(one.equal_area * _outer(one) * (1 - math.cos(math.pi / one.n_around)) for one in planes)
        + 0.1 * size
    )
    flat = 1e-6 * np.ptp(mesh.points[:, 2])
    try:
        ties = tuple(
            tie(mesh, UPPER, part, level, flat, reach, names) for part, level, names in joints
        )
    except InputError as error:
        raise InputError(file, error.key, None, error.allowed) from None
    return Shape(adjust(mesh, ties), ties, body.element_order or 1, size)


def _outer(plane: Annulus | Disc) -> float:
    return plane.radius if isinstance(plane, Disc) else plane.outer_radius


def _taper(body: Round, levels: NDArray[Any]) -> NDArray[Any]:
    """Radii (n,) of a body at levels (n,) [m] above its foot, over that of its section."""
    if not isinstance(body, Cone):
        return np.ones(len(levels))
    ends = np.array([body.bottom_diameter_m, body.top_diameter_m]) / body.outer_diameter_m
    return np.interp(levels, [0.0, body.height_m], ends)


def _swept(
    plane: Annulus | Disc,
    levels: NDArray[Any],
    part: int,
    true_ends: tuple[bool, bool],
    radii: NDArray[Any] | None = None,
) -> BrickMesh:
    """Bricks of a round section between levels (n,) [m], with radii (n,) over its own there.

    The section is a polygon. At ends that touch other bodies its corners lie on the true circles,
    since the body rolls on them; between, they lie so far outside that the volume is that of the
    circle.
    """
    radii = np.ones(len(levels)) if radii is None else radii
    layers = len(levels) - 1
    mesh = extruded(plane, 0.0, float(layers), layers, part)
    level = np.rint(mesh.points[:, 2]).astype(int)
    factors = radii * _spread(plane.equal_area, np.diff(levels), radii, true_ends)
    for end, true in zip((0, -1), true_ends):
        if true:
            factors[end] = radii[end]
    points = np.column_stack([mesh.points[:, :2] * factors[level][:, None], levels[level]])
    return replace(mesh, points=points)


def _spread(
    equal_area: float, heights: NDArray[Any], radii: NDArray[Any], true_ends: tuple[bool, bool]
) -> float:
    """Factor s on the radii of all levels but those true ends whose factor is 1, by which the
    volume is that of the circle, or of the frustum.

    A layer of height h between radii p, q has the share h (p^2 + p q + q^2) / 3.
    """
    layers = np.column_stack([heights, radii[:-1], radii[1:]])
    ends = [
        layer
        for layer, true in zip((layers[0], layers[-1][[0, 2, 1]]), true_ends)
        if true  # its own radius before the other
    ]
    squares = sum(height * own**2 for height, own, _ in ends)
    crossed = sum(height * own * other for height, own, other in ends)
    whole = (heights * ((radii[:-1] ** 2 + radii[:-1] * radii[1:] + radii[1:] ** 2) / 3)).sum()
    a, b, c = (
        whole - (squares + crossed) / 3,
        crossed / 3,
        squares / 3 - whole * equal_area**2,
    )
    factor: float = (-b + math.sqrt(b * b - 4 * a * c)) / (2 * a)
    return factor
