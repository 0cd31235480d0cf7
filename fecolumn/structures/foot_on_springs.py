"""A rigid body that leans slowly on springs that only push: soil, or a pad.

Its potential energy over the tilt is that of weight and springs at the height at which these carry
the weight. It grows up to the critical tilt and falls beyond it. That tilt is less than the one at
which the centre of mass stands over the edge: the edge sinks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from fecolumn.contact.overturning import Stance, weakest

# Tilts at which the energy is found, up to that at which the centre of mass stands over the edge
_TILTS = 200


@dataclass(frozen=True)
class FootOnSprings:
    """stance: of the body on rigid ground. arms: (n, 3) [m] points of its foot from the centre of
    mass, of a dome the centre of its sphere; stiffness: (n,) [N/m] of the springs below them.
    radius: [m] of a dome, 0 of any other foot.
    """

    stance: Stance
    arms: NDArray[Any]
    stiffness: NDArray[Any]
    radius: float = 0.0

    @property
    def sinks(self) -> float:
        """Way [m] by which it settles upright."""
        return float(self.stance.weight / self.stiffness.sum())

    @property
    def holds(self) -> float:
        """Stiffness of its springs against tilting over its weight times the height of its centre
        of mass, less than 1 of a body that does not stand.

        A dome has one spring and stands where the centre of mass is below that of its sphere.
        """
        if self.radius:
            return self.radius / float(self.radius - self.arms[0, 2])
        middle = self.stiffness @ self.arms[:, :2] / self.stiffness.sum()
        away = self.arms[:, :2] - middle
        weakly = np.linalg.eigvalsh((self.stiffness * away.T) @ away)[0]
        return float(weakly / (self.stance.weight * self.stance.depth))

    @property
    def critical(self) -> float:
        """Tilt [rad] towards the weakest edge at which it is lost without help, 0 of a body that
        does not stand upright.
        """
        return self._summit[0]

    @property
    def barrier(self) -> float:
        """Energy [J] that takes it to the critical tilt slowly."""
        return self._summit[1]

    @cached_property
    def _summit(self) -> tuple[float, float]:
        """Critical tilt [rad] and barrier [J]."""
        tilts = np.linspace(0.0, max(self.stance.critical, 0.0), _TILTS + 1)
        energy = np.array([self._energy(tilt) for tilt in tilts])
        highest = int(np.argmax(energy))
        return float(tilts[highest]), float(energy[highest] - energy[: highest + 1].min())

    def _energy(self, tilt: float) -> float:
        """Potential energy [J] of the body that leans by `tilt` [rad] to its weakest edge, the
        springs carrying its weight.
        """
        depths = self._depths(tilt)

        def excess(height: float) -> float:
            return float(self.stiffness @ np.maximum(depths - height, 0.0)) - self.stance.weight

        highest = depths.max()
        lowest = highest - 2 * np.ptp(depths) - 2 * self.stance.weight / self.stiffness.min()
        height = brentq(excess, lowest, highest)
        pressed = np.maximum(depths - height, 0.0)
        return float(self.stance.weight * height + self.stiffness @ pressed**2 / 2)

    def _depths(self, tilt: float) -> NDArray[Any]:
        """Depths (n,) [m] of the points below the centre of mass, of a dome that of its lowest
        place.
        """
        edge, ahead = weakest(self.stance.corners)
        depth, along = self.stance.depth, self.arms[:, :2] @ ahead
        if self.radius:
            if math.sin(tilt) * self.radius <= edge:
                return self.radius - self.arms[:, 2] * math.cos(tilt)
            depth, along = math.sqrt(self.radius**2 - edge**2) - self.arms[0, 2], np.array([edge])
        depths: NDArray[Any] = depth * math.cos(tilt) + along * math.sin(tilt)
        return depths
