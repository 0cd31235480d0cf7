"""Bodies of two grids: a finely meshed lower part, to which a coarser upper part is tied, on its
flange and below its cap.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeGuard

from fecolumn.case.bodies import Block, Cylinder, MeshBody, Tube
from fecolumn.case.body_keys import WithMaterial
from fecolumn.case.column_keys import Base, Column, MeshSizes
from fecolumn.case.sections import Cap, Flange
from fecolumn.case.sizes import sized
from fecolumn.foundation.content import content
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import BrickMesh
from fecolumn.mesh.estimate import body_counts
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.specimen import body_mesh
from fecolumn.mesh.tie import Tie
from fecolumn.mesh.upright import Upright

#: Bodies that may have two grids.
OfGrids = Tube | Cylinder | Block | MeshBody


@dataclass(frozen=True, slots=True)
class Built(Upright):
    """Sections of the short form that say what a column is built of."""

    column: Column
    mesh: MeshSizes
    flange: Flange | None
    cap: Cap | None


def is_tied(body: WithMaterial) -> TypeGuard[OfGrids]:
    """Whether a body is of two grids, or has a plate that its own grid cannot have."""
    if isinstance(body, MeshBody):
        return body.cap is not None
    if getattr(body, "fine_height_m", None) is not None:
        return True
    return isinstance(body, Block) and (body.flange is not None or body.cap is not None)


def built_of(body: OfGrids) -> Built:
    """What a body is built of, all sizes known.

    Raises
    ------
    InputError
        a mesh of one's own cannot be read.
    ValueError
        a kind that is none of mesh, block, cylinder and tube.
    """
    match body:
        case MeshBody(kind="mesh"):
            if not own_mesh(body.drawn).has_foot:
                raise InputError(
                    body.mesh_file, "cap", None, "must be left out of a mesh without a flat foot"
                )
            column = Column(
                mesh_file=body.mesh_file,
                mesh_unit=body.mesh_unit,
                mesh_size_m=body.mesh_size_m,
                cut_foot_m=body.cut_foot_m,
            )
        case Block(kind="block"):
            column = Column(
                shape="block",
                length_m=body.length_m,
                width_m=body.width_m,
                height_m=body.height_m,
                fine_height_m=body.fine_height_m,
            )
        case Cylinder(kind="cylinder") | Tube(kind="tube"):
            column = Column(
                shape="solid" if body.kind == "cylinder" else "tube",
                outer_diameter_m=body.outer_diameter_m,
                wall_m=getattr(body, "wall_m", None),
                height_m=body.height_m,
                fine_height_m=body.fine_height_m,
            )
        case _:
            raise ValueError(f"no mesh of two grids, or with a plate, of kind {body.kind!r}")
    mesh = MeshSizes(
        fine_size_m=body.element_size_m,
        coarse_size_m=body.coarse_size_m,
        cap_size_m=body.cap_size_m,
        element_order=body.element_order,
    )
    flange = getattr(body, "flange", None)
    known = content(column.mesh_file) if column.mesh_file else ""
    column, _, mesh = sized(column, flange, body.cap, Base(), mesh, known)
    return Built(column, mesh, flange, body.cap)


def tied_mesh(
    key: str, body: OfGrids, file: Path | str
) -> tuple[BrickMesh, tuple[Tie, ...], int, float]:
    """Mesh of a body of two grids, its ties, order of its elements and element size at its foot
    [m].

    Raises
    ------
    InputError
        parts that cannot be tied.
    """
    built = built_of(body)
    try:
        mesh, ties = body_mesh(built)
    except InputError as error:
        raise InputError(file, f"{key}: {error.key}", error.value, error.allowed) from None
    order, size = built.mesh.element_order, built.mesh.fine_size_m
    assert order is not None and size is not None
    return mesh, ties, order if body.deforms else 1, size


def tied_counts(body: OfGrids) -> tuple[int, int]:
    """Elements and nodes of a body of two grids, told without making them."""
    elements, nodes, _ = body_counts(built_of(body))
    return sum(elements.values()), sum(nodes.values())
