"""What the filter of the contact keeps from the bodies: the deformation that contact forces leave
to statics.
"""

from __future__ import annotations

import numpy as np

from fecolumn.fem.foot import FilteredFoot
from fecolumn.fem.free_body import FreeBody
from fecolumn.fem.rotation import into_frames


class StaticRest:
    """Static displacement of the bodies of a System under the part of its contact forces that a
    step does not resolve, without which stresses near contacts lack.
    """

    def __init__(self, system):
        self._column, self._foot, self._first = (
            system.column,
            system.interface.foot,
            system.interface.rows,
        )
        self._free = (
            {part: FreeBody(part) for part in dict.fromkeys(system.column.parts)}
            if self._foot.filtered
            else {}
        )

    def displacement(self, at_nodes: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """(n_owned, 3) [m] in the frames of the bodies, turned by `rotation`, of forces (N, 3) [N]
        on the surface nodes in the table frame.
        """
        column, forces = self._column, into_frames(at_nodes, rotation, self._first)
        if not self._free:
            return np.zeros((column.n_owned, 3))
        resolved, nodes = (
            self._foot.load(forces),
            [self._foot.nodes] if isinstance(self._foot, FilteredFoot) else self._foot.nodes,
        )
        found = [
            self._free[part]
            .response((part.spread(own, forces[first]) - resolved[rows]).reshape(-1, 1))
            .reshape(-1, 3)
            for part, own, first, rows in zip(column.parts, nodes, self._first, column.rows)
        ]
        return np.concatenate(found)
