"""The wobbling column: a rigid column of round foot that rolls on its rim in three dimensions
(Vassiliou 2018).

It tilts by theta towards the azimuth phi, where its rim touches, does not slip and does not turn
about its axis: the contact runs on the circle on which the foot stood. Two degrees of freedom,
nothing lost (`benchmarks/wobbling_equations.py` derives, `wobbling_motion` integrates).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking import wobbling_equations as equations
from fecolumn.engines.rocking.column import RigidColumn
from fecolumn.engines.rocking.model import ModelResponse
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.schema import InputError, Section, parameter
from fecolumn.foundation.section_class import section_class
from fecolumn.motions.record import GroundMotion

#: Tolerance of a step's error, relative to the state: free motion then keeps its energy to 1e-10 in
#: a hundred swings
TOLERANCE = 1e-12
#: Difference of the inertias across the axis, over their mean, that a round body may have
_ROUND = 0.02


@section_class()
class WobblingSection(Section):
    """Round rigid column that rolls on the rim of its foot."""

    outer_diameter_m: float | None = parameter(
        None,
        doc="outer diameter; or slenderness_rad and half_diagonal_m",
        unit="m",
        above=0,
        high=1000,
    )
    height_m: float | None = parameter(
        None, doc="height; or slenderness_rad and half_diagonal_m", unit="m", above=0, high=1000
    )
    slenderness_rad: float | None = parameter(
        None,
        doc="alpha: tilt at which the centre of mass stands over the rim",
        unit="rad",
        above=0,
        high=1.5,
    )
    half_diagonal_m: float | None = parameter(
        None, doc="R: distance of the centre of mass from the rim", unit="m", above=0, high=1000
    )
    wall_m: float | None = parameter(
        None,
        doc="wall thickness of a tube; left out: a solid cylinder",
        unit="m",
        above=0,
        high=500,
    )
    density_kg_m3: float = parameter(
        2000.0,
        doc="density; of a free column it matters to forces and energies alone",
        unit="kg/m3",
        above=0,
        high=1e5,
    )
    tendon_n_m: float = parameter(
        0.0,
        doc="stiffness of a tendon on the axis, from the ground to the column",
        unit="N/m",
        low=0,
        high=1e12,
    )
    tendon_prestress_n: float = parameter(
        0.0, doc="force of that tendon upright", unit="N", low=0, high=1e12
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
        doc="Coulomb friction coefficient of the foot: only checked, the column does not slide",
        above=0,
        high=10,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Wobbling:
    """A rigid column on its round rim, or one of `columns` equal ones with its share of a slab.

    Attributes
    ----------
    body
        (10,) parameters of one column with its share, see `wobbling_equations`.
    columns
        their number.
    restitution
        of the tilt's rate where it passes upright in a plane.
    friction
        Coulomb coefficient, which is only checked.
    """

    TABLE: ClassVar[str] = "wobbling"
    SECTION: ClassVar[type] = WobblingSection

    body: np.ndarray
    columns: int = 1
    restitution: float = 1.0
    friction: float = math.inf

    @classmethod
    def of_section(cls, section: WobblingSection, file) -> Wobbling:
        """Column of its table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        radius, height = round_outline(section, cls.TABLE, file)
        inner = bore(section, radius, cls.TABLE, file)
        mass = section.density_kg_m3 * math.pi * (radius**2 - inner**2) * height
        return cls(
            cylinder_body(
                radius, inner, height, mass, 0.0, section.tendon_n_m, section.tendon_prestress_n
            ),
            restitution=section.restitution,
            friction=section.friction_coefficient,
        )

    @classmethod
    def of_body(cls, column: RigidColumn, friction: float, file) -> Wobbling:
        """A body on its round foot, with its mass, centre and inertia.

        Raises
        ------
        InputError
            the foot is not round, or the body not alike around its axis.
        """
        if not column.round:
            raise InputError(
                file,
                "integration.engine",
                cls.TABLE,
                "needs a round foot: a tube or a solid cylinder",
            )
        across, radius = (column.inertia[0] + column.inertia[1]) / 2, column.half_foot[0]
        if (
            abs(column.inertia[0] - column.inertia[1]) > 2 * _ROUND * across
            or math.hypot(*column.offset) > _ROUND * radius
        ):
            raise InputError(
                file,
                "cap",
                None,
                f"the inertias of the body about x and y, {column.inertia[0]:.3g} and "
                f"{column.inertia[1]:.3g} kg m2, must differ by "
                f'{2 * _ROUND:.0%} at most for integration.engine = "{cls.TABLE}", '
                "which takes it for round",
            )
        body = np.array(
            [
                radius,
                column.height,
                column.top,
                column.mass,
                0.0,
                across,
                column.inertia[2],
                0.0,
                0.0,
                GRAVITY,
            ]
        )
        return cls(body, friction=friction)

    @property
    def slenderness(self) -> float:
        """Alpha of one column [rad]."""
        return math.atan2(self.body[0], self.body[1])

    @property
    def critical_tilt(self) -> float:
        """Tilt at which nothing rights it any more [rad]; a right angle where a tendon
        always does.
        """
        from scipy.optimize import brentq

        return (
            float(brentq(self.righting_moment, 1e-12, math.pi / 2))
            if self.righting_moment(math.pi / 2) < 0
            else math.pi / 2
        )

    @property
    def critical_displacement(self) -> float:
        """Displacement of the top, or slab, there [m]."""
        return float(self.moved(self.critical_tilt)[0])

    @property
    def energy_to_overturn(self) -> float:
        """That takes it there from upright [J]."""
        return self.columns * sum(interpreted(equations.potential)(self.body, self.critical_tilt))

    def righting_moment(self, tilt: float) -> float:
        """Of one column with its share of the slab [N m]: weight and tendon."""
        rise, _, tendon = interpreted(equations.moments)(self.body, float(tilt))
        return self.body[9] * rise + tendon

    def moved(self, tilt) -> tuple[np.ndarray, np.ndarray]:
        """Displacement towards the azimuth and up [m] of the point whose displacement counts, here
        the top's centre.
        """
        tilt, radius, height = np.asarray(tilt, float), self.body[0], self.body[2]
        down = 2 * np.sin(tilt / 2) ** 2
        return radius * down + height * np.sin(tilt), radius * np.sin(tilt) - height * down

    def respond(
        self,
        motion: GroundMotion,
        *,
        free_s: float = 0.0,
        every_s: float = 0.0,
        tilt: float = 0.0,
        tilt_rate: float = 0.0,
        direction: float = 0.0,
        tolerance: float = TOLERANCE,
    ) -> ModelResponse:
        """As of Model; `impact_times` are those of passing upright in a plane or nearly so."""
        from fecolumn.engines.rocking.wobbling_motion import (
            LIFTED,
            LOSS,
            TIME,
            WORK,
            energies,
            foot_forces,
            wobble,
        )

        ground = np.concatenate([motion.acceleration, np.zeros((math.ceil(free_s / motion.dt), 3))])
        start = np.array(
            [max(tilt, LIFTED) if tilt or tilt_rate else 0.0, direction, tilt_rate, 0.0]
        )
        rows, passages, fallen = wobble(
            self.body, ground, motion.dt, start, self.critical_tilt, tolerance, self.restitution
        )
        notes, peaks = self._forces(foot_forces(self.body, rows, ground[: len(rows)]), rows)
        steps = max(1, round(every_s / motion.dt)) if every_s else 1
        rows = rows[np.unique(np.append(np.arange(0, len(rows), steps), len(rows) - 1))]
        kinetic, strain, gravity = self.columns * energies(self.body, rows).T
        work, impact = self.columns * rows[:, [WORK, LOSS]].T
        total = kinetic + strain + gravity
        theta, phi = rows[:, 1], rows[:, 2]
        along, up = self.moved(theta)
        return ModelResponse(
            time=rows[:, TIME],
            coordinates={"theta": theta, "phi": phi},
            units={"theta": "rad", "phi": "rad"},
            tilt=theta,
            u_top=np.column_stack([along * np.cos(phi), along * np.sin(phi), up]),
            overturned=bool(fallen),
            impact_times=passages,
            energy=dict(
                kinetic=kinetic,
                strain=strain,
                gravity=gravity,
                base_work=work,
                impact=impact,
                closure=total - total[0] - work - impact,
            ),
            notes=tuple(notes),
            peaks=peaks,
        )

    def _forces(self, foot, rows) -> tuple[list[str], dict[str, float]]:
        """Notes and peaks of the friction that no slip demands, while it is not falling."""
        upward = (rows[:, 1] > 0) & (rows[:, 1] < self.critical_tilt)
        if not upward.any():
            return [], {}
        foot = foot[upward]
        # a column's tendon presses it on the ground, a frame's one is between column and slab
        if not self.body[4]:
            stretch = 2 * self.body[0] * np.sin(rows[upward, 1] / 2)
            pull = self.body[8] + self.body[7] * stretch
            foot = foot + pull[:, None] * np.column_stack(
                [np.sin(rows[upward, 1] / 2), np.zeros(len(foot)), np.cos(rows[upward, 1] / 2)]
            )
        with np.errstate(divide="ignore", invalid="ignore"):
            demanded = np.where(
                foot[:, 2] > 0, np.hypot(foot[:, 0], foot[:, 1]) / foot[:, 2], math.inf
            )
        # of one that leaves the ground there is none
        peaks = (
            {"friction demanded [-]": float(demanded.max())} if np.isfinite(demanded.max()) else {}
        )
        if not demanded.max() > self.friction:
            return [], peaks
        most = "more than any" if math.isinf(demanded.max()) else f"{demanded.max():.3g}"
        return [
            f"wobbling demands a friction coefficient of {most}, more than the "
            f"{self.friction:g} there is for {(demanded > self.friction).mean():.1%} "
            "of the time off the ground: it would slide"
        ], peaks

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        (rise, lever, tendon), along = (
            interpreted(equations.moments)(self.body, 0.0),
            interpreted(equations.inertia)(self.body, 0.0)[0],
        )
        pace = self.body[9] * math.hypot(rise, lever) / along
        return {
            "mass": (self.columns * (self.body[3] + self.body[4]), "kg"),
            "slenderness alpha": (self.slenderness, "rad"),
            "R": (math.hypot(self.body[0], self.body[1]), "m"),
            "frequency parameter p": (math.sqrt(pace), "rad/s"),
            "uplift at": ((self.body[9] * rise + tendon) / (self.body[9] * lever), "g"),
            "critical tilt": (self.critical_tilt, "rad"),
            "displacement of the top there": (self.critical_displacement, "m"),
            "energy to overturn": (self.energy_to_overturn, "J"),
        }


