"""The voussoirs of an arch, which are bodies of their own: prisms in the frame of its circle."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fecolumn.case.bodies import Arch, Prism
from fecolumn.case.body_keys import Placed, Solid
from fecolumn.case.check_bodies import check_arch
from fecolumn.case.checked import refuse_in
from fecolumn.foundation.schema import Section, build

#: Keys that a voussoir may have of its own
_OWN = tuple(one.name for one in dataclasses.fields(Solid) if one.name not in ("at_m", "copies_m"))
# What a voussoir does not have from its arch, where it states a key
_INSTEAD = {
    "material": (
        "youngs_modulus_pa",
        "poissons_ratio",
        "density_kg_m3",
        "mass_kg",
        "damping_ratio",
    ),
    "density_kg_m3": ("mass_kg",),
    "mass_kg": ("density_kg_m3",),
}
# A prism by which the keys of a voussoir are checked
_ANY: dict[str, Any] = {"outline_m": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], "width_m": 1.0}


def without_voussoirs(tables: Any) -> tuple[Any, dict[str, dict[str, Any]]]:
    """Tables of bodies, and of them those of single voussoirs, such as "arch 3" beside an arch."""
    if not isinstance(tables, dict):
        return tables, {}
    own = {}
    for name, table in tables.items():
        arch = tables.get(name.rpartition(" ")[0])
        if isinstance(arch, dict) and arch.get("kind") == "arch" and isinstance(table, dict):
            own[name] = table
    return {name: table for name, table in tables.items() if name not in own}, own


def with_voussoirs(
    bodies: dict[str, Placed], own: dict[str, dict[str, Any]], file: Path | str
) -> tuple[dict[str, Placed], dict[str, Arch]]:
    """Bodies of a case with those of arches in the place of these, and the arches by name; own:
    tables of single voussoirs.

    Raises
    ------
    InputError
        an arch that cannot be, a body that has the name of a voussoir, or a voussoir that is none,
        or says of itself what its arch does.
    """
    refuse = refuse_in(file)
    arches = {name: body for name, body in bodies.items() if isinstance(body, Arch)}
    found: dict[str, Placed] = {}
    single: dict[str, Prism] = {}
    for name, body in bodies.items():
        if name not in arches:
            found[name] = body
            continue
        check_arch(f"bodies.{name}", arches[name], refuse)
        made = voussoirs(name, arches[name])
        if twice := [one for one in made if one in bodies]:
            refuse(f"bodies.{twice[0]}", None, f"is the name of a voussoir of bodies.{name}")
        found |= made
        single |= made
    for name, table in own.items():
        arch = name.rpartition(" ")[0]
        if arch in arches and name not in found:
            refuse(f"bodies.{name}", None, f"no such voussoir: {arch} has {arches[arch].voussoirs}")
        if not_own := [key for key in table if key not in _OWN]:
            refuse(
                f"bodies.{name}",
                None,
                f"is a voussoir of bodies.{arch}, which says its {not_own[0]}; of its own are "
                f"{', '.join(_OWN)}",
            )
        if name in single:
            checked = build(Prism, _ANY | table, file, f"bodies.{name}.")
            found[name] = differing(single[name], {key: getattr(checked, key) for key in table})
    return found, arches


def differing(body: Prism, own: dict[str, Any]) -> Prism:
    """A voussoir with keys of its own."""
    left = {key for one in own for key in _INSTEAD.get(one, ()) if key not in own}
    cleared: dict[str, Any] = dict.fromkeys(left)
    return dataclasses.replace(body, **cleared, **own)


def with_arches(
    bodies: Mapping[str, Placed], arches: Mapping[str, Arch]
) -> dict[str, Section | dict[str, Any]]:
    """Bodies of a case with an arch in the place of its voussoirs, where they are still those of
    it, and after it the keys of voussoirs that have some of their own: undoes `with_voussoirs`.
    """
    found: dict[str, Section | dict[str, Any]] = dict(bodies)
    for name, arch in arches.items():
        made = voussoirs(name, arch)
        own = {key: _own_keys(bodies.get(key), body) for key, body in made.items()}
        if None in own.values():
            continue
        stated = {key: table for key, table in own.items() if table}
        first, before, found = next(iter(made)), found, {}
        for key, body in before.items():
            if key == first:
                found |= {name: arch, **stated}
            elif key not in made:
                found[key] = body
    return found


def _own_keys(body: Placed | None, made: Prism) -> dict[str, Any] | None:
    """Keys in which a body differs from a voussoir of its arch; None where it is not one."""
    keys = [key for key in _OWN if getattr(body, key, None) != getattr(made, key)]
    own = {key: getattr(body, key) for key in keys if getattr(body, key, None) is not None}
    return own if isinstance(body, Prism) and differing(made, own) == body else None


def voussoirs(name: str, arch: Arch) -> dict[str, Prism]:
    """Bodies of an arch by name, in their order from its first springing."""
    own = {
        one.name: getattr(arch, one.name) for one in dataclasses.fields(Prism) if one.name in _ALIKE
    }
    if arch.mass_kg is not None:
        own["mass_kg"] = arch.mass_kg / arch.voussoirs
    return {
        f"{name} {number}": Prism(**own, outline_m=outline)
        for number, outline in enumerate(_outlines(arch), 1)
    }


# Keys that a voussoir has from its arch
_ALIKE = {one.name for one in dataclasses.fields(Arch)} - {"kind", "copies_m"}


def _outlines(arch: Arch) -> list[tuple[tuple[float, float], ...]]:
    """Corners (x, z) [m] of each voussoir: its inner arc, then its outer one back.

    A polygon inscribed in a circle has the share sin(a) / a of its sector, a the angle of a side.
    All corners are farther out by the root of that, so that faces between voussoirs are equal.
    """
    count = arch.voussoirs * arch.arc_sides
    first, span = math.radians(arch.from_deg), math.radians(arch.to_deg - arch.from_deg)
    step = span / count
    larger = math.sqrt(step / math.sin(step))
    angles = [first + span * number / count for number in range(count + 1)]
    # quarters exactly, so that a springing at 180 degrees is level
    ways = [(round(math.cos(angle), 15), round(math.sin(angle), 15)) for angle in angles]
    inner, outer = (
        [(larger * radius * x, larger * radius * z) for x, z in ways]
        for radius in (
            arch.mean_radius_m - arch.thickness_m / 2,
            arch.mean_radius_m + arch.thickness_m / 2,
        )
    )
    pieces = [
        slice(arch.arc_sides * number, arch.arc_sides * (number + 1) + 1)
        for number in range(arch.voussoirs)
    ]
    return [(*inner[piece], *outer[piece][::-1]) for piece in pieces]
