"""Elastic ground that a rocking model of rigid bodies takes as rigid."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

from fecolumn.case.case import Case
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.column import RigidColumn
from fecolumn.structures.ground import thickness_of

#: What the weight takes of the stiffness against rocking of the ground below a foot, W h / (k I),
#: from which on it is told: so much less than on rigid ground tips the body over.
SOFT_GROUND = 0.01


def tell_of_soft_ground(case: Case, body: RigidColumn, mass: float, file: Path | str) -> None:
    """Warn of a plate or a layer that gives so much below a foot that its model should not take it
    as rigid.

    It gives as a layer of thickness t that is pressed evenly (Winkler 1867): k = E / t per area,
    less stiff than it is below a foot that is narrow beside t.

    Parameters
    ----------
    mass
        that the foot carries [kg].
    """
    a, b = sorted(body.half_foot)
    second = math.pi * a**4 / 4 if body.round else 4 / 3 * b * a**3
    for name, ground in case.grounds.items():
        if ground.kind not in ("plate", "unbounded"):
            continue
        stiffness = ground.youngs_modulus_pa / thickness_of(ground, 2 * a) * second
        taken = mass * GRAVITY * body.height / stiffness
        if taken > SOFT_GROUND:
            warnings.warn(
                f"{file}: grounds.{name}: integration.engine = {case.integration.engine!r} takes "
                f"it as rigid, and it gives: the weight takes {100 * taken:.2g} % of its "
                f"stiffness against rocking, W h / (E I / t); the reduced and the rigid engine "
                "know how it gives",
                stacklevel=4,
            )
