"""Free rocking of a rigid column about its rim with plastic impacts (Housner 1963), without the
slender approximation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad

from fecolumn.case.sections import GRAVITY
from fecolumn.mesh.mass import MassProperties


@dataclass(frozen=True, slots=True)
class Housner:
    """Rigid column that rocks in a plane of symmetry.

    Attributes
    ----------
    slenderness
        tilt at which the centre of mass stands over the rim, alpha [rad].
    moment
        m g R [N m].
    inertia
        I_O about the rim [kg m2].
    restitution
        angular velocity after an impact over that before [-].
    """

    slenderness: float
    moment: float
    inertia: float
    restitution: float

    def energy(self, tilt: float) -> float:
        """Energy of rest at `tilt` [rad] above that of standing [J]."""
        return self.moment * float(np.cos(self.slenderness - tilt) - np.cos(self.slenderness))

    def quarter_period(self, tilt: float) -> float:
        """Time [s] from rest at `tilt` [rad] to upright.

        Energy: th'^2 / 2 = p^2 [cos(alpha - th0) - cos(alpha - th)]; th = th0 (1 - s^2) takes the
        root's singularity out.
        """
        start, p = self.slenderness - tilt, np.sqrt(self.moment / self.inertia)

        def slowness(s):
            # cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2), which does not cancel at s = 0
            turned = tilt * s * s
            fallen = 2 * np.sin(start + turned / 2) * np.sin(turned / 2)
            return (
                2 * tilt * s / np.sqrt(2 * fallen)
                if s > 0
                else 2 * tilt / np.sqrt(2 * tilt * np.sin(start))
            )

        return float(quad(slowness, 0.0, 1.0, epsabs=1e-12)[0] / p)

    def after_impact(self, tilt: float) -> float:
        """Next peak of the tilt [rad] on the other side, after rest at `tilt` [rad] and one
        impact.
        """
        kept = self.restitution**2 * self.energy(tilt) / self.moment
        return float(self.slenderness - np.arccos(np.cos(self.slenderness) + kept))

    def impact_times(self, tilt: float, count: int) -> np.ndarray:
        """Times (count,) [s] of the impacts after release at rest from `tilt` [rad]."""
        times, time = [], 0.0
        for _ in range(count):
            quarter = self.quarter_period(tilt)
            times.append(time + quarter)
            tilt = self.after_impact(tilt)
            time = times[-1] + self.quarter_period(tilt)
        return np.array(times)


def housner(body: MassProperties, radius: float) -> Housner:
    """Rocking of a body about a rim of `radius` [m]: p^2 = m g R / I_O, r = 1 - 2 m R^2
    sin^2(alpha) / I_O.
    """
    height = float(body.centre[2])
    inertia = float(body.inertia[1, 1] + body.mass * (radius**2 + height**2))
    return Housner(
        float(np.arctan2(radius, height)),
        float(body.mass * GRAVITY * np.hypot(radius, height)),
        inertia,
        float(1 - 2 * body.mass * radius**2 / inertia),
    )
