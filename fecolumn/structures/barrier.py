"""Energy that it takes to overturn a structure slowly."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fecolumn.case import GRAVITY, Initial
from fecolumn.dynamics.overturning import Stance, stance
from fecolumn.schema import InputError
from fecolumn.structures.feet import edge_points
from fecolumn.structures.model import StructureModel
from fecolumn.structures.place import Standing, placed, touching

# Directions [deg] in which a body is leaned; the least energy is in that of its weakest edge
_DIRECTIONS = (0.0, 90.0, 180.0, 270.0)


def stances(structure: StructureModel, standing: list[Standing]) -> dict[int, Stance]:
    """Stance, each by itself, of the parts that stand on a face below them; standing: the parts upright."""
    found = {}
    for joint in structure.joints:
        model = standing[joint.slave].model
        if model.surfaces[joint.slave_surface].normal[2] < -math.sqrt(0.5):
            found[joint.slave] = stance(_footing(structure, standing, joint), model.inertia, model.mass * GRAVITY, joint.friction, 0.0)
    return found


def _footing(structure: StructureModel, standing: list[Standing], joint) -> np.ndarray:
    """Points (n, 3) [m] from the slave's centre of mass over which it tips: of its foot, of the edge of a dome, or of what is narrower than the foot that stands on it."""
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    arms = slave.model.arms[surface.nodes]
    if joint.ball and joint.ball.is_dome:
        return arms[0] + edge_points(joint.ball)
    below = [other for other in structure.joints if (other.slave, other.master) == (joint.master, joint.slave)]
    if not below:
        return arms
    own = [slave.center + arms[touching(standing, joint)]]
    for other in below:
        part = standing[other.slave]
        own.append(part.center + part.model.arms[part.model.surfaces[other.slave_surface].nodes[touching(standing, other)]])
    return np.concatenate(own) - slave.center


def least_barrier(structure: StructureModel, standing: list[Standing]) -> float:
    """Least energy [J] that leans a part by its own critical tilt, with all that then stands on it, over what it has upright.

    Where a part cannot lean alone, as a column of a frame, all of its model lean.
    """
    lifts, upright = [], [replace(part, start=None) for part in standing]
    for place, foot in stances(structure, standing).items():
        alike = [k for k, part in enumerate(standing) if part.model is standing[place].model]
        for direction in _DIRECTIONS:
            start = Initial(tilt_rad=min(max(foot.critical, 0.0), 1.5), direction_deg=direction)
            for leaning in ([place], alike):
                trial = [replace(part, start=start) if k in leaning else part for k, part in enumerate(upright)]
                try:
                    there = placed(trial, list(structure.joints), "")
                except InputError:
                    continue
                lifts.append(sum(part.model.mass * GRAVITY * (now.center[2] - part.center[2]) for part, now in zip(upright, there)))
                break
    return max(0.0, float(min(lifts, default=0.0)))
