"""Static response of a body that nothing holds."""

from __future__ import annotations

import numpy as np

from fecolumn.fem.effective import effective_factor

# Shift of the singular free-free stiffness [1/s2]: far below the square of any column's first elastic frequency
SHIFT = 400.0


def rigid_fields(body) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rigid motions (3 n_owned, 6), translations and rotations about the centre of mass; M times them; and the 6 x 6 masses."""
    arm = body.X - body.center
    fields = np.stack([np.tile(e, (len(arm), 1)) for e in np.eye(3)] + [np.cross(e, arm) for e in np.eye(3)], axis=-1)
    fields = np.asfortranarray(fields.reshape(-1, 6))
    momentum = body.apply_many(body.mass, fields)
    return fields, momentum, body.sum(fields.T @ momentum)


class FreeBody:
    """Static response of a free body to forces, its rigid motion taken out (inertia relief).

    Forces act together with the inertia forces of the rigid acceleration they cause. With K + s M factored, Y1 = (K + s M)^-1 f and
    Y2 = (K + s M)^-1 M Y1, the response is Y1 + s Y2 up to (s / w^2)^2, 1e-8 of the first mode's part.
    """

    def __init__(self, body):
        self.body = body
        self._factor = effective_factor(body, SHIFT, 1.0)
        self.fields, self.momentum, self.masses = rigid_fields(body)
        self._shares = np.linalg.inv(self.masses)

    def response(self, forces: np.ndarray) -> np.ndarray:
        """Elastic displacements (3 n_owned, k) under reduced forces (3 n_owned, k)."""
        body = self.body
        forces = forces - self.momentum @ (self._shares @ body.sum(self.fields.T @ forces))
        once = self._elastic(self._factor.solve_many(forces))
        twice = self._elastic(self._factor.solve_many(body.apply_many(body.mass, once)))
        return once + SHIFT * twice

    def _elastic(self, columns: np.ndarray) -> np.ndarray:
        return columns - self.fields @ (self._shares @ self.body.sum(self.momentum.T @ columns))
