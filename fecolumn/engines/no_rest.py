"""What a user is told where a structure does not come to rest: which body, where it stands, and the
keys that may help.
"""

from __future__ import annotations

from fecolumn.case.case import Case
from fecolumn.case.joint import Joint, own_contact
from fecolumn.engines.dynamics.gravity import NoEquilibrium

# Names of joints that are told, at most
_TOLD = 3


def no_rest(case: Case, error: NoEquilibrium) -> str:
    """The error with the body that moved most, its joints with their friction, and ways out."""
    copies = case.copies
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
    return (
        f"{told}: it may slide, tip over, or stand on what gives too much; look at "
        f"bodies.{body}.at_m, its friction and stiffness, and what holds it, or {way_out}"
    )


def _ends(case: Case, end: str) -> tuple[tuple[str, int], ...]:
    """Copies that an end of a joint means, none of a ground."""
    return () if end in case.grounds else case.copies_of(end)


def _friction(case: Case, joint: Joint) -> float:
    return own_contact(joint, case.contact).friction_coefficient
