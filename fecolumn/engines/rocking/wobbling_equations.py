"""Equations of motion of the wobbling column and frame.

With b the radius of the rim, h the height of the centre of mass, H that of the column, m its mass,
m_s its share of the slab, I_1 and I_3 its inertia across and along the axis, theta the tilt, phi
the azimuth and e = 2 b sin(theta/2) the stretch of the tendon,

    T = A theta'^2/2 + B(theta) phi'^2/2,    V = g rise(theta) + P e + k e^2/2,
    A = I_1 + m (h^2 + b^2) + m_s (H^2 + 4 b^2),
    B = 4 s^2 [(I_1 + m h^2 + m_s H^2) c^2 + (I_3 + m b^2 + 4 m_s b^2) s^2
               + 2 b (m h + 2 m_s H) s c],    s, c = sin, cos (theta/2),
    rise = u sin(theta) - w (1 - cos(theta)),    lever = u (1 - cos(theta)) + w sin(theta),
    u = b (m + 2 m_s),    w = h m + H m_s.

`benchmarks.wobbling_equations` derives them with sympy, and a test compares them. Half angles are
written because 1 - cos(theta) cancels where the tilt is small.

Arguments of all functions, in SI units, of one column with its share of the slab:
    body: (10,) radius of rim, height of the centre of mass, height of column [m]; mass, share of
        the slab [kg]; inertia about the centre of mass across and along the axis [kg m2]; tendon's
        stiffness [N/m] and pull while the column stands [N]; gravity [m/s2].
    tilt, azimuth [rad]: of the axis; the foot's rim touches at the azimuth, to which the column
        leans.
    tilt_rate [rad/s]; spin [kg m2/s]: momentum of the azimuth, inertia[1] times its rate.
    ground_x, ground_y, ground_z: acceleration of the ground [m/s2].
    push, across_push: that to the azimuth and across it [m/s2].
"""

from __future__ import annotations

import math

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

_RADIUS, _CENTRE, _HEIGHT, _MASS, _SLAB, _ACROSS, _ALONG, _STIFFNESS, _PULL, _GRAVITY = range(10)


@njit(alone=True)
def _levers(body: Array, tilt: float) -> tuple[float, float, float, float]:
    """Mass times rise and times way to the azimuth of all masses [kg m], and their derivatives by
    the tilt. The second derivatives are -lever' and rise'.
    """
    u = body[_RADIUS] * (body[_MASS] + 2 * body[_SLAB])
    w = body[_CENTRE] * body[_MASS] + body[_HEIGHT] * body[_SLAB]
    s, c = math.sin(0.5 * tilt), math.cos(0.5 * tilt)
    sine, versine = 2 * s * c, 2 * s * s
    cosine = 1 - versine
    return (
        u * sine - w * versine,
        u * versine + w * sine,
        u * cosine - w * sine,
        u * sine + w * cosine,
    )


@njit(alone=True)
def _tilt_inertia(body: Array) -> float:
    """A [kg m2]."""
    column = body[_MASS] * (body[_CENTRE] ** 2 + body[_RADIUS] ** 2)
    return body[_ACROSS] + column + body[_SLAB] * (body[_HEIGHT] ** 2 + 4 * body[_RADIUS] ** 2)


@njit(alone=True)
def _azimuth_inertia(body: Array, tilt: float) -> tuple[float, float]:
    """B [kg m2], and its derivative by the tilt."""
    upper = body[_HEIGHT] * body[_SLAB]
    across = body[_ACROSS] + body[_CENTRE] ** 2 * body[_MASS] + body[_HEIGHT] * upper
    along = body[_ALONG] + body[_RADIUS] ** 2 * (body[_MASS] + 4 * body[_SLAB])
    mixed = 2 * body[_RADIUS] * (body[_CENTRE] * body[_MASS] + 2 * upper)
    s, c = math.sin(0.5 * tilt), math.cos(0.5 * tilt)
    part = across * c * c + along * s * s + mixed * s * c
    slope = (along - across) * s * c + 0.5 * mixed * (c * c - s * s)
    return 4 * s * s * part, 4 * s * (c * part + s * slope)


