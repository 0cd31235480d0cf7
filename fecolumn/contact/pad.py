"""A pad or soil below the foot: springs and dashpots per area that only push (Winkler 1867)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fecolumn._compiled import njit

# Stiffness along over that across the pad: circular footing on an elastic half-space of Poisson's ratio 1/3, 2 (1 - nu) / (2 - nu)
# (Mindlin 1949; Gazetas 1991)
SHEAR_RATIO = 0.8


@dataclass(frozen=True, slots=True)
class Pad:
    """Springs and dashpots side by side (Kelvin and Voigt) under each contact point, r = k u + c du/dt.

    In a step from u0 to u1 the force is that of the midpoint, r = k (u0 + u1) / 2 + c (u1 - u0) / dt, so that spring and column exchange
    energy without loss and the dashpots take c (u1 - u0)^2 / dt:

        u1 = give r + kept u0,     give = 1 / (k / 2 + c / dt),     kept = (c / dt - k / 2) / (c / dt + k / 2).

    The pad has no mass. Where nothing presses it recovers by its dashpots, at once where c / dt < k / 2. It takes the place of impacts, and of the
    rim's rolling: a node of the rim that comes down presses a spring, which gives back what it takes.

    Args:
        stiffness: (n, 3) of each point [N/m]. relaxation: c / k [s], of all alike.
        frequency: of the standing column's vertical mode [Hz].
    """

    stiffness: np.ndarray
    relaxation: float
    frequency: float = math.inf

    def give(self, dt: float) -> tuple[np.ndarray, float]:
        """Compliance (n, 3) [m/N] and share kept of the indentation in a step dt [s]; infinite: at rest, u1 = r / k."""
        if math.isinf(dt):
            return 1 / self.stiffness, 0.0
        dashpot = self.relaxation / dt
        return 1 / (self.stiffness * (0.5 + dashpot)), (dashpot - 0.5) / (dashpot + 0.5)


def pad_of(case, areas: np.ndarray, mass: float) -> Pad | None:
    """The pad of a case below points with tributary areas (n,) [m2] that carry `mass` [kg]; None where its base is another.

    One relaxation time for all: that at which the dashpots give the vertical mode of the column on the whole pad, of angular frequency
    w = sqrt(k A / m), the damping ratio D of the case: c = 2 D k / w.
    """
    base = case.base
    if base.kind != "pad":
        return None
    shear = base.shear_stiffness_n_m3 or SHEAR_RATIO * base.stiffness_n_m3
    stiffness = np.outer(areas, [shear, shear, base.stiffness_n_m3])
    w = math.sqrt(stiffness[:, 2].sum() / mass)
    return Pad(stiffness, 2 * base.damping_ratio / w, w / (2 * math.pi))


@njit
def indent(give, kept, forces, before, after):
    """after (n, 3): indentation [m] of the pad by forces (n, 3) that found it indented by `before` (n, 3)."""
    for i in range(len(forces)):
        pressed = forces[i, 2] > 0
        for a in range(3):
            after[i, a] = give[i, a] * forces[i, a] + kept * before[i, a] if pressed else max(kept, 0.0) * before[i, a]
        # a foot that has left in the step leaves the pad level
        after[i, 2] = max(after[i, 2], 0.0)


@njit
def dashpot_work(stiffness, give, kept, forces, before, after):
    """Energy [J] that the dashpots take in a step, at least 0: work of the forces (n, 3) on the pad less what its springs then hold."""
    taken = 0.0
    for i in range(len(forces)):
        for a in range(3):
            if forces[i, 2] > 0:
                taken += forces[i, a] * (give[i, a] * forces[i, a] + (kept - 1.0) * before[i, a])
            taken -= stiffness[i, a] * (after[i, a] ** 2 - before[i, a] ** 2) / 2
    return taken
