"""The meshed specimen: body (column and cap, tied) and base."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fecolumn.mesh.base_plate import base_mesh
from fecolumn.mesh.bricks import CAP, FLANGE, LOWER, UPPER, BrickMesh, boundary_faces, merged_mesh
from fecolumn.mesh.cap_plate import cap_mesh
from fecolumn.mesh.column import column_mesh, round_section
from fecolumn.mesh.imported import imported_column
from fecolumn.mesh.tie import Tie, adjust, tie
from fecolumn.mesh.upright import Upright


@dataclass(frozen=True, slots=True)
class SpecimenMesh:
    """What the solver stands on.

    Attributes
    ----------
    body
        flange, lower column, upper column and cap in one mesh, slaves already on their master
        surfaces.
    base
        base plate, a tensor-product grid with its top at z = 0; without bricks where the base has
        no edges.
    ties
        slaves and masters, as point numbers of the body.
    foot_nodes
        (n_foot,) point numbers of the body in the plane z = 0, sorted.
    """

    body: BrickMesh
    base: BrickMesh
    ties: tuple[Tie, ...]
    foot_nodes: np.ndarray


def specimen_mesh(case: Upright) -> SpecimenMesh:
    """Meshes of a case, built or imported.

    Parameters
    ----------
    case
        of one upright column, as `load_case` makes it.

    Returns
    -------
    SpecimenMesh
        bricks of the body and of the base, nodes (n, 3) [m] each, what ties parts of the body to
        one another, and the nodes of its foot.

    Raises
    ------
    InputError
        the imported mesh does not fit the case, or parts cannot be tied.
    """
    body, ties = body_mesh(case)
    foot = np.unique(boundary_faces(body, body.foot_part, 0.0, 1e-6 * case.column.height_m))
    return SpecimenMesh(body, base_mesh(case), ties, foot)


def body_mesh(case: Upright) -> tuple[BrickMesh, tuple[Tie, ...]]:
    """Mesh of a column with flange and cap, slaves already on their master surfaces, and its ties.

    Raises
    ------
    InputError
        as of `specimen_mesh`.
    """
    column = imported_column(case) if case.column.mesh_file else column_mesh(case)
    cap = cap_mesh(case)
    height = column.points[:, 2].max()
    body = column
    if cap is not None:
        body = merged_mesh([column, cap.shifted(height - cap.points[:, 2].min())])
    flat = 1e-6 * height

    ties = []
    for one, other, level, keys in _joints(case, column, height):
        ties.append(tie(body, one, other, level, flat, _reach(case), keys))
    body = adjust(body, ties)
    return body, tuple(ties)


def _joints(
    case: Upright, column: BrickMesh, height: float
) -> Iterator[tuple[int, int, float, str]]:
    """Slave part, master part, height [m] and keys of each joint, from the foot upwards."""
    lowest = LOWER if column.has_part(LOWER) else UPPER
    if column.has_part(FLANGE):
        yield lowest, FLANGE, case.seat_m, "flange, column"
    if column.has_part(LOWER) and column.has_part(UPPER):
        yield (
            LOWER,
            UPPER,
            case.seat_m + case.column.fine_height_m,
            "mesh.fine_size_m, mesh.coarse_size_m",
        )
    if case.cap:
        yield column.top_part, CAP, height, "column.height_m, cap"


def _reach(case: Upright) -> float:
    """How far a slave may be moved [m]: the sagitta of a brick's chord and a tenth of a fine
    brick.
    """
    if case.column.mesh_file or case.column.shape == "block":
        return 0.1 * case.mesh.fine_size_m
    sagitta = (
        case.column.outer_diameter_m
        / 2
        * (1 - math.cos(math.pi / round_section(case, UPPER).n_around))
    )
    if case.flange:
        sagitta += (
            case.flange.outer_diameter_m
            / 2
            * (1 - math.cos(math.pi / round_section(case, FLANGE).n_around))
        )
    return sagitta + 0.1 * case.mesh.fine_size_m
