"""What no single key of a case can know."""

from __future__ import annotations

from pathlib import Path

from fecolumn.case.bodies import Storeys
from fecolumn.case.check_found import check_found
from fecolumn.case.check_grounds import check_grounds
from fecolumn.case.check_motion import check_strong_part
from fecolumn.case.check_rolling import check_rolling
from fecolumn.case.checked import CheckedCase, Refuse, refuse_in
from fecolumn.case.joint import own_contact
from fecolumn.case.sections import (
    DEFAULT,
    FULL_ORDER_KEYS,
    MOST_STEPS,
    UNTIL_REST,
    Motion,
)
from fecolumn.foundation.schema import (
    InputError,
    meant,
    parameter_of,
)


def check(case: CheckedCase, file: Path | str) -> None:
    """What no single key can know: names that tables use of one another, and keys of which only one
    may stand.
    """
    from fecolumn.case.check_bodies import check_body
    from fecolumn.case.check_bond import check_bond
    from fecolumn.case.check_link import check_link
    from fecolumn.case.check_step import check_step

    refuse = refuse_in(file)
    if case.own:  # the rest is checked by the model
        _check_integration(case, refuse)
        return
    check_step(case.integration, refuse)
    if not case.bodies:
        refuse(
            "bodies",
            None,
            "missing; a case needs a table [column], [bodies.NAME] or that of a rocking model",
        )
    for name, body in case.bodies.items():
        check_body(f"bodies.{name}", body, case.materials, refuse)
        ground = getattr(body, "moves_with", "")
        if ground and ground not in case.grounds:
            known = ", ".join(case.grounds)
            refuse(f"bodies.{name}.moves_with", ground, f"no such ground; known: {known}")
    if case.bodies and all(getattr(body, "fixed", False) for body in case.bodies.values()):
        refuse(f"bodies.{name}.fixed", True, "must be false of one body at least: nothing moves")
    if not case.joints and not case.contact.between:
        refuse(
            "joints",
            None,
            "missing; a structure needs a table [joints.NAME] at least, for what "
            "stands on the ground",
        )
    for name, interface in case.joints.items():
        _check_name(case, f"joints.{name}.between", interface.slave, refuse, ground=False)
        _check_name(case, f"joints.{name}.between", interface.on, refuse)
        if interface.slave == interface.on and len(case.copies_of(interface.on)) == 1:
            told = "must be two bodies, or a body and a ground: of this one there is no other copy"
            refuse(f"joints.{name}.between", interface.on, told)
        if all(case.is_held(one) for one in (interface.slave, interface.on)):
            told = f'"{interface.slave}" and "{interface.on}" are both fixed'
            refuse(f"joints.{name}", None, f"must name a body that moves: {told}")
        friction = own_contact(interface, case.contact).friction_coefficient
        check_bond(f"joints.{name}", interface, friction, refuse)
    for name, link in case.links.items():
        _check_name(case, f"links.{name}.body", link.body, refuse, ground=False)
        _check_name(case, f"links.{name}.to", link.to, refuse)
        check_link(f"links.{name}", link, refuse)
        if case.is_held(link.body) and case.is_held(link.to):
            told = f'"{link.body}" and "{link.to}" are both fixed'
            refuse(f"links.{name}", None, f"must hold a body that moves: {told}")
        if len({body for body, _ in case.copies_of(link.body)}) > 1:
            refuse(
                f"links.{name}.body",
                link.body,
                f'must be one body, such as "{case.names_of(link.body)[0]}"',
            )
        if link.to not in case.grounds and len(case.copies_of(link.to)) > 1:
            refuse(
                f"links.{name}.to",
                link.to,
                f'must be one of its copies, such as "{case.names_of(link.to)[0]}"',
            )
        if link.to not in case.grounds and case.copies_of(link.to)[0] in case.copies_of(link.body):
            refuse(
                f"links.{name}.to",
                link.to,
                f'must be another body than links.{name}.body = "{link.body}": a link '
                "from a body to itself does nothing",
            )
    for name, start in case.initial.items():
        _check_name(case, f"initial.{name}", name, refuse, ground=False)
        if case.is_held(name):
            refuse(f"initial.{name}", None, f'must be left out: "{name}" is fixed')
        for key in ("velocity_m_s", "spin_rad_s"):
            if len(value := getattr(start, key)) != 3:
                refuse(f"initial.{name}.{key}", list(value), "must be three numbers: x, y, z")
    if case.observed:
        watched = case.observed.partition(".")[0]
        _check_name(case, "observed", watched, refuse, ground=False)
        if getattr(case.bodies[case.copies_of(watched)[0][0]], "fixed", False):
            refuse("observed", case.observed, "must be a body that moves: this one is fixed")
        if len(case.copies_of(watched)) > 1:
            refuse(
                "observed",
                case.observed,
                f'must be one of its copies, such as "{case.names_of(watched)[0]}"',
            )
    for name, body in case.bodies.items():
        if isinstance(body, Storeys) and not case.modes_of(name):
            key, value = (
                ("integration.engine", "rigid")
                if case.integration.engine == "rigid"
                else (f"bodies.{name}.modes", 0)
            )
            refuse(
                key,
                value,
                f'leaves the storeys of "{name}" their springs and no inertia: choose '
                f'integration.engine = "reduced" with modes, of which {2 * body.floors} '
                "are all",
            )
    check_grounds(case, refuse)
    check_rolling(case, refuse)
    check_found(case, refuse, lambda key, name: _check_name(case, key, name, refuse, ground=False))
    _check_integration(case, refuse)


