"""Whether the feet of many bodies stay, and the operator of their contact problem while they do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.arrays import arrays_of
from fecolumn.contact.interface import rims_at_rest
from fecolumn.contact.pose import SLAVE
from fecolumn.contact.problem import STICKS_STILL, begin_problem
from fecolumn.contact.stick import holds, is_worth, no_stick
from fecolumn.contact.tolerances import LEVEL
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.problem import Problem
    from fecolumn.engines.dynamics.places import Nodal


class StickOperatorCache:
    """Stick operator (`contact.stick`) of a structure in full order.

    stick: Stick, rims: (ni,) of RIM of the present step, both as `contact.forces.solve_linear`
    takes them.

    Parameters
    ----------
    interfaces
        (ni,) of INTERFACE.
    points
        of all of them; 0 where no operator is wanted, as of a single foot, whose problem is small.
    """

    def __init__(self, interfaces: Array, points: int) -> None:
        self._interfaces = interfaces
        self.stick, self.rims = no_stick(points, len(interfaces)), rims_at_rest(len(interfaces))
        # compliance that the operator was found with, None of a checkpoint's; poses at the start of
        # the step
        self._nodal: Nodal | None = None
        self._poses: Array | None = None
        self._still, self._worth = False, False

    def note(self, poses: Array, rims: Array) -> None:
        """Note, at the start of a step, whether feet with these poses (ni,) of POSE and rims are
        where the operator holds, and whether they go on to stay as they did in the step before,
        long enough for finding it to pay.
        """
        before, angles, self._poses, self.rims = self._poses, self.rims["angle"], poses, rims
        self._still, self._worth = (
            interpreted(holds)(self.stick, self._interfaces, rims, 0.0, poses, 1.0),
            False,
        )
        if before is not None and np.array_equal(angles, rims["angle"], equal_nan=True):
            turns = np.abs(poses["turned"][:, SLAVE] - before["turned"][:, SLAVE]).max(axis=(1, 2))
            ways = np.abs(poses["foot"] - before["foot"])[:, :2].max(axis=1)
            level = np.abs(self._interfaces["axes"][:, 2, 2]) > LEVEL
            worth = (
                interpreted(is_worth)(*foot, 1.0)
                for foot in zip(self._interfaces, poses, turns, ways)
            )
            self._worth = level.all() and all(worth)

    def begin(self, problem: Problem, nodal: Nodal) -> None:
        """Begin a contact problem of a stage with the compliance `nodal` of `dynamics.places`."""
        still = self._still and (self._nodal is nodal or self._nodal is None)
        begin_problem(problem, still, self._worth and not still)

    def end(self, problem: Problem, nodal: Nodal) -> None:
        """Note whether the problem has found the operator."""
        if problem.flags[STICKS_STILL]:
            self._nodal = nodal

    def to_keep(self, nodal: Nodal | None) -> dict[str, Array]:
        """Arrays of a checkpoint with the operator found with `nodal`, so that an analysis goes on
        to the last digit as if it had not been interrupted; none of another.
        """
        return (
            {f"stick.{name}": values for name, values in arrays_of(self.stick).items()}
            if nodal is not None and self._nodal is nodal
            else {}
        )

    def take(self, arrays: dict[str, Array]) -> None:
        """Take over the operator from the arrays of a checkpoint, if there is one."""
        own = arrays_of(self.stick)
        if all(f"stick.{name}" in arrays for name in own):
            for name, values in own.items():
                values[...] = arrays[f"stick.{name}"]
