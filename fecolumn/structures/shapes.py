"""Meshes of single bodies, each in its own drawing, z up: the middle of its foot at the origin, of
a prism the point from which its outline is measured.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Block, Cone, Cylinder, MeshBody, Plate, Prism, Storeys, Tube
from fecolumn.case.polygon import signed_area
from fecolumn.case.sections import Cap, Flange
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import CAP, FLANGE, UPPER, BrickMesh, brick_mesh, merged_mesh
from fecolumn.mesh.column import divisions
from fecolumn.mesh.gmsh_section import NotMeshed, extruded, swept_grid
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.jacobian import corner_jacobians
from fecolumn.mesh.prism import polygon_counts, prism_mesh
from fecolumn.mesh.section import Annulus, Disc
from fecolumn.mesh.tie import Tie, adjust, tie
from fecolumn.structures.lines import (
    Span,
    count_at_ends,
    count_at_spots,
    fine_at_ends,
    fine_at_spots,
)
from fecolumn.structures.tied import is_tied, tied_counts, tied_mesh

# Elements around a round body, and along the geometric mean of a block's sides
AROUND, _ALONG = 24, 8
# Length of linear elements along a bar over its depth d: a length l makes bending stiffer by (l /
# d)^2 / 2
_LONG = 0.2
# Elements along the longer side of a plate, away from what stands on it
_ACROSS = 8


#: Bodies with a round section, those whose elements are made here, and all that have elements.
Round = Tube | Cylinder | Cone
Gridded = Round | Block | Plate | Prism | Storeys
Meshable = Gridded | MeshBody
#: Low x, high x, low y, high y and size [m] in the drawing of a plate where another body meets it.
Spot = tuple[float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Shape:
    """A body's elements: mesh, ties between its parts, polynomial order of the elements, and
    element size at its foot [m].
    """

    mesh: BrickMesh
    ties: tuple[Tie, ...]
    order: int
    size: float


def shape_of(key: str, body: Meshable, file: Path | str, spots: Sequence[Spot] = ()) -> Shape:
    """Mesh of a body that is none of matrices.

    Parameters
    ----------
    key
        of the body in its case, for messages.
    spots
        (low x, high x, low y, high y, size) [m] in the drawing where other bodies meet a plate.

    Raises
    ------
    InputError
        a mesh file that cannot be used, parts that cannot be tied, or a body that Gmsh does not
        mesh.
    ValueError
        a kind without a mesh.
    """
    try:
        return _shape_of(key, body, file, spots)
    except NotMeshed as error:
        raise InputError(
            file,
            key,
            None,
            f"cannot be meshed: {error}; make what is thin thicker, or its elements of another "
            "size (element_size_m)",
        ) from None


def _shape_of(key: str, body: Meshable, file: Path | str, spots: Sequence[Spot]) -> Shape:
    if is_tied(body):
        return Shape(*tied_mesh(key, body, file))
    # by the word, so that a kind that comes from the class of another one has to be named here
    match body:
        case MeshBody(kind="mesh"):
            return _own(key, body, file)
        case Plate(kind="plate" | "slab") | Storeys(kind="storeys"):
            return _plate(body, spots)
        case Block(kind="block"):
            return _block(body)
        case Prism(kind="prism"):
            return _prism(key, body, file)
        case Tube(kind="tube") | Cylinder(kind="cylinder") | Cone(kind="cone"):
            return _round(key, body, file)
    raise ValueError(f"{key}: shape_of names no mesh of kind {body.kind!r}")


def element_size(body: Gridded) -> float:
    """Element size at feet and heads [m], as stated or as it follows from the body's dimensions."""
    if body.element_size_m is not None:
        return body.element_size_m
    if isinstance(body, (Plate, Storeys)):
        return max(body.length_m, body.width_m) / _ACROSS
    if isinstance(body, Block):
        return min(
            math.sqrt(body.length_m * body.width_m) / _ALONG, min(body.length_m, body.width_m) / 4
        )
    if isinstance(body, Prism):
        across = math.sqrt(abs(signed_area(body.outline_m)))
        return min(math.sqrt(across * body.width_m) / _ALONG, min(across, body.width_m) / 4)
    return (
        math.pi
        * (body.outer_diameter_m - (body.wall_m if isinstance(body, Tube) else 0.0))
        / AROUND
    )


