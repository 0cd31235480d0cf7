"""Near-fault motions: a coherent velocity pulse over a stochastic high-frequency part (Mavroeidis
and Papageorgiou 2003).

The recipe of the podium study of Bantilas et al.; where it is silent:
- Noise is normalised to unit root mean square of its Fourier amplitude (Boore 2003), so the mean
    square is the target's.
- The stochastic amplitude is lowered by the pulse's, frequency by frequency, and is zero where the
    pulse's is larger.
- The middle of the pulse falls on the peak of the noise's window.
- What is left of the stochastic part below the pulse's band is filtered out (low cut, zero phase),
    and its displacement is
  led in from and out to zero, so that it starts and ends at rest; at the end the ground is
      displaced by the pulse alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import next_fast_len

from fecolumn.foundation.refused import OutOfRange
from fecolumn.foundation.version import __version__
from fecolumn.motions.atkinson_silva import duration, fourier_amplitude
from fecolumn.motions.directivity_pulse import DirectivityPulse, scenario_pulse
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.record import GroundMotion

MAGNITUDES = (5.5, 6.0, 6.5, 7.0, 7.5)
DISTANCES = (5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0)
LOW_CUT = 0.1
SOURCE = (
    "synthetic: Mavroeidis and Papageorgiou (2003) pulse, Atkinson and Silva (2000) stochastic part"
)
_WINDOW_PEAK, _WINDOW_END, _WINDOW_LENGTH = 0.2, 0.05, 2.0
_NOISE_LENGTH = 1.25


@dataclass(frozen=True, slots=True)
class Scenario:
    """An earthquake as a site near its fault meets it.

    Attributes
    ----------
    magnitude
        moment magnitude, from 4 to 8.
    distance
        from the fault [km], from 0 to 40.

    Raises
    ------
    ValueError
        a value outside its range.
    """

    magnitude: float
    distance: float

    def __post_init__(self) -> None:
        if not 4 <= self.magnitude <= 8:
            raise OutOfRange("magnitude", self.magnitude, "lie in [4, 8]")
        if not 0 <= self.distance <= 40:
            raise OutOfRange("distance", self.distance, "lie in [0, 40] km", "km")

    @property
    def pulse(self) -> DirectivityPulse:
        """The scenario's mean pulse."""
        return scenario_pulse(self.magnitude, self.distance)

    @property
    def low_cut(self) -> float:
        """Corner of the low cut [Hz]: 0.1 Hz, or the lower end of the pulse's band, 0.45/T_p, if
        that is less.
        """
        pulse = self.pulse
        return min(LOW_CUT, (1 - 1 / pulse.gamma) / pulse.period)


def saragoni_hart_window(time: ArrayLike, length: float) -> NDArray[Any]:
    """Envelope a (t/L)^b exp(-c t/L): 1 at t = 0.2 L, 0.05 at L, 0 before t = 0 (Saragoni and Hart
    1974; Boore 2003).
    """
    eps, eta = _WINDOW_PEAK, _WINDOW_END
    b = -eps * math.log(eta) / (1 + eps * (math.log(eps) - 1))
    relative = np.maximum(np.asarray(time, dtype=np.float64), 0.0) / length
    result: NDArray[Any] = (relative / eps) ** b * np.exp(b * (1 - relative / eps))
    return result


def stochastic_spectra(
    scenario: Scenario,
    generators: Iterable[np.random.Generator],
    dt: float,
    n_steps: int,
    start: float,
) -> NDArray[Any]:
    """Fourier transforms int a exp(-2 pi i f t) dt of windowed noise shaped to Atkinson and Silva's
    amplitude.

    Parameters
    ----------
    scenario
        magnitude and distance.
    generators
        n_motions random generators, one a motion.
    dt, n_steps
        step [s] and number of samples of the motion.
    start
        when the noise begins [s].

    Returns
    -------
    (n_motions, n_steps // 2 + 1) complex [m/s], at numpy.fft.rfftfreq(n_steps, dt).
    """
    length = _WINDOW_LENGTH * duration(scenario.magnitude, scenario.distance)
    time = np.arange(n_steps) * dt - start
    window = np.where(time <= _NOISE_LENGTH * length, saragoni_hart_window(time, length), 0.0)
    noise = np.fft.rfft(
        np.array([generator.standard_normal(n_steps) for generator in generators]) * window, axis=1
    )
    noise /= np.sqrt((np.abs(noise[:, 1:]) ** 2).mean(axis=1, keepdims=True))
    result: NDArray[Any] = noise * fourier_amplitude(
        np.fft.rfftfreq(n_steps, dt), scenario.magnitude, scenario.distance
    )
    return result


