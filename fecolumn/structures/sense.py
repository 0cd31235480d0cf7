"""Structures whose numbers, each in its range, make no sense together: told before anything is
computed.
"""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Matrices, Prism
from fecolumn.case.body_keys import Solid
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.case.check_way import check_way
from fecolumn.case.checked import refuse_in
from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.structures.model import BodyModel, HullOutline, JointModel, StructureModel
from fecolumn.structures.size import LARGE, largest_side
from fecolumn.structures.standing import Standing, loads, supports_of

# Mean strain of a body at rest below one of its faces: what elements are made for is a tenth of it
_STRAIN = 0.1
# [kg/m3]: densities of what is as stiff as stone or metal lie between
_LIGHT, _HEAVY = 5.0, 25_000.0
# [Pa]: Young's modulus from which on a body is as stiff as stone or metal
_STIFF = 1e9
# Contact points from which on those of rigid bodies are told of: steps take milliseconds
_MANY_POINTS = 1000
# Over the weight of the lighter body: force of a link that cannot be told from none
_FORCE = 1e-6


def check_sense(
    case: Case,
    structure: StructureModel,
    standing: list[Standing],
    extents: list[NDArray[Any]],
    file: Path | str,
) -> None:
    """Refuse soft bodies that their load flattens, links that hold nothing, and a cap of the top's
    way that no structure stays below.

    Parameters
    ----------
    standing
        as of `place`.
    extents
        of each part, lowest and highest place (2, 3) [m] from its centre of mass.
    """
    tops = [one.center[2] + own[:, 2] for one, own in zip(standing, extents)]
    height = float(np.ptp(np.concatenate(tops)))
    check_way(case.overturn, height, refuse_in(file))
    _check_forces(case, structure, file)
    if case.integration.engine != "rigid":
        _check_strains(case, structure, standing, file)


def tell_of_lengths(case: Case, file: Path | str) -> None:
    """Warn, once, of a prism so large that its lengths are likely not in metres."""
    sides = {
        name: largest_side(body) for name, body in case.bodies.items() if isinstance(body, Prism)
    }
    if sides and max(sides.values()) > LARGE:
        name = max(sides, key=sides.__getitem__)
        warnings.warn(
            f'{file}: bodies.{name}: "{name}" is {sides[name]:g} m large, which looks like '
            "millimetres: lengths are in metres",
            stacklevel=2,
        )


def tell_of_restitution(
    case: Case, joints: list[JointModel], standing: list[Standing], file: Path | str
) -> None:
    """Warn of restitution where more than it decides how a body rebounds: on ground that gives, and
    of elastic bodies in steps that are shorter than their slowest vibration.
    """
    dt, engine = case.integration.dt_s, case.integration.engine
    for joint in joints:
        if not joint.restitution:
            continue
        places = [place for place in (joint.slave, joint.master) if place != GROUND]
        slowest = min(standing[place].model.frequencies.min(initial=math.inf) for place in places)
        period = 2 * math.pi / slowest
        ground = list(case.grounds.values())[joint.ground] if joint.master == GROUND else None
        if engine != "rigid" and (dt == "auto" or float(dt) < period) and period > 0:
            told = (
                f"elastic bodies vibrate for up to {period:.2g} s, and steps that are shorter "
                "follow that: how high a body rebounds then depends on integration.dt_s"
            )
        elif ground is not None and ground.kind in ("plate", "unbounded"):
            told = (
                "ground that gives takes and returns energy of its own: how high a body rebounds "
                "depends on integration.dt_s"
            )
        else:
            continue
        name = joint.name.partition(":")[0]
        warnings.warn(
            f"{file}: joints.{name}: restitution = {joint.restitution:g} is that of rigid bodies "
            f"on rigid ground; {told}",
            stacklevel=3,
        )
        return


def tell_of_densities(
    case: Case,
    bodies: dict[str, BodyModel],
    outlines: dict[str, HullOutline | None],
    file: Path | str,
) -> None:
    """Warn of stiff bodies whose density, mass over volume, is that of no stone or metal.

    Parameters
    ----------
    bodies
        by name, as of `BodyModel`.
    outlines
        by name, with the volume [m3]; None of a body without a shape.
    """
    told = set()
    for name, outline in outlines.items():
        body = case.bodies[name]
        if isinstance(body, Matrices):
            _tell_of_matrices(name, bodies[name], file)
        if not outline or not isinstance(body, Solid):
            continue
        density = bodies[name].mass / outline["volume"]
        stiff = material_of(body, case.materials).youngs_modulus_pa >= _STIFF
        if not stiff or _LIGHT <= density <= _HEAVY:
            continue
        own = f"bodies.{name}.{'density_kg_m3' if body.mass_kg is None else 'mass_kg'}"
        if body.mass_kg is None and body.density_kg_m3 is None:
            own = f"materials.{body.material}.density_kg_m3"
        if own not in told:
            warnings.warn(
                f'{file}: {own}: "{name}" has {density:.3g} kg/m3, and stone and metal '
                f"{_LIGHT:g} to {_HEAVY:g}: densities are in kg/m3 and masses in kg, "
                "1 g/cm3 = 1 t/m3 = 1000 kg/m3",
                stacklevel=2,
            )
        told.add(own)


