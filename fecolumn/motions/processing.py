"""Pure functions from a ground motion to the one an analysis is run with."""

from __future__ import annotations

import dataclasses
import math
import warnings
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.signal import firwin, resample_poly

from fecolumn.case.sections import GRAVITY
from fecolumn.motions.record import GroundMotion

LOST_ENERGY = 0.05
_TAPER = 0.02
# Kaiser window: 80 dB of attenuation, transition between 0.92 and 1.0 of the lower Nyquist
# frequency
_HALF_LENGTH, _CUTOFF, _KAISER_BETA = 64, 0.96, 8.0
_TIME_ERROR = 5e-4
_LONGEST = 1_000_000  # of the ratio's numbers: the filter has 128 times as many terms, a gigabyte


class AliasingWarning(UserWarning):
    """The step is too coarse for the motion: a good part of it lies above the Nyquist frequency and
    is filtered out.
    """


def rotate(motion: GroundMotion, angle_deg: float) -> GroundMotion:
    """Motion turned about z, from x towards y: at 90 degrees what was along x is along y."""
    cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    turned = np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    return dataclasses.replace(motion, acceleration=motion.acceleration @ turned)


def without_vertical(motion: GroundMotion) -> GroundMotion:
    """Motion with no acceleration along z."""
    acceleration = motion.acceleration.copy()
    acceleration[:, 2] = 0.0
    return dataclasses.replace(motion, acceleration=acceleration)


def scale(motion: GroundMotion, factor: float) -> GroundMotion:
    """Motion with its accelerations times `factor`."""
    return dataclasses.replace(motion, acceleration=motion.acceleration * factor)


def scale_time(motion: GroundMotion, factor: float) -> GroundMotion:
    """Motion with time times `factor`: accelerations stay, velocities scale by `factor`,
    displacements by its square.
    """
    return dataclasses.replace(motion, dt=motion.dt * factor)


def integrate(motion: GroundMotion) -> tuple[NDArray[Any], NDArray[Any]]:
    """Velocity [m/s] and displacement [m] from rest, (n_steps, 3) each, by the trapezoidal rule; no
    baseline correction.
    """
    velocity = cumulative_trapezoid(motion.acceleration, dx=motion.dt, axis=0, initial=0.0)
    return velocity, cumulative_trapezoid(velocity, dx=motion.dt, axis=0, initial=0.0)


def arias_intensity(motion: GroundMotion) -> NDArray[Any]:
    """Intensity pi/(2 g) int a^2 dt up to each sample (n_steps, 3) [m/s], by the trapezoidal rule
    (Arias 1970).
    """
    result: NDArray[Any] = (
        math.pi
        / (2 * GRAVITY)
        * cumulative_trapezoid(motion.acceleration**2, dx=motion.dt, axis=0, initial=0.0)
    )
    return result


def strong_part(motion: GroundMotion, fractions: tuple[float, float]) -> GroundMotion:
    """Motion between two fractions of the Arias intensity of its horizontal components together.

    The part between the fractions is kept as it is. So that it does not start with a jump, a cut
    end is led in (out) by the recorded samples before (after) it under a half cosine, 2 % of the
    part long or as long as there are samples. Cutting leaves the base with the velocity it had: see
    `integrate`.

    Parameters
    ----------
    motion
        unchanged where its horizontal components are zero.
    fractions
        two rising numbers in [0, 1]; 0 and 1 do not cut.
    """
    intensity = arias_intensity(motion)[:, :2].sum(axis=1)
    n_steps = len(intensity)
    if intensity[-1] == 0:
        return motion
    husid = intensity / intensity[-1]
    first = int(np.searchsorted(husid, fractions[0], side="right")) - 1 if fractions[0] > 0 else 0
    last = int(np.searchsorted(husid, fractions[1])) if fractions[1] < 1 else n_steps - 1
    taper = math.ceil(_TAPER * (last - first))
    start, stop = max(first - taper, 0), min(last + taper, n_steps - 1)
    window = np.ones(stop - start + 1)
    window[: first - start] = _half_cosine(first - start)
    window[len(window) - (stop - last) :] = _half_cosine(stop - last)[::-1]
    return dataclasses.replace(
        motion, acceleration=motion.acceleration[start : stop + 1] * window[:, None]
    )


def _half_cosine(n_steps: int) -> NDArray[Any]:
    """Values of a rise from 0 to 1, neither included."""
    result: NDArray[Any] = 0.5 * (1 - np.cos(math.pi * np.arange(1, n_steps + 1) / (n_steps + 1)))
    return result


