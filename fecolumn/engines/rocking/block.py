"""The planar rocking block (Housner 1963): free or held by springs, a tendon, a roof; leaning to
both sides or to one.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, NamedTuple, TypedDict, Unpack

import numpy as np

from fecolumn.case.model_sections import BlockModel
from fecolumn.case.outline_keys import half_and_height
from fecolumn.engines.rocking.column import RigidColumn
from fecolumn.engines.rocking.impact import body_restitution, one_sided_restitution
from fecolumn.engines.rocking.plane import PlanarModel, Plane
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.foundation.schema import InputError


@dataclass(frozen=True, slots=True, eq=False)
class RockingBlock(PlanarModel):
    """A rigid body that rocks in the planes of x and y, each as if the other did not move.

    Attributes
    ----------
    planes
        one for each axis along which it can rock.
    """

    TABLE: ClassVar[str] = "block"

    planes: tuple[Plane, ...]

    @classmethod
    def of_section(cls, section: BlockModel, file: Path | str) -> RockingBlock:
        """Block of its table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        half, height = half_and_height(section, "block", file)
        width = 2 * half
        own = dataclasses.replace(section, width_m=width, height_m=height)
        mass = section.density_kg_m3 * width * height * (section.depth_m or 1.0)
        for key, value, high in (
            ("spring_height_m", section.spring_height_m, height),
            ("bed_to_m", section.bed_to_m, height),
            ("bed_from_m", section.bed_from_m, section.bed_to_m or height),
        ):
            if value is not None and value > high:
                raise InputError(file, f"block.{key}", value, f"must be at most {high:g} m")
        if abs(section.roof_eccentricity_m) > width / 2:
            raise InputError(
                file,
                "block.roof_eccentricity_m",
                section.roof_eccentricity_m,
                f"must lie on the top, within {width / 2:g} m",
            )
        if section.sides == 1 and section.depth_m:
            raise InputError(
                file,
                "block.depth_m",
                section.depth_m,
                "must be left out where block.sides = 1: such a block leans to +x alone",
            )
        planes = [_plane(own, 0, (width, height), mass)]
        if section.depth_m:
            planes.append(
                _plane(
                    dataclasses.replace(own, roof_eccentricity_m=0.0, roof_thrust_n=0.0),
                    1,
                    (section.depth_m, height),
                    mass,
                )
            )
        block = cls(tuple(planes))
        for plane in block.planes:
            _refuse_fallen(plane, file, section)
        return block

    @classmethod
    def of_body(
        cls, body: RigidColumn, friction: float, file: Path | str, restitution: float | None = None
    ) -> RockingBlock:
        """A body on its foot, with its mass, centre and inertia; its restitution by the plastic
        impact unless given.

        Raises
        ------
        InputError
            the body does not stand on its foot.
        """
        planes = []
        for axis in (0, 1):
            edges = (
                body.half_foot[axis] - body.offset[axis],
                body.half_foot[axis] + body.offset[axis],
            )
            if min(edges) <= 0:
                raise InputError(
                    file,
                    "column",
                    None,
                    f"its centre of mass stands {body.offset[axis]:.3g} m from the "
                    f"middle of the foot, whose half is {body.half_foot[axis]:.3g} m",
                )
            planes.append(
                body_plane(
                    PlanarBody(
                        axis,
                        body.mass,
                        edges,
                        body.height,
                        body.inertia[1 - axis],
                        body.top,
                        (body.half_foot[axis],) * 2,
                    ),
                    restitution,
                    friction=friction,
                )
            )
        return cls(tuple(planes))

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        return {
            name: value
            for plane in self.planes
            for name, value in described(plane, len(self.planes) > 1).items()
        }


class PlanarBody(NamedTuple):
    """A rigid body in the vertical plane in which it rocks.

    axis: along which it rocks, 0 of x, 1 of y. mass [kg]. edges: (2,) horizontal distances [m] of
    the centre of mass from the edge on the positive side of the axis and from the other edge.
    height: of the centre of mass above the foot [m]. central: inertia [kg m2] about the centre of
    mass, for rotation in the plane. top: height above the foot [m] of the point whose displacement
    counts; top_inside: (2,) its horizontal distances [m] inwards from the two edges.
    """

    axis: int
    mass: float
    edges: tuple[float, float]
    height: float
    central: float
    top: float
    top_inside: tuple[float, float]


class PlaneLaws(TypedDict, total=False):
    """What holds a plane and where it may lean to, as of Plane."""

    restraints: tuple[Restraint, Restraint]
    friction: float
    only: int