def _tell_of_matrices(name: str, model: BodyModel, file: Path | str) -> None:
    """Warn of a body of matrices that is lighter than any: units that do not fit each other."""
    nodes = np.concatenate([one.nodes for one in model.surfaces.values()])
    sides = np.ptp(model.arms[nodes], axis=0)[:2]
    height = 2 * float(np.abs(model.arms[nodes, 2]).max())
    density = model.mass / max(float(sides.prod()) * height, 1e-300)
    if density < _LIGHT:
        warnings.warn(
            f'{file}: bodies.{name}.mass_file: "{name}" weighs {model.mass:.3g} kg, its contact '
            f"nodes take {sides[0]:.3g} x {sides[1]:.3g} m, and its centre of mass is "
            f"{height / 2:.3g} m over them: {density:.2g} kg/m3 of that box, which looks like "
            "other units: masses are in kg, stiffnesses in N/m, places in m",
            stacklevel=2,
        )


def tell_of_tilts(joints: list[JointModel], standing: list[Standing], file: Path | str) -> None:
    """Warn, once, of a body that is tilted at the start below one that is not tilted with it."""
    for upper, below in enumerate(supports_of(standing, joints)):
        own = standing[upper].start
        if len(below) != 1 or below[0][0] == GROUND:
            continue
        lower = standing[below[0][0]]
        if lower.start is None or not lower.start.tilt_rad:
            continue
        if own is not None and (own.tilt_rad or own.moves):
            continue
        warnings.warn(
            f'{file}: initial: "{standing[upper].name}" stands on "{lower.name}", which begins '
            f"tilted by {lower.start.tilt_rad:g} rad, and begins level on its raised edge: a tilt "
            "is from the vertical, and of one body; the same tilt_rad and direction_deg for "
            f'[initial."{standing[upper].name}"] carry it along',
            stacklevel=2,
        )
        return


def tell_of_points(structure: StructureModel, file: Path | str) -> None:
    """Warn of many contact points of bodies that do not deform: their corners suffice."""
    counts = {
        joint.name: len(structure.parts[joint.slave].model.surfaces[joint.slave_surface].nodes)
        for joint in structure.joints
        # a round rim needs its points, and so does what gives or is glued over the face
        if not (joint.round or joint.pad or joint.bond or joint.law.any())
    }
    total = sum(counts.values())
    rigid = not any(part.model.flexibility.any() for part in structure.parts)
    if rigid and total > _MANY_POINTS:
        most = max(counts, key=lambda name: counts[name])
        warnings.warn(
            f"{file}: {total:,} contact points of rigid bodies, {counts[most]} in joint "
            f'"{most}": the corners of a face suffice, and steps cost a small part: set '
            "contact.interior_points = 0 and element_size_m to the bodies' shorter sides",
            stacklevel=3,
        )


def _check_forces(case: Case, structure: StructureModel, file: Path | str) -> None:
    for link in structure.links:
        ends = [end for end in (link.a, link.b) if end != GROUND]
        least = _FORCE * GRAVITY * min(structure.parts[end].model.mass for end in ends)
        for name, keys in case.links.items():
            if link.name not in (name, *(f"{name} {n + 1}" for n in range(len(structure.parts)))):
                continue
            for key in ("breaking_n", "yield_n", "slip_n"):
                value = getattr(keys, key)
                if value is not None and value < least:
                    raise InputError(
                        file,
                        f"links.{name}.{key}",
                        value,
                        f"must be at least {least:.3g} N, {_FORCE:g} of the weight of what it "
                        "holds: a link that gives way at less holds nothing; leave it out",
                    )


def _check_strains(
    case: Case, structure: StructureModel, standing: list[Standing], file: Path | str
) -> None:
    bodies = [name for name, _ in case.copies]
    for joint, load in zip(structure.joints, loads(standing, structure.joints)):
        if joint.gap or joint.ball:
            continue
        surfaces = [(joint.slave, joint.slave_surface)]
        if joint.master_surface is not None:
            surfaces.append((joint.master, joint.master_surface))
        area = min(standing[at].model.surfaces[face].areas.sum() for at, face in surfaces)
        for at, _ in surfaces:
            body = case.bodies[bodies[at]]
            if not isinstance(body, Solid) or not body.deforms or area <= 0:
                continue
            stiffness = material_of(body, case.materials).youngs_modulus_pa
            if load > _STRAIN * area * stiffness:
                named = body.material and body.youngs_modulus_pa is None
                own = f"materials.{body.material}" if named else f"bodies.{bodies[at]}"
                raise InputError(
                    file,
                    f"{own}.youngs_modulus_pa",
                    stiffness,
                    f"must be at least {load / (_STRAIN * area):.3g} Pa: at rest "
                    f'"{standing[at].name}" bears {load:.3g} N on {area:.3g} m2, which strains it '
                    f"by {100 * load / (area * stiffness):.3g} %, and elements are made for "
                    f"{100 * _STRAIN:g} % at most; what is softer is a pad of its joint",
                )
