"""The rocking podium in bodies beside the model with the impact laws CRV and CAV."""

from __future__ import annotations

import math

import numpy as np

from fecolumn.case.model_sections import CAV, CRV
from fecolumn.engines.rocking.podium import Podium
from fecolumn.engines.rocking.podium_impact import podium_restitution
from fecolumn.engines.rocking.storeys import storeys
from fecolumn.motions.record import GroundMotion
from fecolumn.verification.podium_structure import (
    ALPHA,
    GAMMA,
    HALF_DIAGONAL,
    let_go,
    podium_case,
    tilt_of,
)

#: Periods of the building on a fixed slab [s]
PERIODS = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
#: Of concrete: columns of 2 x 2 elements in plan with 10 modes, points that give as concrete does
CONCRETE = dict(
    column=dict(rigid=False, modes=10, element_size_m=0.2225, youngs_modulus_pa=30e9),
    building=dict(youngs_modulus_pa=30e9),
)
_DT = 5e-4


def laws(floors: int) -> tuple[float, float]:
    """Rate of the tilt after over before an impact, by CRV and CAV."""
    return tuple(podium_restitution(law, ALPHA, GAMMA, floors) for law in (CRV, CAV))


def kept_rate(rows: dict, skip: float = 2e-3, width: float = 8e-3) -> float:
    """Rate of the tilt after over before the first impact: by straight and curved fits over `width`
    [s], `skip` [s] from it.
    """
    time, tilt = rows["time"], tilt_of(rows)
    passed = int(np.argmax(tilt < 0))
    at = float(np.interp(0.0, -tilt[passed - 1 : passed + 1], time[passed - 1 : passed + 1]))
    before, after = (
        ((time > at - skip - width) & (time < at - skip)),
        ((time > at + skip) & (time < at + skip + width)),
    )
    return float(
        np.polyfit(time[after] - at, tilt[after], 2)[1]
        / np.polyfit(time[before] - at, tilt[before], 2)[1]
    )


def impacts(floors: int = 3, concrete: bool = False, periods=PERIODS) -> list[tuple]:
    """Of each period: rate kept at the first impact from 0.3 alpha, and root of the share of the
    energy at the next largest tilt.
    """
    found = []
    for period in periods:
        rows = let_go(
            podium_case(floors, period, 0.3 * ALPHA, _DT, **(CONCRETE if concrete else {})), 1.1
        )
        tilt = tilt_of(rows)
        found.append((period, kept_rate(rows), risen(tilt, 0.3)))
    return found


def risen(tilt: np.ndarray, share: float) -> float:
    """Root of the potential energy at the largest tilt after the first impact over that of the tilt
    `share` alpha.
    """
    after = -float(tilt[int(np.argmax(tilt < 0)) :].min())
    return math.sqrt(
        (math.cos(ALPHA - after) - math.cos(ALPHA))
        / (math.cos(ALPHA * (1 - share)) - math.cos(ALPHA))
    )


def model_rocking(
    floors: int, law: str, period: float, share: float, seconds: float, dt: float = 1e-3
):
    """Response of the model let go at `share` of alpha."""
    podium = Podium(ALPHA, HALF_DIAGONAL, 1e4, 1e5, storeys("triangular", floors, 1e5, period), law)
    rest = GroundMotion(np.zeros((round(seconds / dt) + 1, 3)), dt, "at rest", "")
    return podium.respond(rest, tilt=share * ALPHA)


def rocking(floors: int, concrete: bool, share: float = 0.9, seconds: float = 4.0) -> dict:
    """Rows of bodies let go at `share` of alpha, with a building of n / 10 s."""
    return let_go(
        podium_case(floors, floors / 10, share * ALPHA, _DT, **(CONCRETE if concrete else {})),
        seconds,
    )


def tops(tilt: np.ndarray) -> list[float]:
    """Largest tilts over alpha between one passage upright and the next, after the first."""
    ends = np.flatnonzero(np.diff(np.sign(tilt)) != 0)
    return [float(np.abs(tilt[a:b]).max() / ALPHA) for a, b in zip(ends, ends[1:]) if b - a > 10]
