"""Parameters of a rigid structure that rocks in a plane with one degree of freedom; `swing` has its
law and moves it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fecolumn.engines.rocking.swing import (
    ALPHA,
    FASTEST,
    GRAVITY,
    HELD,
    KEPT,
    N_PARAMETERS,
    ONLY,
    P2,
    PER_MASS,
    SPRING,
    TENDON,
    THRUST,
    look,
)

__all__ = ["GRAVITY", "Rocker"]


@dataclass(frozen=True, slots=True, eq=False)
class Rocker:
    """Parameters of one structure; pairs are of the sides + and -.

    Attributes
    ----------
    alpha
        (2,) [rad]
    p2
        p^2 (2,) [1/s2]
    restitution
        of phi' as it leaves a side (2,)
    radius
        R_s (2,) [m]; mass [kg].
    springs
        (2, 3) sums K y^2, K y c, K c^2 over the springs, over I_s [1/s2]
    tendon
        (2, 2) n^2 K_t c^2 and n P c, over I_s [1/s2]
    thrust
        (2, 2) s H y and s H c, over I_s [1/s2].
    only
        side it can lean to alone, +1 or -1; 0 for both.
    """

    alpha: tuple[float, float]
    p2: tuple[float, float]
    restitution: tuple[float, float]
    radius: tuple[float, float]
    mass: float = 1.0
    springs: tuple = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    tendon: tuple = ((0.0, 0.0), (0.0, 0.0))
    thrust: tuple = ((0.0, 0.0), (0.0, 0.0))
    only: int = 0

    @property
    def row(self) -> np.ndarray:
        """(N_PARAMETERS,) for `rock_all`."""
        row = np.zeros(N_PARAMETERS)
        row[ALPHA : ALPHA + 2], row[P2 : P2 + 2], row[KEPT : KEPT + 2] = (
            self.alpha,
            self.p2,
            self.restitution,
        )
        row[SPRING : SPRING + 6], row[TENDON : TENDON + 4], row[THRUST : THRUST + 4] = (
            np.ravel(self.springs),
            np.ravel(self.tendon),
            np.ravel(self.thrust),
        )
        row[ONLY] = self.only
        row[PER_MASS : PER_MASS + 2] = GRAVITY * np.array(self.radius) / self.p2
        stiff = (
            np.abs(self.springs).sum(axis=1)
            + np.abs(np.array(self.tendon)[:, 0])
            + np.abs(self.thrust).sum(axis=1)
        )
        row[FASTEST] = math.sqrt(max(self.p2 + stiff))
        row[HELD] = float(np.any(self.springs) or np.any(self.tendon) or np.any(self.thrust))
        return row

    def restoring(self, tilt, side: int = 1) -> np.ndarray:
        """Restoring moment at lean `tilt` >= 0 on a side [N m], without ground motion."""
        return self._along(tilt, side)[..., 0]

    def potential(self, tilt, side: int = 1) -> tuple[np.ndarray, np.ndarray]:
        """Gravity energy, and that of springs, tendon and thrust, at lean `tilt` >= 0 on a side,
        from upright [J].
        """
        found = self._along(tilt, side)
        return found[..., 1], found[..., 2]

    def _along(self, tilt, side: int) -> np.ndarray:
        """Restoring moment, gravity energy and held energy (..., 3) [N m, J]."""
        row, k, found = self.row, 0 if side > 0 else 1, np.empty((np.size(tilt), 4))
        look(row, k, np.ascontiguousarray(np.ravel(tilt), float), found)
        return self.mass * row[PER_MASS + k] * found[:, :3].reshape(*np.shape(tilt), 3)

    def critical(self, side: int = 1) -> float:
        """Lean at which the restoring moment vanishes [rad]; pi/2 where it never does."""
        found = np.empty((1, 4))
        look(self.row, 0 if side > 0 else 1, np.zeros(1), found)
        return float(found[0, 3])
