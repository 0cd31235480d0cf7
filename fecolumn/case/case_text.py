"""A case as text: a few lines for a screen, or its TOML file."""

from __future__ import annotations

import collections
from typing import Any, Protocol

from fecolumn.case.checked import CheckedCase
from fecolumn.case.short_form import ShortForm
from fecolumn.foundation.schema import table_of

# Names of a table of tables that a line shows
_SHOWN = 6


class ShownCase(CheckedCase, Protocol):
    """Attributes of a Case that its text tells; a Case imports its text, and not it a Case."""

    @property
    def title(self) -> str:
        """Of figures."""

    @property
    def id(self) -> str:
        """As of Case."""

    @property
    def short(self) -> ShortForm | None:
        """None of a case that was stated in the full form."""

    def tables(self, *, defaults: bool = True, arches: bool = True) -> dict[str, Any]:
        """As of Case."""


def case_text(case: ShownCase) -> str:
    """A few lines: title, what stands there, engine, step, motion."""
    plan, motion = case.integration, case.motion
    step = f"dt {plan.dt_s:g} s" if isinstance(plan.dt_s, float) else f"dt {plan.dt_s}"
    time = f", {plan.duration_s:g} s" if plan.duration_s else ""
    shaken = "no motion"
    if motion:
        factor = f" x {motion.scale:g}" if motion.scale != 1 else ""
        shaken = f"motion {motion.source}{factor}"
    bodies = {
        name: f"{len(body.copies_m)} x {body.kind}" if body.copies_m else body.kind
        for name, body in case.bodies.items()
    }
    lines = [
        f"Case {case.title!r}, id {case.id}"
        if case.title
        else f"Case without a title, id {case.id}"
    ]
    lines += [f"  {name}: {section!r}" for name, section in case.own.items()]
    for what, named in (
        ("bodies", bodies),
        ("joints", {name: f"{one.slave} on {one.on}" for name, one in case.joints.items()}),
        ("links", {name: one.kind for name, one in case.links.items()}),
        ("grounds", {name: one.kind for name, one in case.grounds.items()}),
    ):
        if named:
            lines.append(f"  {what}: {_listed(named)}")
    lines.append(f"  {plan.engine} engine, {step}{time}; {shaken}")
    return "\n".join(lines)


def _listed(named: dict[str, str]) -> str:
    """Names with their kinds; of many the first, and how many of each kind."""
    if len(named) <= _SHOWN:
        return ", ".join(f"{name} ({kind})" for name, kind in named.items())
    kinds = collections.Counter(named.values())
    if len(kinds) > _SHOWN:
        return f"{', '.join(list(named)[:_SHOWN])} ... {len(named)} in all"
    return f"{len(named)}: " + ", ".join(f"{count} {kind}" for kind, count in kinds.items())


def toml_of(case: ShownCase, full: bool, defaults: bool) -> str:
    """Text of the TOML file of a case, as of `Case.to_toml`."""
    import tomli_w

    from fecolumn.case.sizes import opened

    form = case.short
    if not form or full:
        return tomli_w.dumps(full_form(case, defaults, arches=True))
    if defaults:
        return tomli_w.dumps(form.tables())
    tables = table_of(opened(form), defaults=False)
    return tomli_w.dumps({name: table for name, table in tables.items() if table != {}})


def full_form(case: ShownCase, defaults: bool = False, arches: bool = False) -> dict[str, Any]:
    """Tables of the full form of a case, as its file would have them.

    Parameters
    ----------
    defaults
        keys at their defaults, too.
    arches
        as they were stated, or voussoir by voussoir.
    """
    tables = case.tables(defaults=defaults, arches=arches)
    return {name: table for name, table in tables.items() if table != {}}
