"""From the case of a structure to what an engine needs of it."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import replace

import numpy as np
from scipy.spatial import ConvexHull

from fecolumn.case.bodies import PULLING, PUSHING, Matrices, Storeys
from fecolumn.case.case import identity
from fecolumn.case.check_bodies import material_of
from fecolumn.case.sections import Initial
from fecolumn.contact.law import interface_compliance
from fecolumn.contact.rim import Rim
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures import model as models
from fecolumn.structures.bonds import check_starts, with_bonds
from fecolumn.structures.check import (
    check_joints,
    check_layout,
    check_links,
    check_points,
    check_rest,
    tell_of_gaps,
)
from fecolumn.structures.feet import ball_of, hertz
from fecolumn.structures.ground import bases_of
from fecolumn.structures.hulls import found_contact
from fecolumn.structures.layout import Layout, layout_of
from fecolumn.structures.model import BodyModel, Joint, Link, Part, StructureModel
from fecolumn.structures.pads import with_pads
from fecolumn.structures.place import Standing, loads, placed
from fecolumn.structures.sense import check_sense
from fecolumn.structures.size import size_of
from fecolumn.structures.store import (
    KEPT_MODES,
    keep_body,
    keep_layout,
    kept_body,
    kept_layout,
    key_of,
    shape_at,
)

# Keys of a body that no operator has
_LOOSE = ("at_m", "copies_m", "modes", "damping_ratio", "material")


def structure_model(case, file="case", say=lambda text: None) -> StructureModel:
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
    found = _layout(case, file, say, fields=bool(case.links) and case.integration.n_modes != 0)
    wanted = {name: kept_body(one) for name, one in found["models"].items()}
    return assembled(case, wanted, found, file, say)


def kept_keys(case, file="case") -> dict[str, str]:
    """Key of each body's reduced model in `store`, on disk with the modes all over it."""
    return _layout(case, file, lambda text: None, fields=True)["models"]


def _layout(case, file, say, fields: bool = False) -> dict:
    """The layout as `store.keep_layout` keeps it, made if it is not on disk; fields as of
    `store.kept_layout`.
    """
    key = key_of(_geometry(case))
    found = kept_layout(key, fields)
    if found is None:
        say(f"meshing {len(case.bodies)} different bodies, at least {size_of(case, file).counts}")
        found = keep_models(case, layout_of(case, file), file, say)
        keep_layout(key, found)
    return found


def _geometry(case) -> dict:
    """What of a case decides its layout and the reduced bodies."""
    bodies = {
        name: _made_of(case, name) | {"places": body.places} for name, body in case.bodies.items()
    }
    keys = ("slave", "on", "open", "interior_points", "allowance_m")
    return {
        "bodies": bodies,
        "levels": {name: ground.level_m for name, ground in case.grounds.items()},
        "joints": {
            name: [getattr(one, key) for key in keys] + [one.stiffness_n_m3 is not None]
            for name, one in case.joints.items()
        },
        "interior": case.interior_points,
    } | ({"found": sorted({name for name, _ in case.found})} if case.found else {})


def _made_of(case, name: str) -> dict:
    """What of a body's keys decides its reduced model."""
    body = case.bodies[name]
    table = {
        key: value
        for key, value in identity(body).items()
        if key not in _LOOSE or isinstance(body, Storeys) and key == "damping_ratio"
    }
    if not isinstance(body, Matrices):
        material = dataclasses.asdict(material_of(body, case.materials))
        if not isinstance(body, Storeys):
            del material["damping_ratio"]
        table["material"] = material
    if body.as_drawn:
        table["as_drawn"] = True
    return table | {"modes": max(case.modes_of(name), KEPT_MODES)}


def keep_models(case, layout: Layout, file, say) -> dict:
    """Check a layout and have its bodies on disk; what `store.keep_layout` keeps of it."""
    check_drawings(case, layout, file)
    keys = {}
    for name, one in layout.drawings.items():
        patches = layout.patches[name]
        said = {
            surface: [patch.positions.tolist(), patch.axes.tolist(), len(patch.triangles)]
            for surface, patch in patches.items()
        }
        keys[name] = key_of([_made_of(case, name), said])
        count = max(case.modes_of(name), KEPT_MODES)

        def make(name=name, one=one, patches=patches, count=count):
            say(f'making the reduced model of "{name}" (once)')
            return one.model(patches, count)

        keep_body(keys[name], make)
    return {"models": keys} | said_of(layout)


def check_drawings(case, layout: Layout, file) -> None:
    """Refuse bodies that overlap or stand on nothing, those with too many contact points, and links
    to nowhere.
    """
    check_layout(case, layout, file)
    check_links(case, _extents(layout), file)
    for name in layout.drawings:
        check_points(name, layout.patches[name], file)


def said_of(layout: Layout) -> dict:
    """What `assembled` takes of a layout."""
    sizes = {name: one.shape.size for name, one in layout.drawings.items() if one.shape}
    return {
        "sizes": sizes,
        "extents": _extents(layout),
        "outlines": {name: _outline(one) for name, one in layout.drawings.items()},
        "contacts": [dataclasses.asdict(contact) for contact in layout.contacts],
    }


