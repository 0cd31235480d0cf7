"""What one impact takes from the rocking of a column, by the length of the step at the impact."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from benchmarks.impact.rocker import rocker

#: Longest step of the fall and of the rise [s]: there is no impact in them.
AWAY = 2.5e-4
#: The impact is over when the column is up again by this share of its release, and this tilt [rad].
CLEAR, CLEAR_TILT = 0.03, 3e-4
#: Time after which it is over in any case [s].
LONGEST = 0.05
#: Tilts, over that of release, between which the arcs before and after are fitted: without the
#: impact and the vibration of the release.
ARC = (0.2, 0.85)
#: Steps of an arc that its fit needs.
FEWEST = 20


class StoodStill(ArithmeticError):
    """A column did not rise again as far as what an impact took is told by."""


@dataclass(frozen=True)
class Loss:
    """Energies over Housner's loss, of one impact.

    contact: dissipated by impact and friction until the column is clear. rocking: what rocking has
    lost, by the tilts at which it turns round before and after; what is more than contact is in
    elastic vibration. restitution: angular velocity after over before by that; housner: of a rigid
    block; seconds: of computing the impact.
    """

    contact: float
    rocking: float
    restitution: float
    housner: float
    seconds: float


def first_impact(
    kind: str,
    share: float,
    dt: float,
    modes: int = 100,
    alpha: float = 0.0,
    damping: float = 0.0,
    height: float = 1.5,
    size: float = 0.005,
    away: float = AWAY,
) -> Loss:
    """Loss of the first impact of a column released at rest at `share` of its critical tilt;
    arguments as of `rocker`, away: longest step [s] of the fall and of the rise.
    """
    column, block = rocker(kind, share, dt, modes, alpha, damping, height, size)
    return impact_of(column, block, share, dt, away)


def impact_of(column, block, share: float, dt: float, away: float = AWAY) -> Loss:
    """Loss of the first impact of a rocker that was released at `share` of the critical tilt of
    its Housner's block; steps of dt [s] at the impact, up to `away` [s] before and after.

    Raises
    ------
    StoodStill
        it did not rise again above what the end of an impact is told by.
    """
    away = max(away, dt)
    release = share * block.slenderness
    clear, highest, now = CLEAR * release + CLEAR_TILT, 0.0, 0.0

    def steps(dt, arc):
        nonlocal now
        count = max(1, round(away / dt))
        tilts = column.steps(dt, count)
        arc.append(np.column_stack([now + dt * np.arange(1, count + 1), tilts]))
        now += count * dt

    down, up = [], []
    steps(away, down)
    while column.tilt > clear:
        steps(away, down)
    before, began, hit = column.mechanical, time.perf_counter(), now
    while now - hit < LONGEST and not (column.lean < 0 and column.tilt > clear):
        steps(dt, up)
    seconds, after = time.perf_counter() - began, column.mechanical
    while column.tilt < ARC[1] * release and column.tilt > 0.98 * highest:
        highest = max(highest, column.tilt)
        steps(away, up)
    arcs = [np.concatenate(arc) for arc in (down, up)]
    arcs = [arc[(arc[:, 1] > ARC[0] * release) & (arc[:, 1] < ARC[1] * release)] for arc in arcs]
    if min(map(len, arcs)) < FEWEST:
        raise StoodStill(f"it rose to {highest / release:.2f} of the tilt of its release")
    with np.errstate(invalid="ignore"):
        first, second = (block.energy(tilt) for tilt in turning_tilts(*arcs, block))
    if not np.isfinite(first + second):
        raise StoodStill("its arcs are none of a rigid block: elastic motion is as large")
    housner = first * (1 - block.restitution**2)
    return Loss(
        (before - after) / housner,
        (first - second) / housner,
        float(np.sqrt(second / first)),
        block.restitution,
        seconds,
    )


def turning_tilts(down: np.ndarray, up: np.ndarray, block) -> tuple[float, float]:
    """Tilts [rad] at which rocking turned round before and after, from rows (n, 2) of time [s] and
    tilt [rad] of the two arcs.

    A slender block has tilt'' = p^2 (tilt - alpha) (Housner 1963): tilt = alpha - a cosh(p t) - b
    sinh(p t) on each arc, with one alpha; it turns round at alpha - sqrt(a^2 - b^2). The fit
    averages over the vibrations; what the elastic foot changes is the same on both arcs.
    """
    (t0, y0), (t1, y1) = down.T, up.T
    s0, s1 = block.p * (t0 - t0[-1]), block.p * (t1 - t1[0])
    matrix = np.zeros((len(t0) + len(t1), 5))
    matrix[:, 0] = 1.0
    matrix[: len(t0), 1], matrix[: len(t0), 2] = -np.cosh(s0), -np.sinh(s0)
    matrix[len(t0) :, 3], matrix[len(t0) :, 4] = -np.cosh(s1), -np.sinh(s1)
    alpha, a0, b0, a1, b1 = np.linalg.lstsq(matrix, np.concatenate([y0, y1]), rcond=None)[0]
    return alpha - np.sqrt(a0**2 - b0**2), alpha - np.sqrt(a1**2 - b1**2)
