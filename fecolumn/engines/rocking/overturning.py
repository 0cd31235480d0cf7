"""Which pulses overturn a block: spectra of the least acceleration, islands and safe gaps, closed
forms (Makris 2014 and what he reviews).

Everything is dimensionless: frequency w_p/p, amplitude a_p/(g tan alpha).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.swing import rock_all
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.engines.rocking.swing_motion import IMPACT_COUNT, PEAK_TILT
from fecolumn.foundation.arrays import Array
from fecolumn.motions.pulses import Pulse

#: Coefficients of a_p/(g tan alpha) = 1 + beta w_p/p (Makris and Roussos 1998), and gamma of tan
#: alpha = (a_p/g) p T_p/(gamma + p T_p).
LINEAR = {"one_sine": 1 / 6, "type_c": 1 / 6, "one_cosine": 1 / 4}
DESIGN = {"rectangular": 1.0, "one_sine": math.pi / 3, "one_cosine": math.pi / 2}
# Samples of a pulse in its period: the law sees straight lines between them, off by (2 pi/n)^2/12
_SAMPLES = 600
_ROUNDS = 24  # of bisection: 2^-24 of a step of the grid


@dataclass(frozen=True, slots=True)
class Band:
    """Amplitudes that overturn alike.

    Attributes
    ----------
    low, high
        of a_p/(g tan alpha); high is inf where the band leaves the range looked at.
    impacts
        before overturning.
    """

    low: float
    high: float
    impacts: int


def pulse_outcomes(
    shape: str,
    frequency: float,
    amplitudes: ArrayLike,
    slenderness: float,
    restitution: float | None = None,
) -> Array:
    """Impacts before the block overturns, -1 where it stays (n,), for amplitudes a_p/(g tan alpha)
    (n,) of a pulse of frequency w_p/p.
    """
    kept = housner_restitution(slenderness) if restitution is None else restitution
    ground, step = _unit_pulse(shape, frequency)
    sizes = np.atleast_1d(np.asarray(amplitudes, float))
    found = rock_all(
        [ground],
        step,
        np.zeros(len(sizes), int),
        sizes * GRAVITY * math.tan(slenderness),
        row_of_block(slenderness, 1.0, kept)[None],
    )
    return np.where(np.isinf(found[:, PEAK_TILT]), found[:, IMPACT_COUNT], -1).astype(int)


def _unit_pulse(shape: str, frequency: float) -> tuple[Array, float]:
    """Samples (n, 2) along x and z of a pulse of amplitude 1, and their step in units of 1/p."""
    pulse = Pulse(shape, 1.0, 2 * math.pi / frequency)
    count = math.ceil(_SAMPLES * (pulse.end - pulse.start) / pulse.period)
    step = (pulse.end - pulse.start) / count
    return np.column_stack(
        [pulse.acceleration(pulse.start + step * np.arange(count + 1)), np.zeros(count + 1)]
    ), step


def overturning_bands(
    shape: str,
    frequency: float,
    slenderness: float,
    *,
    lowest: float = 1.0,
    highest: float = 14.0,
    points: int = 1301,
    restitution: float | None = None,
) -> list[Band]:
    """Bands of amplitude that overturn a block, from low to high; between them it stays: islands
    and safe gaps.

    Bands narrower than a step of the grid of `points` amplitudes may be missed.

    Parameters
    ----------
    shape
        of motions.pulses.SHAPES.
    frequency
        w_p/p.
    slenderness
        alpha [rad].
    restitution
        None for a rectangular block's.
    """
    grid = np.geomspace(lowest, highest, points)
    found = pulse_outcomes(shape, frequency, grid, slenderness, restitution)
    edges = np.flatnonzero(found[1:] != found[:-1])
    low, high, left, right = grid[edges], grid[edges + 1], found[edges], found[edges + 1]
    for _ in range(_ROUNDS if len(edges) else 0):
        middle = (low + high) / 2
        now = pulse_outcomes(shape, frequency, middle, slenderness, restitution)
        below = now == left
        low, high, right = (
            np.where(below, middle, low),
            np.where(below, high, middle),
            np.where(below, right, now),
        )
    bands, start = [], (lowest, int(found[0]))
    for bound, after in [*zip((low + high) / 2, found[edges + 1]), (math.inf, -1)]:
        if start[1] >= 0:
            bands.append(Band(float(start[0]), float(bound), start[1]))
        start = bound, int(after)
    return bands


def half_sine_overturning(frequency: float) -> float:
    """a_p/(g tan alpha) of the half-sine pulse that just overturns a slender block without impact;
    the pulse starts where it lifts the block.

    (w/p) sin psi - cos psi = exp(-(p/w) (pi - psi)), a_p = g tan(alpha)/sin psi (Shi, Anooshehpoor,
    Zeng and Brune 1996). frequency: w_p/p.
    """
    return 1 / math.sin(half_sine_phase(frequency))


def half_sine_phase(frequency: float) -> float:
    """Psi of `half_sine_overturning` [rad]."""
    phase: float = brentq(
        lambda psi: (
            frequency * math.sin(psi) - math.cos(psi) - math.exp(-(math.pi - psi) / frequency)
        ),
        1e-9,
        math.pi / 2,
        xtol=1e-14,
    )
    return phase


def linear_overturning(shape: str, frequency: ArrayLike) -> Array:
    """a_p/(g tan alpha) = 1 + beta w_p/p, for w_p/p <= pi: a line through computed spectra, not a
    bound.

    At alpha = 10 degrees the one-sine pulse overturns at 6 to 9 % less. Source: Makris and Roussos
    (1998).
    """
    least: Array = 1 + LINEAR[shape] * np.asarray(frequency, float)
    return least


def rectangular_slenderness(duration: ArrayLike) -> Array:
    """Factor phi of the least tan(alpha) = phi a_p / g with which a slender block stands a
    rectangular pulse: 1 - exp(-p T_p), exact (Housner 1963).

    Housner's cosh(p T_p) = 1 + 1/(2 r (r - 1)) is the same, r = 1/phi = a_p / (g tan(alpha)). A
    block that just overturns has the tilt alpha - theta'/p at the end of the pulse. All computed
    one-sine and one-cosine pulses of `benchmarks.rocking.design` need less, of equal a_p and T_p.

    Parameters
    ----------
    duration
        (...,) or one number, p T_p [-]: frequency parameter p of the block [rad/s] times duration
        T_p of the pulse [s].

    Returns
    -------
    phi [-], in the shape of `duration`.
    """
    factor: Array = -np.expm1(-np.asarray(duration, float))
    return factor


def slenderness_factor(duration: ArrayLike, pulse: str = "rectangular") -> Array:
    """First estimate of the factor phi by which a block has to be slender to survive a pulse, by
    the formula of Makris and Vassiliou (2012).

    The least tan(alpha) is estimated as phi a_p / g. Here alpha is the slenderness angle of a
    slender block on rigid ground [rad], a_p the amplitude of the ground acceleration [m/s2] and g
    gravity. The factor is phi = p T_p / (gamma + p T_p): 0 for a very short pulse, 1 for a very
    long one. It leaves out the tilt that the block has at the end of the pulse: under a rectangular
    pulse a block of this slenderness falls, see `rectangular_slenderness`.

    Parameters
    ----------
    duration
        (...,) or one number, p T_p [-]: frequency parameter p of the block [rad/s] times duration
        T_p of the pulse [s].
    pulse
        shape of the pulse, one of DESIGN, which has its gamma [-]. "rectangular" has the smallest
        gamma, so that its phi is the largest.

    Returns
    -------
    phi [-], in the shape of `duration`.
    """
    factor: Array = np.asarray(duration, float) / (DESIGN[pulse] + np.asarray(duration, float))
    return factor


def critical_tilt_rate(slenderness: float) -> float:
    """Tilt velocity over p that takes a block from upright to the critical tilt:
    sqrt(2 (1 - cos alpha)), alpha where it is slender (Eq. 39 of Makris 2014).
    """
    return math.sqrt(2 * (1 - math.cos(slenderness)))