def energy_above(motion: GroundMotion, frequency: float) -> float:
    """Share of the Arias intensity of all components together that lies above a frequency [Hz]."""
    power = (np.abs(np.fft.rfft(motion.acceleration, axis=0)) ** 2).sum(axis=1)
    # all bins but zero and Nyquist stand for two
    power[1 : (len(motion.acceleration) + 1) // 2] *= 2
    total = power.sum()
    return (
        float(power[np.fft.rfftfreq(len(motion.acceleration), motion.dt) > frequency].sum() / total)
        if total
        else 0.0
    )


def resample(motion: GroundMotion, dt: float) -> GroundMotion:
    """Motion sampled anew at k dt up to its end, band-limited.

    A polyphase filter (linear phase, 80 dB down from the lower of the two Nyquist frequencies on,
    flat up to 0.92 of it) interpolates, and where dt is coarser takes away what would fold back.
    The ratio of steps is a fraction so close that no sample is off by a thousandth of dt. The
    straight line between the end values is set aside before filtering and put back after, so that
    the ends do not ring. Peaks are not rescaled.

    Parameters
    ----------
    motion
        returned as it is where its step already is dt.
    dt
        new step [s].

    Raises
    ------
    ValueError
        dt is longer than the motion, or the ratio of steps is too odd.

    Warns
    -----
        AliasingWarning: more than 5 % of the Arias intensity is filtered out.
    """
    n_steps = len(motion.acceleration)
    if dt > motion.duration * (1 + 1e-9):
        raise ValueError(f"dt = {dt:g} s is longer than the motion, {motion.duration:g} s")
    ratio = _ratio(motion.dt / dt, n_steps)
    if ratio == 1:
        return dataclasses.replace(motion, dt=dt)
    lost = energy_above(motion, 0.5 / dt) if dt > motion.dt else 0.0
    if lost > LOST_ENERGY:
        warnings.warn(
            f"{motion.name}: {100 * lost:.0f} % of the Arias intensity lies above {0.5 / dt:g} Hz, "
            f"the Nyquist frequency of dt = {dt:g} s, and is filtered out",
            AliasingWarning,
            stacklevel=2,
        )
    up, down = ratio.numerator, ratio.denominator
    longer = max(up, down)
    if longer > _LONGEST:
        raise ValueError(
            f"dt = {dt:g} s has no simple ratio to the motion's step, {motion.dt:.12g} "
            "s: the filter between them would fill the memory"
        )
    low_pass = firwin(
        2 * _HALF_LENGTH * longer + 1, _CUTOFF / longer, window=("kaiser", _KAISER_BETA)
    )
    resampled = resample_poly(
        motion.acceleration, up, down, axis=0, window=low_pass, padtype="line"
    )
    return dataclasses.replace(
        motion, acceleration=resampled[: (n_steps - 1) * up // down + 1], dt=dt
    )


def join(motion: GroundMotion, dt: float) -> GroundMotion:
    """Motion at k dt up to its end on straight lines between its samples; returned as it is where
    its step already is dt.

    Parameters
    ----------
    motion
        at its own step.
    dt
        new step, not longer [s].
    """
    if math.isclose(dt, motion.dt, rel_tol=1e-9):
        return motion
    times = dt * np.arange(math.floor(motion.duration / dt * (1 + 1e-9)) + 1)
    samples = motion.dt * np.arange(len(motion.acceleration))
    return dataclasses.replace(
        motion,
        acceleration=np.column_stack([np.interp(times, samples, a) for a in motion.acceleration.T]),
        dt=dt,
    )


def delay(motion: GroundMotion, seconds: float) -> GroundMotion:
    """Motion that begins later, by any fraction of its step, after rest.

    Whole steps are zeros put before. The fraction is a turn of phases in the frequency domain,
    band-limited as `resample` is, and like there the straight line between the end values is set
    aside before and put back, moved, after.

    Parameters
    ----------
    motion
        returned as it is without a delay.
    seconds
        at least 0.
    """
    if not (math.isfinite(seconds) and seconds >= 0):
        raise ValueError(f"seconds = {seconds}: must be at least 0")
    if seconds == 0:
        return motion
    whole, fraction = divmod(seconds / motion.dt, 1.0)
    acceleration, n_steps = motion.acceleration, len(motion.acceleration)
    if fraction:
        slope = (acceleration[-1] - acceleration[0]) / (n_steps - 1)
        line = acceleration[0] + slope * np.arange(n_steps)[:, None]
        length = 2 * n_steps  # zeros, so that the end does not come round to the start
        turn = np.exp(-2j * math.pi * np.fft.rfftfreq(length, 1.0) * fraction)[:, None]
        moved = np.fft.irfft(
            np.fft.rfft(acceleration - line, length, axis=0) * turn, length, axis=0
        )[: n_steps + 1]
        # rest before the first sample and after the last
        moved[1:n_steps] += line[1:] - fraction * slope
        acceleration = moved
    return dataclasses.replace(motion, acceleration=np.pad(acceleration, ((int(whole), 0), (0, 0))))


def _ratio(ratio: float, n_steps: int) -> Fraction:
    """Simplest fraction for old over new step, off by less than half a thousandth of the new step
    at the last sample.
    """
    size = 1
    while True:
        fraction = Fraction(ratio).limit_denominator(size)
        if (
            fraction > 0
            and abs(float(fraction) - ratio) * n_steps * max(1.0, 1.0 / ratio) <= _TIME_ERROR
        ):
            return fraction
        size *= 2
