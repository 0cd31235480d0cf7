"""Limit analysis of dry-jointed walls of rigid blocks by linear programming: the load multiplier
that begins to move them, and how.

Blocks (weights down, `multiplier` times weights sideways) touch along straight joints. A joint
carries a compression n_1, n_2 >= 0 at either end and a shear |s| <= mu (n_1 + n_2). The largest
multiplier in equilibrium is a linear programme (Livesley 1978), solved by HiGHS; the duals of
equilibrium are the velocities of its mechanism.

Normality makes a joint that slides dilate by mu: so the multiplier is an upper bound. Coulomb
friction does not dilate. Then a multiplier must have forces and a mechanism that go together
(sliding only where s = mu n, opening only where n = 0), and there may be many such; Gilbert,
Casapulla and Ahmed (2006) find one by a series of linear programmes: |s| <= mu n' + slope (n - n'),
n' from the programme before, slope -> 0, until what holds at n' holds at n.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linprog
from scipy.sparse import coo_matrix, vstack

from fecolumn.foundation.arrays import Array

#: Two faces touch where they are this close, over the smallest side of a block [-]
_CLOSE = 1e-6


@dataclass(frozen=True, slots=True)
class StraightJoint:
    """Straight contact between two blocks.

    Attributes
    ----------
    first, second
        blocks, -1 for the ground; the first is pressed by the normal.
    ends
        (2, 2) its end points [m].
    normal
        (2,) unit vector from the second block into the first.
    """

    first: int
    second: int
    ends: Array
    normal: Array


@dataclass(frozen=True, slots=True)
class Collapse:
    """What a limit analysis finds.

    Attributes
    ----------
    multiplier
        of the horizontal loads.
    normal
        (joints, 2) compression at the ends [N]
    shear
        (joints,) on the first block along the normal turned by a right angle to the left [N].
    velocity
        (blocks, 3) of the mechanism: x, y of the centre and counter-clockwise turn, such that the
        loads' power is 1.
    residual
        largest |s| - mu n over all joints, over the total weight; above 0 the forces are not those
        of the friction asked for.
    iterations
        linear programmes solved.
    """

    multiplier: float
    normal: Array
    shear: Array
    velocity: Array
    residual: float
    iterations: int


@dataclass(frozen=True, slots=True)
class Wall:
    """Rectangular blocks in their places.

    Attributes
    ----------
    boxes
        (blocks, 4) left, bottom, right, top [m].
    weights
        (blocks,) [N].
    joints
        between blocks, and to the ground.
    loads
        (blocks,) horizontal loads at the centres [N] for a multiplier of 1; towards +x positive.
    """

    boxes: Array
    weights: Array
    joints: tuple[StraightJoint, ...]
    loads: Array

    @property
    def centres(self) -> Array:
        """(blocks, 2) [m]."""
        middles: Array = (self.boxes[:, :2] + self.boxes[:, 2:]) / 2
        return middles


def wall_of_boxes(boxes: ArrayLike, unit_weight: float, depth: float = 1.0) -> Wall:
    """Wall of rectangles, those at the lowest level standing on rough ground; loads are the
    weights, towards +x.

    Parameters
    ----------
    boxes
        (blocks, 4) left, bottom, right, top [m]; they must not overlap.
    unit_weight
        [N/m3].
    depth
        [m].
    """
    boxes = np.asarray(boxes, float)
    near = _CLOSE * (boxes[:, 2:] - boxes[:, :2]).min()
    joints, ground = [], boxes[:, 1].min()
    for i, (left, bottom, right, top) in enumerate(boxes):
        if bottom < ground + near:
            joints.append(
                StraightJoint(
                    i, -1, np.array([[left, bottom], [right, bottom]]), np.array([0.0, 1.0])
                )
            )
        for j, (x0, y0, x1, y1) in enumerate(boxes):
            if abs(bottom - y1) < near and min(right, x1) - max(left, x0) > near:
                joints.append(
                    StraightJoint(
                        i,
                        j,
                        np.array([[max(left, x0), bottom], [min(right, x1), bottom]]),
                        np.array([0.0, 1.0]),
                    )
                )
            if abs(left - x1) < near and min(top, y1) - max(bottom, y0) > near:
                joints.append(
                    StraightJoint(
                        i,
                        j,
                        np.array([[left, max(bottom, y0)], [left, min(top, y1)]]),
                        np.array([1.0, 0.0]),
                    )
                )
    weights = unit_weight * depth * np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)
    return Wall(boxes, weights, tuple(joints), weights.copy())


def running_bond(
    blocks: int, courses: int, length: float, height: float, unit_weight: float = 1e4
) -> Wall:
    """Wall of `blocks` blocks a course in running bond, the lowest course beginning and ending with
    a half block.

    Parameters
    ----------
    length, height
        of a block [m].
    unit_weight
        [N/m3].
    """
    boxes = []
    for course in range(courses):
        cuts = np.arange(blocks + 1) * length
        if course % 2 == 0:
            cuts = np.concatenate([[0.0], cuts[:-1] + length / 2, cuts[-1:]])
        boxes += [
            (x0, course * height, x1, (course + 1) * height) for x0, x1 in zip(cuts[:-1], cuts[1:])
        ]
    return wall_of_boxes(boxes, unit_weight)


def associated(wall: Wall, friction: float) -> Collapse:
    """Largest multiplier with sliding that dilates by the friction coefficient: an upper bound of
    Coulomb friction's.

    Raises
    ------
    ValueError
        the wall does not stand under its weight, or no multiplier makes it move.
    """
    slope, kept = np.full(len(wall.joints), friction), np.zeros(len(wall.joints))
    multiplier, normal, shear, velocity = _programme(wall, slope, kept)
    return Collapse(
        multiplier, normal, shear, velocity, _residual(wall, normal, shear, friction), 1
    )


def non_associated(
    wall: Wall,
    friction: float,
    *,
    starts: int = 1,
    seed: int = 0,
    dilatancy: float = 1e-4,
    tolerance: float = 1e-6,
    most: int = 200,
) -> Collapse:
    """Multiplier with sliding that does not dilate, by a series of linear programmes after Gilbert,
    Casapulla and Ahmed (2006).

    Of the forces that a programme leaves open those nearest to the last ones are taken: so the
    series ends where the forces repeat themselves. Other starts may end at other multipliers, all
    of them possible; the least one found is returned.

    Parameters
    ----------
    friction
        Coulomb coefficient.
    starts
        the associated solution's forces first, then random ones of `seed`.
    dilatancy
        last slope of the sliding surfaces, nearly 0: with 0 a mechanism could slide without work.
    tolerance
        of the forces beyond Coulomb's cone, over the total weight.
    most
        linear programmes of a start.

    Raises
    ------
    ValueError
        as `associated`; or no start converged.
    """
    first, rng, found = associated(wall, friction), np.random.default_rng(seed), []
    for start in range(starts):
        normal = first.normal.sum(axis=1)
        if start:
            normal = (
                wall.weights.mean()
                * rng.exponential(3.0, len(normal))
                * rng.integers(0, 2, len(normal))
            )
        slope = friction
        for iteration in range(2, most + 1):
            slope = max(0.7 * slope, dilatancy)
            multiplier, ends, shear, velocity = _programme(
                wall, np.full(len(normal), slope), (friction - slope) * normal, normal
            )
            residual = _residual(wall, ends, shear, friction)
            if slope == dilatancy and residual < tolerance:
                found.append(Collapse(multiplier, ends, shear, velocity, residual, iteration))
                break
            normal = 0.4 * normal + 0.6 * ends.sum(axis=1)
    if not found:
        raise ValueError(
            f"limit analysis has not converged in {most} linear programmes: multiplier "
            f"{multiplier:.6g}, forces {residual:.1e} of the weight beyond friction"
        )
    return min(found, key=lambda one: one.multiplier)


def _residual(wall: Wall, normal: Array, shear: Array, friction: float) -> float:
    return float((np.abs(shear) - friction * normal.sum(axis=1)).max() / wall.weights.sum())


def _programme(
    wall: Wall, slope: Array, kept: Array, near: Array | None = None
) -> tuple[float, Array, Array, Array]:
    """Multiplier, forces and mechanism for |s| <= kept + slope (n_1 + n_2) at each joint; of many
    forces those nearest to compressions `near`.
    """
    joints, blocks = len(wall.joints), len(wall.boxes)
    centres = wall.centres
    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []

    def act(block: int, column: int, force: Array, at: Array) -> None:
        if block >= 0:
            arm = at - centres[block]
            rows.extend((3 * block, 3 * block + 1, 3 * block + 2))
            columns.extend((column,) * 3)
            values.extend((force[0], force[1], arm[0] * force[1] - arm[1] * force[0]))

    for number, joint in enumerate(wall.joints):
        along = np.array([-joint.normal[1], joint.normal[0]])
        for place, force, at in (
            (0, joint.normal, joint.ends[0]),
            (1, joint.normal, joint.ends[1]),
            (2, along, joint.ends[0]),
        ):
            act(joint.first, 3 * number + place, force, at)
            act(joint.second, 3 * number + place, -force, at)
    scale = wall.weights.sum()
    for block, load in enumerate(wall.loads):
        rows.append(3 * block)
        columns.append(3 * joints)
        values.append(load / scale)
    size = 3 * joints + 1 + joints  # forces, multiplier, distances from `near`
    equal = coo_matrix((values, (rows, columns)), shape=(3 * blocks, size)).tocsr()
    right = np.zeros(3 * blocks)
    right[1::3] = wall.weights / scale
    every, ones = np.arange(joints), np.ones(joints)
    first, second, shear, distance = 3 * every, 3 * every + 1, 3 * every + 2, 3 * joints + 1 + every

    def limit(*terms: tuple[NDArray[Any], NDArray[Any]]) -> coo_matrix:
        """Rows of sum of (coefficients, columns)."""
        return coo_matrix(
            (
                np.concatenate([coefficients for coefficients, _ in terms]),
                (np.tile(every, len(terms)), np.concatenate([at for _, at in terms])),
            ),
            shape=(joints, size),
        )

    limits = vstack(
        [
            limit((ones, shear), (-slope, first), (-slope, second)),
            limit((-ones, shear), (-slope, first), (-slope, second)),
            limit((ones, first), (ones, second), (-ones, distance)),
            limit((-ones, first), (-ones, second), (-ones, distance)),
        ]
    ).tocsr()
    near = np.zeros(joints) if near is None else near
    most = np.concatenate([kept, kept, near, -near]) / scale
    free, positive = (None, None), (0.0, None)
    bounds: list[tuple[float | None, float | None]] = [
        *[positive, positive, free] * joints,
        free,
        *[positive] * joints,
    ]
    cost = np.zeros(size)
    cost[3 * joints] = -1
    found = linprog(
        cost, limits[: 2 * joints], most[: 2 * joints], equal, right, bounds, method="highs"
    )
    if found.status == 3:
        raise ValueError("no multiplier makes the wall move: it is held by its joints")
    if found.status != 0:
        raise ValueError(
            "the wall does not stand under its own weight, or the linear programme "
            f"failed ({found.message})"
        )
    multiplier, velocity = (
        float(found.x[3 * joints]),
        found.eqlin.marginals.reshape(blocks, 3) / scale,
    )
    if near.any():
        bounds[3 * joints] = (multiplier - 1e-9, None)
        cost[:] = 0
        cost[3 * joints + 1 :] = 1
        nearest = linprog(cost, limits, most, equal, right, bounds, method="highs")
        found = nearest if nearest.status == 0 else found
    forces = scale * found.x[: 3 * joints].reshape(joints, 3)
    power = float(velocity[:, 0] @ wall.loads)
    return multiplier, forces[:, :2], forces[:, 2], velocity / power if power else velocity
