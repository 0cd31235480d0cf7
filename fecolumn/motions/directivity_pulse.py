"""The velocity pulse of forward directivity after Mavroeidis and Papageorgiou (2003)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

# means over recorded pulses (Rupakhety et al. 2011)
MEAN_PHASE = 1.93
MEAN_GAMMA = 1.83


@dataclass(frozen=True, slots=True)
class DirectivityPulse:
    """Velocity of a cosine under a raised-cosine envelope, centred at t = 0.

    For |t| <= gamma T_p/2, and zero elsewhere,

        v(t) = A_p/2 [1 + cos(2 pi t/(gamma T_p))] cos(2 pi t/T_p + nu).

    The velocity vanishes at both ends, the acceleration too; the ground stays displaced by
    A_p T_p cos(nu) sin(pi gamma) / (2 pi (1 - gamma^2)).

    Attributes
    ----------
    velocity_amplitude
        peak velocity V_p [m/s], not the envelope's A_p.
    period
        T_p [s].
    phase
        nu [rad].
    gamma
        periods within the envelope, greater than 1.

    Raises
    ------
    ValueError
        a value outside its range.
    """

    velocity_amplitude: float
    period: float
    phase: float = MEAN_PHASE
    gamma: float = MEAN_GAMMA

    def __post_init__(self) -> None:
        if not 0 < self.velocity_amplitude < math.inf:
            raise ValueError(
                f"peak velocity V_p = {self.velocity_amplitude:g} m/s must be finite "
                "and greater than 0"
            )
        if not 0 < self.period < math.inf:
            raise ValueError(f"period T_p = {self.period:g} s must be finite and greater than 0")
        if not 1 < self.gamma < math.inf:
            raise ValueError(f"gamma = {self.gamma:g} must be finite and greater than 1")
        if not math.isfinite(self.phase):
            raise ValueError(f"phase nu = {self.phase:g} rad must be finite")

    @property
    def half_length(self) -> float:
        """Time from the start to the middle [s]."""
        return 0.5 * self.gamma * self.period

    @property
    def envelope_amplitude(self) -> float:
        """A_p [m/s], such that the largest velocity is V_p."""
        s = np.linspace(-self.gamma / 2, self.gamma / 2, 2001)
        near = s[np.argmax(np.abs(self._velocity_shape(s)))]
        best = minimize_scalar(
            lambda x: -abs(self._velocity_shape(x)),
            bounds=(near - 1e-2, near + 1e-2),
            method="bounded",
            options={"xatol": 1e-10},
        )
        return self.velocity_amplitude / -float(best.fun)

    def velocity(self, time: ArrayLike) -> NDArray[Any]:
        """Velocity at any times [m/s]."""
        s = np.asarray(time, dtype=np.float64) / self.period
        return self.envelope_amplitude * np.where(
            np.abs(s) <= self.gamma / 2, self._velocity_shape(s), 0.0
        )

    def acceleration(self, time: ArrayLike) -> NDArray[Any]:
        """Acceleration at any times [m/s2]."""
        s = np.asarray(time, dtype=np.float64) / self.period
        rate = -sum(
            weight * ratio * np.sin(2 * math.pi * ratio * s + self.phase)
            for weight, ratio in self._tones()
        )
        return (
            2
            * math.pi
            * self.envelope_amplitude
            / self.period
            * np.where(np.abs(s) <= self.gamma / 2, rate, 0.0)
        )

    def displacement(self, time: ArrayLike) -> NDArray[Any]:
        """Displacement at any times, from rest [m]."""
        s = np.clip(
            np.asarray(time, dtype=np.float64) / self.period, -self.gamma / 2, self.gamma / 2
        )
        path: NDArray[Any] = np.zeros_like(s)
        for weight, ratio in self._tones():
            start = math.sin(-math.pi * ratio * self.gamma + self.phase)
            path = path + weight / ratio * (np.sin(2 * math.pi * ratio * s + self.phase) - start)
        return self.envelope_amplitude * self.period / (2 * math.pi) * path

    def _velocity_shape(self, s: NDArray[Any]) -> NDArray[Any]:
        result: NDArray[Any] = (
            0.5 * (1 + np.cos(2 * math.pi * s / self.gamma)) * np.cos(2 * math.pi * s + self.phase)
        )
        return result

    def _tones(self) -> tuple[tuple[float, float], ...]:
        """Weight and frequency [1/T_p] of the three cosines, of one phase, whose sum the velocity
        is.
        """
        return (0.5, 1.0), (0.25, 1 + 1 / self.gamma), (0.25, 1 - 1 / self.gamma)


def scenario_pulse(magnitude: float, distance: float) -> DirectivityPulse:
    """Mean pulse of an earthquake (Rupakhety et al. 2011, as in Dimitrakopoulos and Paraskeva
    2015).

    log10 V_p = -5.17 + 1.98 min(M, 7) - 0.14 min(M, 7)^2 - 0.10 log10(R^2 + 0.562) [cm/s], log10
    T_p = -2.87 + 0.47 M.

    Parameters
    ----------
    magnitude
        moment magnitude M.
    distance
        distance R from the fault [km].
    """
    capped = min(magnitude, 7.0)
    velocity = 10 ** (
        -5.17 + 1.98 * capped - 0.14 * capped**2 - 0.10 * math.log10(distance**2 + 0.562)
    )
    return DirectivityPulse(velocity / 100, 10 ** (-2.87 + 0.47 * magnitude))
