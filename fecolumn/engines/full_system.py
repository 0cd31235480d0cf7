"""The mechanical system of a case in full order: bodies of elements on their grounds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.case.case import Case
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.links_of_model import StiffLink
from fecolumn.engines.dynamics.structure import kinematics_of, structure_system
from fecolumn.engines.dynamics.system import System
from fecolumn.engines.elements import MeshedBody, structure_of_elements
from fecolumn.engines.reduced_engine import begins_unstrained, upright
from fecolumn.foundation.schema import InputError
from fecolumn.structures.layout import Layout
from fecolumn.structures.model import StructureModel

if TYPE_CHECKING:
    from mpi4py import MPI


class FullSystem(NamedTuple):
    """A System and what it was made of.

    structure: the StructureModel at the start of the case; the model of the system is the same
    upright. meshed: the elements of each part.
    """

    system: System
    structure: StructureModel
    meshed: list[MeshedBody]


def full_system(
    case: Case, comm: MPI.Intracomm, file: Path | str, layout: Layout | None = None
) -> FullSystem:
    """The system of a case on all ranks of `comm`.

    Parameters
    ----------
    file
        of the case, for messages.
    layout
        meshes and contact points of its bodies; made from the case unless given.

    Raises
    ------
    InputError
        bodies without elements, bodies that nothing holds up, or links too stiff for the step.
    """
    plan = case.integration
    structure, meshed = structure_of_elements(case, comm, file, layout)
    damped = [case.modes_of(name) for name, _ in case.copies]
    flying = [part.name for part in structure.parts if part.airborne]
    if flying and not begins_unstrained(case, structure):
        raise InputError(
            file,
            "integration.start",
            plan.start,
            f'lets bodies begin at rest, and nothing holds "{flying[0]}" up: in full order say '
            'start = "drawn", or take engine = "reduced"',
        )
    plastic = case.contact.impact == "plastic"
    if not plastic and any(joint.pad for joint in structure.joints):
        raise InputError(
            file,
            "contact.impact",
            case.contact.impact,
            "must be plastic where a joint has a pad, whose springs take the place of impacts",
        )
    try:
        system = structure_system(
            upright(case, structure),
            [one.body for one in meshed],
            HHT(float(plan.dt_s), plan.alpha_hht),
            np.array([0.0, 0.0, -GRAVITY]),
            filtered=plastic,
            nodes=[one.nodes for one in meshed],
            damped=damped,
            kinematics=kinematics_of(plan.kinematics),
        )
    except StiffLink as error:
        name, _, told = str(error).partition(": ")
        raise InputError(file, name, None, told) from None
    return FullSystem(system, structure, meshed)
