"""A column as one rigid body: what closed-form models take from a case."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RigidColumn:
    """Column with flange and cap, standing on its foot.

    Attributes
    ----------
    mass
        [kg].
    height
        of the centre of mass [m].
    inertia
        about axes along x, y and z through it (3,) [kg m2].
    offset
        of the centre of mass from the middle of the foot along x and y (2,) [m].
    half_foot
        half the foot's extent along x and y (2,) [m].
    top
        height of the top's centre [m].
    round
        whether the foot is round.
    """

    mass: float
    height: float
    inertia: tuple[float, float, float]
    offset: tuple[float, float]
    half_foot: tuple[float, float]
    top: float
    round: bool
