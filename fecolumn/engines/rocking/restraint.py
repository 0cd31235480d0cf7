"""What holds a rocking structure: springs, a bed of springs, a tendon, a thrust."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.foundation.arrays import Array


@dataclass(frozen=True, slots=True)
class Restraint:
    """Springs, tendon and thrust of a structure, for one side it leans to.

    A point at height y, at the horizontal distance c inside the edge, moves by u = y sin phi + c (1
    - cos phi) in the lean phi.

    Attributes
    ----------
    springs
        (n, 3) stiffness K [N/m], height y [m], distance c [m]: horizontal springs to fixed points
        far away, free of force upright.
    bed
        (n, 4) stiffness over height K' [N/m2], bottom and top [m], c [m]: springs smeared over the
        height.
    tendons
        (n, 3) stiffness K_t [N/m], prestress P [N], 2 c times the number of joints it crosses [m]:
        stretched by that times sin(phi/2).
    thrust
        (H, y, c) horizontal force [N] towards the lean at a point [m].
    """

    springs: tuple[tuple[float, float, float], ...] = ()
    bed: tuple[tuple[float, float, float, float], ...] = ()
    tendons: tuple[tuple[float, float, float], ...] = ()
    thrust: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def moments(self) -> tuple[float, float, float]:
        """Sums K y^2, K y c, K c^2 [N m]."""
        found = np.zeros(3)
        for stiffness, height, inside in self.springs:
            found += stiffness * np.array([height**2, height * inside, inside**2])
        for stiffness, low, high, inside in self.bed:
            found += stiffness * np.array(
                [(high**3 - low**3) / 3, (high**2 - low**2) / 2 * inside, (high - low) * inside**2]
            )
        square, mixed, level = found.tolist()
        return square, mixed, level

    @property
    def forces(self) -> tuple[float, float]:
        """Sums K y, K c [N]: the springs pull with K y sin phi + K c (1 - cos phi)."""
        found = np.zeros(2)
        for stiffness, height, inside in self.springs:
            found += stiffness * np.array([height, inside])
        for stiffness, low, high, inside in self.bed:
            found += stiffness * np.array([(high**2 - low**2) / 2, (high - low) * inside])
        upper, lower = found.tolist()
        return upper, lower

    @property
    def tendon(self) -> tuple[float, float]:
        """Sums K_t (e/2)^2 and P e/2 over the tendons, e their stretch over sin(phi/2) [N m]:
        moment K_t (e/2)^2 sin phi + P e/2 cos(phi/2).
        """
        return (
            sum(stiffness * (reach / 2) ** 2 for stiffness, _, reach in self.tendons),
            sum(force * reach / 2 for _, force, reach in self.tendons),
        )

    @property
    def thrust_moments(self) -> tuple[float, float]:
        """H y, H c of the thrust [N m]."""
        force, height, inside = self.thrust
        return force * height, force * inside

    def tension(self, lean: ArrayLike) -> Array:
        """Of all tendons together [N]."""
        return sum(
            (
                force + stiffness * reach * np.sin(np.asarray(lean) / 2)
                for stiffness, force, reach in self.tendons
            ),
            0.0 * np.asarray(lean),
        )

    def pull(self, lean: Array) -> Array:
        """Horizontal force of springs and thrust on the structure, against the lean [N]."""
        rising, turning = self.forces
        pull: Array = rising * np.sin(lean) + turning * (1 - np.cos(lean)) - self.thrust[0]
        return pull
