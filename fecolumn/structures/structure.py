"""From the case of a structure to what an engine needs of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.body_keys import Solid, WithMaterial
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.case.sections import Initial
from fecolumn.contact.points import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bonds import check_starts, with_bonds
from fecolumn.structures.case_joints import joint_of, with_hertz
from fecolumn.structures.case_links import links_at_copies, with_shapes
from fecolumn.structures.check import (
    check_carried,
    check_joints,
    check_links,
    tell_of_gaps,
)
from fecolumn.structures.check_rest import check_rest
from fecolumn.structures.check_soil import check_soil
from fecolumn.structures.far_places import tell_of_far_places
from fecolumn.structures.ground import bases_of
from fecolumn.structures.hulls import found_contact
from fecolumn.structures.made_layout import layout_on_disk
from fecolumn.structures.model import BodyModel, JointModel, LinkModel, Part, StructureModel
from fecolumn.structures.pads import with_pads
from fecolumn.structures.place import placed
from fecolumn.structures.sense import (
    check_sense,
    tell_of_densities,
    tell_of_lengths,
    tell_of_points,
    tell_of_restitution,
    tell_of_tilts,
)
from fecolumn.structures.standing import Standing, joined_to
from fecolumn.structures.store import KeptLayout, kept_body


def structure_model(
    case: Case, file: Path | str = "case", say: Callable[[str], None] = lambda text: None
) -> StructureModel:
    """The structure of a case at its start; bodies that are on disk are not made again.

    Parameters
    ----------
    file
        of the case, for messages.
    say
        told what takes long.

    Raises
    ------
    InputError
        a structure that cannot be, told by the names of its bodies, interfaces and links.
    """
    found = layout_on_disk(
        case, file, say, fields=bool(case.links) and case.integration.n_modes != 0
    )
    wanted = {name: kept_body(one) for name, one in found["models"].items()}
    return assembled(case, wanted, found, file, say)


def assembled(
    case: Case,
    bodies: dict[str, BodyModel],
    layout: KeptLayout,
    file: Path | str,
    say: Callable[[str], None] = lambda text: None,
) -> StructureModel:
    """Structure of the reduced `bodies` by name, put together as a `layout` of `keep_models` says.

    Raises
    ------
    InputError
        as of `structure_model`.
    """
    # again, as a layout that is on disk says nothing of links
    check_links(case, layout["extents"], file)
    copies = case.copies
    places = {copy: place for place, copy in enumerate(copies)}
    kept = {name: _that_moves(case, name, model) for name, model in bodies.items()}
    standing = _standing(case, [kept[name] for name, _ in copies])
    joints = [
        joint_of(case, contact, kept, places, layout["sizes"], file)
        for contact in layout["contacts"]
    ]
    joints = _told_apart(joints)
    check_joints(joints, standing, file)
    interfaces = [one["interface"] for one in layout["contacts"]]
    joints = with_pads(case, joints, standing, interfaces, file)
    joints = with_hertz(case, joints, standing, copies)
    joints = with_bonds(case, joints, standing, interfaces, file)
    check_starts(joints, standing, file)
    parts = tuple(
        Part(
            one.name,
            one.model,
            there.center,
            there.rotation,
            _damping(case, name, one.model),
            there.velocity,
            there.spin,
            one.held,
        )
        for (name, _), one, there in zip(copies, standing, placed(standing, joints, file))
    )
    links = tuple(
        with_shapes(link, copies, standing, layout.get("models", {}))
        for name in case.links
        for link in links_at_copies(case, name, places, standing)
    )
    outlines = {
        name: one and one | {"points": np.array(one["points"]) - bodies[name].center}
        for name, one in layout["outlines"].items()
    }
    airborne = _airborne(standing, joints, links)
    check_carried(case, airborne, joints, links, standing, file)
    parts = tuple(replace(part, airborne=place in airborne) for place, part in enumerate(parts))
    extents = [
        np.array(layout["extents"][name]) - one.model.center
        for (name, _), one in zip(copies, standing)
    ]
    # a dome has one node, which is no measure of it
    reach = np.concatenate(
        [
            one.center + reach
            for one, own in zip(standing, extents)
            for reach in (one.model.arms, own)
        ]
    )
    base, *more = bases_of(case, standing, joints, reach, file, say)
    structure = StructureModel(
        parts,
        tuple(joints),
        links,
        base,
        _observed(case, parts, places, file),
        tuple(more),
        tuple(ground.level_m for ground in case.grounds.values()),
        tuple(outlines[name] for name, _ in copies),
        found_contact(case, places, outlines, file),
    )
    replaced = structure.replaced
    met = [one for n, one in enumerate(joints) if n not in replaced]
    tell_of_gaps(met, standing, list(case.grounds), file)
    tell_of_lengths(case, file)
    tell_of_far_places(case, standing, extents, file)
    tell_of_restitution(case, met, standing, file)
    tell_of_densities(case, bodies, layout["outlines"], file)
    tell_of_tilts(joints, standing, file)
    tell_of_points(structure, file)
    check_sense(case, structure, standing, extents, file)
    check_rest(case, structure, standing, file)
    check_soil(case, structure, standing, extents, file)
    return structure


def _airborne(
    standing: list[Standing], joints: list[JointModel], links: tuple[LinkModel, ...]
) -> set[int]:
    """Places of the parts that no joint without a gap, and no link, ties to a ground."""
    pairs = [(joint.slave, joint.master) for joint in joints if not joint.gap]
    pairs += [(link.a, link.b) for link in links if link.stiffness]
    held = {GROUND} | {place for place, part in enumerate(standing) if part.held >= 0}
    return set(range(len(standing))) - joined_to(held, pairs)


def _that_moves(case: Case, name: str, model: BodyModel) -> BodyModel:
    """A body with its modes; in the rigid engine without any give but that of a stated contact
    stiffness.
    """
    if (
        case.integration.engine == "rigid"
        and getattr(case.bodies[name], "contact_stiffness_n_m3", None) is None
    ):
        return model.undeformed()
    return model.with_modes(case.modes_of(name))


def standing_of(case: Case, structure: StructureModel) -> list[Standing]:
    """The parts of a structure as they stand before any is tilted."""
    return _standing(case, [part.model for part in structure.parts])


def _standing(case: Case, bodies: list[BodyModel]) -> list[Standing]:
    starts = _starts(case)
    return [
        Standing(
            case.names_of(name)[number],
            model,
            np.array(case.bodies[name].places[number]) + model.center,
            starts.get((name, number)),
            _held_by(case, name),
        )
        for (name, number), model in zip(case.copies, bodies)
    ]


def _held_by(case: Case, name: str) -> int:
    """Place of the ground that holds a body, -1 of one that is free."""
    body = case.bodies[name]
    if not isinstance(body, Solid) or not body.fixed:
        return -1
    return list(case.grounds).index(body.moves_with) if body.moves_with else 0


def _starts(case: Case) -> dict[tuple[str, int], Initial]:
    """Start of each copy that has one; "column 2" goes before "column", "arch 2" before "arch"."""
    found: dict[tuple[str, int], Initial] = {}
    for name in sorted(case.initial, key=lambda one: -len(case.copies_of(one))):
        found |= dict.fromkeys(case.copies_of(name), case.initial[name])
    return found


def _damping(case: Case, name: str, model: BodyModel) -> float | NDArray[Any]:
    if model.damping is not None:
        return model.damping
    body = case.bodies[name]
    if body.damping_ratio is not None:
        return body.damping_ratio
    if not isinstance(body, WithMaterial):
        return 0.0
    return material_of(body, case.materials).damping_ratio


def _observed(
    case: Case, parts: tuple[Part, ...], places: dict[tuple[str, int], int], file: Path | str
) -> tuple[int, str]:
    if case.observed:
        name, _, mark = case.observed.partition(".")
        body, (number,) = case.meant_by(name)
        place, mark = places[body, number], mark or "top"
        # those of storeys are drifts, no places
        known = [one for one in parts[place].model.marks if not one.startswith("storey ")]
        if mark not in known:
            raise InputError(
                file,
                "observed",
                case.observed,
                f'"{name}" has no such mark; its marks: {", ".join(known)}',
            )
        return place, mark
    return max(
        (place for place, part in enumerate(parts) if part.held < 0),
        key=lambda place: parts[place].center[2] + parts[place].model.marks["top"][0][2],
    ), "top"


def _told_apart(joints: list[JointModel]) -> list[JointModel]:
    """The joints, each with a name of its own: of two bodies that meet in several faces the second
    meeting is "joint: up on low, 2".
    """
    met: dict[str, int] = {}
    found = []
    for joint in joints:
        number = met[joint.name] = met.get(joint.name, 0) + 1
        found.append(joint if number == 1 else replace(joint, name=f"{joint.name}, {number}"))
    return found
