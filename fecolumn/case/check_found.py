"""What a case must not state whose contact is found while bodies move."""

from __future__ import annotations

from collections.abc import Callable

from fecolumn.case.bodies import Matrices, Storeys
from fecolumn.case.body_keys import Placed
from fecolumn.case.checked import CheckedCase, Refuse

_KEY = "contact.between"
# Engines that move bodies in three dimensions and find their contact point by point
_ENGINES = ("reduced", "rigid")


def check_found(case: CheckedCase, refuse: Refuse, check_name: Callable[[str, str], None]) -> None:
    """Refuse bodies, grounds and joints that contact.between cannot have.

    check_name: refuses the name of a body that the case does not have; its arguments are the key
    and the name.
    """
    chosen = case.contact.between
    if not chosen:
        return
    told = list(chosen) if chosen != "all" else chosen
    for name in chosen if chosen != "all" else ():
        check_name(_KEY, name)
    if (engine := case.integration.engine) not in _ENGINES:
        refuse(
            _KEY,
            told,
            f"must be left out with integration.engine = {engine!r}: contact is found while bodies "
            'move with integration.engine = "reduced" or "rigid"',
        )
    if case.contact.law != "augmented_lagrange":
        refuse("contact.law", case.contact.law, f"must be augmented_lagrange beside {_KEY}")
    if value := case.contact.rolling_resistance:
        refuse("contact.rolling_resistance", value, f"must be 0 beside {_KEY}")
    levels: dict[float, str] = {}
    for name, ground in case.grounds.items():
        if ground.kind != "rigid":
            refuse(
                f"grounds.{name}.kind",
                ground.kind,
                f"must be rigid beside {_KEY}: where bodies fall to, no ground is meshed",
            )
        if (first := levels.setdefault(ground.level_m, name)) != name:
            refuse(
                f"grounds.{name}.level_m",
                ground.level_m,
                f"must differ from that of grounds.{first} beside {_KEY}: there each ground is a "
                "plane without end",
            )
    bodies = dict.fromkeys(name for name, _ in case.found)
    if all(case.is_held(name) for name in bodies):
        refuse(_KEY, told, "must name a body that moves: these are all fixed")
    for name in bodies:
        _check_body(name, case.bodies[name], refuse)
    for name, joint in case.joints.items():
        ends = {
            body
            for one in (joint.slave, joint.on)
            if one not in case.grounds
            for body, _ in case.copies_of(one)
        }
        if not ends <= set(bodies):
            continue
        for key in ("stiffness_n_m3", "rolling_resistance", "law"):
            value = getattr(joint, key)
            if value and value != "augmented_lagrange":
                refuse(
                    f"joints.{name}.{key}",
                    value,
                    f"must be left out where {_KEY} has both bodies, which may meet anywhere",
                )


def _check_body(name: str, body: Placed, refuse: Refuse) -> None:
    key = f"bodies.{name}"
    if isinstance(body, (Matrices, Storeys)):
        refuse(
            f"{key}.kind",
            body.kind,
            f"has no outline of which {_KEY} could find where it meets others: name the others",
        )
    for one in ("foot_radius_m", "edge_radius_m"):
        if value := getattr(body, one, None):
            refuse(f"{key}.{one}", value, f"must be left out beside {_KEY}: it finds flat faces")
