"""How the two faces of a joint move and turn with the deformation of their bodies.

The frame of a body that deforms moves with its mean motion, and turns where the body sways on a
foot that stays. What a joint slides, rises and tilts by is that of its faces.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import MASTER, SLAVE
from fecolumn.fem.rotation import vector_product
from fecolumn.structures.model import JointModel, StructureModel, Surface


class FaceFit(NamedTuple):
    """Mean displacement and turn of a face.

    body: place of the part. nodes: (k,) rows among its model's nodes. fit: (6, k, 3) that takes
    displacements (k, 3) [m] of these in the body's frame to their mean (3,) [m] and the turn (3,)
    [rad] nearest to them, by least squares of weighted nodes.
    """

    body: int
    nodes: NDArray[Any]
    fit: NDArray[Any]


def face_fits(structure: StructureModel) -> list[tuple[FaceFit, FaceFit | None]]:
    """Of each joint that of the slave's face and that of the master's where the slave begins on
    it, None on the ground.
    """
    return [(_of_slave(structure, one), _of_master(structure, one)) for one in structure.joints]


def face_operators(
    structure: StructureModel, first: NDArray[Any], shapes: NDArray[Any], static: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Mean displacement [m] and turn [rad] of the faces of slave and master of each joint, in the
    frames of their bodies: (ni, 2, 6, m) in the modes of the body, (ni, 2, 6, 3 n) by forces on
    its contact nodes [m/N, rad/N]; 0 of a ground, and of bodies without modes.

    Parameters
    ----------
    first
        (nb + 1,) row of each body's first contact node, and the number of all, N.
    shapes
        (N, 3, m) of the modes at the nodes.
    static
        (3 N, 3 n) [m/N] displacements of nodes by forces on those of their body.
    """
    sizes = len(structure.joints), 2, 6
    moves, gives = np.zeros((*sizes, shapes.shape[2])), np.zeros((*sizes, static.shape[1]))
    lines = static.reshape(len(shapes), 3, -1)
    for place, fits in enumerate(face_fits(structure)):
        for side, one in enumerate(fits):
            # of a body without modes, springs of its contact are no part of it
            if one is not None and len(structure.parts[one.body].model.frequencies):
                rows = first[one.body] + one.nodes
                moves[place, side] = np.einsum("ska,kam->sm", one.fit, shapes[rows])
                gives[place, side] = np.einsum("ska,kan->sn", one.fit, lines[rows])
    return moves, gives


class FaceMotion:
    """Tilt and motion of joints from poses and deformation of their bodies.

    Parameters
    ----------
    structure
        whose joints they are.
    reference
        (ni,) of POSE of the joints where they have moved by nothing.
    rows
        of each body among the nodes of contact.
    """

    def __init__(
        self, structure: StructureModel, reference: NDArray[Any], rows: list[slice]
    ) -> None:
        self._feet, self._normals = reference["foot"], reference["turned"][:, SLAVE, 2]
        self._fits = [
            (joint, side, rows[one.body].start + one.nodes, one.fit.reshape(6, -1))
            for joint, fits in enumerate(face_fits(structure))
            for side, one in zip((SLAVE, MASTER), fits)
            if one is not None
        ]

    def moved(self, poses: NDArray[Any], deformed: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        """Angles (ni,) [rad] between the faces of the joints, and what the slaves' have moved by
        over the masters' (ni, 3) [m] along and across these: of poses (ni,) and the displacements
        (N, 3) [m] of all nodes of contact from the rigid motion of their bodies, in the frames of
        these.
        """
        shift, turn = np.zeros((2, len(poses), 2, 3))
        for joint, side, nodes, fit in self._fits:
            motion = fit @ deformed[nodes].ravel()
            shift[joint, side], turn[joint, side] = motion[:3], motion[3:]
        turned = poses["turned"]
        shift = np.einsum("jsab,jsb->jsa", turned, shift)
        own = np.stack([self._normals, turned[:, MASTER, 2]], axis=1)
        normals = np.einsum("jsab,jsb->jsa", turned, own + vector_product(turn, own))
        first, second = normals[:, SLAVE], normals[:, MASTER]
        across = np.linalg.norm(vector_product(first, second), axis=1)
        tilts = np.arctan2(across, np.einsum("ja,ja->j", first, second))
        return tilts, poses["foot"] - self._feet + shift[:, SLAVE] - shift[:, MASTER]


def _of_slave(structure: StructureModel, joint: JointModel) -> FaceFit:
    model = structure.parts[joint.slave].model
    surface = model.surfaces[joint.slave_surface]
    return FaceFit(joint.slave, surface.nodes, _fit(model.arms[surface.nodes], surface.areas))


def _of_master(structure: StructureModel, joint: JointModel) -> FaceFit | None:
    """Of the places on the master that lie at the slave's nodes, each with the slave's area."""
    if joint.master == GROUND:
        return None
    assert joint.master_surface is not None  # the ground alone has none
    slave, master = structure.parts[joint.slave], structure.parts[joint.master]
    own, other = (
        slave.model.surfaces[joint.slave_surface],
        master.model.surfaces[joint.master_surface],
    )
    arms = slave.model.arms[own.nodes] @ slave.rotation.T + slave.center - master.center
    shares = _shares(other, master.model.arms, arms @ master.rotation)
    carries = shares.any(axis=0)
    shares, nodes = shares[:, carries], other.nodes[carries]
    fit = _fit(shares @ master.model.arms[nodes], own.areas)
    return FaceFit(joint.master, nodes, np.einsum("ska,kn->sna", fit, shares))


def _shares(surface: Surface, arms: NDArray[Any], places: NDArray[Any]) -> NDArray[Any]:
    """Shares (k, n) of the surface's nodes in its displacement at places (k, 3) [m]: linear in the
    triangle that holds the place, or is nearest to it; arms: of the model's nodes.
    """
    corners = surface.plane(arms[surface.nodes])[surface.triangles, :2]
    start, sides = corners[:, 0], corners[:, 1:] - corners[:, :1]
    offset = surface.plane(places)[:, None, :2] - start
    two = np.einsum("kta,tab->ktb", offset, np.linalg.inv(sides))
    parts = np.concatenate([1 - two.sum(axis=2, keepdims=True), two], axis=2)
    held = parts.min(axis=2).argmax(axis=1)
    rows = np.arange(len(places))
    parts = np.clip(parts[rows, held], 0.0, 1.0)
    shares = np.zeros((len(places), len(surface.nodes)))
    corner_nodes = surface.triangles[held]
    np.add.at(shares, (rows[:, None], corner_nodes), parts / parts.sum(axis=1, keepdims=True))
    return shares


def _fit(arms: NDArray[Any], areas: NDArray[Any]) -> NDArray[Any]:
    """`FaceFit.fit` of points with arms (k, 3) [m] and areas (k,) [m2]."""
    weights = areas / areas.sum() if areas.sum() > 0 else np.full(len(arms), 1 / len(arms))
    arms = arms - weights @ arms
    inertia = np.einsum("k,ka,kb->ab", weights, arms, arms)
    inertia = np.trace(inertia) * np.eye(3) - inertia
    # cross product of an arm and a displacement, as a matrix of the displacement
    crosses = np.cross(np.eye(3)[None], arms[:, None]).transpose(0, 2, 1)
    turn = np.einsum("ab,k,kbc->akc", np.linalg.pinv(inertia, 1e-9, True), weights, -crosses)
    mean = np.einsum("k,ac->akc", weights, np.eye(3))
    return np.concatenate([mean, turn])
