"""Pads and soil below the joints of a structure."""

from __future__ import annotations

import dataclasses
import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.ground import Ground
from fecolumn.case.joint import Joint
from fecolumn.case.sections import GRAVITY
from fecolumn.contact.pad import pad_below
from fecolumn.contact.points import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.structures.model import JointModel, StructureModel
from fecolumn.structures.spring_areas import spring_areas, stiffer_in_rocking
from fecolumn.structures.standing import Standing, dome_load, loads

# Steps in a period of the vertical vibration on a pad: needed, and for 3 % in frequency (period
# error (w dt)^2 / 12)
FEWEST_STEPS, FEW_STEPS = 4, 10
# Error of the stiffness in rocking, from too few points, that is told
ROCKS_AMISS = 0.03


def pad_keys(case: Case, interface: str) -> tuple[Joint | Ground | None, str]:
    """Where the keys of the pad below an interface are stated, and their names' beginning: the
    interface's own, or its ground; None, "" without a pad.
    """
    keys = case.joints[interface]
    if keys.stiffness_n_m3 is not None:
        return keys, f"joints.{interface}"
    ground = case.grounds.get(keys.on)
    if ground is not None and ground.kind == "pad":
        return ground, f"grounds.{keys.on}"
    return None, ""


def with_pads(
    case: Case,
    joints: list[JointModel],
    standing: list[Standing],
    interfaces: list[str],
    file: Path | str,
) -> list[JointModel]:
    """The joints, those on a pad with its springs; interfaces: names of theirs.

    One relaxation time for all joints of a pad: that at which the dashpots give what the pad
    carries, on all its area, the stated damping ratio.

    Raises
    ------
    InputError
        a pad that yields under the weight on it.
    """
    pads = [pad_keys(case, name) for name in interfaces]
    found, carried = list(joints), loads(standing, joints)
    for where in dict.fromkeys(where for _, where in pads if where):
        own = [k for k, (_, other) in enumerate(pads) if other == where]
        springs = [_areas_below(standing, joints[k], carried[k], pads[k], file) for k in own]
        touched = np.array([areas[rows].sum() for areas, rows in springs])
        # several faces of one body on another carry its load together
        pressures = [
            carried[k]
            / (areas.sum() if joints[k].on_dome else _area_below(standing, joints, joints[k]))
            for k, (areas, _) in zip(own, springs)
        ]
        mass = np.dot(pressures, touched) / GRAVITY / touched.sum()
        for k, (areas, rows), pressure in zip(own, springs, pressures):
            keys = pads[k][0]
            assert keys is not None
            _tell_of_few_points(standing, joints[k], areas, rows, where, file)
            if keys.yield_pa and pressure >= keys.yield_pa:
                raise InputError(
                    file,
                    f"{where}.yield_pa",
                    keys.yield_pa,
                    f'must be more than {pressure:.4g} Pa, with which "'
                    f'{standing[joints[k].slave].name}" presses on it at rest',
                )
            found[k] = dataclasses.replace(
                joints[k],
                pad=pad_below(keys, areas, mass or _own_mass(standing, joints[k], areas)),
                restitution=0.0,
                rolling=0.0,
                # a node of a rim that comes down on a pad presses a spring
                round=False,
            )
    return found