@njit(alone=True)
def _tilt_acceleration(
    body: Array, tilt: float, spin: float, push: float, ground_z: float
) -> float:
    """Second derivative of the tilt [rad/s2]."""
    _, _, rise, lever = _levers(body, tilt)
    inertia, slope = _azimuth_inertia(body, tilt)
    turning = 0.5 * slope * (spin / inertia) ** 2
    weight = (body[_GRAVITY] + ground_z) * rise
    tendon = moments(body, tilt)[2]
    return (turning - weight - tendon - push * lever) / _tilt_inertia(body)


@njit(alone=True)
def rates(
    body: Array,
    tilt: float,
    azimuth: float,
    tilt_rate: float,
    spin: float,
    ground_x: float,
    ground_y: float,
    ground_z: float,
) -> tuple[float, ...]:
    """Rates of tilt, azimuth, tilt_rate, spin, and of the work that the base does [W]."""
    c, s = math.cos(azimuth), math.sin(azimuth)
    push, across_push = ground_x * c + ground_y * s, ground_y * c - ground_x * s
    _, lever, rise_rate, lever_rate = _levers(body, tilt)
    turn = spin / _azimuth_inertia(body, tilt)[0]
    return (
        tilt_rate,
        turn,
        _tilt_acceleration(body, tilt, spin, push, ground_z),
        -across_push * lever,
        -(push * lever_rate + ground_z * rise_rate) * tilt_rate - across_push * lever * turn,
    )


@njit(alone=True)
def force(
    body: Array,
    tilt: float,
    tilt_rate: float,
    spin: float,
    push: float,
    across_push: float,
    ground_z: float,
) -> tuple[float, float, float]:
    """Force of the ground on the foot [N]: towards the azimuth, across it, up. It is the rate of
    the momentum of all masses.
    """
    total = body[_MASS] + body[_SLAB]
    _, lever, rise_rate, lever_rate = _levers(body, tilt)
    inertia, slope = _azimuth_inertia(body, tilt)
    turn = spin / inertia
    fall = _tilt_acceleration(body, tilt, spin, push, ground_z)
    turned = -(across_push * lever + slope * tilt_rate * turn) / inertia
    return (
        rise_rate * tilt_rate**2 + lever_rate * fall - lever * turn**2 + total * push,
        2 * lever_rate * tilt_rate * turn + lever * turned + total * across_push,
        -lever_rate * tilt_rate**2 + rise_rate * fall + total * (body[_GRAVITY] + ground_z),
    )


@njit(alone=True)
def inertia(body: Array, tilt: float) -> tuple[float, float]:
    """Of tilt and of azimuth [kg m2]."""
    return _tilt_inertia(body), _azimuth_inertia(body, tilt)[0]


@njit(alone=True)
def potential(body: Array, tilt: float) -> tuple[float, float]:
    """Of gravity, 0 upright, and of the tendon [J]."""
    stretch = 2 * body[_RADIUS] * math.sin(0.5 * tilt)
    rise = _levers(body, tilt)[0]
    return body[_GRAVITY] * rise, (body[_PULL] + 0.5 * body[_STIFFNESS] * stretch) * stretch


@njit(alone=True)
def moments(body: Array, tilt: float) -> tuple[float, float, float]:
    """Derivatives by the tilt of mass times rise and times lever of the weight [kg m], and of the
    tendon's energy [N m].
    """
    _, _, rise_rate, lever_rate = _levers(body, tilt)
    pull = body[_PULL] + 2 * body[_STIFFNESS] * body[_RADIUS] * math.sin(0.5 * tilt)
    return rise_rate, lever_rate, body[_RADIUS] * math.cos(0.5 * tilt) * pull
