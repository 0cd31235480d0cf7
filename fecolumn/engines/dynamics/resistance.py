"""Rolling resistance of rims in full order: moments on the rigid motion of bodies, which strain
nothing.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import MASTER, SLAVE
from fecolumn.contact.rolling import rolling_moment
from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.rotation import into_frames, out_of_frames
from fecolumn.foundation.arrays import Array


class Resistance:
    """Moments of `contact.rolling.rolling_moment` as accelerations of all nodes: on the bodies that
    roll, and the opposite on those on which they roll.
    """

    def __init__(self, system: Any) -> None:
        self._bodies, self._interface = system.bodies, system.interface
        made = system.bodies.of_each(lambda part, _: rigid_fields(part))
        self._turns, self._momenta = ([one[:, 3:] for one in each] for each in list(zip(*made))[:2])
        self._inverse = [np.linalg.inv(masses[3:, 3:]) for _, _, masses in made]

    def acceleration(self, state: Any, dt: float) -> Array:
        """Acceleration (n_owned, 3) [m/s2] in a step of `dt` [s] from a state."""
        bodies, interface, R = self._bodies, self._interface, state.rotation
        own = into_frames(state.v, R, bodies.rows)
        momenta = bodies.sum(
            np.stack([of.T @ own[rows].ravel() for of, rows in zip(self._momenta, bodies.rows)])
        )
        spins = np.einsum("bij,bj->bi", self._inverse, momenta)
        moments, loads = np.zeros((len(R), 3)), np.zeros(len(interface.interfaces))
        np.add.at(loads, interface.points["interface"], state.forces[:, 2])
        for one, pose, load in zip(
            interface.interfaces, interface.poses(state.x, R), loads.tolist()
        ):
            if not one["rolling"] > 0:
                continue
            b, m, turned = int(one["slave"]), int(one["master"]), pose["turned"]
            spin, inverse = spins[b], self._inverse[b]
            # of the master into the slave's frame
            turn = turned[SLAVE].T @ turned[MASTER]
            if m != GROUND:
                spin, inverse = spin - turn @ spins[m], inverse + turn @ self._inverse[m] @ turn.T
            moment = rolling_moment(
                np.ascontiguousarray(turned[SLAVE]),
                spin,
                load,
                float(one["radius"]),
                float(one["rolling"]),
                inverse,
                dt,
            )
            moments[b] += moment
            if m != GROUND:
                moments[m] -= turn.T @ moment
        rates = [inverse @ moment for inverse, moment in zip(self._inverse, moments)]
        fields = [(turns @ rate).reshape(-1, 3) for turns, rate in zip(self._turns, rates)]
        return out_of_frames(np.concatenate(fields), R, bodies.rows)
