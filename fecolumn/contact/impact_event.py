"""Whether points land or slip ends in a step, and when."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.tolerances import ARRIVES, FULL_FRICTION, OPEN, SLIDE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Answers of `impact_event`
NOTHING, LANDS, TURNS = range(3)


@njit
def mark_landing(
    interfaces: Array, points: Array, listed: Array, before: Array, after: Array, landing: Array
) -> int:
    """Mark in `landing` (n,) those of the listed points (k,) that touch at the end of the step and
    were open at its start: how many.

    One that has come to the surface just at the end, by more than ARRIVES, and does not carry yet
    lands with those that do: else rounding would say which points of a face take part. Where none
    does it is left a little above the surface: else it would not have been open when it carries in
    the next step.
    """
    count = 0
    for i in listed:
        landing[i] = _was_open(interfaces, points, before, i) and after[i].force[2] > 0
        count += landing[i]
    for i in listed:
        width = interfaces[points[i].interface].width
        if after[i].force[2] > 0 or not after[i].located:
            continue
        comes = before[i].relative[2] - after[i].relative[2] > ARRIVES * width
        if not comes or not _was_open(interfaces, points, before, i):
            continue
        if after[i].relative[2] < 2 * OPEN * width:
            if count > 0:
                landing[i] = True
            else:
                after[i].relative[2] = 2 * OPEN * width
    return count


@njit
def _was_open(interfaces: Array, points: Array, before: Array, i: int) -> bool:
    """Whether point i, which does not roll, was open at the start of the step."""
    above = before[i].relative[2] > OPEN * interfaces[points[i].interface].width
    return not points[i].rolls and before[i].force[2] <= 0 and above


@njit
def mark_turning(points: Array, listed: Array, before: Array, after: Array, turning: Array) -> int:
    """Mark in `turning` (n,) those of the listed points (k,) whose slip may end within the step, in
    stick or in slip the other way: how many.
    """
    count = 0
    for i in listed:
        turning[i] = False
        touching = after[i].force[2] > 0
        if not touching:
            continue
        slips = (
            after[i].anchor[0] != before[i].anchor[0] or after[i].anchor[1] != before[i].anchor[1]
        )
        turning[i] = slips and before[i].force[2] > 0 or not slips and _slid(points, before, i)
        count += turning[i]
    return count


@njit
def _slid(points: Array, before: Array, i: int) -> bool:
    """Whether point i slid at the start of the step: full friction."""
    pull = np.hypot(before[i].force[0], before[i].force[1])
    return pull > 0 and pull >= (1 - FULL_FRICTION) * points[i].friction * before[i].force[2]


@njit
def impact_event(
    interfaces: Array,
    points: Array,
    listed: Array,
    before: Array,
    after: Array,
    dt: float,
    early: Array,
    late: Array,
    landing: Array,
    turning: Array,
) -> int:
    """Whether the velocities at the end of a step must be taken anew: NOTHING, a point LANDS, or
    slip TURNS for most of the foot.

    Parameters
    ----------
    early, late
        (n, 3) velocities [m/s] of the marked points at the start and at the end of the step.
    listed
        (k,) the points that may carry.
    landing, turning
        (n,) masks that `mark_landing` and `mark_turning` made. On return `turning` marks only the
        points whose slip really ends, and only in interfaces where these carry more than half of
        the force.
    """
    lands, turned, total = False, np.zeros(len(interfaces)), np.zeros(len(interfaces))
    for i in listed:
        lands |= landing[i]
        k = points[i].interface
        total[k] += after[i].force[2]
        if not turning[i]:
            continue
        turning[i] = False
        if not dt * np.hypot(early[i, 0], early[i, 1]) > SLIDE * interfaces[k].width:
            continue
        s0, s1 = after[i].anchor[0] - before[i].anchor[0], after[i].anchor[1] - before[i].anchor[1]
        slips = s0 != 0.0 or s1 != 0.0
        against = min(early[i, 0] * s0 + early[i, 1] * s1, late[i, 0] * s0 + late[i, 1] * s1) < 0
        turning[i] = not slips or against
        turned[k] += after[i].force[2] if turning[i] else 0.0
    if lands:
        return LANDS
    # few points of many turn where a standing foot slips in part: that is elastic, not motion
    turns = False
    for i in listed:
        k = points[i].interface
        turning[i] = turning[i] and 2 * turned[k] > total[k] > 0
        turns |= turning[i]
    return TURNS if turns else NOTHING


@njit
def touched(listed: Array, before: Array, after: Array, landing: Array) -> Array:
    """Those of the listed points (k,) that carry at the start or at the end of the step, or land
    (mask).
    """
    union, k = np.empty(len(listed), np.int64), 0
    for i in listed:
        if before[i].force[2] > 0 or after[i].force[2] > 0 or landing[i]:
            union[k] = i
            k += 1
    return union[:k]


@njit
def landing_moment(
    union: Array, before: Array, after: Array, early: Array, landing: Array, dt: float
) -> float:
    """Fraction of the step at which the landing points (mask) arrive, mean by their forces."""
    total = weights = 0.0
    for i in union:
        if landing[i]:
            gap = before[i].relative[2]
            total += after[i].force[2] * gap / max(-dt * early[i, 2], gap)
            weights += after[i].force[2]
    return total / weights


@njit
def turning_moment(
    points: Array,
    before: Array,
    after: Array,
    start: Array,
    free: Array,
    pushed: Array,
    union: Array,
    turning: Array,
) -> float:
    """Fraction of the step at which full friction ends the slip of the turning points (mask), mean
    by their forces.

    start, free: (3 k,) velocities at the ends of the step without its contact impulses; pushed: (3
    k,) what these gave [m/s].
    """
    total = weights = 0.0
    for j in range(len(union)):
        i = union[j]
        if not turning[i]:
            continue
        s0, s1 = after[i].anchor[0] - before[i].anchor[0], after[i].anchor[1] - before[i].anchor[1]
        if not start[3 * j] * s0 + start[3 * j + 1] * s1 > 0:
            s0, s1 = start[3 * j], start[3 * j + 1]
        normal = after[i].force[2]
        # a point found to stick had less than full friction, possibly forwards
        share = np.hypot(after[i].force[0], after[i].force[1]) / max(
            points[i].friction * normal, 2.3e-308
        )
        way = start[3 * j] * s0 + start[3 * j + 1] * s1
        braking = abs(pushed[3 * j] * s0 + pushed[3 * j + 1] * s1)
        stop = free[3 * j] * s0 + free[3 * j + 1] * s1 - braking / max(share, 2.2e-16)
        total += normal * (way / (way - stop) if way > 0 and stop < 0 else 1.0)
        weights += normal
    return total / weights
