"""When bodies of a structure are lost: past their point of no return, where they have one."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.overturning import FAR, Limits
from fecolumn.contact.points import GROUND
from fecolumn.structures.barrier import is_level, stances
from fecolumn.structures.model import StructureModel
from fecolumn.structures.standing import Standing, Supports, supports_of


def limits_of(structure: StructureModel, standing: list[Standing]) -> Limits:
    """When each part of a structure counts as lost (overturned).

    There are four rules, one for each kind of support:

    1. A part that only level faces support has a point of no return. Beyond its critical tilt,
       gravity overturns it. It returns only if friction pushes its edge back under its centre of
       mass; on the ground the push is bounded by the ground motion that is still to come. This is
       the rule for one body on the ground, for each body of a stack, and for equal columns below
       one slab, which lean together as one column would alone.
    2. A part that links, a bond or side faces hold, that rolls on a dome, or that carries such a
       part, is lost at 45 degrees, or at its critical tilt plus the angle of friction where that is
       more, but at 90 degrees at most.
       If its critical tilt is above 45 degrees, as of a slab wider than high, it is lost at 90
       degrees: leaning beyond its critical tilt, it may still fall back.
    3. A part whose contact is found during the motion is never lost: the analysis goes on until it
       lies on the ground.
    4. Any other part is lost at 45 degrees.

    Parameters
    ----------
    structure
        with n parts.
    standing
        (n,) the same parts upright, in their places.

    Returns
    -------
    Limits: tilts (n,) [rad] beyond which a part is lost, inf where rules 1 and 3 hold; standing
    (n,) and corners (k, 2) [m] with the Stances of rule 1.
    """
    joints = list(structure.joints)
    found, supports = stances(structure, standing), supports_of(standing, joints)
    held = {place for link in structure.links for place in (link.a, link.b)}
    for joint in joints:
        if not is_level(standing, joint):
            held |= {joint.slave, joint.master}
        if joint.on_dome:
            held.add(joint.slave)
        if joint.bond is not None:
            held |= {joint.slave, joint.master}
    held = _with_supports(held, supports)
    tilts, rows, _ = Limits.of_tilt(len(standing))
    fall = set(structure.found.parts) if structure.found else set()
    corners = [np.zeros((0, 2))]
    tilts[list(fall)] = np.inf
    for place, stance in found.items():
        if place in fall:
            continue
        if place in held:
            steepest = stance.critical + np.arctan(stance.friction)
            if stance.critical > FAR:
                steepest = np.pi / 2
            tilts[place] = max(FAR, min(steepest, np.pi / 2))
            continue
        below = [one for one, _ in supports[place]]
        rows[place]["below"] = below[0] if len(below) == 1 else GROUND
        rows[place]["ground"] = below == [GROUND] and _moves_with_ground(place, supports, standing)
        rows[place]["first"] = sum(map(len, corners))
        rows[place]["count"] = len(stance.corners)
        for name in ("depth", "critical", "weight", "friction", "inertia"):
            rows[place][name] = getattr(stance, name)
        corners.append(stance.corners)
        tilts[place] = np.inf
    return Limits(tilts, rows, np.ascontiguousarray(np.concatenate(corners)))


def _with_supports(held: set[int], supports: list[Supports]) -> set[int]:
    """Parts that are held, and all that these stand on, one on the other: what holds a slab holds
    its columns.
    """
    found, left = set(held), [place for place in held if place != GROUND]
    while left:
        below = {one for one, _ in supports[left.pop()]} - found - {GROUND}
        found |= below
        left += below
    return found


def _moves_with_ground(place: int, supports: list[Supports], standing: list[Standing]) -> bool:
    """Whether a part on the ground is alone there and nothing stands on it, or it is one of equal
    columns below one slab and there is nothing else: the force of the ground on all bodies, which
    tells whether an edge sticks, is then that on it.
    """
    on_it = [upper for upper, below in enumerate(supports) if place in [one for one, _ in below]]
    if not on_it:
        return all(
            k == place or standing[k].held >= 0 or GROUND not in [one for one, _ in below]
            for k, below in enumerate(supports)
        )
    columns = [k for k, below in enumerate(supports) if [one for one, _ in below] == [GROUND]]
    return (
        len(columns) == len(standing) - 1 > 1
        and all(standing[k].model is standing[place].model for k in columns)
        and sorted(one for one, _ in supports[on_it[0]]) == columns
    )