def counts_of(
    key: str, body: Meshable, file: Path | str, spots: Sequence[Spot] = ()
) -> tuple[int, int]:
    """Elements and nodes of the mesh that `shape_of` makes, told without making it; arguments as
    there.
    """
    if is_tied(body):
        return tied_counts(body)
    if isinstance(body, MeshBody):
        shape = _own(key, body, file)
        return len(shape.mesh.cells), own_mesh(body.drawn).counts(shape.order)[0]
    if isinstance(body, (Plate, Storeys)):
        coarse, lines = _plate_lines(body, spots)
        grids = [
            tuple(
                count_at_spots(length, line, coarse)
                for length, line in zip((body.length_m, body.width_m), lines)
            )
            + (divisions(body.thickness_m, coarse),)
        ]
        return _counts(grids, (), _plate_order(body))
    size = element_size(body)
    if isinstance(body, Block):
        return _counts(
            [
                (
                    divisions(body.length_m, size),
                    divisions(body.width_m, size),
                    count_at_ends(body.height_m, size, _coarse_size(body, size)),
                )
            ],
            (),
            body.element_order or 1,
        )
    if isinstance(body, Prism):
        order, layers = body.element_order or 1, divisions(body.width_m, size)
        cells, nodes = polygon_counts(np.array(body.outline_m), size, order)
        return cells * layers, nodes * (order * layers + 1)
    planes, heights = (
        _planes(body, size),
        [count_at_ends(body.height_m, size, _coarse_size(body, size))],
    )
    flange, cap = _plates_of(body)
    if flange:
        heights.append(_flange_layers(flange, size))
    return _counts(
        [[divisions(side, size) for side in (cap.length_m, cap.width_m, cap.thickness_m)]]
        if cap
        else [],
        zip(planes, heights),
        body.element_order or 1,
    )


def _counts(
    grids: Sequence[Sequence[int]], swept: Iterable[tuple[Annulus | Disc, int]], order: int
) -> tuple[int, int]:
    """Elements and nodes of grids (elements along x, y, z) and of sections swept in layers."""
    swept = list(swept)
    return (
        sum(math.prod(grid) for grid in grids)
        + sum(plane.n_cells * layers for plane, layers in swept),
        sum(math.prod(order * n + 1 for n in grid) for grid in grids)
        + sum(plane.n_nodes(order) * (order * layers + 1) for plane, layers in swept),
    )


def _own(key: str, body: MeshBody, file: Path | str) -> Shape:
    try:
        own = own_mesh(body.drawn)
    except InputError as error:
        raise InputError(
            file, f"{key}.mesh_file", error.value, f"{body.mesh_file}: {error.allowed}"
        ) from None
    if not (own.has_foot or body.as_drawn):
        placed = "copies_m" if body.copies_m else "at_m"
        raise InputError(
            file,
            f"{key}.{placed}",
            [list(place) for place in body.copies_m] or list(body.at_m or ()),
            "must be left out, and the body stays where its file has it: it has no flat foot, in "
            "the lowest horizontal plane, whose middle could be moved there",
        )
    if own.is_tetrahedral and body.element_order == 1 and body.deforms:
        raise InputError(
            file,
            f"{key}.element_order",
            1,
            "must be 2 for tetrahedra: those of first order are far too stiff in bending",
        )
    return Shape(
        own.mesh,
        (),
        body.element_order or (2 if own.is_tetrahedral else 1) if body.deforms else 1,
        body.element_size_m or own.foot_edge,
    )


def _plate(body: Plate | Storeys, spots: Sequence[Spot]) -> Shape:
    """Tensor grid, fine where other bodies meet it, one layer of second order through the thickness
    unless it is thick.
    """
    coarse, lines = _plate_lines(body, spots)
    x, y = (
        fine_at_spots(length, line, coarse)
        for length, line in zip((body.length_m, body.width_m), lines)
    )
    z = np.linspace(0.0, body.thickness_m, divisions(body.thickness_m, coarse) + 1)
    return Shape(
        swept_grid(x, y, z, UPPER),
        (),
        _plate_order(body),
        min([size for _, _, size in lines[0]], default=coarse),
    )


