"""Meshes of single bodies, each in its own drawing, z up: the middle of its foot at the origin, of
a prism the point from which its outline is measured.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from fecolumn.case.bodies import Block, Cone, Cylinder, MeshBody, Plate, Prism, Storeys, Tube
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import UPPER, brick_mesh
from fecolumn.mesh.column import divisions
from fecolumn.mesh.gmsh_section import NotMeshed, swept_grid
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.jacobian import corner_jacobians
from fecolumn.mesh.prism import polygon_counts, prism_mesh
from fecolumn.mesh.section import Annulus, Disc
from fecolumn.structures.lines import (
    Span,
    count_at_ends,
    count_at_spots,
    fine_at_ends,
    fine_at_spots,
)
from fecolumn.structures.round_shape import flange_layers, plates_of, round_sections, round_shape
from fecolumn.structures.shape import (
    ACROSS_A_PLATE,
    Meshable,
    Shape,
    Spot,
    coarse_size,
    element_size,
)
from fecolumn.structures.tied import is_tied, tied_counts, tied_mesh


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
            return round_shape(key, body, file)
    raise ValueError(f"{key}: shape_of names no mesh of kind {body.kind!r}")


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
                    count_at_ends(body.height_m, size, coarse_size(body, size)),
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
        round_sections(body, size),
        [count_at_ends(body.height_m, size, coarse_size(body, size))],
    )
    flange, cap = plates_of(body)
    if flange:
        heights.append(flange_layers(flange, size))
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
        element_size(body), max(body.length_m, body.width_m) / ACROSS_A_PLATE
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
    z = fine_at_ends(body.height_m, size, coarse_size(body, size))
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
