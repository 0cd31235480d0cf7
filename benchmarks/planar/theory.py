"""Closed forms of rigid blocks that rock without sliding, in the plane (Housner 1963; Makris and
Vassiliou 2013). SI units, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit

from benchmarks.planar.bodies import GRAVITY


@dataclass(frozen=True)
class Rocker:
    """A block that turns about one of two pivots.

    Attributes
    ----------
    alpha
        slenderness towards +x and towards -x (2,) [rad].
    p
        frequency parameters (2,) [1/s].
    kept
        rate after over before an impact (2,), from turning towards +x and towards -x.
    """

    alpha: tuple[float, float]
    p: tuple[float, float]
    kept: tuple[float, float]

    def uplift(self, side: int = 0) -> float:
        """Acceleration [m/s2] of the ground at which it lifts and turns towards +x (side 0; the
        ground goes towards -x) or -x (1).
        """
        return GRAVITY * math.tan(self.alpha[side])

    def quarter_period(self, tilt: float, side: int = 0) -> float:
        """Time [s] from rest at a tilt [rad] to the impact: the exact swing of the inverted
        pendulum, by quadrature.
        """
        alpha, p = self.alpha[side], self.p[side]
        # the substitution tilt (1 - s^2) takes the pole at rest away
        s, weights = np.polynomial.legendre.leggauss(60)
        s, weights = (s + 1) / 2, weights / 2
        at = tilt * (1 - s**2)
        speed = p * np.sqrt(2 * (np.cos(alpha - tilt) - np.cos(alpha - at)))
        return float(weights @ (2 * tilt * s / speed))

    def rate(self, tilt: float, side: int = 0, now: float = 0.0) -> float:
        """Angular velocity [rad/s] upright, before or after the impact, of a motion that at a tilt
        [rad] turns by `now` [rad/s]: conservation of energy.
        """
        alpha, p = self.alpha[side], self.p[side]
        return math.sqrt(now**2 + 2 * p**2 * (math.cos(alpha - tilt) - math.cos(alpha)))

    def shaken(self, ground: np.ndarray, dt: float, parts: int = 4) -> np.ndarray:
        """Tilt (n + 1,) [rad], positive towards +x, under accelerations (n + 1,) [m/s2] at steps of
        dt [s], each in so many parts.
        """
        return _shaken(
            np.array(self.alpha),
            np.array(self.p),
            np.array(self.kept),
            np.ascontiguousarray(ground, float),
            dt,
            parts,
        )


def displaced_block(width: float, height: float, d: float = 0.0) -> Rocker:
    """A block on an equal one, displaced by d >= 0 [m] towards +x: towards +x it turns about the
    edge below, an arm of width / 2 - d; d = 0: on the ground.
    """
    h, arms = height / 2, (width / 2 - d, width / 2)
    r2 = [arm**2 + h**2 for arm in arms]
    central = (width**2 + height**2) / 12
    # angular momentum about the pivot to come, per mass, over the rate before: I + the part of the
    # path of the centre across the new arm
    kept = [
        (central + h**2 - old * new) / (central + new**2 + h**2) for old, new in (arms, arms[::-1])
    ]
    return Rocker(
        tuple(math.atan2(arm, h) for arm in arms),
        tuple(math.sqrt(GRAVITY * math.sqrt(r) / (central + r)) for r in r2),
        tuple(kept),
    )


def equivalent_block(column, gamma: float) -> Rocker:
    """The frame of columns (width, height) and a beam of gamma times their mass."""
    width, height = column
    alpha, r = math.atan2(width, height), math.hypot(width, height) / 2
    p = math.sqrt(0.75 * GRAVITY / r * (1 + 2 * gamma) / (1 + 3 * gamma))
    kept = (1 - 1.5 * math.sin(alpha) ** 2 + 3 * gamma * math.cos(2 * alpha)) / (1 + 3 * gamma)
    return Rocker((alpha, alpha), (p, p), (kept, kept))


@njit(cache=True)
def _pull(alpha, p, side, tilt, a):
    """Angular acceleration [1/s2] at a tilt >= 0 towards a side (0: +x, 1: -x) under the ground's
    acceleration a.
    """
    outwards = -a if side == 0 else a
    return p[side] ** 2 * (
        -np.sin(alpha[side] - tilt) + outwards / GRAVITY * np.cos(alpha[side] - tilt)
    )


@njit(cache=True)
def _shaken(alpha, p, kept, ground, dt, parts):
    """Runge and Kutta's steps; an impact is found on the cubic of its step to its end, one a
    step.
    """
    found, side, tilt, rate, h = np.zeros(len(ground)), -1, 0.0, 0.0, dt / parts
    for k in range(len(ground) - 1):
        for part in range(parts):
            first = ground[k] + (ground[k + 1] - ground[k]) * part / parts
            last = ground[k] + (ground[k + 1] - ground[k]) * (part + 1) / parts
            left = h
            if side < 0:
                for s in range(2):
                    if _pull(alpha, p, s, 0.0, last) > 0.0:
                        side = s
                if side < 0:
                    continue
            for _ in range(3):  # until an impact, and after it
                begin = last + (first - last) * left / h
                new_tilt, new_rate = _runge_kutta(alpha, p, side, tilt, rate, begin, last, left)
                if new_tilt >= 0.0:
                    tilt, rate = new_tilt, new_rate
                    break
                low, high = 0.0, left
                for _ in range(60):
                    middle = (low + high) / 2
                    if (
                        _runge_kutta(
                            alpha,
                            p,
                            side,
                            tilt,
                            rate,
                            begin,
                            begin + (last - begin) * middle / left,
                            middle,
                        )[0]
                        >= 0.0
                    ):
                        low = middle
                    else:
                        high = middle
                rate = _runge_kutta(
                    alpha, p, side, tilt, rate, begin, begin + (last - begin) * high / left, high
                )[1]
                left -= high
                rate, tilt, side = -rate * kept[side], 0.0, 1 - side
                if rate < 1e-9:
                    side, rate = -1, 0.0
                    break
        found[k + 1] = tilt if side == 0 else -tilt
        if tilt > np.pi / 4:
            return found[: k + 2]
    return found


@njit(cache=True)
def _runge_kutta(alpha, p, side, tilt, rate, a, b, h):
    """Tilt and rate after h [s] under an acceleration from a to b."""
    k1, l1 = rate, _pull(alpha, p, side, tilt, a)
    k2, l2 = rate + h / 2 * l1, _pull(alpha, p, side, tilt + h / 2 * k1, (a + b) / 2)
    k3, l3 = rate + h / 2 * l2, _pull(alpha, p, side, tilt + h / 2 * k2, (a + b) / 2)
    k4, l4 = rate + h * l3, _pull(alpha, p, side, tilt + h * k3, b)
    return tilt + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), rate + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
