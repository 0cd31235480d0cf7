"""A step of a podium, of which it lands or lifts off at the end, if in it.

While it stands the modes are stepped exactly, below a straight ground acceleration; else by
classical Runge-Kutta steps. Landing and lifting off are located within the step.
"""

from __future__ import annotations

from typing import NamedTuple

from fecolumn.engines.rocking.podium_equations import (
    SUMS,
    GroundPiece,
    PodiumNumbers,
    podium_push,
    podium_rates,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# what these functions are compiled with
_EQUATIONS = ("podium_equations.py",)
_TRIES = 60  # for the instant of an impact or of lifting off
_WITHIN = 1e-13  # of a step: how exactly that instant is found
_PROGRESS = 1e-6  # of a step: the least that an impact takes, so that time goes on


class PodiumRates(NamedTuple):
    """Rates (4 + 2 n,) of the states of a step: first at its begin, last at its end, between them
    those of a Runge-Kutta step.
    """

    first: Array
    second: Array
    third: Array
    fourth: Array
    last: Array


@njit(alone=_EQUATIONS, fastmath=SUMS)
def _advance(
    x: Array,
    side: float,
    podium: PodiumNumbers,
    ground: GroundPiece,
    h: float,
    rates: PodiumRates,
    out: Array,
) -> None:
    """State after a Runge-Kutta step, into out; `rates.first` are those at x."""
    first, second, third, fourth = rates.first, rates.second, rates.third, rates.fourth
    size = len(x)
    for i in range(size):
        out[i] = x[i] + 0.5 * h * first[i]
    podium_rates(out, side, podium, ground, 0.5 * h, second)
    for i in range(size):
        out[i] = x[i] + 0.5 * h * second[i]
    podium_rates(out, side, podium, ground, 0.5 * h, third)
    for i in range(size):
        out[i] = x[i] + h * third[i]
    podium_rates(out, side, podium, ground, h, fourth)
    for i in range(size):
        out[i] = x[i] + h * (first[i] + 2 * second[i] + 2 * third[i] + fourth[i]) / 6


@njit(alone=_EQUATIONS)
def stand_on(
    x: Array, podium: PodiumNumbers, free: Array, ground: GroundPiece, h: float, out: Array
) -> None:
    """State of a standing podium after a step, exact, into out; free (3, n): of `free_vibration`
    in such a step.
    """
    a, slope, shares, n = ground.along, ground.slope, podium.gamma * podium.eta, len(podium.part)
    work, damped = 0.0, 0.0
    for j in range(n):
        stiff, damping, part = podium.stiff[j], podium.damping[j], podium.part[j]
        # a straight line drives a straight line, what differs from it vibrates freely
        speed = -part * slope / stiff
        place = -(part * a + damping * speed) / stiff
        y, v = x[2 + j] - place, x[2 + n + j] - speed
        out[2 + j] = place + speed * h + free[0, j] * y + free[1, j] * v
        out[2 + n + j] = speed - stiff * free[1, j] * y + free[2, j] * v
        moved, sped = out[2 + j] - x[2 + j], out[2 + n + j] - x[2 + n + j]
        # integral of y from the equation of motion, and of a y' by parts
        area = -(part * (a + 0.5 * slope * h) * h + sped + damping * moved) / stiff
        done = -part * ((a + slope * h) * out[2 + j] - a * x[2 + j] - slope * area)
        work += done
        damped += done - 0.5 * (
            out[2 + n + j] ** 2 - x[2 + n + j] ** 2 + stiff * (out[2 + j] ** 2 - x[2 + j] ** 2)
        )
    out[0], out[1] = 0.0, 0.0
    out[2 + 2 * n], out[3 + 2 * n] = x[2 + 2 * n] + shares * work, x[3 + 2 * n] + shares * damped


@njit(alone=_EQUATIONS)
def _past(
    x: Array, side: float, podium: PodiumNumbers, ground: GroundPiece, h: float, shear: float
) -> float:
    """How far a state h [s] after the begin of a step is past landing or, of one that stands and
    has this base shear, past lifting off.
    """
    return -side * x[0] if side != 0.0 else podium_push(podium, shear, ground, h)[1]


@njit(alone=_EQUATIONS)
def _instant(
    x: Array,
    side: float,
    podium: PodiumNumbers,
    ground: GroundPiece,
    times: tuple[float, float],
    late_past: float,
    rates: PodiumRates,
    out: Array,
) -> float:
    """When in a step it lands or lifts off [s].

    Parameters
    ----------
    times
        length of the step, at whose end it is past that by `late_past`, and of a full step [s].
    """
    # false position, the end that stays counting half each time (Illinois)
    early, late, kept = 0.0, times[0], 0
    shear = podium_rates(x, side, podium, ground, 0.0, rates.second)
    early_past = _past(x, side, podium, ground, 0.0, shear)
    for _ in range(_TRIES):
        share = early_past / (early_past - late_past) if early_past < 0 else 0.5
        middle = early + share * (late - early)
        _advance(x, side, podium, ground, middle, rates, out)
        shear = podium_rates(out, side, podium, ground, middle, rates.last)
        past = _past(out, side, podium, ground, middle, shear)
        if past > 0:
            late, late_past = middle, past
            early_past *= 0.5 if kept == 1 else 1.0
            kept = 1
        else:
            early, early_past = middle, past
            late_past *= 0.5 if kept == -1 else 1.0
            kept = -1
        if late - early <= _WITHIN * times[1]:
            break
    return max(late, _PROGRESS * times[1]) if side != 0.0 else late


@njit(alone=_EQUATIONS)
def podium_step(
    x: Array,
    side: float,
    podium: PodiumNumbers,
    free: Array,
    ground: GroundPiece,
    times: tuple[float, float],
    rates: PodiumRates,
    out: Array,
) -> tuple[float, float, bool]:
    """A step, which ends where it lands or lifts off.

    Parameters
    ----------
    free
        (3, n) of `free_vibration` in a full step; (3, 0) where a mode is damped critically or more.
    times
        length of the step, and of a full one [s].
    rates
        `first`: those at x; last: made, those of the state after the step.
    out
        made: the state after the step.

    Returns
    -------
    Length of the step made [s]; base shear V/M [m/s2] and whether it lands, both at its end.
    """
    h, full = times
    if side == 0.0 and h == full and free.shape[1] > 0:
        stand_on(x, podium, free, ground, h, out)
    else:
        _advance(x, side, podium, ground, h, rates, out)
    shear = podium_rates(out, side, podium, ground, h, rates.last)
    past = _past(out, side, podium, ground, h, shear)
    if past > 0:
        h = _instant(x, side, podium, ground, times, past, rates, out)
        _advance(x, side, podium, ground, h, rates, out)
        shear = podium_rates(out, side, podium, ground, h, rates.last)
    return h, shear, past > 0 and side != 0.0
