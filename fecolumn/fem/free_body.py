"""Static response of a body that nothing holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.fem.effective import effective_factor
from fecolumn.fem.rayleigh import spectral_shift
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body

# Shift of the singular free-free stiffness over the bound of the first elastic frequency's square:
# two terms of the series do
_SHARE = 3e-6
# Remainder at which the series ends, over the displacement (root of the sum of squares over all
# nodes)
REMAINDER = 1e-10
# Terms after which it is given up: they do down to a first elastic frequency of a three-thousandth
# of the bound's
MOST_TERMS = 1000


def rigid_fields(body: Body) -> tuple[Array, Array, Array]:
    """Rigid motions (3 n_owned, 6), translations and rotations about the centre of mass; M times
    them; and the 6 x 6 masses.
    """
    arm = body.X - body.center
    fields = np.stack(
        [np.tile(e, (len(arm), 1)) for e in np.eye(3)] + [np.cross(e, arm) for e in np.eye(3)],
        axis=-1,
    )
    fields = np.asfortranarray(fields.reshape(-1, 6))
    momentum = body.apply_many(body.mass, fields)
    return fields, momentum, body.sum(fields.T @ momentum)


class FreeBody:
    """Static response of a free body to forces, its rigid motion taken out (inertia relief).

    Forces act together with the inertia forces of the rigid acceleration they cause. With A = K + s
    M factored, the response is the sum over k of A^-1 (s M A^-1)^k f. In a mode of frequency w each
    term is s / (w^2 + s) of the one before, so that the series converges at any shift s > 0, and
    what is left out is known from the last two terms.
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        #: s [1/s2].
        self.shift = spectral_shift(body, _SHARE)
        self._factor = effective_factor(body, self.shift, 1.0)
        self.fields, self.momentum, self.masses = rigid_fields(body)
        self._shares = np.linalg.inv(self.masses)

    def response(self, forces: Array) -> Array:
        """Elastic displacements (3 n_owned, k) under reduced forces (3 n_owned, k), to REMAINDER of
        each.

        Raises
        ------
        RuntimeError
            the series does not converge.
        """
        body = self.body
        forces = forces - self.momentum @ (self._shares @ body.sum(self.fields.T @ forces))
        term = self._elastic(self._factor.solve_many(forces))
        total, first = term, self._size(term)
        before = first
        for _ in range(MOST_TERMS):
            term = self.shift * self._elastic(
                self._factor.solve_many(body.apply_many(body.mass, term))
            )
            total, size = total + term, self._size(term)
            # the terms to come, as a geometric series of the last ratio: size^2 / (before - size)
            if np.all(size**2 <= REMAINDER * first * (before - size)):
                return total
            before = size
        raise RuntimeError(
            f"the static response of the body has not converged after {MOST_TERMS} "
            "terms: largest of the last ones "
            f"{size.max():.3g} m, of all {first.max():.3g} m"
        )

    def _size(self, columns: Array) -> Array:
        """Root of the sum of squares (k,) of each column."""
        return np.sqrt(self.body.sum(np.einsum("ik,ik->k", columns, columns)))

    def _elastic(self, columns: Array) -> Array:
        return columns - self.fields @ (self._shares @ self.body.sum(self.momentum.T @ columns))
