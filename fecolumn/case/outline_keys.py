"""Keys of the rigid bodies of rocking models: a rectangle or a circle by its sides, or by
slenderness and half diagonal; its friction, tendon and restitution.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from fecolumn.foundation.schema import InputError, Section, parameter


@dataclass(frozen=True, slots=True, kw_only=True)
class OutlineKeys(Section):
    """A body of a height and a size across."""

    ACROSS: ClassVar[str]

    height_m: float | None = parameter(
        None,
        doc="height of the block or of a column; or state slenderness_rad and half_diagonal_m",
        unit="m",
        above=0,
        high=1000,
    )
    slenderness_rad: float | None = parameter(
        None,
        doc="alpha: tilt at which the centre of mass of the block, or of a column alone, is "
        "above the edge",
        unit="rad",
        above=0,
        high=1.5,
    )
    half_diagonal_m: float | None = parameter(
        None,
        doc="R: half the diagonal, the distance of the centre of mass from the edge",
        unit="m",
        above=0,
        high=1000,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class RectangleKeys(OutlineKeys):
    """A rectangle that rocks along x."""

    ACROSS: ClassVar[str] = "width_m"

    width_m: float | None = parameter(
        None,
        doc="width of the block or of a column along x; or state slenderness_rad and "
        "half_diagonal_m",
        unit="m",
        above=0,
        high=1000,
    )


@dataclass(frozen=True, kw_only=True)  # of two bases one alone can have slots
class RestraintKeys(Section):
    """Friction, and a tendon, of each body of a model."""

    friction_coefficient: float = parameter(
        0.6,
        doc="Coulomb friction coefficient at the foot; only for a check: the model does not slide",
        above=0,
        high=10,
    )
    tendon_n_m: float = parameter(
        0.0,
        doc="stiffness of a tendon on the axis of the block or of each column, anchored below "
        "the foot unless this table states otherwise; with springs in series, of tendon and "
        "springs together",
        unit="N/m",
        low=0,
        high=1e12,
    )
    tendon_prestress_n: float = parameter(
        0.0, doc="force of each tendon while the body is upright", unit="N", low=0, high=1e12
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class RockingKeys(RestraintKeys, RectangleKeys):
    """A rectangle that rocks about its edges."""

    restitution: float | None = parameter(
        None,
        doc="ratio of the angular velocity after an impact to that before it; left out: that "
        "of an impact without bounce",
        low=0,
        high=1,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingKeys(RestraintKeys, OutlineKeys):
    """A cylinder or tube that rolls on the rim of its foot."""

    ACROSS: ClassVar[str] = "outer_diameter_m"

    outer_diameter_m: float | None = parameter(
        None,
        doc="outer diameter of a column; or state slenderness_rad and half_diagonal_m",
        unit="m",
        above=0,
        high=1000,
    )
    wall_m: float | None = parameter(
        None,
        doc="wall thickness of a tube; left out: a solid cylinder",
        unit="m",
        above=0,
        high=500,
    )
    restitution: float = parameter(
        1.0,
        doc="ratio of the rate of tilt after an impact to that before it, where a column rocks "
        "in a plane and passes upright; a column that rolls past upright loses nothing",
        low=0,
        high=1,
    )


def half_and_height(section: OutlineKeys, table: str, file: Path | str) -> tuple[float, float]:
    """Half the size across and the height [m].

    Raises
    ------
    InputError
        neither the sides are stated nor slenderness and half diagonal, or keys of both.
    """
    keys = section.ACROSS, "height_m", "slenderness_rad", "half_diagonal_m"
    across, height, alpha, diagonal = values = [getattr(section, key) for key in keys]
    given = [key for key, value in zip(keys, values) if value is not None]
    if given == [*keys[:2]]:
        return across / 2, height
    if given == [*keys[2:]]:
        return diagonal * math.sin(alpha), 2 * diagonal * math.cos(alpha)
    key = given[0] if given else section.ACROSS
    raise InputError(
        file,
        f"{table}.{key}",
        getattr(section, key),
        f"state {table}.{section.ACROSS} and {table}.height_m, or {table}.slenderness_rad and "
        f"{table}.half_diagonal_m",
    )


def bore(section: RollingKeys, radius: float, table: str, file: Path | str) -> float:
    """Inner radius [m] of a column of this outer radius [m].

    Raises
    ------
    InputError
        a wall thicker than the radius.
    """
    if section.wall_m is None:
        return 0.0
    if section.wall_m > radius:
        raise InputError(
            file,
            f"{table}.wall_m",
            section.wall_m,
            f"must be at most the outer radius, {radius:g} m",
        )
    return radius - section.wall_m
