"""How the two faces of a joint move and turn with the deformation of their bodies.

The frame of a body that deforms moves with its mean motion, and turns where the body sways on a
foot that stays. What a joint slides, rises and tilts by is that of its faces.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fecolumn.contact.points import GROUND
from fecolumn.structures.model import BodyModel, JointModel, StructureModel


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
    its contact nodes [m/N, rad/N]; 0 of a ground.

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
            if one is not None:
                rows = first[one.body] + one.nodes
                moves[place, side] = np.einsum("ska,kam->sm", one.fit, shapes[rows])
                gives[place, side] = np.einsum("ska,kan->sn", one.fit, lines[rows])
    return moves, gives


def _of_slave(structure: StructureModel, joint: JointModel) -> FaceFit:
    model = structure.parts[joint.slave].model
    surface = model.surfaces[joint.slave_surface]
    return _fit(joint.slave, model, surface.nodes, surface.areas)


def _of_master(structure: StructureModel, joint: JointModel) -> FaceFit | None:
    """Of the master's nodes nearest to those of the slave, each with the slave's area."""
    if joint.master == GROUND:
        return None
    assert joint.master_surface is not None  # the ground alone has none
    slave, master = structure.parts[joint.slave], structure.parts[joint.master]
    own, other = (
        slave.model.surfaces[joint.slave_surface],
        master.model.surfaces[joint.master_surface],
    )
    arms = slave.model.arms[own.nodes]
    places = slave.center + arms @ slave.rotation.T - master.center
    near = cKDTree(master.model.arms[other.nodes]).query(places @ master.rotation)[1]
    nodes, row = np.unique(other.nodes[near], return_inverse=True)
    return _fit(joint.master, master.model, nodes, np.bincount(row, own.areas, len(nodes)))


def _fit(body: int, model: BodyModel, nodes: NDArray[Any], areas: NDArray[Any]) -> FaceFit:
    weights = areas / areas.sum() if areas.sum() > 0 else np.full(len(nodes), 1 / len(nodes))
    arms = model.arms[nodes] - weights @ model.arms[nodes]
    inertia = np.einsum("k,ka,kb->ab", weights, arms, arms)
    inertia = np.trace(inertia) * np.eye(3) - inertia
    # cross product of an arm and a displacement, as a matrix of the displacement
    crosses = np.cross(np.eye(3)[None], arms[:, None]).transpose(0, 2, 1)
    turn = np.einsum("ab,k,kbc->akc", np.linalg.pinv(inertia, 1e-9, True), weights, -crosses)
    mean = np.einsum("k,ac->akc", weights, np.eye(3))
    return FaceFit(body, nodes, np.concatenate([mean, turn]))
