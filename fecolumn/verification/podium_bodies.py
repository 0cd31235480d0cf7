"""Impact of a podium of bodies below a building of one storey: two masses and a spring, struck at
one of them.

Requirement: the impact of the columns takes no longer than a step, the spring of the storey needs a
quarter of its period to answer. So the slab comes out of an impact at the rate of CAV, the law by
which the floor keeps its absolute velocity, whatever the period; the floor then swings about the
slab, and the mean rate over its swing is that of the momentum of both. Where floor and slab went
equally fast before, that is the rate of CRV.

Derivation. Per N m_c R^2, with theta the columns' tilt, g = m_b / (N m_c), eta = M / m_b, s = sin
alpha and v the velocity of the floor over 2 R cos alpha: slab and columns have the inertia A = I +
4 g + 4 g eta s^2, the floor B = 4 g eta (1 - s^2), and without weight

    A theta'' = -B v',   v'' = -w^2 (v - theta'),   so that
    theta' = m + (theta'+ - m) cos(W t),   m = (A theta'+ + B v) / (A + B),   W^2 = w^2 (1 + B / A).

theta'+ = CAV theta'- and v = theta'- make m = CRV theta'-: both laws are the same balance of
angular momentum, one at the moment of the impact, the other after the building has come to swing.
Weight adds a term t^2. It must hold the swing: with an amplitude of the slab's acceleration above g
tan(alpha) of all masses, W 2 R (CRV - CAV) theta'- m_b > (m_b + M) g tan(alpha), the columns are
driven back onto the edges that they left and strike again.

Source: the paper on impact modelling of multi-storey podium structures, equations 5 and 6, which
takes CAV for the limit of a flexible building and CRV for that of a stiff one; [D] derived here.
Tolerance: dt / 2 over the time before the impact from which the rate is fitted, or half of the
slab's way in a swing over the columns' width, by which inertia and weight change on it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fecolumn.case.model_sections import CAV
from fecolumn.engines.rocking.podium_impact import podium_restitution
from fecolumn.verification.podium_structure import (
    ALPHA,
    GAMMA,
    HALF_DIAGONAL,
    let_go,
    podium_case,
    tilt_of,
)
from fecolumn.verification.result import Row

#: Periods of the storey on a fixed slab [s], down to what the weight holds; share of alpha from
#: which the podium is let go; step [s]
_PERIODS, _SHARE, _DT = (0.3, 0.1, 0.06), 0.1, 2.5e-4
#: Time before the impact [s] from which rates are fitted, and around it within which the step knows
#: it
BEFORE, SKIPPED = 4e-3, 5e-4
#: Longer than the fall to the impact takes [s]
_FALL = 0.32
_ALLOWED = 3e-3


def podium_rows() -> Iterator[Row]:
    """Rows of all periods."""
    for period in _PERIODS:
        found, words = struck(period), f"podium below a storey of {period:g} s"
        yield Row(
            f"{words}: velocity of the slab right after an impact over that before, CAV [-] (D)",
            podium_restitution(CAV, ALPHA, GAMMA, 1.0),
            found["slab"],
            _ALLOWED,
        )
        yield Row(
            f"{words}: the same of the floor, which the impact does not reach [-] (D)",
            1.0,
            found["floor"],
            _ALLOWED,
        )
        yield Row(
            f"{words}: mean of the slab while the floor swings, momentum of both [-] (D)",
            found["momentum"],
            found["mean"],
            _ALLOWED,
        )


def struck(period: float, dt: float = _DT) -> dict:
    """Velocities after over before the first impact: of the `slab` right after it and its `mean`
    over the swing of the floor, `momentum` that of the momentum of both, and of the `floor`.
    """
    carried, squared = 4 * GAMMA, math.sin(ALPHA) ** 2
    slab, floor = 4 / 3 + carried * (1 + squared), carried * (1 - squared)
    swing = 2 * math.pi / period * math.sqrt(1 + floor / slab)
    history = let_go(
        podium_case(1, period, _SHARE * ALPHA, dt, building=dict(damping_ratio=0.0)),
        _FALL + 2 * math.pi / swing,
    )
    time, tilt, drift = history["time"], tilt_of(history), history["storey/building 1/drift"][:, 0]
    moved = 2 * HALF_DIAGONAL * np.sign(tilt) * (math.sin(ALPHA) - np.sin(ALPHA - np.abs(tilt)))
    passed = int(np.argmax(tilt < 0))
    t = time - float(np.interp(0.0, -tilt[passed - 1 : passed + 1], time[passed - 1 : passed + 1]))
    before, after = (t > -BEFORE) & (t < -SKIPPED), (t > SKIPPED) & (t < 2 * math.pi / swing)
    came, along = (np.polyfit(t[before], values[before], 2)[1] for values in (moved, drift))
    # weight pulls all the more the nearer to upright
    forms = np.column_stack(
        [t**k for k in range(4)] + [np.sin(swing * t) / swing, 1 - np.cos(swing * t)]
    )[after]
    (_, mean, *_, swung, _), (_, drifted, *_, drift_swung, _) = (
        np.linalg.lstsq(forms, values[after], rcond=None)[0] for values in (moved, drift)
    )
    law = podium_restitution(CAV, ALPHA, GAMMA, 1.0)
    return dict(
        slab=(mean + swung) / came,
        mean=mean / came,
        momentum=(slab * law + floor * (1 + along / came)) / (slab + floor),
        floor=(mean + swung + drifted + drift_swung) / (came + along),
    )
