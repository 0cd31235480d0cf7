"""Impact laws of rocking bodies: angular velocity after over before, the impulse acting where the
body lands.

Every law keeps the angular momentum about the point the body lands on (Housner 1963): the impact is
plastic there, and without impulse at the point the body leaves. The manual derives them (fecolumn
help rocking).
"""

from __future__ import annotations

import math


def housner_restitution(slenderness: float) -> float:
    """Of a rectangular block, 1 - 3/2 sin^2 alpha (Housner 1963); 0, it stops, for alpha above 54.7
    degrees.
    """
    return max(1.0 - 1.5 * math.sin(slenderness) ** 2, 0.0)


def rectangular_restitution(aspect: float) -> float:
    """The same by height over width mu: (2 mu^2 - 1)/(2 (mu^2 + 1)); 0 where that is negative."""
    return max((2 * aspect**2 - 1) / (2 * (aspect**2 + 1)), 0.0)


def body_restitution(
    mass: float, central_inertia: float, left: tuple[float, float], landed: tuple[float, float]
) -> float:
    """Of any rigid body whose centre of mass is at `left` (x, z) [m] from the edge it leaves and at
    `landed` from that it lands on.

    Parameters
    ----------
    mass
        [kg].
    central_inertia
        about the centre of mass [kg m2].
    """
    return max(_kept(mass, central_inertia, left, landed), 0.0)


def _kept(
    mass: float, central_inertia: float, left: tuple[float, float], landed: tuple[float, float]
) -> float:
    """As `body_restitution`, below 0 where the body turns back."""
    momentum = central_inertia + mass * (left[0] * landed[0] + left[1] * landed[1])
    return momentum / (central_inertia + mass * (landed[0] ** 2 + landed[1] ** 2))


def one_sided_restitution(
    mass: float, central_inertia: float, edges: tuple[float, float], centre: float, height: float
) -> float:
    """Of a body with a flat foot that strikes a rigid wall behind it and goes back the way it came;
    a share of the speed, at least 0.

    It lands on its other foot edge, strikes the wall with the top edge above that, and lands on the
    first foot edge again, each time keeping its angular momentum. Of a rectangular block that is
    (1 - 3/2 sin^2 alpha)^2 (3/2 cos^2 alpha - 1) (Sorrentino, Kunnath, Monti and Scalora 2008).
    Tests on walls find less.

    Parameters
    ----------
    mass
        [kg].
    central_inertia
        about the centre of mass [kg m2].
    edges
        distances of the centre of mass from the edge on which it leans, and from the wall, along
        the ground [m].
    centre, height
        of the centre of mass and of the top above the ground [m].
    """
    leaning, landed, struck = (
        (-edges[0], centre),
        (edges[1], centre),
        (edges[1], centre - height),
    )
    first = body_restitution(mass, central_inertia, leaning, landed)
    last = body_restitution(mass, central_inertia, landed, leaning)
    return first * max(-_kept(mass, central_inertia, landed, struck), 0.0) * last


def frame_restitution(slenderness: float, mass_ratio: float) -> float:
    """Of a rocking frame, gamma its beam's mass over that of all columns (Makris and Vassiliou
    2013); gamma = 0 is the block's.
    """
    kept = 1.0 - 1.5 * math.sin(slenderness) ** 2 + 3.0 * mass_ratio * math.cos(2 * slenderness)
    return max(kept / (1.0 + 3.0 * mass_ratio), 0.0)
