"""The first impacts of a trial: when they are, what they take, and by how much that changes from
one time step to another.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import TRIAL_STEPS

#: Change by half the step, over the value at half the step, of the mean loss at the first impacts
#: and of the largest tilt after them, below which a step is taken; and standard error of that
#: change above which it cannot be told. Chosen: the loss of a single impact of elastic bodies
#: scatters by as much with where in the step it lands.
SAME_STEP = 0.05
#: Starts of each step, shifted by so many parts of it. Chosen: four tell the mean to half the
#: scatter of one.
STARTS = 4
#: Impacts that are looked at, the time [s] within which the first must come, and the time [s] from
#: then on within which the others must: they bound what the trials cost.
_IMPACTS, FIRST_S, OTHERS_S = 3, 10.0, 2.0
#: Of loss and tilt from a step to a shorter one, and the standard error of the former [-]
Changes = tuple[float, float, float]
# Energy that impacts take in a step, over that to overturn, from which on something has landed:
# what a body loses that rocks at a thousandth of its critical tilt
_LANDS = 1e-6
# The same over the most that any step's impacts take: rattling before and between counts for none
_COUNTS = 1e-2
# Tilt after the impacts over the largest, below which it counts as that much: of what is at rest by
# then nothing but rounding is left
_TILT_COUNTS = 0.1
#: Time [s] without a landing after which the next is of another impact: ten of the longest steps
APART_S = 10 * max(TRIAL_STEPS)
# Part of the time between impacts that is left out at either end, where trials may still land
_LEFT_OUT = 0.25


@dataclass(frozen=True, slots=True)
class Window:
    """What trials look at: times [s] of the first landing, and between which the tilt after the
    impacts is taken, the latter the end; and the number of impacts.
    """

    lands: float
    begins: float
    ends: float
    impacts: int


@dataclass(frozen=True, slots=True)
class TrialResult:
    """A step [s] and what its starts gave, (starts,) each: loss at the impacts over the rigid loss,
    nan where that is not known; energy that impacts and friction took [J]; largest tilt of a body
    after the impacts, and in all [rad]; and how many starts were lost or failed by then.
    """

    dt: float
    share: NDArray[Any]
    energy: NDArray[Any]
    after: NDArray[Any]
    tilt: NDArray[Any]
    lost: int

    def loss(self, shares: bool) -> NDArray[Any]:
        """Loss (starts,), over the rigid loss or [J]."""
        return self.share if shares else self.energy

    def told(self, shares: bool) -> dict[str, Any]:
        """Of the summary; shares: whether the loss is that over the rigid loss."""
        loss = self.loss(shares)
        mean = float(loss.mean()) if loss.size else None
        return dict(
            dt_s=self.dt,
            loss=mean,
            loss_scatter=float(loss.std(ddof=1) / mean) if mean and loss.size > 1 else None,
            tilt_after_rad=float(self.after.mean()) if self.after.size else None,
            lost=self.lost,
        )


def know_share(results: list[TrialResult]) -> bool:
    """Whether the loss over the rigid loss is known of all starts."""
    return bool(results) and all(np.isfinite(one.share).all() for one in results)


def change(longer: TrialResult, shorter: TrialResult) -> Changes:
    """Changes of mean loss and of mean tilt after the impacts from a step to a shorter one, over
    the latter, and the standard error of the first; infinite where starts ended differently.
    """
    if longer.lost or shorter.lost:
        every = longer.lost == shorter.lost == STARTS
        return (0.0, 0.0, 0.0) if every else (np.inf, np.inf, np.inf)
    shares = know_share([longer, shorter])
    before, loss = longer.loss(shares), shorter.loss(shares)
    scale = float(loss.mean())
    if scale <= 0:
        return np.inf, np.inf, np.inf
    error = np.sqrt((before.var(ddof=1) + loss.var(ddof=1)) / STARTS)
    tilt = max(float(shorter.after.mean()), _TILT_COUNTS * float(shorter.tilt.mean()))
    return (
        float(abs(before.mean() - scale) / scale),
        float(abs(longer.after.mean() - shorter.after.mean()) / tilt) if tilt else 0.0,
        float(error / scale),
    )


def window_of(rows: dict[str, NDArray[Any]], barrier_j: float) -> Window | None:
    """The first impacts in the columns of a history; None where nothing lands in time.

    barrier_j: energy to overturn [J].
    """
    now = rows["time"]
    begins, ends = landings(rows, barrier_j, FIRST_S + OTHERS_S)
    if not begins.size or begins[0] > FIRST_S:
        return None
    first_s = float(begins[0])
    limit = min(float(now[-1]), first_s + OTHERS_S)
    number = int(np.count_nonzero(begins <= limit))
    if number > _IMPACTS:
        limit, number = min(limit, float(begins[_IMPACTS])), _IMPACTS
    end = min(float(ends[number - 1]), limit)
    if end == limit:  # still landing: the tilt of the last part
        return Window(first_s, limit - _LEFT_OUT * (limit - first_s), limit, number)
    left_out = _LEFT_OUT * (limit - end)
    return Window(first_s, end + left_out, limit - left_out, number)


def landings(
    rows: dict[str, NDArray[Any]],
    barrier_j: float,
    until_s: float = np.inf,
    apart_s: float = APART_S,
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Times (n,), (n,) [s] at which impacts begin and end; what is less than a hundredth of the
    largest until a time counts for none.

    barrier_j: energy to overturn [J]. apart_s: time [s] without a landing after which the next is
    of another impact.
    """
    now = rows["time"]
    took = np.diff(-rows["energy/impact"], prepend=-rows["energy/impact"][0])
    largest = took[now <= until_s].max(initial=0.0)
    lands = now[took > max(_LANDS * barrier_j, _COUNTS * largest)]
    if not lands.size:
        return lands, lands
    first = np.flatnonzero(np.diff(lands, prepend=-np.inf) > apart_s)
    last = np.append(first[1:], lands.size) - 1
    return lands[first], lands[last]
