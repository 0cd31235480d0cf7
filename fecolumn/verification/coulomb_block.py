"""A rigid block on a shaken table under Coulomb's law, exact: slip in one direction and in two."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


class NewmarkBlock:
    """Slip under the pulse A sin(w t), 0 < w t < 2 pi, friction mu g = r (Newmark 1965).

    At rest until A sin(w t1) = r; then against the ground until t2, (A/w) (cos w t2 - cos w t1) + r
    (t2 - t1) = 0. There the ground still pulls with more than r, and the block turns round at once;
    it stops after the pulse.

    Parameters
    ----------
    amplitude, frequency, resistance
        A [m/s2], w [rad/s], r [m/s2]; A / r near 2, for which the sequence is as said.

    Attributes
    ----------
    frequency
        w [rad/s].
    stop
        end of slip [s].
    distance
        what it is off in the end [m].
    path
        all it slid [m].
    """

    def __init__(self, amplitude: float, frequency: float, resistance: float) -> None:
        A, w, r = self.amplitude, self.frequency, self.resistance = amplitude, frequency, resistance
        begin, end = np.arcsin(r / A) / w, 2 * np.pi / w
        turn = brentq(
            lambda t: A / w * (np.cos(w * t) - np.cos(w * begin)) + r * (t - begin),
            np.pi / w,
            end,
            xtol=1e-15,
        )
        if A * abs(np.sin(w * turn)) < r:
            raise ValueError("the block would rest between its two slides")
        speed = A / w * (1 - np.cos(w * turn)) - r * (end - turn)
        self.stop = end + speed / r
        self._pieces = [(begin, 0.0, 0.0, -1)]  # start, position, velocity, direction
        self._pieces.append((turn, self._slip(0, turn), 0.0, 1))
        self._pieces.append((end, self._slip(1, end), speed, 1))
        self.distance, back = self._slip(2, self.stop), self._pieces[1][1]
        self.path = self.distance - 2 * back

    def _slip(self, piece: int, t: float) -> float:
        """Displacement [m] at time t in a piece; the last has no ground motion."""
        (begin, position, speed, direction), A, w = (
            self._pieces[piece],
            self.amplitude,
            self.frequency,
        )
        past = t - begin
        driven = (
            A / w * ((np.sin(w * t) - np.sin(w * begin)) / w - np.cos(w * begin) * past)
            if piece < 2
            else 0.0
        )
        return position + speed * past + driven - direction * self.resistance * past**2 / 2

    def displacement(self, times: np.ndarray) -> np.ndarray:
        """Slip [m] at `times` [s]."""
        pieces = np.searchsorted([piece[0] for piece in self._pieces], times, side="right") - 1
        return np.array(
            [
                self._slip(piece, min(t, self.stop)) if piece >= 0 else 0.0
                for t, piece in zip(times, pieces)
            ]
        )


class TurningBlock:
    """Slip (2,) on ground that turns, a_g = A (cos w t, sin w t), from rest; friction r < A, so
    that the slip never stops.

    From rest u' = -(A - r) t e(k w t), e the unit vector of an angle and k = A / (2 A - r) from the
    transverse balance (A - r) k = A (1 - k); after a microsecond of it an explicit Runge-Kutta
    method of order 8 takes over.

    Parameters
    ----------
    amplitude, frequency, resistance
        A [m/s2], w [rad/s], r [m/s2].
    seconds
        how long.
    """

    def __init__(
        self, amplitude: float, frequency: float, resistance: float, seconds: float
    ) -> None:
        self.amplitude, self.frequency, self._first = amplitude, frequency, 1e-6

        def rate(t: float, y: np.ndarray) -> np.ndarray:
            return np.concatenate([y[2:], -self.ground(t) - resistance * y[2:] / np.hypot(*y[2:])])

        angle = amplitude / (2 * amplitude - resistance) * frequency * self._first
        speed = -(amplitude - resistance) * self._first * np.array([np.cos(angle), np.sin(angle)])
        start = np.concatenate([speed * self._first / 2, speed])
        self._path = solve_ivp(
            rate, (self._first, seconds), start, "DOP853", rtol=1e-12, atol=1e-15, dense_output=True
        ).sol

    def ground(self, t: float) -> np.ndarray:
        """Ground acceleration (2,) [m/s2]."""
        return self.amplitude * np.array([np.cos(self.frequency * t), np.sin(self.frequency * t)])

    def displacement(self, t: float) -> np.ndarray:
        """Slip (2,) [m]."""
        return self._path(max(t, self._first))[:2]

    def velocity(self, t: float) -> np.ndarray:
        """Its rate (2,) [m/s]."""
        return self._path(max(t, self._first))[2:]