def _plate_lines(body: Plate | Storeys, spots: Sequence[Spot]) -> tuple[float, list[list[Span]]]:
    """Coarse element size [m] of a plate, and its spots along x and y as `lines.fine_at_spots`
    takes them.
    """
    coarse = getattr(body, "coarse_size_m", None) or max(
        element_size(body), max(body.length_m, body.width_m) / _ACROSS
    )
    return coarse, [
        [(spot[2 * axis], spot[2 * axis + 1], body.element_size_m or spot[4]) for spot in spots]
        for axis in range(2)
    ]


def _plate_order(body: Plate | Storeys) -> int:
    return 1 if isinstance(body, Storeys) or not body.deforms else body.element_order or 2


def _block(body: Block) -> Shape:
    size = element_size(body)
    x, y = (
        np.linspace(-side / 2, side / 2, divisions(side, size) + 1)
        for side in (body.length_m, body.width_m)
    )
    z = fine_at_ends(body.height_m, size, _coarse_size(body, size))
    return Shape(swept_grid(x, y, z, UPPER), (), body.element_order or 1, size)


def _prism(key: str, body: Prism, file: Path | str) -> Shape:
    """A polygon extruded along y, or upwards."""
    size, upwards = element_size(body), body.along == "z"
    low, high = (0.0, body.width_m) if upwards else (-body.width_m / 2, body.width_m / 2)
    levels = np.linspace(low, high, divisions(body.width_m, size) + 1)
    mesh = prism_mesh(np.array(body.outline_m), levels, size, UPPER)
    if not upwards:
        mesh = brick_mesh(mesh.points[:, [0, 2, 1]], mesh.cells, UPPER)
    if corner_jacobians(mesh).min() <= 0:
        raise InputError(
            file,
            f"{key}.element_size_m",
            body.element_size_m,
            f"makes folded elements in this outline; {size / 2:.3g} m may do",
        )
    return Shape(mesh, (), body.element_order or 1, size)


def _coarse_size(body: Round | Block, size: float) -> float:
    """Largest element size [m] away from the ends of a block, tube or cylinder."""
    return body.coarse_size_m or max(
        size,
        _LONG
        * (min(body.length_m, body.width_m) if isinstance(body, Block) else body.outer_diameter_m),
    )


def _planes(body: Round, size: float) -> list[Annulus | Disc]:
    """Sections of a round body, and of its flange if it has one."""
    radius, wall = body.outer_diameter_m / 2, getattr(body, "wall_m", None)
    n_around = 4 * max(3, round(2 * math.pi * (radius - (wall or 0.0) / 2) / (4 * size)))
    planes = [
        Annulus(radius - wall, radius, n_around, divisions(wall, size))
        if wall
        else Disc(radius, n_around, divisions(radius / 2, size))
    ]
    if flange := _plates_of(body)[0]:
        outer, inner = flange.outer_diameter_m / 2, flange.inner_diameter_m / 2
        n_flange = 4 * max(3, round(2 * math.pi * outer / (4 * size)))
        planes.append(
            Annulus(inner, outer, n_flange, divisions(outer - inner, size))
            if inner
            else Disc(outer, n_flange, divisions(outer / 2, size))
        )
    return planes


def _plates_of(body: Round) -> tuple[Flange | None, Cap | None]:
    return (None, None) if isinstance(body, Cone) else (body.flange, body.cap)


def _flange_layers(flange: Flange, size: float) -> int:
    return max(2, divisions(flange.thickness_m, size))


def _round(key: str, body: Round, file: Path | str) -> Shape:
    """Tube, cylinder or cone, on its flange and below its cap if it has them, tied; element sizes
    are those of the body's ends.
    """
    size = element_size(body)
    flange, cap = _plates_of(body)
    planes = _planes(body, size)
    levels = fine_at_ends(body.height_m, size, _coarse_size(body, size))
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
                np.linspace(0.0, seat, _flange_layers(flange, size) + 1),
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
