"""What a user is told where a structure does not come to rest: which body, where it stands, and the
keys that may help.
"""

from __future__ import annotations

import numpy as np

from fecolumn.case.bodies import Matrices
from fecolumn.case.case import Case
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.structures.size import extent_in_plan

# Names of joints that are told, at most
_TOLD = 3
# [m] between bodies from which on it is told: some 500 times the height of a structure rounding of
# its turns is no longer told from motion
_FAR = 300.0


def no_rest(case: Case, error: NoEquilibrium) -> str:
    """The error with the body that moved most, its joints with their friction, and ways out."""
    copies = [(name, number) for name in case.bodies for number in range(len(case.names_of(name)))]
    way_out = 'integration.start = "drawn" lets the bodies go from where they are drawn'
    if error.mover is None or error.mover >= len(copies):
        return f"{error}; {way_out}"
    body, number = copies[error.mover]
    place = ", ".join(f"{value:.4g}" for value in case.bodies[body].places[number])
    told = f'{error}, most of all "{case.names_of(body)[number]}", drawn at ({place}) m'
    joints = {
        name: joint
        for name, joint in case.joints.items()
        if (body, number) in _ends(case, joint.slave) + _ends(case, joint.on)
    }
    frictions = [
        f"joints.{name}.friction_coefficient = {_friction(case, joint):g}"
        for name, joint in list(joints.items())[:_TOLD]
    ]
    if frictions:
        told += f", with {', '.join(frictions)}"
    if far := _far_apart(case, copies):
        return f"{told}: {far}, or {way_out}"
    return (
        f"{told}: it may slide, tip over, or stand on what gives too much; look at "
        f"bodies.{body}.at_m, its friction and stiffness, and what holds it, or {way_out}"
    )


def _far_apart(case: Case, copies) -> str:
    """Which bodies are far apart, where any are, and what to do about it; "" where none are."""
    shaped = [one for one in copies if not isinstance(case.bodies[one[0]], Matrices)]
    if len(shaped) < 2:
        return ""
    middles = np.array(
        [
            np.mean(extent_in_plan(case.bodies[name]), axis=0)
            + case.bodies[name].places[number][:2]
            for name, number in shaped
        ]
    )
    far = int(np.ptp(middles, axis=0).argmax())
    ends = middles[:, far].argmin(), middles[:, far].argmax()
    span = float(np.linalg.norm(middles[ends[1]] - middles[ends[0]]))
    if span < _FAR:
        return ""
    one, other = (f'"{case.names_of(shaped[end][0])[shaped[end][1]]}"' for end in ends)
    return (
        f"{one} and {other} are {span:.4g} m apart, and over more than some 500 times the height "
        "of a structure rounding hides whether it rests; analyse what is far apart in files of "
        "its own"
    )


def _ends(case: Case, end: str) -> tuple[tuple[str, int], ...]:
    """Copies that an end of a joint means, none of a ground."""
    return () if end in case.grounds else case.copies_of(end)


def _friction(case: Case, joint) -> float:
    own = joint.friction_coefficient
    return case.contact.friction_coefficient if own is None else own
