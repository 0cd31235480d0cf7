"""Rotation of a floating frame in a step."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


@njit
def turn_by(rotation: Array, vector: Array, target: Array) -> None:
    """Target = rotation exp(vector), by Rodrigues' formula; orthonormal to rounding if `rotation`
    is nearly so.
    """
    x, y, z = vector[0], vector[1], vector[2]
    square = x * x + y * y + z * z
    angle = np.sqrt(square)
    if angle < 1e-4:
        a, b = 1 - square / 6, 0.5 - square / 24
    else:
        a, b = np.sin(angle) / angle, (1 - np.cos(angle)) / square
    e00, e01, e02 = 1 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    e10, e11, e12 = b * x * y + a * z, 1 - b * (x * x + z * z), b * y * z - a * x
    e20, e21, e22 = b * x * z - a * y, b * y * z + a * x, 1 - b * (x * x + y * y)
    for i in range(3):
        r0, r1, r2 = rotation[i, 0], rotation[i, 1], rotation[i, 2]
        target[i, 0] = r0 * e00 + r1 * e10 + r2 * e20
        target[i, 1] = r0 * e01 + r1 * e11 + r2 * e21
        target[i, 2] = r0 * e02 + r1 * e12 + r2 * e22


@njit
def orthonormal(rotation: Array) -> None:
    """Take the rounding of many turns out of a rotation, in place: R (3 - R^T R) / 2."""
    product = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            product[i, j] = (
                rotation[0, i] * rotation[0, j]
                + rotation[1, i] * rotation[1, j]
                + rotation[2, i] * rotation[2, j]
            )
    for i in range(3):
        r0, r1, r2 = rotation[i, 0], rotation[i, 1], rotation[i, 2]
        for j in range(3):
            rotation[i, j] = 1.5 * rotation[i, j] - 0.5 * (
                r0 * product[0, j] + r1 * product[1, j] + r2 * product[2, j]
            )


class Turning(NamedTuple):
    """What turns a body in a step, in its frame at the start unless said otherwise, and what comes
    of it.

    body: of BODY. advance: (3,) dt times the spin at the start. rotation: (3, 3) at the start, into
    the table frame. half: half of dt squared, or what stands for it [s2]. spread: (3, 3) sum of
    arms times forces, arms in the body's frame and forces in the table frame [N m]. resistance:
    (3,) added to the moment [N m]. moment: (3,) and halfway: (3, 3), rotation in the middle of the
    step, are found.
    """

    body: Any
    advance: Array
    rotation: Array
    half: float
    spread: Array
    resistance: Array
    moment: Array
    halfway: Array


@njit
def turning(given: Turning, turn: Array) -> bool:
    """Solve Th = advance/2 + J^-1 exp(-Th) (J advance/2 + half R0^T M) for the turn Th, and its
    moment M, in the column's frame. Returns: whether it was found; of a slender body that turns by
    more than some 1.5 rad in a step it may not be.

    Energy-momentum conserving (Simo and Wong 1991): with M = sinc(|Th|/2) sum (Rh A) x r, Th . M is
    the work of the forces on the path of rigid arms A.

    Parameters
    ----------
    given
        Turning, which gets moment and rotation halfway.
    turn
        (3,) first guess [rad], and the result.
    """
    momentum, value, change = np.empty(3), np.empty(3), 0.0
    inertia, advance = given.body.inertia, given.advance
    for i in range(3):
        momentum[i] = 0.5 * (
            inertia[i, 0] * advance[0] + inertia[i, 1] * advance[1] + inertia[i, 2] * advance[2]
        )
    for _ in range(50):
        _turn_by_turn(given, momentum, turn, value)
        change = 0.0
        for i in range(3):
            change = max(change, abs(value[i] - turn[i]))
            turn[i] = value[i]
        if change <= 1e-17 + 2e-16 * (abs(turn[0]) + abs(turn[1]) + abs(turn[2])):
            return True
    if change <= 1e-12 * (abs(turn[0]) + abs(turn[1]) + abs(turn[2])):
        return True
    # a slender body that turns fast: Newton's method from the turn of a body that nothing moves
    slope, other, most = np.empty((3, 3)), np.empty(3), 0.0
    for i in range(3):
        turn[i] = advance[i]
    for _ in range(50):
        _turn_by_turn(given, momentum, turn, value)
        most = 1e-17 + abs(turn[0]) + abs(turn[1]) + abs(turn[2])
        small, change = 1e-7 * most, 0.0
        for k in range(3):
            kept, turn[k] = turn[k], turn[k] + small
            _turn_by_turn(given, momentum, turn, other)
            turn[k] = kept
            for i in range(3):
                slope[i, k] = (i == k) - (other[i] - value[i]) / small
        for i in range(3):
            value[i] -= turn[i]
        volume = (
            slope[0, 0] * (slope[1, 1] * slope[2, 2] - slope[1, 2] * slope[2, 1])
            - slope[0, 1] * (slope[1, 0] * slope[2, 2] - slope[1, 2] * slope[2, 0])
            + slope[0, 2] * (slope[1, 0] * slope[2, 1] - slope[1, 1] * slope[2, 0])
        )
        if not 0.0 < abs(volume) < np.inf:  # false of what is not a number, too
            return False
        found = np.linalg.solve(slope, value)
        for i in range(3):
            change = max(change, abs(found[i]))
            turn[i] += found[i]
        if change <= 1e-14 * most:
            break
    _turn_by_turn(given, momentum, turn, value)
    return change <= 1e-12 * most


@njit
def _turn_by_turn(given: Turning, momentum: Array, turn: Array, value: Array) -> None:
    """The right side of the equation of `turning` at a turn (3,), put into value (3,); momentum:
    (3,) half of J advance.
    """
    part, inverse, advance, half = (
        np.empty(3),
        given.body.inverse_inertia,
        given.advance,
        given.half,
    )
    rotation, spread, resistance = given.rotation, given.spread, given.resistance
    moment, halfway = given.moment, given.halfway
    x, y, z = turn[0], turn[1], turn[2]
    quarter = (x * x + y * y + z * z) / 4
    sinc = (
        1 - quarter / 6 * (1 - quarter / 20)
        if quarter < 1e-4
        else np.sin(np.sqrt(quarter)) / np.sqrt(quarter)
    )
    part[0], part[1], part[2] = x / 2, y / 2, z / 2
    turn_by(rotation, part, halfway)
    # arms turned into the table frame: B = Rh spread
    m0 = m1 = m2 = 0.0
    for a in range(3):
        m0 += halfway[1, a] * spread[a, 2] - halfway[2, a] * spread[a, 1]
        m1 += halfway[2, a] * spread[a, 0] - halfway[0, a] * spread[a, 2]
        m2 += halfway[0, a] * spread[a, 1] - halfway[1, a] * spread[a, 0]
    for i in range(3):
        moment[i] = (
            sinc * (rotation[0, i] * m0 + rotation[1, i] * m1 + rotation[2, i] * m2) + resistance[i]
        )
    b0, b1, b2 = (
        momentum[0] + half * moment[0],
        momentum[1] + half * moment[1],
        momentum[2] + half * moment[2],
    )
    # exp(-Th) b
    square = x * x + y * y + z * z
    if square < 1e-8:
        s, c = 1 - square / 6, 0.5 - square / 24
    else:
        angle = np.sqrt(square)
        s, c = np.sin(angle) / angle, (1 - np.cos(angle)) / square
    k0, k1, k2 = y * b2 - z * b1, z * b0 - x * b2, x * b1 - y * b0
    l0, l1, l2 = y * k2 - z * k1, z * k0 - x * k2, x * k1 - y * k0
    b0, b1, b2 = b0 - s * k0 + c * l0, b1 - s * k1 + c * l1, b2 - s * k2 + c * l2
    for i in range(3):
        value[i] = 0.5 * advance[i] + inverse[i, 0] * b0 + inverse[i, 1] * b1 + inverse[i, 2] * b2
