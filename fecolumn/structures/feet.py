"""Feet that are not flat: domes, which are caps of a sphere, and feet with a rounded edge.

A dome is drawn for solid bodies: their nodes are lifted to the sphere, ever less up to the top. Of
a tube no node is: its wall down to the place of the lowest point has the mass and the centre of the
spherical shell that closes it, for a sphere and the cylinder around it have equal areas between any
two levels (Archimedes). A rounded edge is not drawn.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Block, Cylinder, Tube, half_sides
from fecolumn.case.body_keys import Placed
from fecolumn.case.sections import Material
from fecolumn.contact.tolerances import ROUND_CORNERS
from fecolumn.mesh.bricks import BrickMesh
from fecolumn.structures.faces import Face
from fecolumn.structures.model import Ball, BodyModel


def lifted(body: Tube | Cylinder | Block, points: NDArray[Any]) -> NDArray[Any]:
    """Points (..., 3) [m] of the drawing of a body with a flat foot where they are in that of one
    with a dome, if its foot is one.
    """
    if isinstance(body, Tube) or not body.foot_radius_m:
        return points
    radius = np.minimum(np.linalg.norm(points[..., :2], axis=-1), body.foot_radius_m)
    fading = np.clip(1 - points[..., 2] / body.height_m, 0.0, 1.0)
    moved = points.copy()
    moved[..., 2] += fading * (body.foot_radius_m - np.sqrt(body.foot_radius_m**2 - radius**2))
    return moved


def domed(
    body: Tube | Cylinder | Block, mesh: BrickMesh, faces: list[Face]
) -> tuple[BrickMesh, list[Face]]:
    """Mesh and plane faces of a body with a dome from those of one with a flat foot; the foot keeps
    its plane, in which the lowest point lies.
    """
    foot = foot_of(faces)
    moved = [
        face if face is foot else dataclasses.replace(face, corners=lifted(body, face.corners))
        for face in faces
    ]
    return dataclasses.replace(mesh, points=lifted(body, mesh.points)), moved


def foot_of(faces: list[Face]) -> Face:
    """The lowest level face of a body."""
    return min(
        (face for face in faces if face.is_level and face.normal[2] < 0),
        key=lambda face: face.corners[:, :, 2].min(),
    )


def ball_of(body: Placed) -> Ball | None:
    """How the foot of a body touches; None where it is flat."""
    if not isinstance(body, (Tube, Cylinder, Block)):
        return None
    if body.foot_radius_m:
        return Ball(body.foot_radius_m, half_sides(body))
    return Ball(body.edge_radius_m) if body.edge_radius_m else None


def with_balls(model: BodyModel, body: Placed) -> BodyModel:
    """The model of a body whose foot is not flat, from that of the nodes of its foot: nodes in the
    places that `model.Ball` tells.
    """
    ball = ball_of(body)
    if not isinstance(body, (Tube, Cylinder, Block)) or not ball or "foot" not in model.surfaces:
        return model
    foot = model.surfaces["foot"]
    count, places = len(foot.nodes), model.arms[foot.nodes] + model.center
    if ball.is_dome:
        # mean motion of the foot's plane and its slopes along x and y: least squares over its area
        plane = np.column_stack([np.ones(count), places[:, :2]])
        means = np.linalg.solve(plane.T @ (foot.areas[:, None] * plane), plane.T * foot.areas)
        centers = np.tile([0.0, 0.0, ball.radius], (3, 1))
        area = foot.areas.sum(keepdims=True)
        foot = dataclasses.replace(foot, nodes=np.arange(1), areas=area, outlines=np.ones(1, bool))
    else:
        half = np.array(half_sides(body))
        inset = 1 - ball.radius / (half if half[1] else half[0])
        means = np.eye(count)
        centers = np.column_stack([places[:, :2] * inset, np.full(count, ball.radius)])
        # what is flat ends where the edge begins to round
        foot = dataclasses.replace(foot, nodes=np.arange(count), region=foot.region * inset)
    others = {name: surface for name, surface in model.surfaces.items() if name != "foot"}
    kept = np.unique(
        np.concatenate([np.zeros(0, np.int64), *(surface.nodes for surface in others.values())])
    )
    rows = np.zeros((len(kept) + len(means), len(model.arms)))
    rows[np.arange(len(kept)), kept], rows[len(kept) :, model.surfaces["foot"].nodes] = 1.0, means
    surfaces = {
        name: dataclasses.replace(surface, nodes=np.searchsorted(kept, surface.nodes))
        for name, surface in others.items()
    }
    return dataclasses.replace(
        model,
        shapes=np.ascontiguousarray(np.einsum("ij,jam->iam", rows, model.shapes)),
        flexibility=np.einsum("ij,jkab,lk->ilab", rows, model.flexibility, rows, optimize=True),
        arms=np.concatenate([model.arms[kept], centers - model.center]),
        surfaces=surfaces | {"foot": dataclasses.replace(foot, nodes=foot.nodes + len(kept))},
    )


def edge_points(ball: Ball) -> NDArray[Any]:
    """Corners (n, 3) [m] of the edge of a dome from the centre of its sphere."""
    x, y = ball.edge
    if y:
        plane = np.array([[x, y], [-x, y], [-x, -y], [x, -y]])
    else:
        angles = 2 * np.pi * np.arange(ROUND_CORNERS) / ROUND_CORNERS
        plane = x * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.column_stack(
        [plane, np.full(len(plane), -math.sqrt(max(ball.radius**2 - x**2 - y**2, 0.0)))]
    )


def hertz(radius: float, load: float, *materials: Material) -> NDArray[Any]:
    """Compliance (3,) [m/N] across x, y and along z of a sphere pressed on a plane by `load` [N],
    linear about it.

    Hertz (1882): d = (9 F^2 / (16 E*^2 rho))^(1/3), 1 / E* = sum (1 - nu^2) / E, and dd/dF; Mindlin
    (1949) across: (2 - nu) / (2 (1 - nu)) of that.

    Parameters
    ----------
    materials
        of the bodies that give, the sphere's first.
    """
    modulus = 1 / sum((1 - one.poissons_ratio**2) / one.youngs_modulus_pa for one in materials)
    along = 2 / 3 * (9 / (16 * modulus**2 * radius * load)) ** (1 / 3)
    ratio = materials[0].poissons_ratio
    compliance: NDArray[Any] = along * np.array([(2 - ratio) / (2 * (1 - ratio))] * 2 + [1.0])
    return compliance
