"""A pad or soil below the foot: springs and dashpots per area that only push (Winkler 1867)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fecolumn.contact.tolerances import YIELDED_GIVES
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Stiffness along over that across the pad: circular footing on an elastic half-space of Poisson's
# ratio 1/3, 2 (1 - nu) / (2 - nu) (Mindlin 1949; Gazetas 1991)
SHEAR_RATIO = 0.8


@dataclass(frozen=True, slots=True)
class Pad:
    """Springs and dashpots side by side (Kelvin and Voigt) under each contact point, r = k u + c
    du/dt.

    In a step from u0 to u1 the force is that of the midpoint, r = k (u0 + u1) / 2 + c (u1 - u0) /
    dt, so that spring and column exchange energy without loss and the dashpots take c (u1 - u0)^2 /
    dt:

        u1 = give r + kept u0
        give = 1 / (k / 2 + c / dt)
        kept = (c / dt - k / 2) / (c / dt + k / 2)

    The pad has no mass. Where nothing presses it recovers by its dashpots, at once where c / dt < k
    / 2. It takes the place of impacts, and of the rim's rolling: a node of the rim that comes down
    presses a spring, which gives back what it takes.

    Parameters
    ----------
    stiffness
        (n, 3) of each point [N/m].
    relaxation
        c / k [s], of all alike.
    frequency
        of the vertical mode of what stands on it [Hz].
    bears
        (n,) force at which the springs below each point yield [N]; None where they never do.
    """

    stiffness: Array
    relaxation: float
    frequency: float = math.inf
    bears: Array | None = None

    def give(self, dt: float) -> tuple[Array, float]:
        """Compliance (n, 3) [m/N] and share kept of the indentation in a step dt [s]; infinite: at
        rest, u1 = r / k.
        """
        if math.isinf(dt):
            return 1 / self.stiffness, 0.0
        dashpot = self.relaxation / dt
        return 1 / (self.stiffness * (0.5 + dashpot)), (dashpot - 0.5) / (dashpot + 0.5)


def pad_below(keys: Any, areas: Array, mass: float) -> Pad:
    """A pad with the keys of a [base], a ground or an interface.

    Parameters
    ----------
    keys
        what has stiffness_n_m3, shear_stiffness_n_m3, damping_ratio and perhaps yield_pa.
    areas
        (n,) [m2] tributary to the points.
    mass
        that all of the pad carries, over its area [kg/m2].
    """
    shear = keys.shear_stiffness_n_m3 or SHEAR_RATIO * keys.stiffness_n_m3
    w, pressure = math.sqrt(keys.stiffness_n_m3 / mass), getattr(keys, "yield_pa", None)
    return Pad(
        np.outer(areas, [shear, shear, keys.stiffness_n_m3]),
        2 * keys.damping_ratio / w,
        w / (2 * math.pi),
        pressure * areas if pressure else None,
    )


class Springs(NamedTuple):
    """Compliance of each point by itself in a step. own: (n, 3) [m/N] of contact law and pad; give:
    (n, 3) [m/N] of the pad, kept: (n,) share of its indentation that is left without force, see
    `Pad.give`. flow: (n,) [m/N] by which the pad gives more once it yields, 0 where it never does;
    yields: (n,) whether it does in this step: then `own` has it, too.
    """

    own: Array
    give: Array
    kept: Array
    flow: Array
    yields: Array


def springs_of(points: Array, interfaces: Array, dt: float) -> Springs:
    """What points (n,) of POINT of interfaces (ni,) of INTERFACE give alone in a step dt [s];
    infinite: at rest.
    """
    give, kept, flow = np.zeros((len(points), 3)), np.zeros(len(points)), np.zeros(len(points))
    for k in np.flatnonzero(interfaces["on_pad"]):
        own = points["interface"] == k
        relaxation = float(interfaces["relaxation"][k])
        give[own], kept[own] = Pad(points["springs"][own], relaxation).give(dt)
    may = points["bears"] > 0
    flow[may] = YIELDED_GIVES * give[may, 2]
    return Springs(points["law"] + give, give, kept, flow, np.zeros(len(points), bool))


@njit
def without_pads(interfaces: Array, points: Array, listed: Array) -> Array:
    """Those of the listed points (k,) below which there is no pad."""
    found, count = np.empty(len(listed), np.int64), 0
    for i in listed:
        if not interfaces[points[i].interface].on_pad:
            found[count] = i
            count += 1
    return found[:count]


@njit
def any_pad(interfaces: Array) -> bool:
    """Whether there is a pad in any of the interfaces (ni,)."""
    for k in range(len(interfaces)):
        if interfaces[k].on_pad:
            return True
    return False


@njit
def begin_yielding(points: Array, springs: Springs) -> None:
    """A new step: no pad yields yet."""
    for i in range(len(points)):
        if springs.yields[i]:
            springs.yields[i] = False
            springs.own[i, 2] = points[i].law[2] + springs.give[i, 2]


@njit
def find_yielding(points: Array, springs: Springs, listed: Array, after: Array) -> bool:
    """Find which pads below the listed points (k,) yield under the forces of `after`, (n,) of
    CONTACT: whether that has changed.

    A pad that yields goes on to give `flow` times what its force exceeds `bears` by, so that it
    bears that force at any settlement.
    """
    changed = False
    for i in listed:
        if springs.flow[i] > 0.0:
            yields = after[i].force[2] > points[i].bears
            if yields != springs.yields[i]:
                springs.yields[i], changed = yields, True
                springs.own[i, 2] = points[i].law[2] + springs.give[i, 2]
                if yields:
                    springs.own[i, 2] += springs.flow[i]
    return changed


@njit(inline="always")
def indented(points: Array, springs: Springs, before: Array, i: int, a: int) -> float:
    """What the springs of point i add to its slip or gap along axis a [m], beside their own
    compliance: indentation that is left, settlement, and of those that yield the force that they
    bear.
    """
    left = springs.kept[i] * before[i].indentation[a]
    if a == 2:
        left += before[i].settled
        if springs.yields[i]:
            left -= springs.flow[i] * points[i].bears
    return left


@njit
def indent(points: Array, springs: Springs, before: Array, after: Array) -> None:
    """Indentation and settlement of the pad at the end of a step in `after` (n,) of CONTACT by the
    forces there, which found it as in `before`.
    """
    for i in range(len(after)):
        pressed = after[i].force[2] > 0
        for a in range(3):
            left = before[i].indentation[a]
            after[i].indentation[a] = (
                springs.give[i, a] * after[i].force[a] + springs.kept[i] * left
                if pressed
                else max(springs.kept[i], 0.0) * left
            )
        # a foot that has left in the step leaves the pad level
        after[i].indentation[2] = max(after[i].indentation[2], 0.0)
        after[i].settled = before[i].settled
        if springs.yields[i]:
            after[i].settled += springs.flow[i] * max(after[i].force[2] - points[i].bears, 0.0)


@njit
def dashpot_work(points: Array, springs: Springs, before: Array, after: Array) -> float:
    """Energy [J] that dashpots and yielding take in a step, at least 0: work of the forces on the
    pad less what its springs then hold.
    """
    taken = 0.0
    for i in range(len(after)):
        taken += after[i].force[2] * (after[i].settled - before[i].settled)
        for a in range(3):
            was, now, force = before[i].indentation[a], after[i].indentation[a], after[i].force[a]
            if after[i].force[2] > 0:
                taken += force * (springs.give[i, a] * force + (springs.kept[i] - 1.0) * was)
            taken -= points[i].springs[a] * (now**2 - was**2) / 2
    return taken
