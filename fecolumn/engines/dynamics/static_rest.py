"""What the filter of the contact keeps from the bodies: the deformation that contact forces leave
to statics.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.fem.free_body import FreeBody
from fecolumn.fem.rotation import into_frames
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.system import System


class StaticRest:
    """Static displacement of the bodies of a System under the part of its contact forces that a
    step does not resolve, without which stresses near contacts lack.
    """

    def __init__(self, system: System) -> None:
        self._bodies, self._foot, self._first = (
            system.bodies,
            system.interface.foot,
            system.interface.rows,
        )
        self._free = (
            {part: FreeBody(part) for part in dict.fromkeys(system.bodies.parts)}
            if self._foot.filtered
            else {}
        )

    def displacement(self, at_nodes: Array, rotation: Array) -> Array:
        """(n_owned, 3) [m] in the frames of the bodies, turned by `rotation`, of forces (N, 3) [N]
        on the surface nodes in the table frame.
        """
        bodies, forces = self._bodies, into_frames(at_nodes, rotation, self._first)
        if not self._free:
            return np.zeros((bodies.n_owned, 3))
        resolved = self._foot.load(forces)
        found = [
            self._free[part]
            .response((part.spread(own, forces[first]) - resolved[rows]).reshape(-1, 1))
            .reshape(-1, 3)
            for part, own, first, rows in zip(
                bodies.parts, self._foot.nodes, self._first, bodies.rows
            )
        ]
        return np.concatenate(found)
