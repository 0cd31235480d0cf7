"""Acceleration pulses of closed form: the strongest part of near-fault motions, and what
overturning spectra are made of.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from fecolumn.foundation.refused import OutOfRange
from fecolumn.foundation.version import __version__
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.record import GroundMotion

SQRT3 = math.sqrt(3.0)
# largest value of |x^3 - 3x| exp(-x^2/2), at x^2 = 3 - sqrt(6); 1.38 in Vassiliou and Makris (2011)
ANTISYMMETRIC_PEAK = (
    math.sqrt(6.0) * math.sqrt(3.0 - math.sqrt(6.0)) * math.exp(-(3.0 - math.sqrt(6.0)) / 2)
)


@dataclass(frozen=True, slots=True)
class PulseShape:
    """A pulse of unit amplitude in dimensionless time s = t/T_p.

    Attributes
    ----------
    start, end
        where the pulse begins and ends [T_p].
    acceleration, velocity, displacement
        functions of s (any shape of array) and of the cycles n, valid from start to end, zero at
        the start [a_p], [a_p T_p], [a_p T_p^2].
    source
        where it is defined.
    """

    start: Callable[[int], float]
    end: Callable[[int], float]
    acceleration: Callable[..., Any]
    velocity: Callable[..., Any]
    displacement: Callable[..., Any]
    source: str


@dataclass(frozen=True, slots=True)
class Pulse:
    """An acceleration pulse, with exact velocity and displacement.

    | shape | acceleration / a_p | residual velocity | residual displacement |
    |---|---|---|---|
    | symmetric_ricker | (1 - 2 q^2) exp(-q^2), q = pi t/T_p | 0 | 0 |
    | antisymmetric_ricker | (x^3 - 3 x) exp(-x^2/2) / 1.380, x = 2 pi t/(sqrt(3) T_p) | 0 | 0 |
    | one_sine (type A) | sin w t, one period | 0 | a_p T_p^2/(2 pi) |
    | one_cosine (type B) | cos w t, one period | 0 | 0 |
    | type_c (C_n) | cos(w t + phi), n + 1/2 - phi/pi periods | 0 | 0 |
    | half_sine | sin w t, half a period | a_p T_p/pi | grows |
    | rectangular | 1, for T_p | a_p T_p | grows |

    with w = 2 pi/T_p. Both Ricker wavelets have the peak of their Fourier amplitude at 1/T_p; they
    have no end, and are cut where what is left out is below 1e-8 of the peak. Half-sine and
    rectangular pulse leave the ground moving: they are Housner's (1963), for theory.

    Attributes
    ----------
    shape
        a key of SHAPES.
    amplitude
        a_p, the peak acceleration [m/s2]; negative turns the pulse round.
    period
        T_p [s].
    cycles
        n of type C_n, at least 1; 1 for all others.

    Raises
    ------
    ValueError
        an unknown shape, or a value outside its range.
    """

    shape: str
    amplitude: float
    period: float
    cycles: int = 1

    def __post_init__(self) -> None:
        if self.shape not in SHAPES:
            raise ValueError(f"shape = {self.shape!r} must be one of {', '.join(SHAPES)}")
        if not math.isfinite(self.amplitude) or self.amplitude == 0:
            raise OutOfRange("amplitude", self.amplitude, "be finite and not 0", "m/s2")
        if not 0 < self.period < math.inf:
            raise OutOfRange("period", self.period, "be finite and greater than 0", "s")
        if self.cycles != int(self.cycles) or self.cycles < 1:
            raise OutOfRange("cycles", self.cycles, "be at least 1, a whole number")
        if self.cycles != 1 and self.shape != "type_c":
            must = f"be 1 for {self.shape}: only type_c has cycles"
            raise OutOfRange("cycles", self.cycles, must)

    @property
    def start(self) -> float:
        """When the pulse begins [s]; negative for the Ricker wavelets, which are centred at 0."""
        return self.period * SHAPES[self.shape].start(self.cycles)

    @property
    def end(self) -> float:
        """When the pulse ends [s]."""
        return self.period * SHAPES[self.shape].end(self.cycles)

    @property
    def length_scale(self) -> float:
        """a_p T_p^2 [m], the length that measures how persistent the pulse is (Makris and Black
        2004).
        """
        return abs(self.amplitude) * self.period**2

    @property
    def residual_velocity(self) -> float:
        """Velocity the ground keeps after the pulse [m/s]."""
        return float(self.velocity(self.end))

    def acceleration(self, time: ArrayLike) -> NDArray[Any]:
        """Acceleration at any times [m/s2]."""
        shape, s = SHAPES[self.shape], np.asarray(time, dtype=np.float64) / self.period
        inside = (s >= shape.start(self.cycles)) & (s <= shape.end(self.cycles))
        return self.amplitude * np.where(inside, shape.acceleration(s, self.cycles), 0.0)

    def velocity(self, time: ArrayLike) -> NDArray[Any]:
        """Velocity at any times, from rest [m/s]."""
        shape = SHAPES[self.shape]
        s = np.clip(
            np.asarray(time, dtype=np.float64) / self.period,
            shape.start(self.cycles),
            shape.end(self.cycles),
        )
        result: NDArray[Any] = self.amplitude * self.period * shape.velocity(s, self.cycles)
        return result

    def displacement(self, time: ArrayLike) -> NDArray[Any]:
        """Displacement at any times, from rest [m]."""
        shape, time = SHAPES[self.shape], np.asarray(time, dtype=np.float64)
        s = np.clip(time / self.period, shape.start(self.cycles), shape.end(self.cycles))
        after = np.maximum(time - self.end, 0.0)
        result: NDArray[Any] = (
            self.amplitude * self.period**2 * shape.displacement(s, self.cycles)
            + self.residual_velocity * after
        )
        return result


def type_c_phase(cycles: int) -> float:
    """Phase phi of type C_n [rad], for which velocity and displacement vanish at the end: ((2n+1)
    pi/2 - phi) tan phi = 1.

    0.0697 pi for n = 1, 0.0410 pi for n = 2 (Makris and Roussos 2000).
    """
    half = (2 * cycles + 1) * math.pi / 2
    result: float = brentq(
        lambda phi: (half - phi) * math.sin(phi) - math.cos(phi), 0.0, 0.5, xtol=1e-15
    )
    return result


def sample(pulse: Pulse, dt: float, lead: float = 0.0, tail: float = 0.0) -> GroundMotion:
    """Pulse along x, sampled.

    Each sample is the mean of the acceleration under a triangle of two steps, a second difference
    of the closed-form displacement. So residual velocity and displacement are exact whatever dt and
    wherever a jump of acceleration falls. A peak is lower by the share (2 pi dt/T_p)^2/12.

    Parameters
    ----------
    dt
        step [s], at most a tenth of the period.
    lead, tail
        rest before and after the pulse [s]; one step more is always at rest.

    Raises
    ------
    ValueError
        step too coarse, or a negative rest.
    """
    if not 0 < dt <= 0.1 * pulse.period * (1 + 1e-12):
        longest = 0.1 * pulse.period
        must = f"be greater than 0 and at most {longest:g} s, a tenth of the pulse's period"
        raise OutOfRange("dt", dt, must, "s")
    for name, rest in (("lead", lead), ("tail", tail)):
        if not 0 <= rest < math.inf:
            raise OutOfRange(name, rest, "be finite and at least 0 s", "s")
    before = math.ceil(lead / dt - 1e-9) + 1
    n_steps = (
        before + math.ceil((pulse.end - pulse.start) / dt - 1e-9) + math.ceil(tail / dt - 1e-9) + 2
    )
    time = pulse.start + dt * (np.arange(-1, n_steps + 1) - before)
    acceleration = np.zeros((n_steps, 3))
    # rest is rest, without the rounding of the differences
    moves = (time[2:] > pulse.start) & (time[:-2] < pulse.end)
    acceleration[moves, 0] = np.diff(pulse.displacement(time), 2)[moves] / dt**2
    name = (
        f"{pulse.shape}{pulse.cycles if pulse.shape == 'type_c' else ''} "
        f"a_p={pulse.amplitude:g} T_p={pulse.period:g}"
    )
    return GroundMotion(acceleration, dt, name, SHAPES[pulse.shape].source)


def pulse_ensemble(
    shape: str,
    amplitudes: Sequence[float],
    periods: Sequence[float],
    dt: float,
    *,
    cycles: int = 1,
    lead: float = 0.0,
    tail: float = 0.0,
) -> Ensemble:
    """Pulses of one shape with every amplitude [m/s2] at every period [s]; other arguments as in
    Pulse and sample.
    """
    pulses = [
        Pulse(shape, float(amplitude), float(period), cycles)
        for period in periods
        for amplitude in amplitudes
    ]
    arguments = {
        "shape": shape,
        "amplitudes_m_s2": [float(a) for a in amplitudes],
        "periods_s": [float(t) for t in periods],
        "dt_s": dt,
        "cycles": cycles,
        "lead_s": lead,
        "tail_s": tail,
    }
    return Ensemble(
        name=f"{shape} pulses",
        motions=tuple(sample(pulse, dt, lead, tail) for pulse in pulses),
        parameters={
            "pulse_amplitude_m_s2": np.array([pulse.amplitude for pulse in pulses]),
            "pulse_period_s": np.array([pulse.period for pulse in pulses]),
            "pulse_length_m": np.array([pulse.length_scale for pulse in pulses]),
            "residual_velocity_m_s": np.array([pulse.residual_velocity for pulse in pulses]),
        },
        provenance={
            "model": SHAPES[shape].source,
            "version": __version__,
            "arguments": arguments,
        },
    )


def _at(value: float) -> Callable[[int], float]:
    return lambda cycles: value


def _gaussian(s: NDArray[Any]) -> NDArray[Any]:
    result: NDArray[Any] = np.exp(-((math.pi * s) ** 2))
    return result


def _antisymmetric(s: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Argument x of the wavelet and exp(-x^2/2)."""
    x = 2 * math.pi / SQRT3 * s
    return x, np.exp(-(x**2) / 2)


