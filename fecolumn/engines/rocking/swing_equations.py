"""Motion of a rigid structure that rocks in a plane with one degree of freedom: its parameters,
restoring moment, potential and equation of motion.

It leans by phi >= 0 about its edge on side s = +1 or -1; theta = s phi is its tilt, positive
towards +x. With M its mass, I_s its inertia, and R_s and alpha_s the distance of its centre of mass
from the edge and the angle of that line to the vertical at phi = 0,

    phi'' = -p_s^2 { (1 + a_z/g) sin(alpha_s - phi) + s a_x/g cos(alpha_s - phi) } - U_s'(phi)/I_s,
    p_s^2 = M g R_s/I_s  (Housner 1963).

U_s: potential of springs, tendons and a thrust. A point of the structure at height y, at the
horizontal distance c inside the edge, moves by u = y sin phi + c (1 - cos phi) towards s; a tendon
in a duct at c is stretched by 2 c sin(phi/2) in each joint that opens:

    U_s = sum K u^2 / 2 + K_t (2 n c sin(phi/2))^2 / 2 + P n 2 c sin(phi/2) - s H u_H.
"""

from __future__ import annotations

import math

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

LYING = math.pi / 2  # lean at which it lies [rad]
BISECTIONS = 55
_SCAN = 128  # points at which the restoring moment is looked at between upright and flat
# Columns of a row of parameters; those of two sides stand one after the other, + first
SLENDERNESS, P2, RESTITUTION, SPRING, TENDON, TENDON_THRUST, ONLY, PER_MASS, FASTEST, HELD = (
    0,
    2,
    4,
    6,
    12,
    16,
    20,
    21,
    23,
    24,
)
N_PARAMETERS = 25


def row_of_block(slenderness: float, p: float, restitution: float) -> Array:
    """Parameters (N_PARAMETERS,) of a free-standing symmetric block of slenderness [rad] and p
    [rad/s].
    """
    row = np.zeros(N_PARAMETERS)
    (
        row[SLENDERNESS : SLENDERNESS + 2],
        row[P2 : P2 + 2],
        row[RESTITUTION : RESTITUTION + 2],
        row[PER_MASS : PER_MASS + 2],
        row[FASTEST],
    ) = slenderness, p * p, restitution, 1.0, p
    return row


@njit(alone=True)
def _held(par: Array, k: int, phi: float) -> float:
    """U'(phi) over the inertia [1/s2]."""
    sine, cosine = math.sin(phi), math.cos(phi)
    a, t, h = SPRING + 3 * k, TENDON + 2 * k, TENDON_THRUST + 2 * k
    moment = (
        par[a] * sine * cosine
        + par[a + 1] * (sine * sine + cosine - cosine * cosine)
        + par[a + 2] * sine * (1 - cosine)
    )
    return (
        moment
        + par[t] * sine
        + par[t + 1] * math.cos(0.5 * phi)
        - par[h] * cosine
        - par[h + 1] * sine
    )


@njit(alone=True)
def _held_potential(par: Array, k: int, phi: float) -> float:
    """U(phi) over the inertia [1/s2]."""
    sine, less = math.sin(phi), 1 - math.cos(phi)
    a, t, h = SPRING + 3 * k, TENDON + 2 * k, TENDON_THRUST + 2 * k
    energy = 0.5 * par[a] * sine * sine + par[a + 1] * sine * less + 0.5 * par[a + 2] * less * less
    return (
        energy
        + par[t] * less
        + 2 * par[t + 1] * math.sin(0.5 * phi)
        - par[h] * sine
        - par[h + 1] * less
    )


@njit(alone=True)
def restoring_moment(par: Array, k: int, phi: float) -> float:
    """Restoring moment over the inertia [1/s2]."""
    moment = par[P2 + k] * math.sin(par[SLENDERNESS + k] - phi)
    return moment + _held(par, k, phi) if par[HELD] != 0.0 else moment


