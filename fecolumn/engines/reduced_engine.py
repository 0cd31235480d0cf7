"""The reduced engine of a structure, as its case says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.tolerances import PARTS
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.start import of_parts
from fecolumn.engines.reduced.structure import structure_of, view_of
from fecolumn.foundation.schema import InputError
from fecolumn.structures.lost import limits_of
from fecolumn.structures.model import StructureModel
from fecolumn.structures.structure import standing_of


def upright(case, model: StructureModel) -> StructureModel:
    """The structure as it stands before any body leans or moves: displacements and links are
    measured from there.
    """
    parts = (
        replace(
            part, center=there.center, rotation=np.eye(3), velocity=np.zeros(3), spin=np.zeros(3)
        )
        for part, there in zip(model.parts, standing_of(case, model))
    )
    return replace(model, parts=tuple(parts))


def begins_unstrained(case, model: StructureModel) -> bool:
    """Whether the start is not gravity equilibrium: a body leans, or the case says so."""
    return case.integration.start == "drawn" or any(part.rotation[2, 2] < 1 for part in model.parts)


def engine_of(case, model: StructureModel, file, stands: bool | None = None) -> Engine:
    """The engine at the start of `model`, or of `upright` in gravity equilibrium.

    stands: whether it begins in that; as the case says unless given.

    Raises
    ------
    InputError
        a link too stiff for the step. NoEquilibrium: as of `start.gravity_equilibrium`.
    """
    plan, gravity = case.integration, np.array([0.0, 0.0, -GRAVITY])
    stands = not begins_unstrained(case, model) if stands is None else stands
    standing, hht = upright(case, model), HHT(plan.dt_s, plan.alpha_hht)

    def build(step, meetings=None):
        parts = PARTS if plan.substeps == "impacts" else 1
        return structure_of(standing, step, gravity, parts, meetings)

    try:
        structure, _ = build(hht)
    except ValueError as error:
        name, _, told = str(error).partition(": ")
        raise InputError(file, name, None, told) from None
    weight = float(structure.bodies.body["mass"].sum()) * GRAVITY
    limits = limits_of(standing, standing_of(case, standing))
    view = view_of(standing, structure, weight, limits, case.overturn.displacement_m)
    return Engine(
        build,
        model.bases,
        view,
        hht,
        lambda engine: of_parts(engine, model.parts, stands),
        plan.max_cuts,
        model,
        plan.substeps,
    )
