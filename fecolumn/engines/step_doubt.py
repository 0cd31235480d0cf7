"""Whether a step that the user states is too long for the rocking and the impacts it met.

Two signs are looked at, both of the analysis itself and without any trial. Rocking between two
landings that takes N steps is off in its period by (pi / N)^2 / 12, the error of the trapezoidal
rule at an angular frequency of pi / (N dt). Impacts that take more than those of rigid bodies do
so because of the step: in the limit rigid bodies take all of it, elastic ones 0.8 (theory,
section 4).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.ending import ROCKS
from fecolumn.engines.first_impacts import APART_S, landings

# Steps between landings below which the period is off by more than 1 %
_STEPS = math.pi / math.sqrt(12 * 0.01)
# Loss of impacts over that of rigid bodies above which the step is doubted: by the scatter of
# releases beside each other at converged steps (theory, section 4)
_SHARE = 1.25
# Steps without a landing after which the next is of another one, and not of the same impact
_APART = 2.5
# Landings that the median needs
_LEAST = 4


def step_doubt(
    rows: dict[str, NDArray[Any]],
    dt: float,
    share: float | None,
    barrier_j: float,
    critical: float | None,
    alone: bool,
    rigid: bool,
) -> str | None:
    """What is doubtful of the step, in words; None where nothing is.

    Parameters
    ----------
    rows
        the history, a row a step.
    dt
        the step [s].
    share
        energy that impacts took over that of rigid bodies, None where that is not known.
    barrier_j
        energy to overturn [J].
    critical
        tilt beyond which the column falls [rad]; None where it is not known.
    alone
        whether it is one body, whose landings follow each other.
    rigid
        whether all bodies are rigid.
    """
    tilts = [rows[name] for name in rows if name.startswith("body/") and name.endswith("/tilt")]
    if max(float(one.max()) for one in (rows["tilt"], *tilts)) < ROCKS * (critical or 0.0):
        return None
    said = []
    apart_s = min(APART_S, _APART * dt)
    between = np.diff(landings(rows, barrier_j, apart_s=apart_s)[0]) if alone else np.empty(0)
    if len(between) >= _LEAST and (steps := float(np.median(between)) / dt) < _STEPS:
        off = (math.pi / steps) ** 2 / 12
        said.append(
            f"half of the landings are less than {steps:.2g} steps after the one before, whose "
            f"time is off by some {100 * off:.2g} %: at most {_short(float(np.median(between)))} s "
            "would follow them"
        )
    if share is not None and share > _SHARE:
        said.append(
            f"impacts took {share:.3g} of what rigid bodies lose, in short steps "
            f"{'they take just that' if rigid else 'elastic ones take about 0.8'}: rocking dies "
            "out too fast, unless joints slide where they land"
        )
    if not said:
        return None
    return (
        f"integration.dt_s = {dt:g} s is long for this motion: {'; '.join(said)}; "
        'dt_s = "auto" chooses a step, fecolumn help theory tells what it does to impacts'
    )


def _short(between: float) -> str:
    """Step that follows landings so far apart, one digit, rounded down."""
    step = between / _STEPS
    unit = 10.0 ** math.floor(math.log10(step))
    return f"{math.floor(step / unit) * unit:g}"