@njit(alone=True)
def swing_potential(par: Array, k: int, phi: float) -> float:
    """Potential over the inertia, 0 upright [1/s2]."""
    energy = par[P2 + k] * (math.cos(par[SLENDERNESS + k] - phi) - math.cos(par[SLENDERNESS + k]))
    return energy + _held_potential(par, k, phi) if par[HELD] != 0.0 else energy


@njit(alone=True)
def critical_lean(par: Array, k: int) -> float:
    """Least lean from which the restoring moment pushes over; pi/2 where none does."""
    if par[HELD] == 0.0:
        return par[SLENDERNESS + k]
    early = late = 0.0
    if restoring_moment(par, k, 0.0) <= 0.0:
        return 0.0
    for point in range(1, _SCAN + 1):
        late = LYING * point / _SCAN
        if restoring_moment(par, k, late) < 0.0:
            for _ in range(BISECTIONS):
                middle = 0.5 * (early + late)
                if restoring_moment(par, k, middle) > 0.0:
                    early = middle
                else:
                    late = middle
            return late
        early = late
    return LYING


@njit(alone=True)
def _turn(par: Array, k: int, s: float, phi: float, x: float, z: float) -> tuple[float, float]:
    """Phi'' [1/s2], and the part of it that the ground makes; x, z: ground acceleration over g."""
    lever = par[SLENDERNESS + k] - phi
    sine, cosine = math.sin(lever), math.cos(lever)
    driven = -par[P2 + k] * (z * sine + s * x * cosine)
    turn = driven - par[P2 + k] * sine
    if par[HELD] != 0.0:
        turn -= _held(par, k, phi)
    return turn, driven


@njit(alone=True)
def swing_step(
    par: Array,
    k: int,
    s: float,
    phi: float,
    rate: float,
    x: float,
    z: float,
    dx: float,
    dz: float,
    step: float,
) -> tuple[float, float, float, float]:
    """phi, phi', the work of the ground over the inertia, and phi'' at the start, after a classical
    Runge-Kutta step; dx, dz: slopes of the ground's acceleration.
    """
    half = 0.5 * step
    k1, w1 = _turn(par, k, s, phi, x, z)
    v2 = rate + half * k1
    k2, w2 = _turn(par, k, s, phi + half * rate, x + half * dx, z + half * dz)
    v3 = rate + half * k2
    k3, w3 = _turn(par, k, s, phi + half * v2, x + half * dx, z + half * dz)
    v4 = rate + step * k3
    k4, w4 = _turn(par, k, s, phi + step * v3, x + step * dx, z + step * dz)
    work = step * (w1 * rate + 2 * w2 * v2 + 2 * w3 * v3 + w4 * v4) / 6
    return (
        phi + step * (rate + 2 * v2 + 2 * v3 + v4) / 6,
        rate + step * (k1 + 2 * k2 + 2 * k3 + k4) / 6,
        work,
        k1,
    )


@njit(alone=True)
def lift(par: Array, k: int, s: float, x: float, z: float) -> float:
    """Phi'' at phi = 0 [1/s2]: positive where the ground lifts the structure onto this side; -1
    where it cannot lean there.
    """
    if par[ONLY] * s < 0.0:
        return -1.0
    return _turn(par, k, s, 0.0, x, z)[0]


@njit(alone=True)
def look(par: Array, k: int, leans: Array, out: Array) -> None:
    """Restoring moment, gravity and held potential over the inertia at leans (n,), and the critical
    lean; out: (n, 4).
    """
    critical = critical_lean(par, k)
    for one in range(len(leans)):
        gravity = par[P2 + k] * (
            math.cos(par[SLENDERNESS + k] - leans[one]) - math.cos(par[SLENDERNESS + k])
        )
        out[one, 0], out[one, 1], out[one, 2], out[one, 3] = (
            restoring_moment(par, k, leans[one]),
            gravity,
            swing_potential(par, k, leans[one]) - gravity,
            critical,
        )
