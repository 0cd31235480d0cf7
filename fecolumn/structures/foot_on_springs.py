"""A rigid body that leans slowly on springs that only push: soil, or a pad.

Its potential energy over the tilt is that of weight and springs at the height at which these carry
the weight. It grows up to the critical tilt and falls beyond it. That tilt is less than the one at
which the centre of mass stands over the edge: the edge sinks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from fecolumn.contact.overturning import Stance, weakest

# Tilts at which the energy is found, up to that at which the centre of mass stands over the edge
_TILTS = 200


@dataclass(frozen=True)
class FootOnSprings:
    """critical: tilt [rad] towards the weakest edge at which it is lost without help, 0 of a body
    that does not stand upright; barrier: energy [J] that takes it there slowly. sinks: way [m] by
    which it settles upright. holds: stiffness of its springs against tilting over its weight times
    the height of its centre of mass, less than 1 of a body that does not stand.
    """

    critical: float
    barrier: float
    sinks: float
    holds: float

    @classmethod
    def of(cls, stance: Stance, arms: NDArray[Any], stiffness: NDArray[Any]) -> FootOnSprings:
        """Of a body with springs of a stiffness (n,) [N/m] below points at `arms` (n, 3) [m] from
        its centre of mass.
        """
        along = arms[:, :2] @ weakest(stance.corners)[1]
        tilts = np.linspace(0.0, max(stance.critical, 0.0), _TILTS + 1)
        energy = np.array([_energy(tilt, stance, along, stiffness) for tilt in tilts])
        highest = int(np.argmax(energy))
        sinks = stance.weight / stiffness.sum()
        middle = stiffness @ arms[:, :2] / stiffness.sum()
        away = arms[:, :2] - middle
        weakly = np.linalg.eigvalsh((stiffness * away.T) @ away)[0]
        return cls(
            float(tilts[highest]),
            float(energy[highest] - energy[: highest + 1].min()),
            float(sinks),
            float(weakly / (stance.weight * stance.depth)),
        )


def _energy(tilt: float, stance: Stance, along: NDArray[Any], stiffness: NDArray[Any]) -> float:
    """Potential energy [J] of a body that leans by `tilt` [rad], the springs carrying its weight;
    along: (n,) places of the springs towards the lean [m].
    """
    # depths of the points below the centre of mass
    depths = stance.depth * math.cos(tilt) + along * math.sin(tilt)

    def excess(height: float) -> float:
        return float(stiffness @ np.maximum(depths - height, 0.0)) - stance.weight

    highest = depths.max()
    lowest = highest - 2 * np.ptp(depths) - 2 * stance.weight / stiffness.min()
    height = brentq(excess, lowest, highest)
    pressed = np.maximum(depths - height, 0.0)
    return float(stance.weight * height + stiffness @ pressed**2 / 2)
