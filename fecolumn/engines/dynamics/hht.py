"""Coefficients of the HHT-alpha time integration."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class HHT:
    """HHT-alpha method of Hilber, Hughes and Taylor (1977).

        M a1 + (1 + alpha) f(x1) - alpha f(x0) = (1 + alpha) F1 - alpha F0
        x1 = x0 + dt v0 + dt^2 [(1/2 - beta) a0 + beta a1]
        v1 = v0 + dt [(1 - gamma) a0 + gamma a1]

    Second order in dt, unconditionally stable, alpha = 0 is the trapezoidal rule. OpenSees calls 1
    + alpha "alpha".

    Parameters
    ----------
    dt
        time step [s].
    alpha
        in [-1/3, 0].
    """

    dt: float
    alpha: float

    def __post_init__(self) -> None:
        if not -1 / 3 <= self.alpha <= 0:
            raise ValueError(
                f"alpha_hht = {self.alpha}: must lie in [-1/3, 0] (OpenSees writes 1 + "
                f"alpha = {1 + self.alpha})"
            )
        if not self.dt > 0:
            raise ValueError(f"dt = {self.dt} s: must be greater than 0")

    @property
    def beta(self) -> float:
        """Share of the end in the displacement [-]."""
        return (1 - self.alpha) ** 2 / 4

    @property
    def gamma(self) -> float:
        """Share of the end in the velocity [-]."""
        return 0.5 - self.alpha

    @property
    def mass_factor(self) -> float:
        """Factor of the mass in the effective matrix, 1 / (beta dt^2) [1/s2]."""
        return 1 / (self.beta * self.dt**2)

    @property
    def rate_factor(self) -> float:
        """Velocity that a displacement of the end of the step brings, gamma / (beta dt) [1/s]."""
        return self.gamma / (self.beta * self.dt)

    @property
    def stiffness_factor(self) -> float:
        """Factor of the stiffness in the effective matrix, 1 + alpha."""
        return 1 + self.alpha
