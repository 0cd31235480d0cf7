"""Joints of a structure from those of its case."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.case.body_keys import WithMaterial
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.case.joint import own_contact
from fecolumn.contact.law import interface_compliance
from fecolumn.contact.points import GROUND
from fecolumn.contact.rim import Rim
from fecolumn.contact.tolerances import LEVEL
from fecolumn.foundation.schema import InputError
from fecolumn.structures.feet import ball_of, hertz
from fecolumn.structures.model import BodyModel, JointModel
from fecolumn.structures.standing import Standing, dome_load, loads


def joint_of(
    case: Case,
    contact: dict[str, Any],
    bodies: dict[str, BodyModel],
    places: dict[tuple[str, int], int],
    sizes: dict[str, float],
    file: Path | str,
) -> JointModel:
    """The joint of one contact of a layout.

    Parameters
    ----------
    contact
        as of `made_layout.said_of`.
    bodies
        models by name.
    places
        number of each copy (name, number) among all parts.
    sizes
        element size [m] by body.

    Raises
    ------
    InputError
        a penalty law of a body without elements.
    """
    name, (body, number) = contact["interface"], contact["slave"]
    keys, model, master = case.joints[name], bodies[body], contact["master"]
    contact_keys = own_contact(keys, case.contact)
    surface = model.surfaces[contact["slave_surface"]]
    outlines = tuple(
        np.array(own) - bodies[of[0]].center
        for own, of in zip(contact["outlines"], (contact["slave"], master))
    )
    border = np.reshape(contact["border"], (-1, 2, 3))
    if master is not None:
        border = border - bodies[master[0]].center
    if contact_keys.law == "penalty" and body not in sizes:
        raise InputError(
            file,
            f"joints.{name}.law",
            contact_keys.law,
            f'must be augmented_lagrange where the slave, "{body}", has no elements',
        )
    drawn = case.bodies[body]
    youngs = (
        material_of(drawn, case.materials).youngs_modulus_pa
        if body in sizes and isinstance(drawn, WithMaterial)
        else 0.0
    )
    law = interface_compliance(contact_keys, youngs, sizes.get(body, 1.0), surface.areas)
    ball = ball_of(case.bodies[body]) if contact["slave_surface"] == "foot" else None
    round_rim = (
        not (ball and ball.is_dome)
        and abs(surface.normal[2]) > LEVEL
        and Rim.find(surface.plane(model.arms[surface.nodes])) is not None
    )
    title = case.names_of(body)[number]
    where = keys.on if master is None else case.names_of(master[0])[master[1]]
    shown = f"{name}, edge" if contact["slave_surface"].endswith(", edge") else name
    return JointModel(
        f"{shown}: {title} on {where}",
        places[body, number],
        contact["slave_surface"],
        GROUND if master is None else places[tuple(master)],
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
        border=border,
    )


def with_hertz(
    case: Case,
    joints: list[JointModel],
    standing: list[Standing],
    copies: Sequence[tuple[str, int]],
) -> list[JointModel]:
    """The joints, domes with the compliance of a sphere on what they stand on, linear about what
    they carry at rest; none in the rigid engine, nor on a pad, which spreads the force.
    """
    if case.integration.engine == "rigid":
        return joints
    found = []
    for joint, load in zip(joints, loads(standing, joints)):
        if joint.ball and joint.on_dome and joint.pad is None:
            bodies = [
                case.bodies[copies[place][0]]
                for place in (joint.slave, joint.master)
                if place != GROUND
            ]
            if getattr(bodies[0], "contact_stiffness_n_m3", None) is None:
                materials = [
                    material_of(body, case.materials)
                    for body in bodies
                    if isinstance(body, WithMaterial)
                ]
                carried = dome_load(standing, joint, load)
                joint = dataclasses.replace(
                    joint, law=joint.law + hertz(joint.ball.radius, carried, *materials)
                )
        found.append(joint)
    return found
