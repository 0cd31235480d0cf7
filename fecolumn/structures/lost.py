"""When bodies of a structure are lost: past their point of no return, where they have one."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.overturning import FAR, Limits
from fecolumn.contact.points import BASE
from fecolumn.structures.barrier import is_level, stances
from fecolumn.structures.model import GROUND, StructureModel
from fecolumn.structures.place import Standing, supports_of


def limits_of(structure: StructureModel, standing: list[Standing]) -> Limits:
    """Limits of the parts of a structure; standing: the parts upright.

    A body that level faces alone support has the point of no return of its Stance on what is below
    it. The top of the barrier of potential energy is where it leans by its critical tilt; a body
    beyond it comes back only where its edge is pushed under it, by friction at most, and on the
    ground by no more than the ground still moves. So it is for one body on the ground, for each of
    a stack, and for equal columns below a slab, which lean as one of them would alone. What links
    or bodies beside it hold, or what rolls on a dome, is lost at 45 degrees or, wider than high,
    where it leans by its critical tilt and the angle of friction. One whose contact is found goes
    on until it lies.
    """
    joints = list(structure.joints)
    found, supports = stances(structure, standing), supports_of(standing, joints)
    linked = {place for link in structure.links for place in (link.a, link.b)}
    held = set(linked)
    for joint in joints:
        if not is_level(standing, joint):
            held |= {joint.slave, joint.master}
        if joint.ball and joint.ball.is_dome:
            held.add(joint.slave)
    tilts, rows, _ = Limits.of_tilt(len(standing))
    fall = set(structure.found.parts) if structure.found else set()
    corners = [np.zeros((0, 2))]
    tilts[list(fall)] = np.inf
    for place, stance in found.items():
        if place in fall:
            continue
        if place in held:
            steepest = stance.critical + np.arctan(stance.friction)
            if place in linked and stance.critical > FAR:
                steepest = np.pi / 2
            tilts[place] = max(FAR, min(steepest, np.pi / 2))
            continue
        below = [one for one, _ in supports[place]]
        rows[place]["below"] = below[0] if len(below) == 1 and below[0] != GROUND else BASE
        rows[place]["ground"] = below == [GROUND] and _moves_with_ground(place, supports, standing)
        rows[place]["first"] = sum(map(len, corners))
        rows[place]["count"] = len(stance.corners)
        for name in ("depth", "critical", "weight", "friction", "inertia"):
            rows[place][name] = getattr(stance, name)
        corners.append(stance.corners)
        tilts[place] = np.inf
    return Limits(tilts, rows, np.ascontiguousarray(np.concatenate(corners)))


def _moves_with_ground(place: int, supports: list, standing: list[Standing]) -> bool:
    """Whether nothing stands on a part on the ground, or it is one of equal columns below one slab
    and there is nothing else.
    """
    on_it = [upper for upper, below in enumerate(supports) if place in [one for one, _ in below]]
    if not on_it:
        return True
    columns = [k for k, below in enumerate(supports) if [one for one, _ in below] == [GROUND]]
    return (
        len(columns) == len(standing) - 1 > 1
        and all(standing[k].model is standing[place].model for k in columns)
        and sorted(one for one, _ in supports[on_it[0]]) == columns
    )
