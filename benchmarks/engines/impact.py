"""What a first impact takes in the reduced engine, over what Housner's rigid block loses, and what
a flat landing gives back, by time step.

Of the specimen on its own mesh with the default's modes, alpha 0, mu 0.8. An impact falls anywhere
in a step: releases at tilts a little apart show how much that matters.
"""

from __future__ import annotations

import numpy as np

from benchmarks.engines.pair import case_of, column, engine
from fecolumn.case.sections import GRAVITY
from fecolumn.verification.models import system_of
from fecolumn.verification.trial import RigidRocking

# of the critical tilt; and so much more, in turn
SHARES, BESIDE = (0.4, 0.05), (1.0, 1.0075, 1.0175)
STEPS = (0.02, 1e-3, 2.5e-4, 1e-4, 2.5e-5)
LANDINGS = (1e-3, 2.5e-4, 1e-4)
FALL = 0.009  # [m]


def impact():
    """Loss of the first impact over Housner's, least and most of the releases; rebound of a flat
    landing over that of an elastic ball.
    """
    rigid = RigidRocking(system_of(case_of(contact={"friction_coefficient": 0.8})))
    yield "rigid block (Housner): restitution [-]", rigid.restitution, rigid.restitution, None
    for share in SHARES:
        for dt in STEPS:
            releases, ratios = zip(
                *(losses_over_housner(rigid, share * more, dt) for more in BESIDE)
            )
            yield (
                f"release at {share:g} alpha, dt {dt:g} s: loss / Housner's of the "
                f"impact, mean of {len(ratios)} [-]",
                0.0,
                np.mean(releases),
                None,
            )
            for word, ratio in (("least", min(ratios)), ("most", max(ratios))):
                yield (
                    f"impact from {share:g} alpha, dt {dt:g} s: loss / Housner's, "
                    f"{word} of {len(ratios)} [-]",
                    1.0,
                    ratio,
                    None,
                )
    for dt in LANDINGS:
        yield (
            f"flat landing from {1e3 * FALL:g} mm, dt {dt:g} s: restitution [-]",
            0.0,
            landing(dt),
            None,
        )


def release(dt: float, **initial):
    """Engine of the specimen that begins in free vibration, alpha 0."""
    return engine(
        case_of(
            contact={"friction_coefficient": 0.8},
            integration={"dt_s": dt, "alpha_hht": 0.0},
            initial=initial,
        )
    )


def advanced(one, seconds: float, dt: float) -> np.ndarray:
    """Rows of the history over `seconds` without ground motion."""
    return one.advance(np.zeros((round(seconds / dt), 3)))[0]


def losses_over_housner(rigid: RigidRocking, share: float, dt: float) -> tuple[float, float]:
    """Mechanical energy lost until a third of the tilt of release is left, and from there to a
    third of it on the other side, over what a rigid block loses in the impact between.

    The former is of the release itself: the column starts unstrained, and its weight falls onto the
    rim.
    """
    tilt = share * rigid.slenderness
    one = release(dt, tilt_rad=tilt)
    first = one.mechanical()
    rows = advanced(one, 1.6 * rigid.quarter_period(tilt), dt)
    lean, high = column(rows, "u_top")[:, 0], column(rows, "tilt") > tilt / 3
    mechanical = sum(column(rows, f"energy/{term}") for term in ("kinetic", "strain", "gravity"))
    rising = np.flatnonzero((lean < 0) & high)[0]
    falling = np.flatnonzero((lean[:rising] > 0) & high[:rising])[-1]
    exact = rigid.energy(tilt) * (1 - rigid.restitution**2)
    return float((first - mechanical[falling]) / exact), float(
        (mechanical[falling] - mechanical[rising]) / exact
    )


def landing(dt: float) -> float:
    """Velocity after over before of a standing column that is thrown up and lands on its whole
    foot, from the heights of its centre of mass.
    """
    speed = np.sqrt(2 * GRAVITY * FALL)
    one = release(dt, velocity_m_s=[0.0, 0.0, float(speed)])
    rows = advanced(one, 3.9 * speed / GRAVITY, dt)  # up, down, and up again whole as it may be
    height, touching = column(rows, "energy/gravity"), column(rows, "active_nodes") > 0
    flown = np.flatnonzero(~touching)[0]
    landed = flown + np.flatnonzero(touching[flown:])[0]
    return float(
        np.sqrt(
            max(0.0, height[landed:].max() - height[0]) / (height[flown:landed].max() - height[0])
        )
    )