def _antisymmetric_acceleration(s: NDArray[Any], n: int) -> NDArray[Any]:
    x, bell = _antisymmetric(s)
    result: NDArray[Any] = (x**3 - 3 * x) * bell / ANTISYMMETRIC_PEAK
    return result


def _antisymmetric_velocity(s: NDArray[Any], n: int) -> NDArray[Any]:
    x, bell = _antisymmetric(s)
    result: NDArray[Any] = -(x**2 - 1) * bell / ANTISYMMETRIC_PEAK * SQRT3 / (2 * math.pi)
    return result


def _antisymmetric_displacement(s: NDArray[Any], n: int) -> NDArray[Any]:
    x, bell = _antisymmetric(s)
    result: NDArray[Any] = x * bell / ANTISYMMETRIC_PEAK * 3 / (4 * math.pi**2)
    return result


def _type_c_displacement(s: NDArray[Any], n: int) -> NDArray[Any]:
    phase, turn = type_c_phase(n), 2 * math.pi * s
    result: NDArray[Any] = (math.cos(phase) - np.cos(turn + phase) - turn * math.sin(phase)) / (
        4 * math.pi**2
    )
    return result


_TURN = 2 * math.pi
_RICKER = "Ricker (1943) wavelet as in Vassiliou and Makris (2011)"
_CYCLOID = "cycloidal pulse of Makris and Roussos (2000)"
_ONE_SINE = PulseShape(
    _at(0.0),
    _at(1.0),
    lambda s, n: np.sin(_TURN * s),
    lambda s, n: (1 - np.cos(_TURN * s)) / _TURN,
    lambda s, n: (s - np.sin(_TURN * s) / _TURN) / _TURN,
    _CYCLOID,
)
SHAPES = {
    "symmetric_ricker": PulseShape(
        _at(-1.6),
        _at(1.6),
        lambda s, n: (1 - 2 * (math.pi * s) ** 2) * _gaussian(s),
        lambda s, n: s * _gaussian(s),
        lambda s, n: -_gaussian(s) / (2 * math.pi**2),
        _RICKER,
    ),
    "antisymmetric_ricker": PulseShape(
        _at(-2.0),
        _at(2.0),
        _antisymmetric_acceleration,
        _antisymmetric_velocity,
        _antisymmetric_displacement,
        _RICKER,
    ),
    "one_sine": _ONE_SINE,
    "one_cosine": PulseShape(
        _at(0.0),
        _at(1.0),
        lambda s, n: np.cos(_TURN * s),
        lambda s, n: np.sin(_TURN * s) / _TURN,
        lambda s, n: (1 - np.cos(_TURN * s)) / _TURN**2,
        _CYCLOID,
    ),
    "type_c": PulseShape(
        _at(0.0),
        lambda n: n + 0.5 - type_c_phase(n) / math.pi,
        lambda s, n: np.cos(_TURN * s + type_c_phase(n)),
        lambda s, n: (np.sin(_TURN * s + type_c_phase(n)) - math.sin(type_c_phase(n))) / _TURN,
        _type_c_displacement,
        _CYCLOID,
    ),
    "half_sine": dataclasses.replace(_ONE_SINE, end=_at(0.5), source="pulse of Housner (1963)"),
    "rectangular": PulseShape(
        _at(0.0),
        _at(1.0),
        lambda s, n: np.ones_like(s),
        lambda s, n: s,
        lambda s, n: s**2 / 2,
        "pulse of Housner (1963)",
    ),
}
