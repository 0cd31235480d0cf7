"""Steps that are not made at once: what is made in parts, and steps that fail and are tried again
in halves.
"""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fecolumn.engines.dynamics.hht import HHT
from fecolumn.foundation.arrays import Array

#: Places of "rolling" and "impacts" among SUBSTEPS, for compiled code.
ROLLING_PARTS, IMPACT_PARTS = range(2)


class Stop(enum.Enum):
    """Why the iteration of a step ended."""

    CONVERGED = "converged"
    ITERATIONS = "no convergence within max_iterations"
    MOTION = "motion and contact forces did not converge"
    CONTACT = "the contact problem did not converge"
    DIVERGED = "the residual grew without bound"
    OFF_BASE = "the foot reached the edge of the base plate"
    OFF_PATCH = "a body left the part of the face below it that was prepared for contact"


class StepFailed(RuntimeError):
    """A step did not converge even after the allowed cuts; `stop` says why, `joints` names those
    of which a body left what was prepared.
    """

    def __init__(self, stop: Stop, message: str, joints: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.stop, self.joints = stop, joints


@dataclass(frozen=True, slots=True)
class Halving:
    """How steps that fail are halved.

    Attributes
    ----------
    take
        function (state, ground, hht) of the state one hht.dt later, or StepFailed.
    max_cuts
        halvings allowed.
    count
        called once for each.
    """

    take: Callable
    max_cuts: int
    count: Callable[[], None]


def in_halves(
    halving: Halving,
    state: Any,
    before: Array,
    after: Array,
    hht: HHT,
    failure: StepFailed,
    cuts: int = 0,
) -> Any:
    """The state after a step that failed with `failure`, made in two halves, and these in halves
    where they fail, too.

    Parameters
    ----------
    state
        at the start of the step.
    before, after
        (3 G,) accelerations of all grounds at the ends of the step [m/s2].
    cuts
        halvings made so far.

    Raises
    ------
    StepFailed
        even with the smallest step; at once where the foot left the base or the part of a face that
        is known, which no smaller step mends.
    """
    at_once = failure.stop in (Stop.OFF_BASE, Stop.OFF_PATCH)
    if cuts == halving.max_cuts or at_once:
        raise StepFailed(
            failure.stop,
            f"{failure} (step cut {cuts} times to {hht.dt:.3g} s; integration.max_cuts = {cuts} "
            "allows no more)"
            if 0 < cuts == halving.max_cuts and not at_once
            else str(failure),
            failure.joints,
        )
    halving.count()
    half, middle = HHT(hht.dt / 2, hht.alpha), (before + after) / 2
    for first, last in ((before, middle), (middle, after)):
        try:
            state = halving.take(state, last, half)
        except StepFailed as again:
            state = in_halves(halving, state, first, last, half, again, cuts + 1)
    return state
