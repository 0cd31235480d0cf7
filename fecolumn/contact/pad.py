"""A pad or soil below the foot: springs and dashpots per area that only push (Winkler 1867)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit

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

        u1 = give r + kept u0,     give = 1 / (k / 2 + c / dt),     kept = (c / dt - k / 2) / (c / dt + k / 2).

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
        of the standing column's vertical mode [Hz].
    """

    stiffness: np.ndarray
    relaxation: float
    frequency: float = math.inf

    def give(self, dt: float) -> tuple[np.ndarray, float]:
        """Compliance (n, 3) [m/N] and share kept of the indentation in a step dt [s]; infinite: at
        rest, u1 = r / k.
        """
        if math.isinf(dt):
            return 1 / self.stiffness, 0.0
        dashpot = self.relaxation / dt
        return 1 / (self.stiffness * (0.5 + dashpot)), (dashpot - 0.5) / (dashpot + 0.5)


def pad_of(case, areas: np.ndarray, mass: float) -> Pad | None:
    """The pad of a case below points with tributary areas (n,) [m2] that carry `mass` [kg]; None
    where its base is another.

    One relaxation time for all: that at which the dashpots give the vertical mode of the column on
    the whole pad, of angular frequency w = sqrt(k A / m), the damping ratio D of the case: c = 2 D
    k / w.
    """
    base = case.base
    if base.kind != "pad":
        return None
    shear = base.shear_stiffness_n_m3 or SHEAR_RATIO * base.stiffness_n_m3
    stiffness = np.outer(areas, [shear, shear, base.stiffness_n_m3])
    w = math.sqrt(stiffness[:, 2].sum() / mass)
    return Pad(stiffness, 2 * base.damping_ratio / w, w / (2 * math.pi))


class Springs(NamedTuple):
    """What points give alone in a step. own: (n, 3) [m/N] of contact law and pad; give: (n, 3)
    [m/N] of the pad, kept: share of its indentation that is left without force, see `Pad.give`.
    """

    own: np.ndarray
    give: np.ndarray
    kept: float


def springs_of(points: np.ndarray, interface, dt: float) -> Springs:
    """What points (n,) of POINT give alone in a step dt [s]; infinite: at rest."""
    if not interface["on_pad"]:
        return Springs(points["law"].copy(), np.zeros((len(points), 3)), 0.0)
    give, kept = Pad(points["springs"], float(interface["relaxation"])).give(dt)
    return Springs(points["law"] + give, give, kept)


@njit
def indent(springs, before, after):
    """Indentation of the pad at the end of a step in `after` (n,) of CONTACT by the forces there,
    which found it as in `before`.
    """
    for i in range(len(after)):
        pressed = after[i].force[2] > 0
        for a in range(3):
            left = before[i].indentation[a]
            after[i].indentation[a] = (
                springs.give[i, a] * after[i].force[a] + springs.kept * left
                if pressed
                else max(springs.kept, 0.0) * left
            )
        # a foot that has left in the step leaves the pad level
        after[i].indentation[2] = max(after[i].indentation[2], 0.0)


@njit
def dashpot_work(points, springs, before, after):
    """Energy [J] that the dashpots take in a step, at least 0: work of the forces on the pad less
    what its springs then hold.
    """
    taken = 0.0
    for i in range(len(after)):
        for a in range(3):
            was, now, force = before[i].indentation[a], after[i].indentation[a], after[i].force[a]
            if after[i].force[2] > 0:
                taken += force * (springs.give[i, a] * force + (springs.kept - 1.0) * was)
            taken -= points[i].springs[a] * (now**2 - was**2) / 2
    return taken