def _check_name(
    case: CheckedCase, key: str, name: str, refuse: Refuse, ground: bool = True
) -> None:
    if ground and name in case.grounds:
        return
    try:
        case.copies_of(name)
    except KeyError:
        known = (
            list(case.grounds) * ground
            + list(case.arches)
            + list(case.bodies)
            + [copy for body in case.bodies for copy in case.names_of(body) if copy != body]
        )
        what = "body or ground" if ground else "body"
        refuse(key, name, f"no such {what}{meant(name, known)}; known: {', '.join(known)}")


def _check_integration(case: CheckedCase, refuse: Refuse) -> None:
    from fecolumn.case.check_full import check_full

    plan = case.integration
    if plan.engine == "full":
        check_full(case, refuse)
    for section, key, needed in (
        ("integration", "kinematics", "corotated"),
        ("contact", "impact", "plastic"),
    ):
        value = getattr(getattr(case, section), key)
        if plan.engine != "full" and value != needed:
            refuse(
                f"{section}.{key}",
                value,
                f"must be {needed} where integration.engine = {plan.engine!r}",
            )
    for key in FULL_ORDER_KEYS if plan.engine != "full" else ():
        if (value := getattr(plan, key)) != DEFAULT[key]:
            refuse(
                f"integration.{key}",
                value,
                f"has no effect where integration.engine = {plan.engine!r}: leave it out",
            )
    if not plan.step_is_chosen and 0 < plan.duration_s < float(plan.dt_s) * (1 - 1e-9):
        refuse(
            "integration.duration_s",
            plan.duration_s,
            f"must be at least integration.dt_s = {float(plan.dt_s):g} s, or 0 for that of the "
            "motion",
        )
    time = plan.duration_s or (
        case.motion.delay_s + case.motion.longest_free_vibration_s if case.motion else 0.0
    )
    if time / plan.shortest_s > MOST_STEPS:
        refuse(
            "integration.dt_s",
            plan.dt_s,
            f"must be at least {time / MOST_STEPS:g} s: more than {MOST_STEPS:.0e} "
            f"steps in {time:g} s",
        )
    if case.motion:
        check_strong_part(case.motion, "motion", refuse)
        value, default = case.motion.rest_ceiling_s, parameter_of(Motion, "rest_ceiling_s").default
        if value != default and case.motion.free_vibration_s != UNTIL_REST:
            told = f'says nothing without motion.free_vibration_s = "{UNTIL_REST}"'
            refuse("motion.rest_ceiling_s", value, told)


def check_duration(case: CheckedCase, file: Path | str) -> None:
    """Refuse to analyse a case that does not say for how long; its mesh may still be looked at."""
    if case.motion is None and case.integration.duration_s == 0:
        raise InputError(
            file,
            "integration.duration_s",
            0,
            "must be greater than 0 s where the case has no motion",
        )
