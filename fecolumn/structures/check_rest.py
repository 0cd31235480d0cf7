"""Structures that cannot rest as their bodies stand, refused by name."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linprog
from scipy.sparse import coo_array, hstack, identity

from fecolumn.case.case import Case
from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.foundation.schema import InputError
from fecolumn.structures.bonds import pulls_of_bonds
from fecolumn.structures.model import JointModel, StructureModel
from fecolumn.structures.place import footing
from fecolumn.structures.standing import Standing

# Over the weight: force by which a body may miss equilibrium
_HELD = 1e-6
# Directions of friction at a point: a pyramid around the cone, by up to 8 % wider, so that no
# structure that can rest is refused
_DIRECTIONS = 8


class _Forces:
    """Forces that two bodies of a structure may have on one another, and what they do to each.

    bounds: of each, least and most of its factor, None where there is none.
    """

    def __init__(self, structure: StructureModel, standing: list[Standing]) -> None:
        self.bounds: list[tuple[float | None, float | None]] = []
        self.free = np.array([one.held < 0 and not one.airborne for one in structure.parts])
        self._centers = np.array([one.center for one in standing])
        #: Radii of gyration [m], by which moments are divided.
        self._sizes = np.array(
            [math.sqrt(np.trace(one.model.inertia) / one.model.mass) for one in structure.parts]
        )
        # of each entry that is not 0: row, column and value
        self._entries: list[NDArray[Any]] = []

    def add(
        self,
        bodies: tuple[int, int],
        forces: ArrayLike,
        points: ArrayLike,
        bounds: list[tuple[float | None, float | None]],
    ) -> None:
        """Forces (k, 3) on the first body, the opposite on the second, at points (k, 3) [m]."""
        columns = len(self.bounds) + np.arange(len(bounds))
        self.bounds += bounds
        for body, sign in zip(bodies, (1.0, -1.0)):
            if body == GROUND or not self.free[body]:
                continue
            own = sign * np.asarray(forces, float)
            moments = np.cross(points - self._centers[body], own) / self._sizes[body]
            values = np.concatenate([own, moments], axis=1)
            rows = np.broadcast_to(6 * body + np.arange(6), values.shape)
            every = np.broadcast_to(columns[:, None], values.shape)
            self._entries.append(np.stack([rows.ravel(), every.ravel(), values.ravel()]))

    def matrix(self) -> Any:
        """Forces and moments over the radius of gyration (6 nb, n) on each body, by factors of 1;
        sparse.
        """
        rows, columns, values = np.concatenate([np.zeros((3, 0)), *self._entries], axis=1)
        shape = 6 * len(self.free), len(self.bounds)
        return coo_array((values, (rows.astype(int), columns.astype(int))), shape=shape)


def _add_contact(forces: _Forces, standing: list[Standing], joint: JointModel) -> None:
    """Edges of the pyramids of friction at all points of a joint."""
    surface = standing[joint.slave].model.surfaces[joint.slave_surface]
    points = footing(standing, joint)
    if joint.ball:
        points = points + joint.ball.radius * surface.normal
    along = np.zeros((1, 3))
    if joint.friction:
        angles = 2 * np.pi * np.arange(_DIRECTIONS)[:, None] / _DIRECTIONS
        wide = joint.friction / math.cos(np.pi / _DIRECTIONS)
        tangents = surface.axes[:, 0], surface.axes[:, 1]
        along = wide * (np.cos(angles) * tangents[0] + np.sin(angles) * tangents[1])
    count = len(points) * len(along)
    forces.add(
        (joint.slave, joint.master),
        np.tile(along - surface.normal, (len(points), 1)),
        np.repeat(points, len(along), axis=0),
        [(0, None)] * count,
    )


def _add_links(forces: _Forces, standing: list[Standing], structure: StructureModel) -> None:
    """Pulls of all links that are not slack."""
    for link in structure.links:
        a = standing[link.a].center + link.arm_a
        b = link.arm_b if link.b == GROUND else standing[link.b].center + link.arm_b
        if not np.linalg.norm(b - a) or not link.stiffness or link.slack:
            continue
        pull = (b - a) / np.linalg.norm(b - a)
        # any point of its line serves for both ends
        bounds = (None if link.pushes else 0, None if link.pulls else 0)
        forces.add((link.a, link.b), pull[None], a[None], [bounds])


def check_rest(
    case: Case, structure: StructureModel, standing: list[Standing], file: Path | str
) -> None:
    """Of a structure that nothing tilts or sets moving, refuse bodies that no contact forces within
    their cones, and no forces of links, hold at rest: what is missing least is a linear programme.

    standing: as of `place`.
    """
    if case.integration.start == "drawn":
        return
    if any(start.tilt_rad or start.moves for start in case.initial.values()):
        return
    if names := unheld(structure, standing):
        raise InputError(
            file,
            "joints",
            None,
            f"{names} cannot rest: no contact forces within friction hold the weight as "
            "the bodies stand; "
            "give a start by [initial.NAME] or integration.start = 'drawn', or other places, "
            "friction, links or bond_tension_pa",
        )


def unheld(structure: StructureModel, standing: list[Standing]) -> str:
    """Names of the bodies that no contact forces within their cones, and no forces of links, hold
    at rest as the bodies stand upright; "" where all are held. standing: as of `place`.
    """
    rows = 6 * len(structure.parts)
    weights = np.array([part.model.mass for part in structure.parts]) * GRAVITY
    forces = _Forces(structure, standing)
    for joint in structure.joints:
        if not joint.gap:
            _add_contact(forces, standing, joint)
        for point, along, least, most in pulls_of_bonds(standing, joint) if joint.bond else ():
            bodies = joint.slave, joint.master
            forces.add(bodies, along[None], point[None], [(least, most)])
    _add_links(forces, standing, structure)
    load = np.zeros(rows)
    load[2::6] = weights * forces.free
    # forces in weights of the heaviest, each row over its body's: the solver takes 1e-9 for nothing
    unit = weights[forces.free].max(initial=1.0)
    scale, count = np.repeat(weights, 6), len(forces.bounds)
    missing = identity(rows)
    bounds = [tuple(one if one is None else one / unit for one in pair) for pair in forces.bounds]
    found = linprog(
        np.concatenate([np.zeros(count), np.ones(2 * rows)]),
        A_eq=hstack([(unit / scale)[:, None] * forces.matrix(), missing, -missing], format="csc"),
        b_eq=load / scale,
        bounds=bounds + [(0, None)] * (2 * rows),
        method="highs",
    )
    if not found.success:
        return ""  # the engine's own search for equilibrium has the last word
    lacks = np.abs(found.x[count : count + rows] - found.x[count + rows :])
    lacks = lacks.reshape(-1, 6).sum(axis=1)
    return ", ".join(f'"{part.name}"' for part, lack in zip(structure.parts, lacks) if lack > _HELD)
