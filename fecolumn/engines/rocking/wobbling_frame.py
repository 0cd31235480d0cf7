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
from pathlib import Path
from typing import ClassVar

from fecolumn.case.model_sections import WobblingFrameModel
from fecolumn.case.outline_keys import bore, half_and_height
from fecolumn.engines.rocking.frame import RockingFrame
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.engines.rocking.wobbling import Wobbling, cylinder_body


@dataclass(frozen=True, slots=True, eq=False)
class WobblingFrame(Wobbling):
    """A slab on `columns` equal columns; attributes as of Wobbling."""

    TABLE: ClassVar[str] = "wobbling_frame"
    RIMS: ClassVar[int] = 2

    @classmethod
    def of_section(  # type: ignore[override]  # each model has a table of its own
        cls, section: WobblingFrameModel, file: Path | str
    ) -> WobblingFrame:
        """Frame of its table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        radius, height = half_and_height(section, cls.TABLE, file)
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
        return float(self.body[4] / self.body[3])

    def pushover(self, tilt: float) -> tuple[float, float]:
        """Displacement of the slab [m] at a tilt >= 0, and the horizontal force on it [N] that
        holds it there: exact, from virtual work.
        """
        reach = 2 * self.body[0] * math.sin(tilt) + self.body[2] * math.cos(tilt)
        return float(self.moved(tilt)[0]), self.columns * self.righting_moment(tilt) / reach

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        force = self.planar.linear_pushover([0.0, 1.0])
        return Wobbling.describe(self) | {
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