def cylinder_body(
    radius: float,
    inner: float,
    height: float,
    mass: float,
    slab: float,
    stiffness: float = 0.0,
    pull: float = 0.0,
) -> np.ndarray:
    """Parameters (10,) of a tube or solid cylinder of mass [kg] with its share of a slab [kg] and a
    tendon's stiffness [N/m] and pull [N].
    """
    squares = radius**2 + inner**2
    return np.array(
        [
            radius,
            height / 2,
            height,
            mass,
            slab,
            mass * (squares / 4 + height**2 / 12),
            mass * squares / 2,
            stiffness,
            pull,
            GRAVITY,
        ]
    )


def round_outline(section, table: str, file) -> tuple[float, float]:
    """Radius and height [m] of a table that states diameter and height, or slenderness and half
    diagonal.

    Raises
    ------
    InputError
        neither pair is there, or both are.
    """
    pairs = ("outer_diameter_m", "height_m"), ("slenderness_rad", "half_diagonal_m")
    given = [tuple(key for key in pair if getattr(section, key) is not None) for pair in pairs]
    if given == [pairs[0], ()]:
        return section.outer_diameter_m / 2, section.height_m
    if given == [(), pairs[1]]:
        return section.half_diagonal_m * math.sin(
            section.slenderness_rad
        ), 2 * section.half_diagonal_m * math.cos(section.slenderness_rad)
    key = next(iter(given[0] + given[1]), "outer_diameter_m")
    raise InputError(
        file,
        f"{table}.{key}",
        getattr(section, key),
        f"state {table}.outer_diameter_m and {table}.height_m, or "
        f"{table}.slenderness_rad and {table}.half_diagonal_m",
    )


def bore(section, radius: float, table: str, file) -> float:
    """Inner radius [m] of a table that may state a wall.

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
