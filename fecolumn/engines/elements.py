"""Bodies of a structure with all their degrees of freedom, from the same meshes and contact points
that the reduced engine has.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Matrices, Storeys
from fecolumn.case.body_keys import Solid
from fecolumn.case.case import Case
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.layout import Layout, layout_of
from fecolumn.structures.made_layout import check_drawings, said_of
from fecolumn.structures.model import BodyModel, StructureModel
from fecolumn.structures.patches import Patch, face_weights
from fecolumn.structures.reduction import bare_model, body_of, top_face
from fecolumn.structures.shape import Shape
from fecolumn.structures.structure import assembled

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.fem.body import Body


@dataclass(frozen=True, eq=False)
class MeshedBody:
    """A body of elements, the same object for all copies.

    body: `fem.body.Body`. model: its BodyModel without modes and flexibility; nodes: (n,) of the
    body that are the model's rows. top, shares: (k,) nodes of the highest level face and their
    shares in its mean, which is the mark "top". shape: its mesh. patches: its contact points by the
    names of the surfaces.
    """

    body: Body
    model: BodyModel
    nodes: NDArray[Any]
    top: NDArray[Any]
    shares: NDArray[Any]
    shape: Shape
    patches: dict[str, Patch]


def structure_of_elements(
    case: Case, comm: MPI.Intracomm, file: Path | str, layout: Layout | None = None
) -> tuple[StructureModel, list[MeshedBody]]:
    """The structure of a case at its start, and the elements of each part; the same on every rank.

    layout: as of `checked_layout`, made on the first rank unless given.

    Raises
    ------
    InputError
        as of `structure.structure_model`; and a body that has no elements.
    """
    from fecolumn.fem.tied_body import known_to_all

    layout = layout or known_to_all(comm, lambda: checked_layout(case, file))
    made = {name: meshed(layout.drawings[name], layout.patches[name], comm) for name in case.bodies}
    structure = assembled(
        case, {name: one.model for name, one in made.items()}, said_of(layout), file
    )
    return structure, [made[name] for name, _ in case.copies]


def checked_layout(case: Case, file: Path | str) -> Layout:
    """Meshes and contact points of the bodies of a case.

    Raises
    ------
    InputError
        a body without elements, or what `layout_of` refuses.
    """
    for name, body in case.bodies.items():
        if isinstance(body, (Matrices, Storeys)):
            raise InputError(
                file,
                f"bodies.{name}.kind",
                body.kind,
                'has no elements: engine = "full" takes bodies of elements, engine = '
                '"reduced" takes all kinds',
            )
        assert isinstance(body, Solid)
        if body.fixed:
            raise InputError(
                file,
                f"bodies.{name}.fixed",
                True,
                'must be false where engine = "full": what holds its bodies is a ground, a plate '
                'or rigid plane at a joint; engine = "reduced" or "rigid" takes fixed bodies',
            )
        if not body.deforms:
            raise InputError(
                file,
                f"bodies.{name}.rigid",
                True,
                'must be false where engine = "full", whose bodies deform; engine = '
                '"reduced" takes both',
            )
    layout = layout_of(case, file)
    check_drawings(case, layout, file)
    return layout


def meshed(drawing: Drawing, patches: dict[str, Patch], comm: MPI.Intracomm) -> MeshedBody:
    """Elements and contact points of a drawing."""
    from fecolumn.engines.dynamics.checkpoint import node_order

    shape, material = drawing.shape, drawing.material
    assert shape and material  # `checked_layout` refuses matrices
    body = body_of(shape, material, comm)
    found = {name: body.find_nodes(patch.positions, patch.part) for name, patch in patches.items()}
    order = node_order(body)
    # by part and place, so that it does not matter how the ranks share them
    nodes = order[np.isin(order, np.concatenate(list(found.values())))]
    row = np.full(body.n_nodes, -1)
    row[nodes] = np.arange(len(nodes))
    face = top_face(drawing.faces)
    positions, shares = face_weights(face, shape.order)
    model = bare_model(
        body,
        nodes,
        {name: patch.surface(row[found[name]], body.center) for name, patch in patches.items()},
        shares @ positions,
    )
    return MeshedBody(
        body, model, nodes, body.find_nodes(positions, face.part), shares, shape, patches
    )
