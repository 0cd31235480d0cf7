"""Bodies that land one after another within a step, which takes them as landing together.

The columns below a beam that does not slide are parallel and land together. Where it slides, one
lands before the other. Together they lose what a rocking frame loses; one after another a trilith
lost a quarter less (`python -m benchmarks.programs`). A step that is longer than the time between
cannot tell which it is.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Time between two landings over the step from which on they are taken to follow one another: of
#: parallel columns it is a hundredth and less, which is rounding of the places within the step.
_APART = 0.02
#: Turn of a body in a step, over the most of any, from which on it is a column that passes upright,
#: not a beam that chatters.
_TURNS = 0.1
#: Share of the energy of impacts above which this is told, and least number of such steps: rattling
#: before the first impact counts for none.
_SHARE, _LEAST = 0.1, 3
#: Steps between two landings that tell their order: a trilith lost 8.3 J at five of them, as in the
#: limit, and 11.4 J at one.
_STEPS = 5


def joined_landings(rows: dict[str, NDArray[Any]], dt: float) -> str | None:
    """What is doubtful of a step of dt [s] in which bodies land together, in words; None where
    nothing is.

    Parameters
    ----------
    rows
        the history, a row a step; otherwise nothing is told.
    """
    turns = [rows[name] for name in rows if name.startswith("body/") and name.endswith("/rotation")]
    time = rows["time"]
    if len(turns) < 2 or len(time) < 3 or abs(time[1] - time[0] - dt) > 1e-6 * dt:
        return None
    took = np.maximum(-np.diff(rows["energy/impact"]), 0.0)
    steps = np.flatnonzero(took)
    took = took[steps]
    before = np.array([turn[steps, :2] for turn in turns])
    after = np.array([turn[steps + 1, :2] for turn in turns])
    # (bodies, steps) when in the step each is nearest to upright, in steps; nan where it is not
    ways = after - before
    squares = np.maximum((ways**2).sum(axis=-1), 1e-300)
    passes = -(before * ways).sum(axis=-1) / squares
    over = (before * after).sum(axis=-1) < 0
    turned = squares > _TURNS**2 * squares.max(axis=0)
    passes = np.where(over & turned & (passes > 0) & (passes < 1), passes, np.nan)
    several = np.isfinite(passes).sum(axis=0) >= 2
    apart = np.zeros(len(steps))
    apart[several] = np.nanmax(passes[:, several], axis=0) - np.nanmin(passes[:, several], axis=0)
    joined = apart > _APART
    share = took[joined].sum() / max(took.sum(), 1e-300)
    if joined.sum() < _LEAST or share < _SHARE:
        return None
    order = np.argsort(apart[joined])
    by_energy = np.cumsum(took[joined][order])
    middle = dt * float(apart[joined][order][np.searchsorted(by_energy, by_energy[-1] / 2)])
    return (
        f"bodies that land one after another, {middle:.1g} s apart, land together in a step of "
        f"{dt:g} s, and that is another impact: {100 * share:.0f} % of what impacts took went so; "
        f"integration.dt_s = {middle / _STEPS:.1g} s would tell them apart"
    )
