"""The wobbling frame: a slab on equal round columns that roll on their rims, free or held by
tendons (Vassiliou 2018; Reggiani Manzo and Vassiliou 2022).

All columns move alike and the slab, which does not slip on their upper rims, translates: the frame
is one column with its share of the slab. Its equations are those of the restrained wobbling frame
that was validated by shaking table tests, as printed there; of the static relation for slender
columns (its equation 1) the first term lacks a factor alpha in print.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fecolumn.engines.rocking import wobbling_equations as equations
from fecolumn.engines.rocking.frame import RockingFrame
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.engines.rocking.wobbling import Wobbling, bore, cylinder_body, round_outline
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.schema import Section, parameter, required
from fecolumn.foundation.section_class import section_class


@section_class()
class WobblingFrameSection(Section):
    """Slab on equal round columns that roll on their rims."""

    column_mass_kg: float = required(doc="mass of one column", unit="kg", above=0, high=1e9)
    slab_mass_kg: float = required(doc="mass of the slab", unit="kg", above=0, high=1e9)
    columns: int = parameter(4, doc="number of columns", low=1, high=10_000)
    outer_diameter_m: float | None = parameter(
        None,
        doc="outer diameter of a column; or slenderness_rad and half_diagonal_m",
        unit="m",
        above=0,
        high=1000,
    )
    height_m: float | None = parameter(
        None,
        doc="height of a column; or slenderness_rad and half_diagonal_m",
        unit="m",
        above=0,
        high=1000,
    )
    slenderness_rad: float | None = parameter(
        None, doc="alpha of a column", unit="rad", above=0, high=1.5
    )
    half_diagonal_m: float | None = parameter(
        None, doc="R of a column: distance of its centre from the rim", unit="m", above=0, high=1000
    )
    wall_m: float | None = parameter(
        None, doc="wall thickness of tubes; left out: solid cylinders", unit="m", above=0, high=500
    )
    tendon_n_m: float = parameter(
        0.0,
        doc="stiffness of each column's restraint, anchored in column and slab: tendon and "
        "springs in series",
        unit="N/m",
        low=0,
        high=1e12,
    )
    tendon_prestress_n: float = parameter(
        0.0, doc="force of each tendon upright", unit="N", low=0, high=1e12
    )
    restitution: float = parameter(
        1.0,
        doc="rate of the tilt after over before, where it passes upright in a plane; "
        "rolling past upright loses nothing",
        low=0,
        high=1,
    )
    friction_coefficient: float = parameter(
        0.6,
        doc="Coulomb friction coefficient of the feet: only checked, the columns do not slide",
        above=0,
        high=10,
    )


@dataclass(frozen=True, slots=True, eq=False)
class WobblingFrame(Wobbling):
    """A slab on `columns` equal columns; attributes as of Wobbling."""

    TABLE: ClassVar[str] = "wobbling_frame"
    SECTION: ClassVar[type] = WobblingFrameSection

    @classmethod
    def of_section(cls, section: WobblingFrameSection, file) -> WobblingFrame:
        """Frame of its table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        radius, height = round_outline(section, cls.TABLE, file)
        body = cylinder_body(
            radius,
            bore(section, radius, cls.TABLE, file),
            height,
            section.column_mass_kg,
            section.slab_mass_kg / section.columns,
            section.tendon_n_m,
            section.tendon_prestress_n,
        )
        return cls(body, section.columns, section.restitution, section.friction_coefficient)

    @property
    def planar(self) -> RockingFrame:
        """The frame of slender columns in a plane, whose static laws are these, too; its impacts
        lose nothing.
        """
        radius, centre, _, mass, slab, *_, stiffness, pull, _ = self.body
        restraint = Restraint(
            tendons=((self.columns * stiffness, self.columns * pull, 2 * radius),)
        )
        return RockingFrame.of(
            self.columns,
            self.slenderness,
            math.hypot(radius, centre),
            mass,
            self.columns * slab,
            restitution=1.0,
            restraint=restraint,
        )

    @property
    def mass_ratio(self) -> float:
        """gamma: the slab's mass over that of all columns."""
        return self.body[4] / self.body[3]

    @property
    def frequency(self) -> float:
        """p_hat [rad/s]: p_hat^2 = (1 + 2 gamma) m_c g R/(I + 4 gamma m_c R^2), I of a column about
        a point of its rim (equation 6).
        """
        rise, lever, _ = interpreted(equations.moments)(self.body, 0.0)
        return math.sqrt(
            self.body[9]
            * math.hypot(rise, lever)
            / interpreted(equations.inertia)(self.body, 0.0)[0]
        )

    def moved(self, tilt) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of the slab towards the azimuth and up [m]."""
        tilt, radius, height = np.asarray(tilt, float), self.body[0], self.body[2]
        down = 2 * np.sin(tilt / 2) ** 2
        return 2 * radius * down + height * np.sin(tilt), 2 * radius * np.sin(tilt) - height * down

    def pushover(self, tilt) -> tuple[float, float]:
        """Displacement of the slab [m] at a tilt >= 0, and the horizontal force on it [N] that
        holds it there: exact, from virtual work.
        """
        reach = 2 * self.body[0] * math.sin(tilt) + self.body[2] * math.cos(tilt)
        return float(self.moved(tilt)[0]), self.columns * self.righting_moment(tilt) / reach

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        force = self.planar.linear_pushover([0.0, 1.0])
        return Wobbling.describe(self) | {
            "frequency parameter p": (self.frequency, "rad/s"),
            "mass ratio gamma": (self.mass_ratio, "-"),
            "critical stiffness of a tendon": (self.planar.critical_tendon_stiffness, "N/m"),
            "horizontal force at uplift, slender": (force[0], "N"),
            "slope of the force after uplift, slender": (force[1] - force[0], "N/m"),
            **(
                {"displacement capacity, slender": (force[0] / (force[0] - force[1]), "m")}
                if force[1] < force[0]
                else {}
            ),
        }
