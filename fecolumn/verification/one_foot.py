"""A body on one flat foot as a structure of one part, from finite elements that no case
describes.
"""

from __future__ import annotations

import numpy as np

from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.structure import structure_of, view_of
from fecolumn.fem.reduction import reduced_at
from fecolumn.structures.lost import limits_of
from fecolumn.structures.model import GROUND, BodyModel, Joint, Part, StructureModel, Surface
from fecolumn.structures.place import Standing

# Tangents of a foot and its normal, which points down, as columns
_DOWN = np.diag([1.0, -1.0, -1.0])


def foot_model(body, nodes, areas, top, n_modes: int) -> tuple[BodyModel, np.ndarray]:
    """A Body reduced to its foot; also the shapes (n_modes, n_owned, 3) of the modes all over it.

    Parameters
    ----------
    nodes
        (n,) of the foot that may touch.
    areas
        (n,) tributary to them [m2].
    top
        (k,) nodes whose mean is the mark "top".
    n_modes
        elastic modes to keep.
    """
    found = reduced_at(body, nodes, n_modes)
    model = BodyModel(
        mass=float(body.total_mass),
        inertia=found.inertia,
        center=body.center,
        frequencies=found.frequencies,
        shapes=found.at(nodes),
        flexibility=found.flexibility,
        arms=body.all_X[nodes] - body.center,
        dofs=3 * body.n_nodes,
        surfaces={"foot": foot_surface(body.all_X[nodes] - body.center, areas)},
        marks={"top": (body.all_X[top].mean(axis=0) - body.center, found.at(top).mean(axis=0))},
    )
    return model, found.fields


def foot_surface(arms: np.ndarray, areas) -> Surface:
    """A level foot with all nodes of a model, at arms (n, 3) [m] from its centre of mass."""
    return Surface(
        np.arange(len(arms)),
        arms.mean(axis=0),
        _DOWN,
        np.asarray(areas),
        np.ones(len(arms), bool),
        np.zeros((0, 3), np.int64),
    )


def on_base(
    model: BodyModel, base, friction: float, law, damping_ratio: float = 0.0, **laws
) -> StructureModel:
    """The structure of one body on a base.

    Parameters
    ----------
    law
        (n, 3) compliance of the contact law [m/N].
    laws
        rim: Rim or None, of which it counts whether there is one; restitution, rolling and pad as
        of Joint.
    """
    is_round = laws.pop("rim", None) is not None
    part = Part("column", model, model.center, np.eye(3), damping_ratio, np.zeros(3), np.zeros(3))
    joint = Joint(
        "foot: column on ground",
        0,
        "foot",
        GROUND,
        None,
        friction,
        law,
        is_round,
        laws.pop("restitution", 0.0),
        **laws,
    )
    return StructureModel((part,), (joint,), (), base, (0, "top"))


def engine_on(
    structure: StructureModel, hht, begin, gravity, cap: float = 0.0, substeps: str = "rolling"
) -> Engine:
    """The reduced engine of a structure of one body.

    Parameters
    ----------
    begin
        function of the engine that returns the first MotionState.
    cap
        displacement of the top that counts as overturned [m], 0 for none.
    """

    def build(step):
        return structure_of(structure, step, gravity)

    weight = structure.parts[0].model.mass * float(np.linalg.norm(gravity))
    limits = limits_of(structure, _standing(structure))
    view = view_of(structure, build(hht)[0], weight, limits, cap)
    return Engine(build, structure.bases, view, hht, begin, model=structure, substeps=substeps)


def _standing(structure: StructureModel) -> list[Standing]:
    return [Standing(part.name, part.model, part.center, None) for part in structure.parts]
