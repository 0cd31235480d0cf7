"""Standing still for a minute at every (dt, alpha) of the study, reduced engine, the specimen's own
mesh.
"""

from __future__ import annotations

import numpy as np

from benchmarks.engines.pair import case_of, column, engine
from benchmarks.figures import ALPHAS, STEPS, G

SECONDS, CHUNK = 60.0, 10_000


def standing(seconds: float = SECONDS):
    """Drift of the top and energy gained, over m g H; the worst alpha of each dt."""
    for dt in STEPS:
        drifts, gains = [], []
        for alpha in ALPHAS:
            drift, gain = still(dt, alpha, seconds)
            drifts.append(drift)
            gains.append(gain)
        yield (
            f"standing {seconds:g} s, dt {dt:g} s, five alphas: drift [m]",
            0.0,
            max(drifts),
            max(drifts) < 1e-9,
        )
        yield (
            f"standing {seconds:g} s, dt {dt:g} s, five alphas: energy gained / m g H [-]",
            0.0,
            max(gains),
            max(gains) < 1e-9,
        )


def still(dt: float, alpha: float, seconds: float) -> tuple[float, float]:
    """Largest way of the top [m] and largest energy above the start over m g H [-]."""
    one = engine(case_of(integration={"dt_s": dt, "alpha_hht": alpha}))
    height = one.model.top_arm[2] + one.model.center[2]
    start, left, drift, gain = (
        column(one.row()[None], "u_top")[0],
        round(seconds / dt),
        0.0,
        -np.inf,
    )
    while left:
        rows, lost = one.advance(np.zeros((min(left, CHUNK), 3)))
        if lost:
            return np.inf, np.inf
        left -= len(rows)
        drift = max(drift, np.linalg.norm(column(rows, "u_top") - start, axis=1).max())
        energy = (
            sum(column(rows, f"energy/{term}") for term in ("kinetic", "strain", "gravity"))
            - one.ledger[0]
        )
        gain = max(gain, energy.max())
    return drift, gain / (one.model.mass * G * height)