def near_fault_motions(
    scenario: Scenario,
    generators: Iterable[np.random.Generator],
    dt: float,
    *,
    fault_parallel: bool = False,
) -> list[GroundMotion]:
    """One motion for each random generator, the fault-normal component along x.

    Parameters
    ----------
    scenario
        magnitude and distance.
    generators
        random generators, one a motion.
    dt
        step [s], at most 0.02.
    fault_parallel
        adds a stochastic part of its own, without a pulse, along y; otherwise y is at rest.

    Raises
    ------
    ValueError
        step too coarse.
    """
    if not 0 < dt <= 0.02:
        must = "be greater than 0 and at most 0.02 s, as the motion reaches 25 Hz and more"
        raise OutOfRange("dt", dt, must, "s")
    pulse, margin = scenario.pulse, 1 / scenario.low_cut
    length = _WINDOW_LENGTH * duration(scenario.magnitude, scenario.distance)
    middle = margin + max(_WINDOW_PEAK * length, pulse.half_length)
    start = middle - _WINDOW_PEAK * length
    total = max(start + _NOISE_LENGTH * length, middle + pulse.half_length) + margin
    n_steps = 2 * next_fast_len(math.ceil(total / dt / 2) + 1, real=True)
    # second differences keep the pulse's residual velocity and displacement exact
    pulse_acceleration = (
        np.diff(pulse.displacement(np.arange(-1, n_steps + 1) * dt - middle), 2) / dt**2
    )
    lowered = np.abs(np.fft.rfft(pulse_acceleration)) * dt
    normal = (
        _back(
            stochastic_spectra(scenario, generators, dt, n_steps, start),
            lowered,
            scenario.low_cut,
            dt,
        )
        + pulse_acceleration
    )
    parallel = np.zeros_like(normal)
    if fault_parallel:
        parallel = _back(
            stochastic_spectra(scenario, generators, dt, n_steps, start), 0.0, scenario.low_cut, dt
        )
    return [
        GroundMotion(
            np.column_stack([x, y, np.zeros(n_steps)]),
            dt,
            f"M{scenario.magnitude:g} R{scenario.distance:g} {number}",
            SOURCE,
        )
        for number, (x, y) in enumerate(zip(normal, parallel), 1)
    ]


def near_fault_ensemble(
    magnitudes: Sequence[float] = MAGNITUDES,
    distances: Sequence[float] = DISTANCES,
    count: int = 100,
    *,
    seed: int = 1,
    dt: float = 0.01,
    fault_parallel: bool = False,
) -> Ensemble:
    """Motions for every magnitude at every distance [km], `count` each; the defaults are the podium
    study's grid.

    A motion depends on seed, magnitude, distance and its number only, not on what else is made.
    """
    if count != int(count) or count < 1:
        raise OutOfRange("count", count, "be at least 1, a whole number")
    if seed != int(seed) or seed < 0:
        raise OutOfRange("seed", seed, "be at least 0, a whole number")
    scenarios = [
        Scenario(float(magnitude), float(distance))
        for magnitude in magnitudes
        for distance in distances
    ]
    motions = []
    for scenario in scenarios:
        keys = [round(1000 * scenario.magnitude), round(1000 * scenario.distance)]
        generators = [np.random.default_rng([seed, *keys, number]) for number in range(count)]
        motions += near_fault_motions(scenario, generators, dt, fault_parallel=fault_parallel)
    columns: dict[str, Callable[[Scenario], float]] = {
        "magnitude": lambda s: s.magnitude,
        "distance_km": lambda s: s.distance,
        "pulse_period_s": lambda s: s.pulse.period,
        "pulse_velocity_m_s": lambda s: s.pulse.velocity_amplitude,
        "low_cut_hz": lambda s: s.low_cut,
    }
    parameters = {
        name: np.repeat([value(scenario) for scenario in scenarios], count)
        for name, value in columns.items()
    }
    arguments = {
        "magnitudes": [float(m) for m in magnitudes],
        "distances_km": [float(d) for d in distances],
        "count": count,
        "dt_s": dt,
        "fault_parallel": fault_parallel,
    }
    return Ensemble(
        "near-fault synthetics",
        tuple(motions),
        parameters,
        {
            "model": SOURCE,
            "version": __version__,
            "seed": int(seed),
            "arguments": arguments,
        },
    )


def _back(
    spectra: NDArray[Any], lowered: float | NDArray[Any], low_cut: float, dt: float
) -> NDArray[Any]:
    """Accelerations of lowered spectra, filtered, starting and ending at rest without
    displacement.
    """
    n_steps = 2 * (spectra.shape[1] - 1)
    omega = 2 * math.pi * np.fft.rfftfreq(n_steps, dt)
    amplitude = np.abs(spectra)
    with np.errstate(divide="ignore", invalid="ignore"):
        kept = np.where(amplitude > lowered, 1 - lowered / amplitude, 0.0)
        kept *= np.where(omega > 0, 1 / (1 + (2 * math.pi * low_cut / omega) ** 4), 0.0)
        spectra = spectra * kept / dt
        # integrated in the frequency domain: no drift can arise
        displacement = np.fft.irfft(np.where(omega > 0, -spectra / omega**2, 0.0), n_steps, axis=1)
        velocity = np.fft.irfft(np.where(omega > 0, spectra / (1j * omega), 0.0), n_steps, axis=1)
    acceleration = np.fft.irfft(spectra, n_steps, axis=1)
    margin = round(1 / low_cut / dt)
    s = np.clip(np.arange(n_steps) / margin, 0, 1)
    rise, slope, bend = (
        10 * s**3 - 15 * s**4 + 6 * s**5,
        30 * s**2 * (1 - s) ** 2,
        60 * s * (1 - s) * (1 - 2 * s),
    )
    window = rise * rise[::-1]
    window_rate = (slope - slope[::-1]) / (margin * dt)
    window_bend = (bend + bend[::-1]) / (margin * dt) ** 2
    result: NDArray[Any] = (
        window * acceleration + 2 * window_rate * velocity + window_bend * displacement
    )
    return result
