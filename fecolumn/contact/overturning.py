"""The point of no return: when a column can no longer come back, whatever the rest of the motion
does.

A rigid body leans so far that its centre of mass stands beyond the edge of its foot, by x in the
horizontal, at the height z above that edge. The base can push its edge up with N and sideways with
T. About the centre of mass, the moment that tilts it further is

    N x - T z >= 0    for    T / N <= x / z = tan(overhang).

T / N is bounded in two ways:

- by friction: T <= mu N, whether the edge sticks, slides, flies or lands;
- where the edge sticks the body turns about it, I tilt'' = m ((g + v) x - a z) under a ground
  acceleration a towards the lean and v upwards, so that T / N stays below x / z as long as a /
  (g + v), the inclination of apparent gravity, does. Of the motion only what is still to come
  matters; a recording that is interpolated between its samples is steepest at one of them.

A tilt that grows while tan(overhang) exceeds the smaller bound therefore grows for ever: tilt'' >=
0 from then on, and the overhang grows with the tilt. After the motion's end the bound of a sticking
edge is 0: the column is lost once it leans beyond its critical tilt and still moves outwards. If an
edge that stuck slides later, T / N has met mu, and x / z is above it.

What is exact and what is not. For a rigid body that tilts in a plane the rule is exact: what it
calls overturned never comes back. It may call it late, as it takes the steepest moment to come for
all moments to come. In three dimensions the overhang is measured in the direction of the lean from
every corner of the foot's convex hull, wherever the body may touch next. The gyroscopic moment is
counted at its present value where it holds the body up, and a body that spins about its own axis so
fast that it may stand as a top, L^2 > I m g h, is judged only when it lies. That a wobbling body's
lean turns while it falls, that the edge of an elastic foot gives a little (inwards, which makes it
fall sooner), and that a column bends, is left out. A body whose axis is horizontal has overturned
in any case.

Source: the equation of rocking is Housner's (1963), Bull. Seism. Soc. Am. 53(2), with vertical
motion as in Makris and Kampas (2016).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from fecolumn.contact.points import GROUND
from fecolumn.contact.record import record
from fecolumn.contact.rim import Rim
from fecolumn.contact.tolerances import ROUND_CORNERS, STICKS
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Answers of `fallen`, and what one of many bodies is that is below the ground, on which it has no
# face to stand
STANDS, NO_RETURN, CAPPED, FELL = range(4)


#: How one of many bodies stands. below: body that it stands on, GROUND of the ground. first, count:
#: corners of its Stance among those of all; depth, critical, weight, friction, inertia: as of it,
#: critical inf of a body without a point of no return. ground: whether the ground's motion alone
#: moves what it stands on and what it carries, so that what is to come of it bounds how a sticking
#: edge is pushed.
STANDING = record(
    ("below", "i8"),
    ("first", "i8"),
    ("count", "i8"),
    ("depth", "f8"),
    ("critical", "f8"),
    ("weight", "f8"),
    ("friction", "f8"),
    ("inertia", "f8", (3, 3)),
    ("ground", "?"),
)


class Stance(NamedTuple):
    """How a column stands: what its overturning depends on.

    corners: (k, 2) of the foot's convex hull, counterclockwise, from the centre of mass in the
    column's frame [m]; depth: height of the centre of mass above the foot [m]; critical: least
    tilt, of all directions, at which the centre of mass stands over the foot's edge [rad], negative
    where it never stands over the foot; inertia: (3, 3) [kg m2]; weight [N]; friction: coefficient;
    cap: top displacement that counts as overturned [m], inf for none.
    """

    corners: Array
    depth: float
    critical: float
    inertia: Array
    weight: float
    friction: float
    cap: float


#: Tilt [rad] at which a body is lost of which links, or bodies beside it, decide whether it
#: returns: far beyond what any that still stands reaches.
FAR = np.pi / 4


class Limits(NamedTuple):
    """When bodies of a structure are lost. tilts: (nb,) [rad] beyond which each is in any case, inf
    of one with a point of no return; standing: (nb,) of STANDING; corners: (k, 2) [m] of them.
    """

    tilts: Array
    standing: Array
    corners: Array

    @classmethod
    def of_tilt(cls, bodies: int, tilt: float = FAR) -> Limits:
        """Of so many bodies that are all lost at a tilt [rad]."""
        standing = np.zeros(bodies, STANDING)
        standing["critical"] = np.inf
        return cls(np.full(bodies, float(tilt)), standing, np.zeros((0, 2)))


def stance(arms: Array, inertia: Array, weight: float, friction: float, cap: float) -> Stance:
    """Stance of a column whose foot's nodes are at `arms` (n, 3) [m] from its centre of mass;
    further arguments as of Stance, cap 0 for none.
    """
    plane = np.asarray(arms, float)[:, :2]
    if rim := Rim.find(arms):
        angles = 2 * np.pi * np.arange(ROUND_CORNERS) / ROUND_CORNERS
        plane = plane.mean(axis=0) + rim.radius * np.column_stack([np.cos(angles), np.sin(angles)])
    corners = plane[ConvexHull(plane).vertices]
    depth = float(-np.mean(np.asarray(arms)[:, 2]))
    return Stance(
        np.ascontiguousarray(corners),
        depth,
        float(np.arctan2(weakest(corners)[0], depth)),
        np.ascontiguousarray(inertia, float),
        float(weight),
        float(friction),
        float(cap) if cap > 0 else np.inf,
    )


def cap_only_stance(inertia: Array, weight: float, cap: float) -> Stance:
    """Stance of one of many bodies: it is lost by its cap alone; further arguments as of Stance,
    cap 0 for none.
    """
    return Stance(
        np.zeros((1, 2)),
        1.0,
        np.inf,
        np.ascontiguousarray(inertia, float),
        float(weight),
        0.0,
        float(cap) if cap > 0 else np.inf,
    )


def weakest(corners: Array) -> tuple[float, Array]:
    """Distance [m] of the nearest edge from the centre of mass, and its outward normal (2,)."""
    edges = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    distances = np.einsum("ka,ka->k", normals, corners)
    nearest = int(np.argmin(distances))
    return float(distances[nearest]), normals[nearest]


def barrier(stance: Stance) -> float:
    """Energy [J] that lifts the column from upright onto its nearest edge: what it takes to
    overturn it slowly, 0 if it cannot stand.
    """
    distance = weakest(stance.corners)[0]
    return (
        stance.weight * (np.hypot(distance, stance.depth) - stance.depth) if distance > 0 else 0.0
    )


def critical_displacement(stance: Stance, top_arm: Array) -> float:
    """Horizontal displacement [m] of a point at `top_arm` (3,) from the centre of mass when the
    rigid column leans by its critical tilt.
    """
    distance, normal = weakest(stance.corners)
    across, up = top_arm[:2] @ normal - distance, top_arm[2] + stance.depth
    return float(across * (np.cos(stance.critical) - 1) + up * np.sin(stance.critical))


def critical_tilt_along(stance: Stance, rotation: Array) -> float:
    """Tilt [rad] at which the centre of mass stands over the foot's farthest corner in the
    direction in which the column leans now.
    """
    lean = rotation[:2, 2]
    length = np.hypot(*lean)
    if length == 0.0:
        return stance.critical
    ahead = (rotation.T @ [*(lean / length), 0.0])[:2]
    return float(np.arctan2((stance.corners @ (ahead / np.linalg.norm(ahead))).max(), stance.depth))


def steepest_to_come(gravity: Array, grounds: Array) -> Array:
    """Largest tangent (n,) of the inclination of apparent gravity from each moment on; inf where it
    points upwards.

    Parameters
    ----------
    gravity
        (3,) [m/s2].
    grounds
        (n, 3) ground accelerations [m/s2] at the ends of the steps to come.
    """
    apparent = np.asarray(gravity, float) - np.asarray(grounds, float)
    level, down = np.hypot(apparent[:, 0], apparent[:, 1]), -apparent[:, 2]
    tangent = np.divide(level, down, out=np.full(len(apparent), np.inf), where=down > 0)
    return np.ascontiguousarray(np.maximum.accumulate(tangent[::-1])[::-1])


@njit
def fallen(
    stance: Stance, rotation: Array, spin: Array, force: Array, top: float, steepest: float
) -> int:
    """Whether the column is lost: STANDS, NO_RETURN or CAPPED.

    Parameters
    ----------
    stance
        Stance.
    rotation
        (3, 3) column to table.
    spin
        (3,) angular velocity in the column's frame [rad/s].
    force
        (3,) of the base on the column [N].
    top
        horizontal displacement of the top [m].
    steepest
        tangent of the steepest inclination of apparent gravity from now on, see `steepest_to_come`.
    """
    if top >= stance.cap:
        return CAPPED
    sine = np.hypot(rotation[0, 2], rotation[1, 2])
    if rotation[2, 2] <= 0:
        return NO_RETURN
    if sine == 0.0 or np.arctan2(sine, rotation[2, 2]) <= stance.critical:
        return STANDS
    ahead, aside = rotation[0, 2] / sine, rotation[1, 2] / sine
    w0 = w1 = w2 = l0 = l1 = own = 0.0
    for a in range(3):
        w0 += rotation[0, a] * spin[a]
        w1 += rotation[1, a] * spin[a]
        w2 += rotation[2, a] * spin[a]
        moved = (
            stance.inertia[a, 0] * spin[0]
            + stance.inertia[a, 1] * spin[1]
            + stance.inertia[a, 2] * spin[2]
        )
        l0 += rotation[0, a] * moved
        l1 += rotation[1, a] * moved
        if a == 2:
            own = moved
    if w1 * ahead - w0 * aside <= 0:  # it comes back, or stays
        return STANDS
    if (
        own**2 > min(stance.inertia[0, 0], stance.inertia[1, 1]) * stance.weight * stance.depth
    ):  # a top
        return STANDS
    # the lean turns about the vertical, and with it the angular momentum along it
    turning = w2 - (w0 * ahead + w1 * aside) * rotation[2, 2] / sine
    held = max(0.0, turning * (l0 * ahead + l1 * aside)) / stance.weight
    sticks = np.hypot(force[0], force[1]) < STICKS * stance.friction * force[2]
    bound = min(stance.friction, steepest) if sticks else stance.friction
    for k in range(len(stance.corners)):
        x, y = stance.corners[k, 0], stance.corners[k, 1]
        beyond = -ahead * (rotation[0, 0] * x + rotation[0, 1] * y - rotation[0, 2] * stance.depth)
        beyond -= aside * (rotation[1, 0] * x + rotation[1, 1] * y - rotation[1, 2] * stance.depth)
        height = rotation[2, 2] * stance.depth - rotation[2, 0] * x - rotation[2, 1] * y
        if beyond - held <= bound * height:
            return STANDS
    return NO_RETURN


@njit
def is_past_no_return(
    standing: Array,
    corners: Array,
    rotation: Array,
    spins: Array,
    b: int,
    force: Array,
    steepest: float,
) -> bool:
    """Whether body b of many is past its point of no return: by `fallen`, from what it stands on.

    Parameters
    ----------
    standing
        (nb,) of STANDING, corners: (k, 2) [m] of their stances.
    rotation
        (nb, 3, 3) of the bodies to the table.
    spins
        (nb, 3) angular velocities in the frames of the bodies [rad/s].
    force
        (3,) of the ground on all bodies [N].
    steepest
        as of `fallen`.
    """
    one = standing[b]
    if one.critical == np.inf:
        return False
    turn, spin, inertia = np.empty((3, 3)), np.empty(3), np.empty((3, 3))
    m = one.below
    for a in range(3):
        spin[a] = spins[b, a]
        for c in range(3):
            inertia[a, c] = one.inertia[a, c]
            turn[a, c] = rotation[b, a, c]
    if m != GROUND:
        for a in range(3):
            for c in range(3):
                turn[a, c] = 0.0
                for d in range(3):
                    turn[a, c] += rotation[m, d, a] * rotation[b, d, c]
        for a in range(3):
            for c in range(3):
                spin[a] -= turn[c, a] * spins[m, c]
    if np.arctan2(np.hypot(turn[0, 2], turn[1, 2]), turn[2, 2]) <= one.critical:
        return False
    stance = Stance(
        corners[one.first : one.first + one.count],
        one.depth,
        one.critical,
        inertia,
        one.weight,
        one.friction,
        np.inf,
    )
    bound = steepest if one.ground else np.inf
    return fallen(stance, turn, spin, force, 0.0, bound) == NO_RETURN
