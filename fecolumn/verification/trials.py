"""A trial of a system in any engine of elements."""

from __future__ import annotations

from fecolumn.engines.dynamics.gravity import standing
from fecolumn.verification import FULL
from fecolumn.verification.reduced_trial import ReducedTrial
from fecolumn.verification.trial import N_MODES, Trial


def begin_trial(
    engine: str, system, start=standing, impact: str = "plastic", n_modes: int = N_MODES
) -> Trial:
    """A trial of a system in an engine of `verification.ELEMENTS`; arguments as of `Trial`, n_modes
    of `ReducedTrial`.
    """
    if engine in FULL:
        return Trial(system, start, impact)
    return ReducedTrial(system, start, n_modes if engine == "reduced" else 0)