def body_plane(
    body: PlanarBody, restitution: float | None = None, **laws: Unpack[PlaneLaws]
) -> Plane:
    """Plane of a rigid body on its foot.

    Parameters
    ----------
    restitution
        of the angular velocity at an impact on either side [-]; None: by the plastic impact.
    laws
        restraints, friction and only, as of Plane.
    """
    mass, central, height = body.mass, body.central, body.height
    first, second = (central + mass * (edge**2 + height**2) for edge in body.edges)
    inertia = first, second
    if restitution is None:
        vectors = (-body.edges[0], height), (body.edges[1], height)
        kept = (
            body_restitution(mass, central, *vectors),
            body_restitution(mass, central, *vectors[::-1]),
        )
    else:
        kept = restitution, restitution
    return Plane(
        body.axis, mass, body.edges, height, inertia, kept, body.top, body.top_inside, **laws
    )


def _plane(section: BlockModel, axis: int, sides: tuple[float, float], mass: float) -> Plane:
    """Plane of a block of these sides: width and height [m]."""
    (width, height), roof, off = sides, section.roof_mass_kg, section.roof_eccentricity_m
    total = mass + roof
    centre = np.array([roof * off, mass * height / 2 + roof * height]) / total
    own, there = centre - (0.0, height / 2), centre - (off, height)
    central = mass * (width**2 + height**2) / 12 + mass * own @ own + roof * there @ there
    restraints = []
    for side in (1, -1):
        middle = width / 2
        springs = (
            ((section.spring_n_m, section.spring_height_m or height, middle),)
            if section.spring_n_m
            else ()
        )
        bed = (
            ((section.bed_n_m2, section.bed_from_m, section.bed_to_m or height, middle),)
            if section.bed_n_m2
            else ()
        )
        tendons = (
            ((section.tendon_n_m, section.tendon_prestress_n, 2 * middle),)
            if section.tendon_n_m or section.tendon_prestress_n
            else ()
        )
        restraints.append(
            Restraint(springs, bed, tendons, (side * section.roof_thrust_n, height, middle))
        )
    restitution = section.restitution
    edges = width / 2 - centre[0], width / 2 + centre[0]
    if section.sides == 1 and restitution is None:
        restitution = one_sided_restitution(
            total, float(central), (float(edges[0]), float(edges[1])), float(centre[1]), height
        )
    return body_plane(
        PlanarBody(
            axis, total, edges, float(centre[1]), float(central), height, (width / 2, width / 2)
        ),
        restitution,
        restraints=(restraints[0], restraints[1]),
        friction=section.friction_coefficient,
        only=1 if section.sides == 1 else 0,
    )


def _refuse_fallen(plane: Plane, file: Path | str, section: BlockModel) -> None:
    for side in plane.sides:
        if not plane.restoring(0.0, side) > 0:
            raise InputError(
                file,
                "block.roof_thrust_n",
                section.roof_thrust_n,
                "overturns the block by itself towards "
                f"{'+' if side > 0 else '-'}{'xy'[plane.axis]}",
            )


def described(plane: Plane, several: bool = False) -> dict[str, tuple[float, str]]:
    """Derived parameters of a plane, name to (value, unit); those of its axis told apart where
    there are several.
    """
    along = f" along {'xy'[plane.axis]}" if several else ""
    tilt, displacement, energy = plane.critical_state()
    found = {
        "mass": (plane.mass, "kg"),
        f"slenderness alpha{along}": (plane.alpha[0], "rad"),
        f"R{along}": (plane.radius[0], "m"),
        f"frequency parameter p{along}": (math.sqrt(plane.p2[0]), "rad/s"),
    }
    if plane.alpha[0] != plane.alpha[1]:
        found |= {
            f"alpha to the other side{along}": (plane.alpha[1], "rad"),
            f"p to the other side{along}": (math.sqrt(plane.p2[1]), "rad/s"),
        }
    if plane.restitution[0] != plane.restitution[1]:
        found[f"restitution from the other side{along}"] = (plane.restitution[1], "-")
    return found | {
        f"restitution of the angular velocity{along}": (plane.restitution[0], "-"),
        f"uplift{along} at": (min(plane.uplift(side) for side in plane.sides), "g"),
        f"critical tilt{along}": (tilt, "rad"),
        f"displacement of the top there{along}": (displacement, "m"),
        f"energy to overturn{along}": (energy, "J"),
    }