def _areas_below(
    standing: list[Standing],
    joint: JointModel,
    load: float,
    pad: tuple[Joint | Ground | None, str],
    file: Path | str,
) -> tuple[NDArray[Any], NDArray[Any]]:
    """As `spring_areas`; of a dome the area of the circle in which it touches at rest.

    A sphere of radius R on springs of stiffness k per area sinks in by d under a force
    pi k R d^2, over a circle of area 2 pi R d: the stiffness about that is k times that area.

    Raises
    ------
    InputError
        a dome that sinks in up to its edge, or stands on springs that yield.
    """
    if not joint.on_dome:
        return spring_areas(standing, joint)
    (keys, where), name = pad, standing[joint.slave].name
    assert keys is not None and keys.stiffness_n_m3 and joint.ball is not None
    if keys.yield_pa:
        raise InputError(
            file,
            f"{where}.yield_pa",
            keys.yield_pa,
            f'must be left out below the dome of "{name}": where springs yield, the circle in '
            "which it touches grows",
        )
    stiffness, radius = keys.stiffness_n_m3, joint.ball.radius
    load = dome_load(standing, joint, load)
    area = 2 * math.sqrt(math.pi * radius * load / stiffness)
    edge = min(side for side in joint.ball.edge if side)
    if area > math.pi * edge**2:
        raise InputError(
            file,
            f"{where}.stiffness_n_m3",
            stiffness,
            f'lets the dome of "{name}" sink in up to its edge at rest: it must be more than '
            f"{4 * radius * load / (math.pi * edge**4):.4g} N/m3",
        )
    return np.array([area]), np.arange(1)


def _tell_of_few_points(
    standing: list[Standing],
    joint: JointModel,
    areas: NDArray[Any],
    rows: NDArray[Any],
    where: str,
    file: Path | str,
) -> None:
    """Warn of points that are too few to resist rocking as the region does in which both faces
    touch.
    """
    ratio = 1.0 if joint.on_dome else stiffer_in_rocking(standing, joint, areas, rows)
    if abs(ratio - 1) > ROCKS_AMISS:
        slave = standing[joint.slave].name
        warnings.warn(
            f'{file}: {where}: the {len(rows)} contact points of "{slave}" on it resist rocking '
            f"{ratio:.2f} times as the whole face does; more inside make it right "
            "(contact.interior_points, or a smaller element_size_m)",
            stacklevel=3,
        )


def _area_below(standing: list[Standing], joints: list[JointModel], joint: JointModel) -> float:
    """Area [m2] of all faces with which the slave of a joint stands on the master."""
    area = 0.0
    for one in joints:
        if (one.slave, one.master) == (joint.slave, joint.master):
            areas, rows = spring_areas(standing, one)
            area += areas[rows].sum()
    return area


def _own_mass(standing: list[Standing], joint: JointModel, areas: NDArray[Any]) -> float:
    """Mass over area [kg/m2] of the bodies of a joint that carries nothing at rest."""
    masses = [standing[joint.slave].model.mass]
    masses += [standing[joint.master].model.mass] if joint.master != GROUND else []
    over_area: float = min(masses) / areas.sum()
    return over_area


def warn_of_grounds(case: Case, structure: StructureModel, file: Path | str) -> None:
    """Tell of a step that resolves the vibration of a plate, or not that of what stands on a pad.

    Raises
    ------
    InputError
        a pad so stiff that its vibration is less than a few steps.
    """
    dt, told = float(case.integration.dt_s), set()
    for joint in structure.joints:
        if joint.pad is None:
            continue
        keys, where = pad_keys(case, joint.name.partition(":")[0])
        assert keys is not None
        steps = 1 / (joint.pad.frequency * dt)
        text = (
            f"the vertical vibration on it, of {joint.pad.frequency:.3g} Hz, takes "
            f"{steps:.2g} steps"
        )
        if steps < FEWEST_STEPS:
            raise InputError(
                file,
                f"{where}.stiffness_n_m3",
                keys.stiffness_n_m3,
                f"{text}; at least {FEWEST_STEPS} are needed: integration.dt_s at most "
                f"{1 / (FEWEST_STEPS * joint.pad.frequency):.2g} s",
            )
        if steps < FEW_STEPS and where not in told:
            told.add(where)
            warnings.warn(
                f"{file}: {where}: {text}; with fewer than {FEW_STEPS} its frequency is off by "
                "more than 3 %",
                stacklevel=2,
            )
    frequency = min(base.frequency for base in structure.bases)
    if dt < 1 / frequency:
        warnings.warn(
            f"{file}: integration.dt_s = {dt:g} s resolves the ground's own vibration (period "
            f"{1 / frequency:.2g} s), which is left out: it responds statically",
            stacklevel=2,
        )
