"""Wax, putty and mortar in the joints of a structure."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.check_bond import cohesion_of, shear_stiffness_of
from fecolumn.case.joint import Joint
from fecolumn.contact.points import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.structures.model import Bond, JointModel
from fecolumn.structures.spring_areas import spring_areas
from fecolumn.structures.standing import Standing, touching


def with_bonds(
    case: Case,
    joints: list[JointModel],
    standing: list[Standing],
    interfaces: list[str],
    file: Path | str,
) -> list[JointModel]:
    """The joints, those that are glued with their Bond; interfaces: names of theirs.

    Of a joint with two sides that one has it of whose face more lies on the other.

    Raises
    ------
    InputError
        nothing to glue: faces that do not touch, or a dome.
    """
    found = list(joints)
    for name in dict.fromkeys(interfaces):
        keys = case.joints[name]
        if not keys.bond_tension_pa:
            continue
        own = [k for k, other in enumerate(interfaces) if other == name]
        closed = [k for k in own if not joints[k].gap]
        if not closed:
            told = "must be left out where the faces are apart at the start: they are not glued"
            raise InputError(file, f"joints.{name}.bond_tension_pa", keys.bond_tension_pa, told)
        for k in closed:
            ball = joints[k].ball
            if ball and ball.is_dome:
                told = (
                    f'must be left out below the dome of "{standing[joints[k].slave].name}", which '
                    "touches in a point"
                )
                raise InputError(file, f"joints.{name}.bond_tension_pa", keys.bond_tension_pa, told)
        reverse = {joints[k].pair: k for k in closed if joints[k].pair >= 0}
        for k in closed:
            if joints[k].pair < 0:
                best = max((k, reverse.get(k, k)), key=lambda one: _share(standing, joints[one]))
                found[best] = _glued(joints[best], standing, keys)
    return found


def _share(standing: list[Standing], joint: JointModel) -> float:
    """Share of the area of a slave's face that lies on the master."""
    areas = standing[joint.slave].model.surfaces[joint.slave_surface].areas
    share: float = areas[touching(standing, joint)].sum() / areas.sum()
    return share


def _glued(joint: JointModel, standing: list[Standing], keys: Joint) -> JointModel:
    areas, rows = spring_areas(standing, joint)
    bond = Bond(
        rows,
        areas[rows],
        keys.bond_stiffness_n_m3,
        shear_stiffness_of(keys),
        keys.bond_tension_pa,
        cohesion_of(keys),
        keys.bond_fracture_energy_j_m2,
    )
    return dataclasses.replace(joint, bond=bond)


def pulls_of_bonds(
    standing: list[Standing], joint: JointModel
) -> list[tuple[NDArray[Any], NDArray[Any], float, float]]:
    """Forces [N] that the points of a glued joint may have on the slave at most: place (3,) [m],
    direction (3,), least and most of it.
    """
    slave, bond = standing[joint.slave], joint.bond
    assert bond is not None
    surface, found = slave.model.surfaces[joint.slave_surface], []
    axes = surface.axes.T
    for row, area in zip(bond.rows, bond.areas):
        place = slave.center + slave.model.arms[surface.nodes[row]]
        found.append((place, axes[2], 0.0, bond.tension * area))
        found += [(place, one, -bond.cohesion * area, bond.cohesion * area) for one in axes[:2]]
    return found


def check_starts(joints: list[JointModel], standing: list[Standing], file: Path | str) -> None:
    """Refuse bodies that lean at the start though they are glued to what they stand on."""
    for joint in joints:
        places = {joint.slave, joint.master} - {GROUND} if joint.bond else ()
        for place in places:
            start = standing[place].start
            if start is not None and start.tilt_rad:
                raise InputError(
                    file,
                    f"initial.{standing[place].name}.tilt_rad",
                    start.tilt_rad,
                    f"must be 0 where joints.{joint.name.partition(':')[0]}.bond_tension_pa glues "
                    "it: what leans has broken loose; give it a velocity_m_s or spin_rad_s, or "
                    "leave bond_tension_pa out",
                )
