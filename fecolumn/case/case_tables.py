"""Tables of a case by name, and the classes of their keys."""

from __future__ import annotations

import typing
from typing import Any

from fecolumn.case.bodies import BODY_KINDS
from fecolumn.case.body_keys import Placed
from fecolumn.case.ground import Ground
from fecolumn.case.joint import Joint
from fecolumn.case.link import Link
from fecolumn.case.mesh_limits import MeshLimits
from fecolumn.case.sections import (
    Contact,
    Initial,
    Integration,
    Material,
    Motion,
    Output,
    Overturn,
)
from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.foundation.schema import Section

#: Tables of tables by name, and the class of each.
NAMED: dict[str, type[Section]] = {
    "bodies": Placed,
    "materials": Material,
    "grounds": Ground,
    "joints": Joint,
    "links": Link,
    "initial": Initial,
}
#: Sections that a structure's case has in common with a column's.
COMMON: dict[str, type[Section]] = {
    "contact": Contact,
    "integration": Integration,
    "motion": Motion,
    "overturn": Overturn,
    "output": Output,
    "mesh": MeshLimits,
}


def of_this_version(key: str) -> str:
    """A dotted key of earlier versions by its name in this one."""
    first, dot, rest = key.partition(".")
    if first != "interfaces":
        return key
    newer = f"joints{dot}{rest}"
    warn_of_older_name("case", key, newer)
    return newer


def type_of(key: str) -> Any:
    """Type of a dotted key of a structure's case, whatever its bodies are called, or None:
    "bodies.slab.length_m" is a float.
    """
    head, _, last = of_this_version(key).rpartition(".")
    kind = _types_in(head).get(last)
    return next((one for one in (kind, *typing.get_args(kind)) if one in (int, float)), kind)


def keys_beside(key: str) -> tuple[str, ...]:
    """Dotted keys of the table that holds a dotted key, such as all of bodies.slab; none of a
    table that is not named by the user.
    """
    head = of_this_version(key).rpartition(".")[0]
    return tuple(sorted(f"{head}.{name}" for name in _types_in(head)))


def _types_in(head: str) -> dict[str, Any]:
    """Types by the keys of a table such as bodies.slab."""
    name, _, own = head.partition(".")
    if not own or "." in own:
        return {}
    classes = (
        set(BODY_KINDS.values()) if name == "bodies" else {NAMED[name]} if name in NAMED else set()
    )
    return {
        field: kind for section in classes for field, kind in typing.get_type_hints(section).items()
    }
