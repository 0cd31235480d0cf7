"""The voussoirs of an arch, which are bodies of their own: prisms in the frame of its circle."""

from __future__ import annotations

import dataclasses
import math

from fecolumn.case.bodies import Arch, Placed, Prism
from fecolumn.case.check_bodies import check_arch
from fecolumn.foundation.schema import InputError


def with_voussoirs(bodies: dict[str, Placed], file) -> tuple[dict[str, Placed], dict[str, Arch]]:
    """Bodies of a case with those of arches in the place of these, and the arches by name.

    Raises
    ------
    InputError
        an arch that cannot be, or a body that has the name of a voussoir.
    """

    def refuse(key, value, allowed):
        raise InputError(file, key, value, allowed)

    arches = {name: body for name, body in bodies.items() if isinstance(body, Arch)}
    found: dict[str, Placed] = {}
    for name, body in bodies.items():
        if name not in arches:
            found[name] = body
            continue
        check_arch(f"bodies.{name}", arches[name], refuse)
        made = voussoirs(name, arches[name])
        if twice := [one for one in made if one in bodies]:
            refuse(f"bodies.{twice[0]}", None, f"is the name of a voussoir of bodies.{name}")
        found |= made
    return found, arches


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
