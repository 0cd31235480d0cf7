"""Places so far from the origin that double precision hardly tells points of a body apart."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.body_keys import WithMaterial
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.case.sections import GRAVITY
from fecolumn.contact.tolerances import SOLVED
from fecolumn.structures.standing import Standing

# Distance from the origin over the width of a body at which the rounding of a place is what contact
# is solved to: 4.5e4. Blocks of 2 mm to 0.1 m go on at 5e4 and stop at 6e4 to 8e4.
_FARTHEST = SOLVED / np.finfo(float).eps
# Of forces by which elements answer a rounding of places over E eps r w, r the distance and w the
# width: measured on blocks of 20 and 200 mm, 0.45 of 200 GPa
_FORCES = 0.45
# Of forces by which links and bonds answer a rounding of places over the weight, above which energy
# is lost or steps stop: measured on mortar of 8e8 and 8e10 N/m3 below a stone of 54 kg
_LINKED = 1e-8


def tell_of_far_places(
    case: Case, standing: list[Standing], extents: list[NDArray[Any]], file: Path | str
) -> None:
    """Warn of the body that is farthest beyond the distance at which steps converge, where the
    structure could be nearer to the origin: at its centre all bodies are within its own size.

    Parameters
    ----------
    standing, extents
        as of `sense.check_sense`.
    """
    found = []
    places = np.concatenate([one.center + own for one, own in zip(standing, extents)])
    size = float(np.ptp(places, axis=0).max())
    for (name, _), one, extent in zip(case.copies, standing, extents):
        sides = np.ptp(extent[:, :2], axis=0)
        width, weight = float(sides.min()), one.model.mass * GRAVITY
        distance = float(np.abs(one.center).max())
        farthest = _FARTHEST * width
        body = case.bodies[name]
        if case.integration.engine == "full" and isinstance(body, WithMaterial):
            stiff = material_of(body, case.materials).youngs_modulus_pa * width
            rounding = _FORCES * stiff * np.finfo(float).eps
            farthest = min(farthest, case.integration.tolerance * weight / rounding)
        if stiff := _linked(case, name, float(sides.prod())):
            farthest = min(farthest, _LINKED * weight / (stiff * np.finfo(float).eps))
        if one.held < 0 and distance > size and distance > farthest:
            found.append((distance / farthest, one.name, distance, farthest))
    if found:
        _, name, distance, farthest = max(found)
        warnings.warn(
            f'{file}: "{name}" is {distance:.3g} m from the origin, where rounding may keep steps '
            f"from converging: with integration.engine = {case.integration.engine!r} it may be "
            f"{farthest:.2g} m; subtract the same from all places",
            stacklevel=2,
        )


def _linked(case: Case, name: str, area: float) -> float:
    """Stiffness [N/m] of the links at a body and of the bonds below and above it, whose joints have
    the `area` [m2] at most.
    """
    # by its own name, those of its copies, or that of its arch
    names = {name, *case.names_of(name), name.rpartition(" ")[0]}
    links = (
        getattr(link, "stiffness_n_m", 0.0)
        for link in case.links.values()
        if names & {link.body, link.to}
    )
    bonds = (
        joint.bond_stiffness_n_m3 for joint in case.joints.values() if names & {*joint.between}
    )
    return sum(links) + area * max(bonds, default=0.0)
