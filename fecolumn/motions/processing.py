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
from scipy.signal import butter, firwin, resample_poly, sosfiltfilt

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


def correct_baseline(motion: GroundMotion, degree: int = 6) -> GroundMotion:
    """Motion without the drift of its displacement.

    A polynomial is fitted to the displacement from rest by least squares, with neither constant nor
    linear term, and its second derivative taken from the acceleration; degree 6 is PEER's practice
    (Ancheta et al. 2013). The motion starts at rest; how well it ends at rest is up to the record:
    see `end_at_rest`.

    Parameters
    ----------
    degree
        of the polynomial in the displacement, from 2 (constant error of the acceleration) to 10.

    Raises
    ------
    ValueError
        degree out of range, or fewer samples than it has terms.
    """
    n_steps = len(motion.acceleration)
    if degree != int(degree) or not 2 <= degree <= 10:
        raise ValueError(f"degree = {degree:g} must be a whole number in [2, 10]")
    if n_steps <= degree:
        raise ValueError(f"{n_steps} samples are too few for a polynomial of degree {degree:g}")
    # powers of t/T keep the fit well-conditioned
    s, powers = np.linspace(0, 1, n_steps), np.arange(2, degree + 1)
    _, displacement = integrate(motion)
    coefficients = np.linalg.lstsq(s[:, None] ** powers, displacement, rcond=None)[0]
    drift = (powers * (powers - 1) * s[:, None] ** (powers - 2)) @ coefficients / motion.duration**2
    return dataclasses.replace(motion, acceleration=motion.acceleration - drift)


def end_at_rest(motion: GroundMotion, displacement: float | None = 0.0) -> GroundMotion:
    """Motion whose velocity, integrated from rest by the trapezoidal rule, is zero at the end.

    Of all corrections it is the least in the mean square: a straight line over time, but for the
    first and last sample.

    Parameters
    ----------
    displacement
        at the end, in all directions [m]; None lets the ground stay where it comes to rest.

    Raises
    ------
    ValueError
        fewer than four samples.
    """
    n_steps = len(motion.acceleration)
    if n_steps < 4:
        raise ValueError(f"{n_steps} samples are too few to correct velocity and displacement")
    # what a unit of acceleration at each sample adds to the last velocity and displacement
    to_velocity = np.full(n_steps, motion.dt)
    to_velocity[[0, -1]] = 0.5 * motion.dt
    to_displacement = motion.dt**2 * np.arange(n_steps - 1.0, -1.0, -1.0)
    to_displacement[[0, -1]] = motion.dt**2 * (0.5 * n_steps - 0.75), 0.25 * motion.dt**2
    velocity, path = integrate(motion)
    effects, excess = to_velocity[None], velocity[-1:]
    if displacement is not None:
        effects, excess = (
            np.array([to_velocity, to_displacement]),
            np.array([velocity[-1], path[-1] - displacement]),
        )
    change = effects.T @ np.linalg.solve(effects @ effects.T, excess)
    return dataclasses.replace(motion, acceleration=motion.acceleration - change)


def band_pass(
    motion: GroundMotion, low: float | None, high: float | None, order: int = 4
) -> GroundMotion:
    """Motion between two frequencies: Butterworth filter run forwards and backwards, so that no
    phase is shifted.

    Zeros are put before and after the motion for the filter to swing in and out, 1.5 order/low
    seconds altogether, and kept (Boore 2005): without them velocity and displacement of the result
    would drift.

    Parameters
    ----------
    low, high
        corners, where the amplitude falls to half [Hz]; None leaves that side open.
    order
        of the filter as run twice, even; the amplitude falls as f^order below `low`.

    Raises
    ------
    ValueError
        corners out of order or above the Nyquist frequency, or an order that is not 2, 4, ... 16.
    """
    nyquist = 0.5 / motion.dt
    for name, corner in (("low", low), ("high", high)):
        if corner is not None and not 0 < corner < nyquist:
            raise ValueError(
                f"{name} = {corner:g} Hz must lie between 0 and {nyquist:g} Hz, the "
                "Nyquist frequency"
            )
    if low is not None and high is not None and low >= high:
        raise ValueError(f"low = {low:g} Hz must be less than high = {high:g} Hz")
    if order not in range(2, 17, 2):
        raise ValueError(f"order = {order:g} must be 2, 4, ... 16")
    acceleration = motion.acceleration
    if low is not None:
        pad = math.ceil(0.75 * order / low / motion.dt)
        acceleration = np.pad(acceleration, ((pad, pad), (0, 0)))
    for corner, kind in ((low, "highpass"), (high, "lowpass")):
        if corner is not None:
            sections = butter(order // 2, corner / nyquist, kind, output="sos")
            acceleration = sosfiltfilt(sections, acceleration, axis=0, padtype=None)
    return dataclasses.replace(motion, acceleration=acceleration)


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
