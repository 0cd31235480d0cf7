"""The rocking frame: free-standing columns that carry a beam, free or held by tendons (Makris and
Vassiliou 2013, 2015).

All columns turn alike and the beam stays level: it moves as a point at twice the half diagonal, (x,
z) = 2 R (sin alpha - sin(alpha - phi), cos(alpha - phi) - cos alpha). With gamma the beam's mass
over that of all columns the frame is a block of p^2 (1 + 2 gamma)/(1 + 3 gamma).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.case.model_sections import FrameModel
from fecolumn.case.outline_keys import half_and_height
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.block import described
from fecolumn.engines.rocking.impact import frame_restitution
from fecolumn.engines.rocking.plane import PlanarModel, Plane
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.foundation.arrays import Array


@dataclass(frozen=True, slots=True, eq=False)
class RockingFrame(PlanarModel):
    """A rocking frame in the plane of x.

    Attributes
    ----------
    columns
        their number.
    column_mass, beam_mass
        of one column, of the beam [kg].
    slenderness
        alpha of a column [rad]
    half_diagonal
        R [m].
    planes
        the one of x: its law of motion and restraints; the ground's motion along y does nothing.
    """

    TABLE: ClassVar[str] = "frame"

    columns: int
    column_mass: float
    beam_mass: float
    slenderness: float
    half_diagonal: float
    planes: tuple[Plane, ...]

    @classmethod
    def of_section(cls, section: FrameModel, file: Path | str) -> RockingFrame:
        """Frame of its table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        half, height = half_and_height(section, "frame", file)
        reach = 2 * half * section.tendon_joints
        tendons = (
            (
                (
                    section.columns * section.tendon_n_m,
                    section.columns * section.tendon_prestress_n,
                    reach,
                ),
            )
            if section.tendon_n_m or section.tendon_prestress_n
            else ()
        )
        return cls.of(
            section.columns,
            math.atan2(2 * half, height),
            math.hypot(2 * half, height) / 2,
            section.column_mass_kg,
            section.beam_mass_kg,
            restitution=section.restitution,
            restraint=Restraint(tendons=tendons),
            friction=section.friction_coefficient,
        )

    @classmethod
    def of(
        cls,
        columns: int,
        slenderness: float,
        half_diagonal: float,
        column_mass: float,
        beam_mass: float,
        *,
        restitution: float | None = None,
        restraint: Restraint | None = None,
        friction: float = math.inf,
    ) -> RockingFrame:
        """Frame of columns of slenderness alpha [rad] and half diagonal R [m]; arguments as of
        Frame and Plane.
        """
        b, h = half_diagonal * math.sin(slenderness), half_diagonal * math.cos(slenderness)
        mass = columns * column_mass + beam_mass
        # the beam counts as a point at 2 R, of all masses only m R and m R^2 enter
        centre = (columns * column_mass + 2 * beam_mass) / mass
        inertia = (
            columns * column_mass * 4 / 3 * half_diagonal**2 + beam_mass * 4 * half_diagonal**2
        )
        kept = (
            frame_restitution(slenderness, beam_mass / (columns * column_mass))
            if restitution is None
            else restitution
        )
        plane = Plane(
            0,
            mass,
            (centre * b, centre * b),
            centre * h,
            (inertia, inertia),
            (kept, kept),
            2 * h,
            (2 * b, 2 * b),
            (restraint or Restraint(),) * 2,
            friction,
        )
        return cls(columns, column_mass, beam_mass, slenderness, half_diagonal, (plane,))

    @property
    def mass_ratio(self) -> float:
        """gamma: the beam's mass over that of all columns."""
        return self.beam_mass / (self.columns * self.column_mass)

    @property
    def plane(self) -> Plane:
        """The plane of x."""
        return self.planes[0]

    @property
    def critical_tendon_stiffness(self) -> float:
        """Stiffness of each column's tendon [N/m] above which the force rises after uplift, as far
        as slender columns go; of a tendon of one joint.

        (1 + 2 gamma) m_c g/(b alpha), Makris and Vassiliou (2015); with two joints it is a quarter.
        """
        b = self.half_diagonal * math.sin(self.slenderness)
        return (1 + 2 * self.mass_ratio) * self.column_mass * GRAVITY / (b * self.slenderness)

    def pushover(self, displacement: ArrayLike) -> Array:
        """Horizontal force at the beam [N] that holds the frame at a displacement >= 0 [m]; exact,
        from virtual work.
        """
        return self.plane.pushover(displacement)

    def linear_pushover(self, displacement: ArrayLike) -> Array:
        """The same for slender columns: (1/2 + gamma) N m_c g alpha + (k b alpha/2 - (1/2 + gamma)
        m_c g) N u/(2 h), k of each tendon over one joint.
        """
        b, h = (
            self.half_diagonal * math.sin(self.slenderness),
            self.half_diagonal * math.cos(self.slenderness),
        )
        weight = (0.5 + self.mass_ratio) * self.columns * self.column_mass * GRAVITY
        stiffness = sum(
            one * (reach / (2 * b)) ** 2 for one, _, reach in self.plane.restraints[0].tendons
        )
        return weight * self.slenderness + (
            stiffness * b * self.slenderness / 2 - weight
        ) * np.asarray(displacement, float) / (2 * h)

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        found = described(self.plane) | {
            "mass ratio gamma": (self.mass_ratio, "-"),
            "critical stiffness of a tendon of one joint": (self.critical_tendon_stiffness, "N/m"),
            "slope of the force after uplift, slender": (
                float(np.diff(self.linear_pushover([0, 1]))[0]),
                "N/m",
            ),
        }
        found["R of the block that rocks alike"] = (
            3 * GRAVITY / (4 * self.plane.p2[0]),
            "m",
        )
        return found
