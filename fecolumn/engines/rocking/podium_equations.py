"""Equations of a podium: columns that rock below an elastic building, in its modes.

State: tilt theta of the columns, its rate, and for each mode j of the building the coordinate y_j
of the floors' displacements relative to the ground, with its rate. With s the side leaned to, beta
= alpha - s theta, beam u = 2 R s (sin alpha - sin beta), v = 2 R (cos beta - cos alpha),
mass-normalised modes and Gamma_j their participation, Lagrange's equations are

    (I + 4 gamma + 4 eta gamma sin^2 beta) R theta''
        = s 2 eta gamma R sin(2 beta) theta'^2 - s (1 + 2 gamma + 2 eta gamma) (g + a_z) sin beta
          - (1 + 2 gamma) a_x cos beta + 2 eta gamma cos(beta) V/M,
    y_j'' = -Gamma_j a_x - f_j,   V = sum Gamma_j f_j,
    f_j = omega_j^2 (y_j - Gamma_j u) + 2 xi_j omega_j (y_j' - Gamma_j u').

While it stands u = 0; it lifts off where |-(1 + 2 gamma) a_x + 2 eta gamma V/M| > (1 + 2 gamma + 2
eta gamma) (g + a_z) tan alpha.

A state x (4 + 2 n,) is theta, theta', y (n,), y' (n,), the work of the ground and what dampers have
taken, both per mass of the columns [J/kg].
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

SUMS = {"reassoc", "contract", "nsz"}  # sums over modes in any order


class PodiumNumbers(NamedTuple):
    """What the equations of a podium have beside its state.

    Attributes
    ----------
    alpha, radius
        slenderness [rad], half diagonal of the columns [m]; sine, cosine, tangent: of alpha.
    inertia, gamma, eta
        I, gamma and eta of the equations [-].
    gravity
        [m/s2].
    stiff, damping, part
        (n,) of the modes: omega^2 [1/s2], 2 xi omega [1/s], Gamma / sqrt(M) [-].
    """

    alpha: float
    radius: float
    inertia: float
    gamma: float
    eta: float
    gravity: float
    sine: float
    cosine: float
    tangent: float
    stiff: Array
    damping: Array
    part: Array


class GroundPiece(NamedTuple):
    """Acceleration of the ground in a step: straight.

    along, up: at its begin [m/s2]; slope, slope_up: their rates [m/s3].
    """

    along: float
    up: float
    slope: float
    slope_up: float


@njit(alone=True)
def acceleration_at(ground: GroundPiece, h: float) -> tuple[float, float]:
    """Along and up [m/s2], h [s] after the begin of the step."""
    return ground.along + h * ground.slope, ground.up + h * ground.slope_up


@njit(alone=True, fastmath=SUMS)
def podium_rates(
    x: Array, side: float, podium: PodiumNumbers, ground: GroundPiece, h: float, out: Array
) -> float:
    """Rates of a state h [s] after the begin of the step, into out; the base shear V/M [m/s2].

    side: leaned to, 1 along x, -1 against it, 0 while it stands.
    """
    a, az = acceleration_at(ground, h)
    radius, gamma, eta, n = podium.radius, podium.gamma, podium.eta, len(podium.part)
    s, c, shift, speed = podium.sine, podium.cosine, 0.0, 0.0
    if side != 0.0:
        beta = podium.alpha - side * x[0]
        s, c = math.sin(beta), math.cos(beta)
        shift, speed = side * 2 * radius * (podium.sine - s), 2 * radius * c * x[1]
    shear, damped, along = 0.0, 0.0, 0.0
    for j in range(n):
        part = podium.part[j]
        slip = x[2 + n + j] - part * speed
        force = podium.stiff[j] * (x[2 + j] - part * shift) + podium.damping[j] * slip
        out[2 + j] = x[2 + n + j]
        out[2 + n + j] = -part * a - force
        shear += part * force
        damped += podium.damping[j] * slip * slip
        along += part * x[2 + n + j]
    turning = 0.0
    if side != 0.0:
        turning = (
            side
            * (
                4 * eta * gamma * radius * s * c * x[1] ** 2
                - (1 + 2 * gamma + 2 * eta * gamma) * (podium.gravity + az) * s
            )
            - (1 + 2 * gamma) * a * c
            + 2 * eta * gamma * c * shear
        ) / ((podium.inertia + 4 * gamma + 4 * eta * gamma * s * s) * radius)
    out[0], out[1] = x[1], turning
    rising = side * (1 + 2 * gamma + 2 * eta * gamma) * radius * s * x[1]
    out[2 + 2 * n] = -a * ((1 + 2 * gamma) * radius * c * x[1] + gamma * eta * along) - az * rising
    out[3 + 2 * n] = gamma * eta * damped
    return shear


@njit(alone=True)
def podium_push(
    podium: PodiumNumbers, shear: float, ground: GroundPiece, h: float
) -> tuple[float, float]:
    """Moment over the edges of a standing podium, in g tan alpha, and what it is over that which
    holds it; it lifts off where this is positive.
    """
    a, az = acceleration_at(ground, h)
    gamma, eta = podium.gamma, podium.eta
    push = -(1 + 2 * gamma) * a + 2 * eta * gamma * shear
    holds = (1 + 2 * gamma + 2 * eta * gamma) * (podium.gravity + az) * podium.tangent
    return push, abs(push) - holds


@njit(alone=True, fastmath=SUMS)
def podium_energy(x: Array, side: float, podium: PodiumNumbers) -> tuple[float, float, float]:
    """Kinetic, strain and gravity, per mass of the columns [J/kg]."""
    radius, gamma, eta, n = podium.radius, podium.gamma, podium.eta, len(podium.part)
    beta = podium.alpha - side * x[0]
    shift = side * 2 * radius * (podium.sine - math.sin(beta))
    kinetic = (
        0.5
        * radius**2
        * (podium.inertia + 4 * gamma + 4 * gamma * eta * math.sin(beta) ** 2)
        * x[1] ** 2
    )
    strain = 0.0
    for j in range(n):
        kinetic += 0.5 * gamma * eta * x[2 + n + j] ** 2
        strain += 0.5 * gamma * eta * podium.stiff[j] * (x[2 + j] - podium.part[j] * shift) ** 2
    return (
        kinetic,
        strain,
        (1 + 2 * gamma + 2 * gamma * eta)
        * podium.gravity
        * radius
        * (math.cos(beta) - podium.cosine),
    )


@njit(alone=True)
def free_vibration(omega: float, xi: float, h: float) -> tuple[float, float, float]:
    """Of a mode, damped less than critically, in a step h: displacement from displacement and from
    velocity, velocity from velocity.
    """
    damped = omega * math.sqrt(1 - xi * xi)
    s, c, decay = math.sin(damped * h), math.cos(damped * h), math.exp(-xi * omega * h)
    turned = xi * omega / damped * s
    return decay * (c + turned), decay * s / damped, decay * (c - turned)
