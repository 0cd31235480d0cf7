"""Rolling resistance of the rim of a body in full order: a moment on its rigid motion, which
strains nothing.
"""

from __future__ import annotations

import numpy as np

from fecolumn.contact.rolling import rolling_moment
from fecolumn.fem.free_body import rigid_fields


class Resistance:
    """Moment of `contact.rolling.rolling_moment` as accelerations of all nodes.

    Parameters
    ----------
    body
        Body.
    rim
        Rim of its foot.
    coefficient
        energy lost per length rolled over the contact force [-].
    """

    def __init__(self, body, rim, coefficient: float):
        self._body, self._rim, self._coefficient = body, rim, coefficient
        fields, momentum, masses = rigid_fields(body)
        self._turns, self._momenta, self._inverse = (
            fields[:, 3:],
            momentum[:, 3:],
            np.linalg.inv(masses[3:, 3:]),
        )

    def acceleration(self, state, dt: float) -> np.ndarray:
        """Acceleration (n_owned, 3) [m/s2] in a step of `dt` [s] from a state."""
        spin = self._inverse @ self._body.sum(self._momenta.T @ (state.v @ state.rotation).ravel())
        moment = rolling_moment(
            state.rotation,
            spin,
            float(state.forces[:, 2].sum()),
            self._rim.radius,
            self._coefficient,
            self._inverse,
            dt,
        )
        return (self._turns @ (self._inverse @ moment)).reshape(-1, 3) @ state.rotation.T
