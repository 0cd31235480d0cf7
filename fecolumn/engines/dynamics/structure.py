"""From bodies that stand on one another to the mechanical system of the full-order engine."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.contact.joints import joints_of
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.links_of_model import links_of
from fecolumn.engines.dynamics.system import State, System, Touching
from fecolumn.fem.composite import Composite, CompositeDamping, CompositeKinematics
from fecolumn.fem.corotated import Corotated

if TYPE_CHECKING:
    from fecolumn.structures.model import Part, StructureModel

# Elastic modes that are damped where the model of a body has none
_DAMPED = 30


def kinematics_of(name: str) -> Any:
    """Kinematics of a body by the name that integration.kinematics gives it."""
    if name == "total_lagrangian":
        from fecolumn.fem.total_lagrangian import TotalLagrangian

        return TotalLagrangian
    return Corotated


def structure_system(
    model: StructureModel,
    bodies: list,
    hht: HHT,
    gravity: ArrayLike,
    filtered: bool = True,
    nodes: list | None = None,
    damped: list | None = None,
    kinematics: Any = Corotated,
) -> System:
    """System of a structure with all degrees of freedom of its bodies.

    Parameters
    ----------
    model
        `structures.model.StructureModel`: where its bodies are and what they do to one another; of
        their own models no more than nodes and surfaces is used.
    bodies
        `fem.body.Body` of each part, copies the same object.
    nodes
        of each, (n,) of the body that are its model's rows; found by their places unless given.
    damped
        of each, lowest elastic modes that are damped; those of its model unless given, or _DAMPED
        where it has none.
    kinematics
        of each body: Corotated, or TotalLagrangian.

    Raises
    ------
    StiffLink
        a link is too stiff for the step.
    """
    parts = model.parts
    composite = Composite(
        bodies, [part.center for part in parts], [part.rotation for part in parts]
    )
    if nodes is None:
        nodes = composite.of_each(
            lambda body, _: body.find_nodes(
                next(part.model for part, own in zip(parts, bodies) if own is body).reference
            )
        )
    ratios: list[Any] = [
        part.damping_ratio if part.model.damping is None else part.model.damping for part in parts
    ]
    damped = damped or [len(part.model.frequencies) or _DAMPED for part in parts]
    damping = (
        CompositeDamping(composite, damped, ratios)
        if np.any([np.any(ratio) for ratio in ratios])
        else None
    )
    system = System(
        composite,
        CompositeKinematics(composite, kinematics),
        Touching(model.bases, nodes, joints_of(parts, model.joints), tuple(model.levels), filtered),
        gravity,
        hht,
        damping,
        links_of(model, hht),
    )
    system.model = model
    return system


def released(system: System, parts: tuple[Part, ...], standing: State | None) -> State:
    """The state that the parts of a StructureModel begin with, as `reduced.start.of_parts`.

    standing: gravity equilibrium that they come from; None: they are unstrained where the parts
    say, and fall freely.
    """
    bodies, state = system.bodies, standing
    if state is None:
        state = system.unstrained(
            bodies.places([part.center for part in parts], [part.rotation for part in parts])
        )
        state = replace(state, a=np.tile(system.gravity, (len(state.x), 1)))
    for part, rows, center in zip(parts, bodies.rows, bodies.centers(state.x)):
        state.v[rows] = part.velocity + np.cross(part.spin, state.x[rows] - center)
    return state
