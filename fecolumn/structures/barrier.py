"""Energy that it takes to overturn a structure slowly."""

from __future__ import annotations

import math
from dataclasses import replace

from fecolumn.case import GRAVITY, Initial
from fecolumn.dynamics.overturning import Stance, stance
from fecolumn.schema import InputError
from fecolumn.structures.model import StructureModel
from fecolumn.structures.place import Standing, placed

# Directions [deg] in which a body is leaned; the least energy is in that of its weakest edge
_DIRECTIONS = (0.0, 90.0, 180.0, 270.0)


def stances(structure: StructureModel) -> dict[int, Stance]:
    """Stance, each by itself, of the parts that stand on a face below them."""
    found = {}
    for joint in structure.joints:
        part = structure.parts[joint.slave]
        surface = part.model.surfaces[joint.slave_surface]
        if surface.normal[2] < -math.sqrt(0.5):
            found[joint.slave] = stance(part.model.arms[surface.nodes], part.model.inertia, part.model.mass * GRAVITY, joint.friction, 0.0)
    return found


def least_barrier(structure: StructureModel, standing: list[Standing]) -> float:
    """Least energy [J] that leans a part by its own critical tilt, with all that then stands on it, over what it has upright.

    Where a part cannot lean alone, as a column of a frame, all of its model lean.
    """
    lifts, upright = [], [replace(part, start=None) for part in standing]
    for place, foot in stances(structure).items():
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