def _outline(drawing) -> dict | None:
    """Corners (n, 3) [m] of the convex hull of a drawing, and its volume [m3]."""
    if drawing.shape is None:
        return None
    points = drawing.shape.mesh.points
    corners = points[ConvexHull(points).vertices]
    return {
        "points": corners.tolist(),
        "volume": float(mass_properties(drawing.shape.mesh, 1.0).volume),
    }


def _extents(layout: Layout) -> dict:
    """Lowest and highest place (3,) [m] of each body by name, as it is drawn."""
    return {
        name: [one.points.min(axis=0).tolist(), one.points.max(axis=0).tolist()]
        for name, one in layout.drawings.items()
    }


def assembled(
    case, bodies: dict[str, BodyModel], layout: dict, file, say=lambda text: None
) -> StructureModel:
    """Structure of the reduced `bodies` by name, put together as a `layout` of `keep_models` says.

    Raises
    ------
    InputError
        as of `structure_model`.
    """
    # again, as a layout that is on disk says nothing of links
    check_links(case, layout["extents"], file)
    copies = [(name, number) for name in case.bodies for number in range(len(case.names_of(name)))]
    places = {copy: place for place, copy in enumerate(copies)}
    kept = {name: _that_moves(case, name, model) for name, model in bodies.items()}
    standing = _standing(case, copies, [kept[name] for name, _ in copies])
    joints = [
        _joint(case, contact, kept, places, layout["sizes"], file) for contact in layout["contacts"]
    ]
    check_joints(joints, standing, file)
    joints = _with_hertz(case, joints, standing, copies)
    interfaces = [one["interface"] for one in layout["contacts"]]
    joints = with_pads(case, joints, standing, interfaces, file)
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
        _with_shapes(link, copies, standing, layout.get("models", {}))
        for name in case.links
        for link in _links(case, name, places, standing)
    )
    outlines = {
        name: one and one | {"points": np.array(one["points"]) - bodies[name].center}
        for name, one in layout["outlines"].items()
    }
    airborne = _airborne(standing, joints, links)
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
    tell_of_gaps([one for n, one in enumerate(joints) if n not in replaced], standing, file)
    check_sense(case, structure, standing, extents, file)
    check_rest(case, structure, standing, file)
    return structure


def _airborne(standing: list[Standing], joints, links) -> set[int]:
    """Places of the parts that no joint without a gap, and no link, ties to a ground."""
    pairs = [(joint.slave, joint.master) for joint in joints if not joint.gap]
    pairs += [(link.a, link.b) for link in links if link.stiffness]
    held = {models.GROUND} | {place for place, part in enumerate(standing) if part.held >= 0}
    while more := {one for pair in pairs if held & set(pair) for one in pair} - held:
        held |= more
    return set(range(len(standing))) - held


def _that_moves(case, name: str, model: BodyModel) -> BodyModel:
    """A body with its modes; in the rigid engine without any give but that of a stated contact
    stiffness.
    """
    if (
        case.integration.engine == "rigid"
        and getattr(case.bodies[name], "contact_stiffness_n_m3", None) is None
    ):
        return model.undeformed()
    return model.with_modes(case.modes_of(name))


def standing_of(case, structure: StructureModel) -> list[Standing]:
    """The parts of a structure as they stand before any is tilted."""
    copies = [(name, number) for name in case.bodies for number in range(len(case.names_of(name)))]
    return _standing(case, copies, [part.model for part in structure.parts])


def _standing(case, copies, bodies: list[BodyModel]) -> list[Standing]:
    starts = _starts(case)
    return [
        Standing(
            case.names_of(name)[number],
            model,
            np.array(case.bodies[name].places[number]) + model.center,
            starts.get((name, number)),
            _held_by(case, name),
        )
        for (name, number), model in zip(copies, bodies)
    ]


def _held_by(case, name: str) -> int:
    """Place of the ground that holds a body, -1 of one that is free."""
    body = case.bodies[name]
    if not getattr(body, "fixed", False):
        return -1
    return list(case.grounds).index(body.moves_with) if body.moves_with else 0


def _starts(case) -> dict[tuple[str, int], Initial]:
    """Start of each copy that has one; "column 2" goes before "column", "arch 2" before "arch"."""
    found = {}
    for name in sorted(case.initial, key=lambda one: -len(case.copies_of(one))):
        found |= dict.fromkeys(case.copies_of(name), case.initial[name])
    return found


