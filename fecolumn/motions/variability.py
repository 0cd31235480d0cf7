"""How the parameters of a stochastic motion vary from motion to motion, and between the components
of one motion.

Distributions, standard deviations and correlations of Dabaghi and Der Kiureghian (2018, Earthquake
Engineering and Structural Dynamics 47) for motions without a pulse, in standard normal space; the
medians are the caller's.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import beta

from fecolumn.motions.stochastic import Component

# of x and of y: ln arias, ln duration 5-95 %, ln frequency, score of the frequency slope, score of
# the damping
_DEVIATIONS = np.array([1.053, 0.398, 0.448, 0.941, 1.008, 1.028, 0.376, 0.400, 0.832, 0.888])
_CORRELATIONS = np.array(
    [
        [1.000, -0.184, 0.014, 0.203, -0.152, 0.945, -0.078, 0.092, 0.104, -0.121],
        [-0.184, 1.000, -0.015, -0.149, 0.089, -0.079, 0.848, -0.060, -0.016, 0.114],
        [0.014, -0.015, 1.000, -0.188, -0.164, 0.072, -0.081, 0.897, -0.078, -0.004],
        [0.203, -0.149, -0.188, 1.000, -0.085, 0.152, -0.028, -0.087, 0.647, -0.157],
        [-0.152, 0.089, -0.164, -0.085, 1.000, -0.110, 0.061, -0.088, -0.106, 0.761],
        [0.945, -0.079, 0.072, 0.152, -0.110, 1.000, -0.074, 0.105, 0.138, -0.107],
        [-0.078, 0.848, -0.081, -0.028, 0.061, -0.074, 1.000, -0.090, -0.050, 0.097],
        [0.092, -0.060, 0.897, -0.087, -0.088, 0.105, -0.090, 1.000, -0.184, 0.007],
        [0.104, -0.016, -0.078, 0.647, -0.106, 0.138, -0.050, -0.184, 1.000, -0.111],
        [-0.121, 0.114, -0.004, -0.157, 0.761, -0.107, 0.097, 0.007, -0.111, 1.000],
    ]
)
# frequency slope: a (right) and b (left) sided exponential with factor c, from _SLOWEST on [Hz/s]
_A, _B, _C, _SLOWEST = 14.2936, 6.4024, 4.4218, -3.5
# ln damping: beta law on [_LEAST, 0]
_DAMPING_SHAPES, _LEAST = (5.3355, 3.8295), -4.7
_PRIMES = np.array([2, 3, 5, 7, 11, 13, 17, 19, 23, 29])
_EDGE = 1e-6


def drawn(
    medians: tuple[Component, Component], seed: int, number: int
) -> tuple[Component, Component]:
    """Parameters of both components of one motion.

    The draws of successive numbers fill the probability space evenly, as the Richtmyer sequence
    with a random shift (Cranley and Patterson 1976): the medians of an ensemble of a hundred then
    stay close to those of the population. A motion's draw depends on its number and the seed, and
    not on how many motions there are.

    Parameters
    ----------
    medians
        of x and y, in this order.
    seed
        of the shift.
    number
        of the motion, from 0.
    """
    shift = np.random.Generator(
        np.random.PCG64(np.random.SeedSequence([seed, len(_PRIMES)]))
    ).random(len(_PRIMES))
    place = np.clip((shift + (number + 1) * np.sqrt(_PRIMES)) % 1.0, _EDGE, 1 - _EDGE)
    scores = (_DEVIATIONS * (np.linalg.cholesky(_CORRELATIONS) @ ndtri(place))).reshape(2, 5)
    x, y = (
        Component(
            arias_m_s=median.arias_m_s * math.exp(arias),
            duration_s=median.duration_s * math.exp(duration),
            frequency_hz=median.frequency_hz * math.exp(frequency),
            frequency_slope_hz_s=slope_of(slope + slope_score(median.frequency_slope_hz_s)),
            damping=damping_of(damping + damping_score(median.damping)),
        )
        for median, (arias, duration, frequency, slope, damping) in zip(medians, scores)
    )
    return x, y


def slope_of(score: float) -> float:
    """Frequency slope [Hz/s] of a standard normal score."""
    probability = float(ndtr(score))
    least = math.exp(_B * _SLOWEST)
    if probability <= _C / _B * (1 - least):
        return math.log(_B / _C * probability + least) / _B
    # the three published constants give a total probability of 1 but for 3e-5
    return -math.log(max(_A / _B * (1 - least) - _A / _C * probability + 1, 1e-12)) / _A


def slope_score(slope: float) -> float:
    """Standard normal score of a frequency slope [Hz/s], the inverse of slope_of."""
    least = math.exp(_B * _SLOWEST)
    below = _C / _B * (math.exp(_B * min(slope, 0.0)) - least)
    return float(ndtri(below + _C / _A * (1 - math.exp(-_A * max(slope, 0.0)))))


def damping_of(score: float) -> float:
    """Damping ratio of a standard normal score."""
    return math.exp(_LEAST * (1 - beta.ppf(ndtr(score), *_DAMPING_SHAPES)))


def damping_score(damping: float) -> float:
    """Standard normal score of a damping ratio, the inverse of damping_of."""
    return float(ndtri(beta.cdf(1 - math.log(damping) / _LEAST, *_DAMPING_SHAPES)))
