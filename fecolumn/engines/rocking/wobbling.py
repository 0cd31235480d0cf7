"""The wobbling column: a rigid column of round foot that rolls on its rim in three dimensions
(Vassiliou 2018).

It tilts by theta towards the azimuth phi, where its rim touches, does not slip and does not turn
about its axis: the contact runs on the circle on which the foot stood. Two degrees of freedom,
nothing lost (`benchmarks/wobbling_equations.py` derives, `wobbling_motion` integrates).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.case.model_sections import WobblingModel
from fecolumn.case.outline_keys import bore, half_and_height
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking import wobbling_equations as equations
from fecolumn.engines.rocking.column import RigidColumn
from fecolumn.engines.rocking.model import (
    ModelResponse,
    balanced,
    check_friction,
    free_times,
    moved_about_edge,
)
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.schema import InputError
from fecolumn.motions.record import GroundMotion

#: Tolerance of a step's error, relative to the state: free motion then keeps its energy to 1e-10 in
#: a hundred swings
STEP_TOLERANCE = 1e-12
#: Difference of the inertias across the axis, over their mean, that a round body may have
_ROUND = 0.02


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
    #: Rims on which the point rolls whose displacement counts: a slab lies on the upper one, too
    RIMS: ClassVar[int] = 1

    body: Array
    columns: int = 1
    restitution: float = 1.0
    friction: float = math.inf

    @classmethod
    def of_section(cls, section: WobblingModel, file: Path | str) -> Wobbling:
        """Column of its table.

        Raises
        ------
        InputError
            keys that do not fit together.
        """
        radius, height = half_and_height(section, cls.TABLE, file)
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
    def of_body(cls, column: RigidColumn, friction: float, file: Path | str) -> Wobbling:
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
        aside, differ = math.hypot(*column.offset), abs(column.inertia[0] - column.inertia[1])
        if aside > _ROUND * radius:
            needs = (
                f"needs a centre of mass on the axis of the foot, up to {_ROUND * radius:.2g} m; "
                f"it is {aside:.3g} m beside it"
            )
            raise InputError(file, "integration.engine", cls.TABLE, needs)
        if differ > 2 * _ROUND * across:
            needs = (
                "needs a body that is alike about its axis: the inertias about x and y, "
                f"{column.inertia[0]:.3g} and {column.inertia[1]:.3g} kg m2, must differ by "
                f"{2 * _ROUND:.0%} at most; look at its cap and at inertia_kg_m2"
            )
            raise InputError(file, "integration.engine", cls.TABLE, needs)
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
    def frequency(self) -> float:
        """P [rad/s]: p^2 = (1 + 2 gamma) m_c g R/(I + 4 gamma m_c R^2), I of a column about a point
        of its rim, gamma the mass of a slab over that of the columns (Reggiani Manzo and Vassiliou
        2022, equation 6).
        """
        rise, lever, _ = interpreted(equations.moments)(self.body, 0.0)
        inertia, _ = interpreted(equations.inertia)(self.body, 0.0)
        return math.sqrt(self.body[9] * math.hypot(rise, lever) / inertia)

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
        energies = interpreted(equations.potential)(self.body, self.critical_tilt)
        energy: float = self.columns * sum(energies)
        return energy

    def righting_moment(self, tilt: float) -> float:
        """Of one column with its share of the slab [N m]: weight and tendon."""
        rise, _, tendon = interpreted(equations.moments)(self.body, float(tilt))
        moment: float = self.body[9] * rise + tendon
        return moment

    def moved(self, tilt: ArrayLike) -> tuple[Array, Array]:
        """Displacement towards the azimuth and up [m] of the top's centre, or of the slab."""
        return moved_about_edge(tilt, self.body[2], self.RIMS * self.body[0])

    def respond(
        self,
        motion: GroundMotion,
        *,
        free_s: float = 0.0,
        tilt: float = 0.0,
        tilt_rate: float = 0.0,
        direction: float = 0.0,
    ) -> ModelResponse:
        """As of Model; `impact_times` are those of passing upright in a plane or nearly so. What
        leans beyond its critical tilt at the end is followed until it has fallen or comes back.
        """
        from fecolumn.engines.rocking.wobbling_motion import (
            LIFTED_TILT,
            WOBBLE_LOSS,
            WOBBLE_TIME,
            WOBBLE_WORK,
            energies,
            foot_forces,
            wobble,
        )

        start = np.array(
            [max(tilt, LIFTED_TILT) if tilt or tilt_rate else 0.0, direction, tilt_rate, 0.0]
        )
        for longer in free_times(free_s, self.frequency):
            still = np.zeros((math.ceil(longer / motion.dt), 3))
            ground = np.concatenate([motion.acceleration, still])
            rows, passages, fallen = wobble(
                self.body,
                ground,
                motion.dt,
                start,
                self.critical_tilt,
                STEP_TOLERANCE,
                self.restitution,
            )
            if fallen or rows[-1, 1] <= self.critical_tilt:
                break
        base = self._base_force(foot_forces(self.body, rows, ground[: len(rows)]), rows)
        notes, peaks = self._check_forces(base, rows)
        kinetic, strain, gravity = self.columns * energies(self.body, rows).T
        work, impact = self.columns * rows[:, [WOBBLE_WORK, WOBBLE_LOSS]].T
        theta, phi = rows[:, 1], rows[:, 2]
        along, up = self.moved(theta)
        return ModelResponse(
            time=rows[:, WOBBLE_TIME],
            coordinates={"theta": theta, "phi": phi},
            units={"theta": "rad", "phi": "rad"},
            tilt=theta,
            u_top=np.column_stack([along * np.cos(phi), along * np.sin(phi), up]),
            overturned=bool(fallen),
            impact_times=passages,
            energy=balanced(
                kinetic=kinetic, strain=strain, gravity=gravity, base_work=work, impact=impact
            ),
            notes=tuple(notes),
            peaks=peaks,
            base_force=self.columns * self._along_axes(base, rows, ground[: len(rows)]),
        )

    def _base_force(self, foot: Array, rows: Array) -> Array:
        """Force of the ground on a column (n, 3) as of `foot_forces` [N], with what its tendon
        presses.
        """
        if self.body[4]:
            return foot  # a frame's tendon is between column and slab
        tilt = rows[:, 1]
        pull = self.body[8] + self.body[7] * 2 * self.body[0] * np.sin(tilt / 2)
        along = np.column_stack([np.sin(tilt / 2), np.zeros(len(tilt)), np.cos(tilt / 2)])
        pressed: Array = foot + pull[:, None] * along
        return pressed

    def _along_axes(self, foot: Array, rows: Array, ground: Array) -> Array:
        """Forces (n, 3) towards the azimuth, across it and up as such along x, y and up [N]; where
        the column stands, by the acceleration of the ground (n, 3) [m/s2].
        """
        c, s = np.cos(rows[:, 2]), np.sin(rows[:, 2])
        turned = np.column_stack(
            [c * foot[:, 0] - s * foot[:, 1], s * foot[:, 0] + c * foot[:, 1], foot[:, 2]]
        )
        mass = self.body[3] + self.body[4]
        standing = mass * (ground + np.array([0.0, 0.0, GRAVITY]))
        standing[:, 2] += 0.0 if self.body[4] else self.body[8]
        found: Array = np.where(rows[:, 1:2] > 0, turned, standing)
        return found

    def _check_forces(self, foot: Array, rows: Array) -> tuple[list[str], dict[str, float]]:
        """Notes and peaks of the friction demanded, while the column neither stands nor falls."""
        tilt = rows[:, 1]
        return check_friction(
            "wobbling",
            "friction_demanded",
            np.hypot(foot[:, 0], foot[:, 1]),
            foot[:, 2],
            rows[:, 0],
            (tilt > 0) & (tilt < self.critical_tilt),
            self.friction,
        )

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        rise, lever, tendon = interpreted(equations.moments)(self.body, 0.0)
        return {
            "mass": (self.columns * (self.body[3] + self.body[4]), "kg"),
            "slenderness alpha": (self.slenderness, "rad"),
            "R": (math.hypot(self.body[0], self.body[1]), "m"),
            "frequency parameter p": (self.frequency, "rad/s"),
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
) -> Array:
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
