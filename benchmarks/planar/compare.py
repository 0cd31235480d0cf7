"""Two programs on the same motions: distributions of the peaks, outcomes motion by motion, and
histories until the third impact.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from benchmarks.planar.advance import History
from benchmarks.planar.bodies import LEFT, RIGHT
from benchmarks.planar.shaken import Response
from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.flips import contingency, flips, mcnemar
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov

#: A joint lands where its tilt comes back from the first to the second or below [rad]; landings
#: within this time [s] are one impact
_SWUNG, _FLAT, _TOGETHER = 1e-3, 1e-5, 0.01
#: Sides that were farther apart meet where they are nearer than this [m]
_MEET = 1e-6
#: Histories agree whose tops are no farther apart than this share of the peak so far
AGREE = 0.01


@dataclass(frozen=True)
class Compared:
    """Of n motions in two programs.

    Attributes
    ----------
    fallen
        overturned in each.
    distance, p
        of the peaks' distributions (Kolmogorov and Smirnov, paired).
    differ
        outcomes that differ
    mcnemar
        p of them.
    off
        median, over motions that both survive, of the difference of the peaks over that of the
        first program.
    failed
        analyses that stopped early, whose motions are left out of all else.
    unsolved
        steps of the other program whose friction problem was not solved to its tolerance.
    """

    n: int
    fallen: tuple[int, int]
    distance: float
    p: float
    differ: int
    mcnemar: float
    off: float
    failed: int
    unsolved: int


def compared(one: list[Response], other: list[Response]) -> Compared:
    """Of two programs on the same motions, in one order; motions in which an analysis stopped early
    are left out. Of no motions at all the statistics are nan.
    """
    failed = sum(bool(response.failed) for response in (*one, *other))
    whole = [not (a.failed or b.failed) for a, b in zip(one, other, strict=True)]
    one, other = (list(itertools.compress(all_of, whole)) for all_of in (one, other))
    if not one:
        nothing = float("nan")
        return Compared(0, (0, 0), nothing, nothing, 0, nothing, nothing, failed, 0)
    fallen = [np.array([response.fallen for response in responses]) for responses in (one, other)]
    peaks = [np.array([response.peak for response in responses]) for responses in (one, other)]
    test = paired_kolmogorov_smirnov(*(censored(*pair) for pair in zip(peaks, fallen)))
    table, both = contingency(*fallen), ~(fallen[0] | fallen[1])
    off = float(np.median(np.abs(peaks[1][both] / peaks[0][both] - 1))) if both.any() else np.nan
    unsolved = sum(response.unsolved for response in other)
    return Compared(
        len(one),
        (int(fallen[0].sum()), int(fallen[1].sum())),
        test.statistic,
        test.p,
        flips(table),
        mcnemar(table),
        off,
        failed,
        unsolved,
    )


def impacts(history: History) -> np.ndarray:
    """Times [s] at which a joint that was open lies flat again, or sides meet, those of several
    joints that land together as one.
    """
    found = []
    for joint in history.structure.joints:
        if joint.face == RIGHT:
            gap = _apart(history, joint)
            found += history.time[1:][(gap[1:] < _MEET) & (gap[:-1] >= _MEET)].tolist()
            continue
        tilt = history.tilt[:, joint.body] - history.tilt[:, joint.other]
        side = 0.0
        for time, now in zip(history.time, tilt):
            if abs(now) > _SWUNG and now * side >= 0:
                side = np.sign(now)
            elif side and now * side < _FLAT:
                found.append(time)
                side = np.sign(now) if abs(now) > _SWUNG else 0.0
    found = np.sort(found)
    return found[np.diff(found, prepend=-np.inf) > _TOGETHER]


def _apart(history: History, joint) -> np.ndarray:
    """Gap (n,) [m] along x between the right side of a body and the left one of another."""
    sides = [
        [
            history.structure.point(body, corner, history.place)[:, 0]
            for corner in history.structure.ends(body, face)
        ]
        for body, face in ((joint.body, RIGHT), (joint.other, LEFT))
    ]
    return np.min(sides[1], axis=0) - np.max(sides[0], axis=0)


def apart(one: Response, other: Response, until: float) -> float:
    """Largest distance of the tops until a time [s], over the largest displacement of the first."""
    n = min(len(one.time), len(other.time), int(np.searchsorted(one.time, until)))
    return float(np.abs(one.top[:n] - other.top[:n]).max() / np.abs(one.top[:n]).max())
