"""Bodies that stand on one another, as the compiled engine takes them: from the plain numbers of a
`structures.model.StructureModel`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.bodies import Bodies, fewest_columns, joined, node_matrix, one_body
from fecolumn.contact.interface import INTERFACE
from fecolumn.contact.joints import joints_of
from fecolumn.contact.overturning import Limits, cap_only_stance
from fecolumn.contact.points import GROUND, POINT
from fecolumn.contact.pose import SLAVE, grounds_at, poses_of
from fecolumn.contact.tolerances import FOUND_ROWS, MOBILITY_LEFT, RIGID_GIVE
from fecolumn.engines.dynamics.bonds import bonded
from fecolumn.engines.dynamics.links_of_model import links_of
from fecolumn.engines.reduced.found_of_model import found_interfaces, found_of, found_points
from fecolumn.engines.reduced.model import Structure, modal_sum
from fecolumn.engines.reduced.observe import MARK, View
from fecolumn.foundation.arrays import Array
from fecolumn.structures.face_motion import face_operators

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.hht import HHT
    from fecolumn.structures.model import BodyModel, StructureModel


def structure_of(
    model: StructureModel,
    hht: HHT,
    gravity: Array,
    parts_of_step: int = 1,
    meetings: int | None = None,
) -> tuple[Structure, Array]:
    """Structure as steps of `hht` see it, and its points (P,) of POINT.

    Parameters
    ----------
    model
        StructureModel, each part with the modes that are to move.
    parts_of_step
        in one of so many points land: what bodies that do not deform give in it is by its length.
    meetings
        pairs of bodies for which there is room where contact is found, FOUND_ROWS a body unless
        given.

    Raises
    ------
    StiffLink
        a link is too stiff for the step.
    """
    parts, modes = model.parts, max(len(part.model.frequencies) for part in model.parts)
    squares, damping, filters = np.zeros((3, len(parts), modes))
    pushes, factors, bodies = [], [], []
    for b, part in enumerate(parts):
        body, m = part.model, len(part.model.frequencies)
        squares[b, :m], ratio = (
            body.frequencies**2,
            part.damping_ratio if body.damping is None else body.damping,
        )
        damping[b, :m] = 2 * ratio * body.frequencies
        shrink = 1 / (1 + squares[b, :m] * hht.stiffness_factor / hht.mass_factor)
        own = body.shapes * (2 * shrink - shrink**2)
        deforms = body.flexibility.any()
        static = node_matrix(body.flexibility)
        if deforms:
            static -= modal_sum(own, 1 / squares[b, :m])
        inertia = (0.0,) if part.held >= 0 else (float(body.mass), body.inertia)
        one = one_body(body.arms, static, modal_sum(own, np.ones(m)), *inertia)
        one.body["held"], one.body["airborne"] = part.held, part.airborne
        if not deforms:
            one.body["stiff"] = m == 0
            one.body["gives"] = _least_give(body, hht.dt / parts_of_step, part.held)
        bodies.append(one)
        pushes.append(own)
        factors.append(fewest_columns(own, MOBILITY_LEFT))
        filters[b, :m] = 2 * shrink - shrink**2
    whole, first = joined(bodies), np.cumsum([0] + [len(part.model.arms) for part in parts])
    reach = np.concatenate(
        [
            np.sqrt(
                (own[..., : len(part.model.frequencies)] ** 2 / part.model.frequencies**2).sum(
                    axis=(1, 2)
                )
            )
            for own, part in zip(pushes, parts)
        ]
    )
    joints = joints_of(parts, model.joints, model.replaced)
    for interface, joint in zip(joints.interfaces, model.joints):
        if joint.master != GROUND:
            surface = parts[joint.master].model.surfaces[str(joint.master_surface)]
            interface["reach"] = reach[first[joint.master] + surface.nodes].max()
    rows = meetings if meetings is not None else FOUND_ROWS * len(parts) if model.found else 0
    interfaces, points = joints.interfaces, joints.points
    found = found_of(model, first, reach, len(interfaces), len(points), rows)
    if rows:
        more = found_interfaces(found, rows), found_points(found, rows)
        interfaces = np.concatenate([interfaces, more[0]]).astype(INTERFACE)
        points = np.concatenate([points, more[1]]).astype(POINT)
    structure = Structure(
        Bodies(*whole[:4], joints.facets, _one_width(pushes), _one_width(factors)),
        squares,
        damping,
        reach,
        interfaces,
        joints.rim,
        joints.overlaps,
        *links_of(model, hht, filters),
        np.array(gravity, float),
        found,
    )
    return structure, points


def _one_width(columns: list[Array]) -> Array:
    """Columns (n, 3, m) of each body, one after the other, with zeros where others have more."""
    width = max(own.shape[2] for own in columns)
    return np.concatenate(
        [np.pad(own, ((0, 0), (0, 0), (0, width - own.shape[2]))) for own in columns]
    )


def _least_give(body: BodyModel, dt: float, held: int) -> float:
    """What each contact point of a BodyModel that does not deform gives alone in steps dt [s], in
    m/N: RIGID_GIVE of what the body's points move on the mean; none of a fixed one, `held` by a
    ground.
    """
    if held >= 0:
        return 0.0
    touching = np.unique(
        np.concatenate(
            [np.zeros(0, np.int64), *(surface.nodes for surface in body.surfaces.values())]
        )
    )
    turning = np.linalg.inv(body.inertia)
    # trace of 1 / m + [a] J^-1 [a]^T
    turned = [np.trace(turning) * (arm @ arm) - arm @ turning @ arm for arm in body.arms[touching]]
    moved = 1 / body.mass + np.sum(turned) / (3 * max(len(touching), 1))
    return float(RIGID_GIVE * dt**2 / 2 * moved)


def view_of(
    model: StructureModel, structure: Structure, weight: float, limits: Limits, cap: float = 0.0
) -> View:
    """What is watched of a StructureModel.

    Parameters
    ----------
    weight
        of all bodies [N].
    cap
        horizontal displacement of the observed mark that counts as overturned [m], 0 for none.
    limits
        when a body is lost.
    """
    centers, rotations = (
        np.array([part.center for part in model.parts]),
        np.tile(np.eye(3), (len(model.parts), 1, 1)),
    )
    modes, (body, name) = structure.squares.shape[1], model.observed
    names = [(b, mark) for b, part in enumerate(model.parts) for mark in part.model.marks]
    marks, shapes = np.zeros(len(names), MARK), np.zeros((len(names), 3, modes))
    for n, (b, mark) in enumerate(names):
        arm, shape = model.parts[b].model.marks[mark]
        marks[n]["body"], marks[n]["arm"], shapes[n, :, : shape.shape[1]] = b, arm, shape
    place = names.index((body, name))
    feet = [joint for joint in model.joints if joint.slave == body]
    foot, foot_shape = np.zeros(3), np.zeros((3, modes))
    if feet:
        own = model.parts[body].model
        surface = own.surfaces[feet[0].slave_surface]
        share = surface.areas / surface.areas.sum()
        foot = share @ own.arms[surface.nodes]
        foot_shape[:, : own.shapes.shape[2]] = np.einsum(
            "i,iam->am", share, own.shapes[surface.nodes]
        )
        if feet[0].ball:
            foot += feet[0].ball.radius * surface.normal
    interfaces = structure.interfaces[: len(model.joints)]
    reference = poses_of(interfaces, centers, rotations, grounds_at(model.levels))
    stance = cap_only_stance(model.parts[body].model.inertia, weight, cap)
    return View(
        centers,
        body,
        np.array(marks[place]["arm"]),
        np.ascontiguousarray(shapes[place]),
        foot,
        foot_shape,
        stance,
        limits.tilts,
        limits.standing,
        limits.corners,
        np.array(reference["foot"]),
        np.array(reference["turned"][:, SLAVE, 2]),
        marks,
        shapes,
        len(model.links),
        np.array(model.levels, float),
        np.array([part.held for part in model.parts]),
        np.array([joint.bond.areas.sum() for joint in bonded(model)]),
        # what is told of a joint's other side is that of the joint
        np.array(
            [
                (GROUND, GROUND) if one.pair >= 0 else (one.slave, one.master)
                for one in model.joints
            ],
            np.int64,
        ).reshape(-1, 2),
        *_faces_of(model, structure),
    )


def _faces_of(model: StructureModel, structure: Structure) -> tuple[Array, Array]:
    """`face_operators` of the joints, of no columns where no body has modes."""
    bodies = structure.bodies
    if not bodies.pushes.shape[2]:
        none = np.zeros((len(model.joints), 2, 6, 0))
        return none, none
    first = np.append(bodies.body["first"], len(bodies.arms))
    return face_operators(model, first, bodies.pushes, bodies.static)
