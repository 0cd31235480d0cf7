"""Baseline and band-pass of a record, as processed records have had them."""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.signal import butter, sosfiltfilt

from fecolumn.motions.processing import integrate
from fecolumn.motions.record import GroundMotion

# Of the record's length: each end that rises from, or falls to, rest by half a cosine
_TAPER = 0.05
# Periods of the high-pass corner by which a record is lengthened at either end before it is
# filtered without shift of phase; Boore and Bommer (2005) take 1.5 n of each for order n
_PAD = 1.5


class WrongCorner(ValueError):
    """A corner of a filter that a record does not allow.

    Attributes
    ----------
    key, value, allowed
        "high_pass" or "low_pass", the corner [Hz], and what it must be.
    """

    def __init__(self, key: str, value: float, allowed: str) -> None:
        super().__init__(f"{key} = {value:g} Hz: {allowed}")
        self.key, self.value, self.allowed = key, value, allowed


def corrected(
    motion: GroundMotion, high_pass: float, low_pass: float, order: int = 4, degree: int = 1
) -> GroundMotion:
    """A record without drift: polynomial baseline taken off, ends tapered, band-pass forwards and
    backwards (Butterworth, acausal), as Boore and Bommer (2005) advise; scipy.signal filters.

    What the padding holds of the filter is kept: the motion is longer by it at either end, so that
    its integrals begin and end at rest.

    Parameters
    ----------
    high_pass
        corner below which it is taken out [Hz]; 0 leaves all.
    low_pass
        corner above which it is taken out [Hz]; 0 leaves all.
    order
        of the filter, applied twice.
    degree
        of the polynomial fitted to the acceleration; -1 takes none off.

    Raises
    ------
    WrongCorner
        corners beyond half of the sampling frequency or in wrong order, or a record too short for
        them.
    """
    nyquist, once = 0.5 / motion.dt, 1 / motion.duration
    half = f"below {nyquist:g} Hz, half of the sampling frequency"
    if low_pass and not low_pass < nyquist:
        raise WrongCorner("low_pass", low_pass, f"must be {half}")
    if high_pass and not once <= high_pass < nyquist:
        least = f"at least {once:.3g} Hz, one period in the record, and {half}"
        raise WrongCorner("high_pass", high_pass, f"must be 0 or {least}")
    if low_pass and not high_pass < low_pass:
        raise WrongCorner("high_pass", high_pass, f"must be below the low-pass {low_pass:g} Hz")
    acceleration, time = motion.acceleration.copy(), np.linspace(-1, 1, len(motion.acceleration))
    moving = [axis for axis in range(3) if acceleration[:, axis].any()]
    for axis in moving:
        if degree >= 0:
            powers = time[:, None] ** np.arange(degree + 1)
            fitted = np.linalg.lstsq(powers, acceleration[:, axis], rcond=None)[0]
            acceleration[:, axis] -= powers @ fitted
    count = int(_TAPER * len(acceleration))
    rise = 0.5 * (1 - np.cos(np.pi * np.arange(count) / max(count, 1)))[:, None]
    acceleration[:count] *= rise
    acceleration[len(acceleration) - count :] *= rise[::-1]
    if high_pass or low_pass:
        corners = [one for one in (high_pass, low_pass) if one]
        kind = "bandpass" if len(corners) == 2 else "highpass" if high_pass else "lowpass"
        pad = int(np.ceil(_PAD * order / corners[0] / motion.dt / 2)) if high_pass else 0
        acceleration = np.pad(acceleration, ((pad, pad), (0, 0)))
        band = corners if len(corners) == 2 else corners[0]
        sections = butter(order, band, kind, fs=1 / motion.dt, output="sos")
        for axis in moving:
            acceleration[:, axis] = sosfiltfilt(sections, acceleration[:, axis], padtype=None)
    source = f"{motion.source}; corrected: degree {degree}, {high_pass:g} to {low_pass:g} Hz"
    return dataclasses.replace(motion, acceleration=acceleration, source=source)


def end_of(motion: GroundMotion) -> tuple[float, float]:
    """Speed [m/s] and distance [m] at the end, integrated from rest, the largest of all axes."""
    velocity, displacement = integrate(motion)
    return float(np.abs(velocity[-1]).max()), float(np.abs(displacement[-1]).max())