def _joint(case, contact: dict, bodies, places, sizes, file) -> Joint:
    name, (body, number) = contact["interface"], contact["slave"]
    keys, model, master = case.joints[name], bodies[body], contact["master"]
    own = {
        key: getattr(keys, key)
        for key in (
            "friction_coefficient",
            "law",
            "penalty_factor",
            "restitution",
            "rolling_resistance",
        )
    }
    contact_keys = dataclasses.replace(
        case.contact, **{key: value for key, value in own.items() if value is not None}
    )
    surface = model.surfaces[contact["slave_surface"]]
    outlines = tuple(
        np.array(own) - bodies[of[0]].center
        for own, of in zip(contact["outlines"], (contact["slave"], master))
    )
    if contact_keys.law == "penalty" and body not in sizes:
        raise InputError(
            file,
            f"joints.{name}.law",
            contact_keys.law,
            f'must be augmented_lagrange where the slave, "{body}", has no elements',
        )
    youngs = (
        0.0
        if body not in sizes
        else material_of(case.bodies[body], case.materials).youngs_modulus_pa
    )
    law = interface_compliance(contact_keys, youngs, sizes.get(body, 1.0), surface.areas)
    ball = ball_of(case.bodies[body]) if contact["slave_surface"] == "foot" else None
    round_rim = (
        not (ball and ball.is_dome)
        and abs(surface.normal[2]) > 1 - 1e-9
        and Rim.find(surface.plane(model.arms[surface.nodes])) is not None
    )
    title = case.names_of(body)[number]
    where = keys.on if master is None else case.names_of(master[0])[master[1]]
    shown = f"{name}, edge" if contact["slave_surface"].endswith(", edge") else name
    return Joint(
        f"{shown}: {title} on {where}",
        places[body, number],
        contact["slave_surface"],
        models.GROUND if master is None else places[tuple(master)],
        contact["master_surface"],
        contact_keys.friction_coefficient,
        law,
        round_rim,
        contact_keys.restitution,
        ball,
        contact["pair"],
        outlines,
        contact_keys.rolling_resistance,
        ground=list(case.grounds).index(keys.on) if master is None else 0,
        gap=contact["gap"],
    )


def _with_hertz(case, joints, standing, copies) -> list[Joint]:
    """The joints, domes with the compliance of a sphere on what they stand on, linear about what
    they carry at rest; none in the rigid engine.
    """
    if case.integration.engine == "rigid":
        return joints
    found = []
    for joint, load in zip(joints, loads(standing, joints)):
        if joint.ball and joint.ball.is_dome:
            bodies = [
                case.bodies[copies[place][0]]
                for place in (joint.slave, joint.master)
                if place != models.GROUND
            ]
            if bodies[0].contact_stiffness_n_m3 is None:
                materials = [
                    material_of(body, case.materials)
                    for body in bodies
                    if not isinstance(body, Matrices)
                ]
                joint = dataclasses.replace(
                    joint, law=joint.law + hertz(joint.ball.radius, load, *materials)
                )
        found.append(joint)
    return found


def _damping(case, name: str, model: BodyModel):
    if model.damping is not None:
        return model.damping
    body = case.bodies[name]
    if body.damping_ratio is not None:
        return body.damping_ratio
    return 0.0 if isinstance(body, Matrices) else material_of(body, case.materials).damping_ratio


def _links(case, name: str, places, standing: list[Standing]):
    """The links of a name, one at each copy of its body; points as the bodies stand."""
    keys = case.links[name]
    body, numbers = case.meant_by(keys.body)
    for number in numbers:
        a = places[body, number]
        origin = np.array(case.bodies[body].places[number])
        other = models.GROUND
        if keys.to not in case.grounds:
            other_body, (other_number,) = case.meant_by(keys.to)
            other = places[other_body, other_number]
        start, end = origin + keys.point_m, origin + keys.to_point_m
        ground = list(case.grounds).index(keys.to) if other == models.GROUND else 0
        if standing[a].held >= 0:
            a, other, start, end = other, a, end, start
        # what a fixed body holds, its ground holds
        if other != models.GROUND and standing[other].held >= 0:
            other, ground = models.GROUND, standing[other].held
        pulls, pushes = keys.kind in PULLING, keys.kind in PUSHING
        yield Link(
            name if len(numbers) == 1 else f"{name} {number + 1}",
            keys.kind,
            a,
            start - standing[a].center,
            other,
            end if other == models.GROUND else end - standing[other].center,
            keys.stiffness_n_m,
            keys.damping_n_s_m,
            0.0 - keys.prestress_n if pushes and not pulls else keys.prestress_n,
            keys.slack_m + keys.gap_m,
            pushes,
            pulls,
            keys.yield_n or keys.slip_n or math.inf,
            keys.breaking_n or math.inf,
            ground,
            keys.hardening,
            keys.yield_exponent or math.inf,
            keys.damping_exponent,
            keys.linear_below_m_s if keys.damping_exponent < 1 else 0.0,
        )


def _with_shapes(link: Link, copies, standing: list[Standing], keys: dict) -> Link:
    """A link with the shapes of the modes at its ends; keys: of the bodies in `store`."""

    def shape(place: int, arm: np.ndarray):
        if place == models.GROUND or not len(standing[place].model.frequencies):
            return None
        key = keys.get(copies[place][0])
        found = key and shape_at(key, arm)
        return None if found is None else found[:, : len(standing[place].model.frequencies)]

    return replace(link, shape_a=shape(link.a, link.arm_a), shape_b=shape(link.b, link.arm_b))


def _observed(case, parts, places, file) -> tuple[int, str]:
    if case.observed:
        name, _, mark = case.observed.partition(".")
        body, (number,) = case.meant_by(name)
        place, mark = places[body, number], mark or "top"
        if mark not in (known := parts[place].model.marks):
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
