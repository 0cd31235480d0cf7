"""Impulses of points that collide, by Coulomb's law in velocities.

Each point gives a little against its impulse, without which many impulses on a stiff foot are not
unique; what that leaves is taken off in the next of a series of solutions (proximal point,
Rockafellar 1976).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.arrays import flat, largest, put_points
from fecolumn.contact.coupling import part_of, softened, stiffnesses
from fecolumn.contact.friction import iterate
from fecolumn.contact.frozen_slips import find_impulses
from fecolumn.contact.newton import NewtonLimits, newton_steps
from fecolumn.contact.problem import N_IMPACT_CONTACT
from fecolumn.contact.tolerances import (
    FROZEN_ENDS,
    IMPACT_GIVES,
    IMPACT_LEAST,
    IMPACT_LEFT,
    IMPACT_MISSED,
    IMPACT_SOLVED,
    IMPACT_TOLD,
    MANY_MISSED,
    MANY_POINTS,
    NEWTON_STALLED,
    NEWTON_STEPS,
    SHARP,
    SWEEPS_MOST,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.coupling import Coupling


@njit
def held_impulses(
    mobility: Coupling,
    velocity: Array,
    friction: Array,
    held: Array,
    guess: Array,
    speed: float,
    pressed: float,
    counts: Array,
) -> tuple[Array, bool]:
    """Impulses (3 k,) of the points `held` (m,) alone, as `_impulses`; guess: (3 k,)."""
    m, impulses = len(held), np.zeros(len(velocity))
    approach, start, mu = (
        np.empty((m, 3)),
        np.empty((m, 3)),
        np.empty(m),
    )
    for i in range(m):
        mu[i] = friction[held[i]]
        for a in range(3):
            approach[i, a], start[i, a] = velocity[3 * held[i] + a], guess[3 * held[i] + a]
    found, solved = _impulses(part_of(mobility, held), approach, mu, start, speed, pressed, counts)
    for i in range(m):
        for a in range(3):
            impulses[3 * held[i] + a] = found[i, a]
    return impulses, solved


@njit
def all_impulses(
    mobility: Coupling,
    velocity: Array,
    friction: Array,
    guess: Array,
    speed: float,
    pressed: float,
    counts: Array,
) -> tuple[Array, bool]:
    """As `_impulses`, with flat arrays (3 k,)."""
    k = len(friction)
    approach, start = np.empty((k, 3)), np.empty((k, 3))
    put_points(velocity, approach)
    put_points(guess, start)
    found, solved = _impulses(mobility, approach, friction, start, speed, pressed, counts)
    return flat(found), solved


@njit
def rough_impulses(
    mobility: Coupling, velocity: Array, friction: Array, listed: Array, guess: Array
) -> Array:
    """Impulses (3 k,) of the listed points (m,) alone, that obey the laws up to IMPACT_TOLD of the
    largest velocity: for what is told of an impact, and moves nothing.

    mobility: by levers. guess: (3 k,). Where the laws are missed by more, the impulses are those of
    frozen slips all the same: in Coulomb's cone, with exact momentum, and they take energy.
    """
    m, impulses = len(listed), np.zeros(len(velocity))
    if m == 0:
        return impulses
    approach, start, mu, give = np.empty((m, 3)), np.empty((m, 3)), np.empty(m), np.empty(m)
    part = mobility if 3 * m == len(velocity) else part_of(mobility, listed)
    alone = stiffnesses(part, False)
    for i in range(m):
        mu[i], give[i] = friction[listed[i]], IMPACT_GIVES[0] / alone[i]
        for a in range(3):
            approach[i, a], start[i, a] = velocity[3 * listed[i] + a], guess[3 * listed[i] + a]
    part, allowed = softened(part, give), IMPACT_TOLD * max(largest(approach), IMPACT_LEAST)
    limits = NewtonLimits(
        allowed,
        stiffnesses(part, True),
        stiffnesses(part, False),
        0.0,
        NEWTON_STEPS,
        NEWTON_STALLED,
    )
    found, residual, _ = newton_steps(part, approach, mu, start, limits)
    if residual > allowed:
        found, _, _ = find_impulses(
            part, approach, mu, start, False, SHARP * allowed, allowed, allowed
        )
    for i in range(m):
        for a in range(3):
            impulses[3 * listed[i] + a] = found[i, a]
    return impulses


@njit
def _impulses(
    mobility: Coupling,
    velocity: Array,
    friction: Array,
    guess: Array,
    speed: float,
    pressed: float,
    counts: Array,
) -> tuple[Array, bool]:
    """Impulses (k, 3) of points that would have velocities (k, 3) [m/s] without them, and whether
    the impulses obey the laws, up to a share IMPACT_LEFT of the largest of these velocities.

    speed: largest velocity that points really have [m/s]; where it is less, the share is of this
    one. pressed: largest velocity that the step's contact gives [m/s].

    Where slip ends, no point approaches. The velocities without impulses then only tell how hard
    bodies are pressed together. A share of these velocities could be more than the slip itself,
    which would never end.

    Each point gives a little against its impulse, a share of its own mobility, without which many
    impulses on a stiff foot are not unique. The velocity that this leaves is taken off in the next
    solution, which is close to the last one (proximal point, Rockafellar 1976).
    """
    k, free, turns = len(velocity), max(largest(velocity), IMPACT_LEAST), 0
    alone, asked, impulses, last, give = (
        stiffnesses(mobility, False),
        velocity.copy(),
        guess,
        np.zeros((k, 3)),
        np.empty(k),
    )
    for share in IMPACT_GIVES:
        for i in range(k):
            give[i] = share / alone[i]
            for a in range(3):
                asked[i, a] = velocity[i, a] - give[i] * last[i, a]
        impulses, solved = _softened_impulses(
            softened(mobility, give),
            asked,
            friction,
            impulses,
            IMPACT_SOLVED * free,
            IMPACT_MISSED * min(speed, max(free, pressed)),
            turns > 0,
            counts,
        )
        if not solved:
            return last, turns > 0
        turns, left = turns + 1, 0.0
        for i in range(k):
            for a in range(3):
                left = max(left, give[i] * abs(impulses[i, a] - last[i, a]))
        if left <= IMPACT_LEFT * min(speed, free):
            break
        last = impulses
    return impulses, True


@njit
def _softened_impulses(
    compliance: Coupling,
    velocity: Array,
    friction: Array,
    guess: Array,
    allowed: float,
    usable: float,
    near: bool,
    counts: Array,
) -> tuple[Array, bool]:
    """Impulses (k, 3) that obey the laws up to a velocity [m/s], and whether they do: where there
    are several, those that Newton finds from the guess. Where it finds none, of bodies that move in
    few ways, what convex problems find up to a larger velocity, `usable`. near: whether the guess
    solves a problem close to this one.
    """
    if len(compliance.whole) == 0 and len(guess) > 0:
        impulses, residual, made = newton_steps(
            compliance,
            velocity,
            friction,
            guess,
            NewtonLimits(
                SHARP * allowed,
                stiffnesses(compliance, True),
                stiffnesses(compliance, False),
                0.0,
                NEWTON_STEPS,
                NEWTON_STALLED,
            ),
        )
        if residual > allowed:
            impulses, residual, more = find_impulses(
                compliance,
                velocity,
                friction,
                guess,
                near,
                SHARP * allowed,
                FROZEN_ENDS * usable,
                usable,
            )
            made, residual = made + more, residual * allowed / usable
            if len(guess) > MANY_POINTS:
                # what else there is costs seconds, or fails as well; this takes energy all the same
                residual /= MANY_MISSED
        counts[N_IMPACT_CONTACT] += made
        if residual <= allowed:
            return impulses, True
    impulses = guess
    for attempt in range(2):
        # a guess far off can trap the iteration: zero is the second
        start = guess if attempt == 0 else np.zeros((len(guess), 3))
        impulses, residual, newtons, others = iterate(
            compliance, velocity, friction, start, SHARP * allowed, True, SWEEPS_MOST
        )
        counts[N_IMPACT_CONTACT] += newtons + others
        if residual <= allowed:
            return impulses, True
    return impulses, False
