"""Bonded joints as links: each contact point is held by a spring along the normal, which only pulls
and shares its place with the contact, and by two along the face.

A link is as long as LONG times the way at which nothing of a point is left, and WIDE times the
width of the face at least, and ends on the master's side, so that it keeps its direction in the
master's frame to that share, and rounding of places hardly turns it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.engines.dynamics.links import LINK
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.structures.model import JointModel, StructureModel, Surface

# Length of a link of a bond over the way at which it has failed; at least, over the width of the
# face
LONG, WIDE = 2e3, 0.1


class BondLinks(NamedTuple):
    """links: (nl,) of LINK, three for each point; shapes: of each, those of the modes at its ends a
    and b, (3, m) or None on a ground.
    """

    links: Array
    shapes: list[tuple]


def bonded(model: StructureModel) -> list:
    """The joints of a StructureModel that are bonded, in their order."""
    return [joint for joint in model.joints if joint.bond is not None]


def bond_links(model: StructureModel) -> BondLinks:
    """The links of all bonded joints of a StructureModel, number 1 those of the first of them."""
    links, shapes = [np.zeros(0, LINK)], []
    for number, joint in enumerate(bonded(model), 1):
        slave, surface = model.parts[joint.slave], _face(model, joint.slave, joint.slave_surface)
        nodes = surface.nodes[joint.bond.rows]
        points = slave.model.arms[nodes]
        if joint.ball is not None:
            points = points + joint.ball.radius * surface.normal
        points = slave.center + points @ slave.rotation.T
        own, other = (
            slave.model.shapes[nodes],
            _shapes_below(model, joint, points),
        )
        for point, area, *moved in zip(points, joint.bond.areas, own, other):
            rows = _links_of_point(model, joint, point, area)
            rows["bond"] = number
            # as they are told: a is a body
            both = tuple(moved) if rows["a"][0] == joint.slave else tuple(moved[::-1])
            links.append(rows)
            shapes += [both] * len(rows)
    return BondLinks(np.concatenate(links).astype(LINK), shapes)


def _links_of_point(model: StructureModel, joint: JointModel, point: Array, area: float) -> Array:
    """Three links (3,) of LINK at a point (3,) [m] of the slave that stands for an area [m2]."""
    bond, rows = joint.bond, np.zeros(3, LINK)
    assert bond is not None
    face = _face(model, joint.slave, joint.slave_surface)
    axes = model.parts[joint.slave].rotation @ face.axes
    stiffness = area * np.array([bond.stiffness, bond.shear_stiffness, bond.shear_stiffness])
    strength = area * np.array([bond.tension, bond.cohesion, bond.cohesion])
    rows["stiffness"], rows["breaks"] = stiffness, strength / stiffness
    # the area below the line that falls from the strength to nothing
    rows["fails"] = np.maximum(rows["breaks"], 2 * bond.energy * area / strength)
    rows["area"], rows["rubs"], rows["leads"] = area, joint.friction, [True, False, False]
    rows["pulls"], rows["pushes"] = True, [False, True, True]
    rows["yields"], rows["bends"], rows["power"] = np.inf, np.inf, 1.0
    width = np.ptp(model.parts[joint.slave].model.arms[face.nodes], axis=0).max()
    rows["length"] = max(LONG * rows["fails"].min(), WIDE * width)
    for row, along in zip(rows, axes.T[[2, 0, 1]]):
        near = _held_at(model, joint.slave, joint.ground, point)
        far = _held_at(model, joint.master, joint.ground, point + row["length"] * along)
        (row["a"], _, row["arm_a"]), (row["b"], row["ground"], row["arm_b"]) = (
            (near, far) if near[0] != GROUND else (far, near)
        )
    return rows


def _held_at(model: StructureModel, place: int, ground: int, point: Array) -> tuple:
    """Body, ground and arm of the end of a link at a point (3,) [m] of a part or the ground; what
    a fixed body holds, its ground holds.
    """
    if place == GROUND or model.parts[place].held >= 0:
        return GROUND, ground if place == GROUND else model.parts[place].held, point
    part = model.parts[place]
    return place, 0, part.rotation.T @ (point - part.center)


def _face(model: StructureModel, place: int, name: str | None) -> Surface:
    assert name is not None
    return model.parts[place].model.surfaces[name]


def _shapes_below(model: StructureModel, joint: JointModel, points: Array) -> list:
    """Shapes (3, m) of the master's modes below points (n, 3) [m] of the slave; None of a
    ground.
    """
    if joint.master == GROUND:
        return [None] * len(points)
    part, face = (
        model.parts[joint.master],
        _face(model, joint.master, joint.master_surface),
    )
    corners = face.plane(part.model.arms[face.nodes])[:, :2]
    places = face.plane((points - part.center) @ part.rotation)[:, :2]
    found, a = [], corners[face.triangles[:, 0]]
    edges = np.stack([corners[face.triangles[:, k]] - a for k in (1, 2)], axis=2)
    inverse = np.linalg.inv(edges)
    for place in places:
        shares = np.einsum("tab,tb->ta", inverse, place - a)
        shares = np.column_stack([1 - shares.sum(axis=1), shares])
        best = int(np.argmax(shares.min(axis=1)))
        nodes = face.nodes[face.triangles[best]]
        found.append(np.einsum("q,qam->am", shares[best], part.model.shapes[nodes]))
    return found
