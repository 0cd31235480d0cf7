"""Links between points of two bodies, or of a body and the ground: tendons, springs, struts, stops,
restrainers with play, dashpots and friction dampers; and those of bonded joints, see `bonds`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.contact.record import record
from fecolumn.contact.tolerances import LEAST_STRETCH
from fecolumn.engines.dynamics.link_law import (
    damage_of,
    drag_of,
    follow_elongation,
    strain_of,
    stretch_of,
)
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

#: A link from body a to body b, -1 for a ground; ground: which one then; arm_a, arm_b: (3,) of its
#: ends from the centres of mass in the bodies' frames, of a ground where it is in the table frame
#: at the start [m]; length: unstressed [m];
#: play: way at either side of it without force [m]; stiffness [N/m]; damping [N s/m]; pulls,
#: pushes: whether it can; yields: force at which it flows [N]; hardens: what more it takes per
#: length that has flowed [N/m]; bends: exponent of the curve along which it comes to flow, infinite
#: where it does so at once; power: of the rate of elongation, to which a dashpot's force is
#: proportional, from `slow` [m/s] on; breaks: elongation beyond its play [m] at which it fails;
#: infinite where it does not. bond: 0, or number from 1 of the bonded joint of which it holds a
#: point: three links, of which the first, which leads, is along the normal; area: that the point
#: stands for [m2]; breaks is then where damage begins, fails: where nothing is left [m]; rubs:
#: shear strength that a tension takes, over the tension.
LINK = record(
    ("a", "i8"),
    ("b", "i8"),
    ("ground", "i8"),
    ("arm_a", "f8", 3),
    ("arm_b", "f8", 3),
    ("length", "f8"),
    ("play", "f8"),
    ("stiffness", "f8"),
    ("damping", "f8"),
    ("pulls", "?"),
    ("pushes", "?"),
    ("yields", "f8"),
    ("hardens", "f8"),
    ("bends", "f8"),
    ("power", "f8"),
    ("slow", "f8"),
    ("breaks", "f8"),
    ("bond", "i8"),
    ("leads", "?"),
    ("area", "f8"),
    ("fails", "f8"),
    ("rubs", "f8"),
)
#: What a link carries from step to step: its length now and the part of it that has flowed [m];
#: force [N], pull > 0, a dashpot's part of it the mean over the step; work: energy that its
#: dashpot, yielding and breaking have taken [J]; whether it is broken; damage: share of its
#: stiffness that a link of a bond has lost.
TIE = record(
    ("length", "f8"),
    ("flowed", "f8"),
    ("force", "f8"),
    ("work", "f8"),
    ("broken", "?"),
    ("damage", "f8"),
)


class Held(NamedTuple):
    """What links hold, as `pull_links` and `end_links` take it of a motion: grounds (G,) of
    GROUND_STATE; bodies with frames (nb,), rotation (nb, 3, 3) and modal (nb, 3, m), of which the
    first row are coordinates; ties (nl,) of TIE.
    """

    grounds: Array
    frames: Array
    rotation: Array
    modal: Array
    ties: Array


class Linked(NamedTuple):
    """links: (nl,) of LINK; ends: (nl, 2, 3, m) shapes of the modes at their ends a and b."""

    links: Array
    ends: Array


@njit
def _end_of(link: Record, side: int, shape: Array, at: Any, target: Array) -> None:
    """Target (3,): where an end of a link is, 0 or 1; shape: (3, m) of the modes there."""
    b, arm = link.b if side else link.a, link.arm_b if side else link.arm_a
    x, y, z = arm[0], arm[1], arm[2]
    if b == GROUND:
        moved = at.grounds[link.ground].moved
        target[0], target[1], target[2] = x + moved[0], y + moved[1], z + moved[2]
        return
    for k in range(shape.shape[1]):
        q = at.modal[b, 0, k]
        x, y, z = x + shape[0, k] * q, y + shape[1, k] * q, z + shape[2, k] * q
    R, center = at.rotation[b], at.frames[b].center
    for a in range(3):
        target[a] = center[a] + R[a, 0] * x + R[a, 1] * y + R[a, 2] * z


@njit
def span(linked: Any, n: int, at: Any, target: Array) -> float:
    """Target (3,): way from end a to end b [m] of link n, held as `at` says; its length."""
    other = np.empty(3)
    _end_of(linked.links[n], 0, linked.ends[n, 0], at, other)
    _end_of(linked.links[n], 1, linked.ends[n, 1], at, target)
    square = 0.0
    for a in range(3):
        target[a] -= other[a]
        square += target[a] ** 2
    return np.sqrt(square)


@njit
def pull(
    link: Record, tie: Record, begin: Array, way: Array, length: float, dt: float, target: Array
) -> float:
    """Target (3,): force [N] of a link on its end a within a step, on b the opposite; the elastic
    force and that of the dashpot.

    A discrete gradient (Gonzalez 1996): its work is the loss of strain energy and what yielding
    takes, exactly; the dashpot's its force at the mean rate times l1 - l0.

    Parameters
    ----------
    begin, way
        (3,) from a to b at the start and at the end of the step [m].
    length
        at the end [m]; tie.length is that at the start.
    """
    before, elastic, rate = tie.length, 0.0, (length - tie.length) / dt
    if not tie.broken:
        s0, change = stretch_of(link, before - link.length - tie.flowed), length - before
        s1, flow, lost = follow_elongation(link, tie, length)
        stiffness = link.stiffness * (1.0 - tie.damage)
        first, last = stiffness * s0, stiffness * s1
        elastic = (first + last) / 2
        if (flow != 0.0 or s0 * s1 <= 0.0) and abs(change) > 1e-12 * link.length:
            held_back = link.hardens * (tie.flowed + flow / 2) * flow
            elastic = (elastic * (s1 - s0) + lost + held_back) / change
            # a mean of the forces on the way, but for rounding
            elastic = min(max(elastic, min(first, last)), max(first, last))
    total = elastic + (0.0 if tie.broken else drag_of(link, rate))
    for a in range(3):
        # without length at both ends of the step it has no direction, and no force
        target[a] = (
            total * (begin[a] + way[a]) / (before + length) if before + length > 0.0 else 0.0
        )
    return total


@njit
def pull_links(linked: Any, start: Any, end: Any, dt: float, pulls: Array) -> float:
    """Pulls (nl, 3): forces [N] of links on their ends a, in a step that brings what they hold from
    `start` to `end`, with the ties of its start; the largest change over the largest force, or over
    that of the least stretch that counts where it is more.

    linked: what has links and ends as Linked has; start, end: what has the places of Held.
    """
    begin, way, force, change, largest = np.empty(3), np.empty(3), np.empty(3), 0.0, 0.0
    links, ties = linked.links, start.ties
    for n in range(len(links)):
        if ties[n].broken:
            for a in range(3):
                pulls[n, a] = 0.0
            continue
        span(linked, n, start, begin)
        length = span(linked, n, end, way)
        pull(links[n], ties[n], begin, way, length, dt, force)
        b = links[n].a if links[n].b == GROUND else links[n].b
        arm = links[n].arm_a if links[n].b == GROUND else links[n].arm_b
        for a in range(3):
            place = abs(end.frames[b].center[a]) + abs(arm[a])
            largest = max(largest, LEAST_STRETCH * place * links[n].stiffness)
            change, largest = max(change, abs(force[a] - pulls[n, a])), max(largest, abs(force[a]))
            pulls[n, a] = force[a]
    return change / largest if largest > 0.0 else 0.0


@njit
def strain_of_links(links: Array, ties: Array) -> float:
    """Strain energy [J] of links with `ties` (nl,)."""
    energy = 0.0
    for n in range(len(links)):
        if not ties[n].broken:
            over, left = ties[n].length - links[n].length - ties[n].flowed, 1.0 - ties[n].damage
            energy += left * strain_of(links[n], stretch_of(links[n], over), ties[n].flowed)
    return energy


@njit
def end_links(linked: Any, start: Any, end: Any, dt: float) -> tuple[float, float]:
    """Carry the ties of `start` on to those of `end`, where links are held as it says: strain
    energy then, energy that their dashpots, yielding and breaking have taken in the step [J].

    Arguments as of `pull_links`; of start only the ties count.
    """
    kept = taken = 0.0
    way, links = np.empty(3), linked.links
    for n in range(len(links)):
        link, tie, new = links[n], start.ties[n], end.ties[n]
        length = span(linked, n, end, way)
        new.flowed, new.broken, new.length, new.work, new.force, new.damage = (
            tie.flowed,
            tie.broken,
            length,
            tie.work,
            0.0,
            tie.damage,
        )
        if tie.broken or link.bond > 0:
            continue
        trial = stretch_of(link, length - link.length - tie.flowed)
        viscous = drag_of(link, (length - tie.length) / dt)
        stretch, flow, yielding = follow_elongation(link, tie, length)
        new.flowed += flow
        held = strain_of(link, stretch, new.flowed)
        lost = viscous * (length - tie.length) + yielding
        # a link that yields breaks where it would carry the breaking force if it did not yield
        if trial != 0.0 and abs(trial + tie.flowed) > link.breaks:
            new.broken = True
            lost += held
        else:
            new.force = link.stiffness * stretch + viscous
            kept += held
        new.work += lost
        taken += lost
    for n in range(len(links)):
        if links[n].leads and not end.ties[n].broken:
            held, lost = _end_point(links[n : n + 3], end.ties[n : n + 3])
            kept += held
            taken += lost
    return kept, taken


@njit
def _end_point(links: Array, ties: Array) -> tuple[float, float]:
    """Damage of a point of a bond at the end of a step, whose three links have the lengths that
    they have then: strain energy that is left, and energy that is taken [J].
    """
    held, slipped, opened = 0.0, 0.0, 0.0
    for k in range(3):
        stretch = stretch_of(links[k], ties[k].length - links[k].length)
        held += strain_of(links[k], stretch, 0.0)
        ties[k].force = links[k].stiffness * stretch
        if k == 0:
            opened = stretch
        else:
            slipped += stretch * stretch
    before = ties[0].damage
    now = max(before, damage_of(links[0], links[1], opened, np.sqrt(slipped)))
    lost = (now - before) * held
    ties[0].work += lost
    for k in range(3):
        ties[k].damage, ties[k].broken = now, now >= 1.0
        ties[k].force *= 1.0 - now
    return (1.0 - now) * held, lost
