"""The podium: an elastic building of n storeys on a beam that free-standing columns carry, which
rock (Bantilas, Kavvadias and Vasiliadis 2021).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from fecolumn.case.model_sections import CRV, PodiumModel
from fecolumn.case.outline_keys import half_and_height
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.model import ModelResponse, balanced, free_times
from fecolumn.engines.rocking.podium_impact import podium_restitution
from fecolumn.engines.rocking.storeys import ElasticBuilding, storeys
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.schema import InputError
from fecolumn.motions.record import GroundMotion

_SHARE = 30  # steps in the period of the highest mode


@dataclass(frozen=True, slots=True, eq=False)
class Podium:
    """A building on a rocking storey.

    Attributes
    ----------
    slenderness
        alpha of the columns [rad]
    half_diagonal
        R [m].
    columns_mass, beam_mass
        of all columns, of the beam [kg].
    building
        on a fixed base.
    law
        of the impact, CRV or CAV.
    inertia
        of a column about its edge over m_c R^2.
    """

    TABLE: ClassVar[str] = "podium"

    slenderness: float
    half_diagonal: float
    columns_mass: float
    beam_mass: float
    building: ElasticBuilding
    law: str = CRV
    inertia: float = 4 / 3

    @classmethod
    def of_section(cls, section: PodiumModel, file: Path | str) -> Podium:
        """Podium of its table.

        Raises
        ------
        InputError
            keys that do not fit together, or columns so stout that the impact law would throw them
            back.
        """
        half, height = half_and_height(section, cls.TABLE, file)
        building = storeys(
            section.profile,
            section.storeys,
            section.floor_mass_kg,
            section.period_s or section.storeys / 10,
            section.damping_ratio,
        )
        found = cls(
            math.atan2(2 * half, height),
            math.hypot(2 * half, height) / 2,
            section.columns * section.column_mass_kg,
            section.beam_mass_kg or section.floor_mass_kg,
            building,
            section.impact,
        )
        if not found.restitution > 0:
            raise InputError(
                file,
                f"{cls.TABLE}.impact",
                section.impact,
                f"throws columns of slenderness {found.slenderness:.3g} rad back "
                f"(restitution {found.restitution:.3g}); must be CRV, or the columns "
                "more slender",
            )
        return found

    @property
    def building_mass(self) -> float:
        """M: of all floors [kg]."""
        return float(self.building.mass.sum())

    @property
    def gamma(self) -> float:
        """Mass of the beam over that of all columns."""
        return self.beam_mass / self.columns_mass

    @property
    def eta(self) -> float:
        """Mass of the building over that of the beam."""
        return self.building_mass / self.beam_mass

    @property
    def restitution(self) -> float:
        """Angular velocity of the columns after over before an impact."""
        return podium_restitution(self.law, self.slenderness, self.gamma, self.eta, self.inertia)

    @property
    def static_shear(self) -> float:
        """V_st: base shear of the building as the podium lifts off in a steady acceleration, M g
        tan alpha [N].
        """
        return self.building_mass * GRAVITY * math.tan(self.slenderness)

    @property
    def frequency(self) -> float:
        """Frequency parameter p of a column [rad/s]."""
        return math.sqrt(GRAVITY / (self.inertia * self.half_diagonal))

    @property
    def critical_tilt(self) -> float:
        """alpha: the building moves along with the beam [rad]."""
        return self.slenderness

    @property
    def critical_displacement(self) -> float:
        """Of the beam there [m]."""
        return 2 * self.half_diagonal * math.sin(self.slenderness)

    @property
    def energy_to_overturn(self) -> float:
        """That takes it there from upright [J]."""
        return self._weight * self.half_diagonal * (1 - math.cos(self.slenderness))

    @property
    def _weight(self) -> float:
        return (self.columns_mass + 2 * self.beam_mass + 2 * self.building_mass) * GRAVITY

    def shake(self, ground: Array, dt: float, tilt: float = 0.0, tilt_rate: float = 0.0) -> Any:
        """What `podium_motion.shake` returns for accelerations (n, 2) along x and up [m/s2] at
        steps dt [s].
        """
        from fecolumn.engines.rocking.podium_motion import PodiumCase, shake

        building, root = self.building, math.sqrt(self.building_mass)
        base = np.array(
            [self.slenderness, self.half_diagonal, self.inertia, self.gamma, self.eta, GRAVITY]
        )
        modes = np.array([building.omega, building.damping, building.participation / root])
        case = PodiumCase(
            base,
            modes,
            building.storey_shears / root,
            np.ascontiguousarray(building.shapes * root),
            self.restitution,
            self.law == CRV,
            2 * math.pi / building.omega[-1] / _SHARE,
        )
        return shake(np.ascontiguousarray(ground, float), dt, case, float(tilt), float(tilt_rate))

    def respond(
        self,
        motion: GroundMotion,
        *,
        free_s: float = 0.0,
        tilt: float = 0.0,
        tilt_rate: float = 0.0,
        direction: float = 0.0,
    ) -> ModelResponse:
        """As of Model; along x alone. A fall that is bound to come is followed to its end.

        The top is the roof; `peaks` have the base shear and the shear of every storey.
        """
        from fecolumn.engines.rocking.podium_motion import (
            PODIUM_DAMPED,
            PODIUM_FLOORS,
            PODIUM_GRAVITATIONAL,
            PODIUM_KINETIC,
            PODIUM_LOSS,
            PODIUM_SHEAR,
            PODIUM_STRAIN,
            PODIUM_TILT,
            PODIUM_TIME,
            PODIUM_WORK,
        )

        along = math.cos(direction)
        for longer in free_times(free_s, self.frequency):
            still = np.zeros((math.ceil(longer / motion.dt), 2))
            ground = np.concatenate([motion.acceleration[:, [0, 2]], still])
            rows, impacts, shears, peak, fallen = self.shake(
                ground, motion.dt, tilt * along, tilt_rate * along
            )
            if fallen or abs(rows[-1, PODIUM_TILT]) <= self.slenderness:
                break
        terms = {
            name: self.columns_mass * rows[:, column]
            for name, column in (
                ("kinetic", PODIUM_KINETIC),
                ("strain", PODIUM_STRAIN),
                ("gravity", PODIUM_GRAVITATIONAL),
                ("base_work", PODIUM_WORK),
                ("impact", PODIUM_LOSS),
                ("damping", PODIUM_DAMPED),
            )
        }
        theta = rows[:, PODIUM_TILT]
        beta = self.slenderness - np.abs(theta)
        beam = np.sign(theta) * 2 * self.half_diagonal * (math.sin(self.slenderness) - np.sin(beta))
        up = 2 * self.half_diagonal * (np.cos(beta) - math.cos(self.slenderness))
        shears = self.building_mass * shears
        peaks = {
            "tilt_over_alpha": peak / self.slenderness,
            "base_shear_n": float(shears[0]),
            "base_shear_over_v_st": float(shears[0] / self.static_shear),
            **{f"storey_{number}_shear_n": float(one) for number, one in enumerate(shears, 1)},
        }
        return ModelResponse(
            time=rows[:, PODIUM_TIME],
            coordinates={
                "theta": theta,
                "beam": beam,
                "base_shear": self.building_mass * rows[:, PODIUM_SHEAR],
            },
            units={"theta": "rad", "beam": "m", "base_shear": "N"},
            tilt=np.abs(theta),
            u_top=np.column_stack([rows[:, -1], np.zeros(len(rows)), up]),
            overturned=bool(fallen),
            impact_times=impacts,
            energy=balanced(**terms),
            peaks=peaks,
            floors=rows[:, PODIUM_FLOORS:],
        )

    def describe(self) -> dict[str, tuple[float, str]]:
        """Derived parameters, name to (value, unit)."""
        building = self.building
        return {
            "mass of the building": (self.building_mass, "kg"),
            "gamma": (self.gamma, "-"),
            "eta": (self.eta, "-"),
            "slenderness alpha": (self.slenderness, "rad"),
            "R": (self.half_diagonal, "m"),
            "frequency parameter p of a column": (self.frequency, "rad/s"),
            "period of mode 1": (2 * math.pi / building.omega[0], "s"),
            "period of the highest mode": (2 * math.pi / building.omega[-1], "s"),
            "effective mass of mode 1": (building.effective_mass[0], "-"),
            f"restitution ({self.law})": (self.restitution, "-"),
            "static base shear at uplift": (self.static_shear, "N"),
            "critical tilt": (self.critical_tilt, "rad"),
            "displacement of the beam there": (self.critical_displacement, "m"),
            "energy to overturn": (self.energy_to_overturn, "J"),
        }


def study_podium(profile: str, n: int, law: str) -> Podium:
    """The podium of Bantilas et al.: R = 1.5 m, tan alpha = 0.15, gamma = 10, beam as heavy as a
    floor, T_1 = n/10 s, damping 5 %.
    """
    return Podium(math.atan(0.15), 1.5, 1e4, 1e5, storeys(profile, n, 1e5, n / 10), law)
