"""Where rolling resistance says something: on round rims."""

from __future__ import annotations

from fecolumn.case.bodies import Block, Footed, Plate, Prism, Storeys
from fecolumn.case.checked import CheckedCase, Refuse

_TOLD = "must be 0 for a block: only a round foot rolls"


def check_rolling(case: CheckedCase, refuse: Refuse) -> None:
    """Refuse the rolling resistance of joints neither of whose bodies can have a round rim."""
    if case.contact.between:  # of which check_found says more
        return
    rolling = {name: _may_roll(case, joint.between) for name, joint in case.joints.items()}
    for name, joint in case.joints.items():
        if joint.rolling_resistance and not rolling[name]:
            refuse(f"joints.{name}.rolling_resistance", joint.rolling_resistance, _TOLD)
    if rolling and not any(rolling.values()):
        if value := case.contact.rolling_resistance:
            refuse("contact.rolling_resistance", value, _TOLD)


def _may_roll(case: CheckedCase, names: tuple[str, ...]) -> bool:
    bodies = {
        body for name in names if name not in case.grounds for body, _ in case.copies_of(name)
    }
    return any(_is_round(case, body) for body in bodies)


def _is_round(case: CheckedCase, name: str) -> bool:
    """Whether a body has a round face, as far as its keys tell: a mesh, and a prism with an upright
    axis, may have one.
    """
    body = case.bodies[name]
    if isinstance(body, Prism):
        return body.along == "z"
    if isinstance(body, Footed) and body.flange:
        return True
    return not isinstance(body, (Block, Plate, Storeys))
