"""Bodies of a structure with all their degrees of freedom, from the same meshes and contact points
that the reduced engine has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.case.bodies import Matrices, Storeys
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.layout import Layout, layout_of
from fecolumn.structures.made_layout import check_drawings, said_of
from fecolumn.structures.model import BodyModel, StructureModel
from fecolumn.structures.patches import Patch, face_weights
from fecolumn.structures.reduction import bare_model, body_of, top_face
from fecolumn.structures.shapes import Shape
from fecolumn.structures.structure import assembled


@dataclass(frozen=True, eq=False)
class MeshedBody:
    """A body of elements, the same object for all copies.

    body: `fem.body.Body`. model: its BodyModel without modes and flexibility; nodes: (n,) of the
    body that are the model's rows. top, shares: (k,) nodes of the highest level face and their
    shares in its mean, which is the mark "top". shape: its mesh. patches: its contact points by the
    names of the surfaces.
    """

    body: object
    model: BodyModel
    nodes: np.ndarray
    top: np.ndarray
    shares: np.ndarray
    shape: Shape
    patches: dict[str, Patch]


def structure_of_elements(
    case, comm, file, layout: Layout | None = None
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
    return structure, [made[name] for name in case.bodies for _ in case.names_of(name)]


def checked_layout(case, file) -> Layout:
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
        if not body.deforms:
            raise InputError(
                file,
                f"bodies.{name}.{'fixed' if body.fixed else 'rigid'}",
                True,
                'must be false where engine = "full", whose bodies deform; engine = '
                '"reduced" takes both',
            )
    layout = layout_of(case, file)
    check_drawings(case, layout, file)
    return layout


def meshed(drawing: Drawing, patches: dict[str, Patch], comm) -> MeshedBody:
    """Elements and contact points of a drawing."""
    from fecolumn.engines.dynamics.checkpoint import node_order

    body = body_of(drawing.shape, drawing.material, comm)
    found = {name: body.find_nodes(patch.positions, patch.part) for name, patch in patches.items()}
    order = node_order(body)
    # by part and place, so that it does not matter how the ranks share them
    nodes = order[np.isin(order, np.concatenate(list(found.values())))]
    row = np.full(body.n_nodes, -1)
    row[nodes] = np.arange(len(nodes))
    face = top_face(drawing.faces)
    positions, shares = face_weights(face, drawing.shape.order)
    model = bare_model(
        body,
        nodes,
        {name: patch.surface(row[found[name]], body.center) for name, patch in patches.items()},
        shares @ positions,
    )
    return MeshedBody(
        body, model, nodes, body.find_nodes(positions, face.part), shares, drawing.shape, patches
    )
