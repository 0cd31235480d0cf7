"""Energy that it takes to overturn a structure slowly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY, Initial
from fecolumn.contact import overturning
from fecolumn.contact.overturning import Stance, stance
from fecolumn.contact.points import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.structures.feet import edge_points
from fecolumn.structures.foot_on_springs import FootOnSprings
from fecolumn.structures.model import JointModel, StructureModel
from fecolumn.structures.place import footing, placed
from fecolumn.structures.spring_areas import spring_areas
from fecolumn.structures.standing import (
    Standing,
    Supports,
    from_below,
    remembered,
    supports_of,
)

# Directions [deg] in which a body is leaned; the least energy is in that of its weakest edge
_DIRECTIONS = (0.0, 90.0, 180.0, 270.0)
# Over the width of what is under several bodies: supports at other heights are no common foot
_LEVEL = 1e-3


def stances(structure: StructureModel, standing: list[Standing]) -> dict[int, Stance]:
    """Stance, each by itself, of the parts that can stand on what is below them; standing: the
    parts upright.

    A part stands over all that it touches below: an architrave over the heads of its columns.
    """
    found = {}
    for place, below in enumerate(supports_of(standing, list(structure.joints))):
        if joints := [
            joint for _, between in below for joint in between if is_level(standing, joint)
        ]:
            model = standing[place].model
            one = _stance_of(
                [place], joints, standing, model.inertia, min(joint.friction for joint in joints)
            )
            if one is not None and one.critical > 0:
                found[place] = one
    return found


def is_level(standing: Sequence[Standing], joint: JointModel) -> bool:
    """Whether a body stands on the faces of a joint, rather than beside them."""
    normal = standing[joint.slave].model.surfaces[joint.slave_surface].normal
    return bool(abs(normal[2]) > math.sqrt(0.5))


def _stance_of(
    places: list[int],
    joints: list[JointModel],
    standing: list[Standing],
    inertia: NDArray[Any],
    friction: float,
) -> Stance | None:
    """Stance of parts that move as one rigid body on `joints`; None where what is below them is not
    level, or no area.
    """
    mass, center = _mass_of(standing, places)
    arms = np.concatenate([_footing(standing, joint) for joint in joints]) - center
    width = np.ptp(arms[:, :2], axis=0)
    if (
        np.linalg.matrix_rank(arms[:, :2] - arms[0, :2], 1e-9 * width.max()) < 2
        or np.ptp(arms[:, 2]) > _LEVEL * width.max()
    ):
        return None
    return stance(arms, inertia, mass * GRAVITY, friction, 0.0)


def _mass_of(standing: Sequence[Standing], places: Sequence[int]) -> tuple[float, NDArray[Any]]:
    """Mass [kg] and centre of mass (3,) [m] of parts together."""
    masses = np.array([standing[place].model.mass for place in places])
    centers = np.array([standing[place].center for place in places])
    return float(masses.sum()), masses @ centers / masses.sum()


def _footing(standing: list[Standing], joint: JointModel) -> NDArray[Any]:
    """Points (n, 3) [m] where the bodies of a joint touch, over which the upper one tips; of a dome
    on its edge.
    """
    if joint.ball is not None and joint.on_dome:
        slave = standing[joint.slave]
        arms = slave.model.arms[slave.model.surfaces[joint.slave_surface].nodes]
        edge: NDArray[Any] = slave.center + arms[0] + edge_points(joint.ball)
        return edge
    return footing(standing, joint)


def least_barrier(structure: StructureModel, standing: list[Standing]) -> float:
    """Least energy [J] that overturns any part of a structure slowly, over what it has upright; 0
    where no part stands by itself.

    Of each part the least of three ways: it leans by its own critical tilt, and all that stands on
    it is carried along upright; it leans as one rigid body with all that stands on it; or all parts
    of its model lean, as the columns of a frame.
    """
    joints = list(structure.joints)
    with remembered():
        lifts = _lifts(joints, stances(structure, standing), standing)
    together = _together(standing, joints)
    lifts += [overturning.barrier(one) for _, one, _ in together]
    lifts += [foot.barrier for _, _, foot in together if foot is not None]
    return float(min((lift for lift in lifts if lift > 0), default=0.0))


def _lifts(
    joints: list[JointModel], alone: dict[int, Stance], standing: list[Standing]
) -> list[float]:
    """Energy [J] that leans each part with a stance, `alone`, by its critical tilt, by itself or
    with all of its model, whatever stands on it being carried along.
    """
    lifts: list[float] = []
    upright = [replace(part, start=None) for part in standing]
    supports = supports_of(standing, joints)
    for place, foot in alone.items():
        alike = [k for k, part in enumerate(standing) if part.model is standing[place].model]
        weakest = math.degrees(math.atan2(*overturning.weakest(foot.corners)[1][::-1]))
        for direction in (*_DIRECTIONS, weakest):
            start = Initial(tilt_rad=min(foot.critical, 1.5), direction_deg=direction)
            for leaning in ([place], alike):
                trial = [
                    replace(part, start=start) if k in leaning else part
                    for k, part in enumerate(upright)
                ]
                try:
                    there = placed(trial, joints, "", _with_what_stands_on(leaning, supports))
                except InputError:
                    continue
                lifts.append(
                    sum(
                        part.model.mass * GRAVITY * (now.center[2] - part.center[2])
                        for part, now in zip(upright, there)
                    )
                )
                break
    return lifts


def _with_what_stands_on(places: list[int], supports: list[Supports]) -> set[int]:
    """These parts and all that stands on them, directly or not."""
    found = set(places)
    for place in from_below(supports):
        if any(below in found for below, _ in supports[place]):
            found.add(place)
    return found


def _together(
    standing: list[Standing], joints: list[JointModel]
) -> list[tuple[int, Stance, FootOnSprings | None]]:
    """Places of parts, and stances of each as one rigid body with all that stands on it, wherever
    these can stand together; with what soil or a pad makes of it, None where there is none.
    """
    supports, found = supports_of(standing, joints), []
    for place in range(len(standing)):
        if standing[place].held >= 0:
            continue
        moved, before = {place}, 0
        while len(moved) > before:
            before = len(moved)
            moved |= {
                upper
                for upper, below in enumerate(supports)
                if any(one in moved for one, _ in below)
            }
        under = [
            joint
            for upper in moved
            for below, between in supports[upper]
            if below == GROUND or below not in moved
            for joint in between
            if is_level(standing, joint)
        ]
        if under and (one := _stance_of(sorted(moved), under, standing, np.eye(3), 0.0)):
            found.append((place, one, _foot_on_springs(one, sorted(moved), under, standing)))
    return found


def _foot_on_springs(
    one: Stance, places: list[int], under: list[JointModel], standing: list[Standing]
) -> FootOnSprings | None:
    """Of parts that move as one rigid body on joints that all have pads; None of others, and of
    those that stand on a dome and on more.
    """
    if any(joint.pad is None or joint.slave not in places for joint in under):
        return None
    radius = under[0].ball.radius if under[0].ball and under[0].on_dome else 0.0
    if len(under) > 1 and any(joint.on_dome for joint in under):
        return None
    center, arms, stiffness = _mass_of(standing, places)[1], [], []
    for joint in under:
        assert joint.pad is not None
        slave, rows = standing[joint.slave], spring_areas(standing, joint)[1]
        nodes = slave.model.surfaces[joint.slave_surface].nodes[rows]
        arms.append(slave.center + slave.model.arms[nodes] - center)
        stiffness.append(joint.pad.stiffness[rows, 2])
    return FootOnSprings(one, np.concatenate(arms), np.concatenate(stiffness), radius)


def feet_on_springs(
    structure: StructureModel, standing: list[Standing]
) -> dict[int, FootOnSprings]:
    """By place, of the parts of a structure that stand on soil or pads alone, each with all that is
    on it as one rigid body.
    """
    together = _together(standing, list(structure.joints))
    return {place: foot for place, _, foot in together if foot is not None}
