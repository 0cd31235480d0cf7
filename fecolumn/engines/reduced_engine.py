"""The reduced engine of a structure, as its case says."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from fecolumn.case.case import Case
from fecolumn.case.sections import GRAVITY, Integration
from fecolumn.contact.overturning import Limits
from fecolumn.contact.tolerances import PARTS
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.links_of_model import StiffLink
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.model import Structure
from fecolumn.engines.reduced.motion import MotionState
from fecolumn.engines.reduced.start import of_parts
from fecolumn.engines.reduced.structure import structure_of, view_of
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.schema import InputError
from fecolumn.structures.lost import limits_of
from fecolumn.structures.model import StructureModel
from fecolumn.structures.standing import as_standing
from fecolumn.structures.structure import standing_of

#: Gravity (3,) [m/s2] in the table frame, in which z is up.
GRAVITY_DOWN = np.array([0.0, 0.0, -GRAVITY])
_PLAN = Integration()


def upright(case: Case, model: StructureModel) -> StructureModel:
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


def begins_unstrained(case: Case, model: StructureModel) -> bool:
    """Whether the start is not gravity equilibrium: a body leans, or the case says so."""
    return case.integration.start == "drawn" or any(part.rotation[2, 2] < 1 for part in model.parts)


class TooManyPoints(ValueError):
    """So many contact points that this machine has no room for what they give one another."""


# Matrices of all points with all others: of the problem (`contact.problem.room`), and of the
# operator of bodies that deform (`contact.stick.Stick`: W, two factors, the inverse)
_RIGID_MATRICES, _ELASTIC_MATRICES = 1, 5


def _check_room(points: int, deforms: bool) -> None:
    """Refuse contact points whose matrices are larger than the memory."""
    matrices = _ELASTIC_MATRICES if deforms else _RIGID_MATRICES
    needed, there = (
        matrices * 72 * points**2,
        os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
    )
    if needed > there:
        raise TooManyPoints(
            f"{points:,} contact points in all: what these give one another takes "
            f"{needed / 2**30:.0f} GiB, and this machine has {there / 2**30:.0f}; a larger "
            "element_size_m of the bodies, or contact.interior_points = 0, makes them fewer"
        )


def engine_of(
    case: Case, model: StructureModel, file: Path | str, stands: bool | None = None
) -> Engine:
    """The engine at the start of `model`, or of `upright` in gravity equilibrium.

    stands: whether it begins in that; as the case says unless given.

    Raises
    ------
    InputError
        a link too stiff for the step, more contact points than this machine has room for.
    NoEquilibrium
        as of `start.gravity_equilibrium`.
    """
    plan = case.integration
    stands = not begins_unstrained(case, model) if stands is None else stands
    try:
        return engine_on(
            upright(case, model),
            HHT(float(plan.dt_s), plan.alpha_hht),
            lambda engine: of_parts(engine, model.parts, stands),
            cap=case.overturn.displacement_m,
            plan=plan,
            model=model,
        )
    except StiffLink as error:
        name, _, told = str(error).partition(": ")
        raise InputError(file, name, None, told) from None
    except TooManyPoints as error:
        raise InputError(file, "joints", None, str(error)) from None


def engine_on(
    standing: StructureModel,
    hht: HHT,
    begin: Callable[[Engine], MotionState],
    *,
    gravity: Array = GRAVITY_DOWN,
    limits: Limits | None = None,
    cap: float = 0.0,
    plan: Integration = _PLAN,
    model: StructureModel | None = None,
) -> Engine:
    """The reduced engine of a structure.

    Parameters
    ----------
    standing
        the structure upright.
    begin
        function of the engine that returns the first motion; see `reduced.start`.
    gravity
        (3,) [m/s2].
    limits
        when bodies are lost; those of `structures.lost` unless given.
    cap
        displacement of the observed mark that counts as overturned [m], 0 for none.
    plan
        of which substeps and max_cuts are taken.
    model
        the structure at its start, for `begin`; `standing` unless given.

    Raises
    ------
    StiffLink
        a link is too stiff for the step.
    TooManyPoints
        as of its name.
    """
    deforms = any(part.model.flexibility.any() for part in standing.parts) or any(
        np.asarray(base.compliance).any() for base in standing.bases
    )

    def build(step: HHT, meetings: int | None = None) -> tuple[Structure, Array]:
        parts = PARTS if plan.substeps == "impacts" else 1
        made = structure_of(standing, step, gravity, parts, meetings)
        _check_room(len(made[1]), deforms)
        return made

    structure, _ = build(hht)
    weight = float(structure.bodies.body["mass"].sum()) * float(np.linalg.norm(gravity))
    limits = limits or limits_of(standing, as_standing(standing))
    view = view_of(standing, structure, weight, limits, cap)
    model = model or standing
    return Engine(build, standing.bases, view, hht, begin, plan.max_cuts, model, plan.substeps)
