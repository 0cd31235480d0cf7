"""What is computed motion by motion, in several processes if wanted: functions that a new process
can import.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.planar import column
from benchmarks.planar.advance import advance
from benchmarks.planar.compare import apart, impacts
from benchmarks.planar.ensembles import PACKAGE, PLANAR, motion, response, shaken
from benchmarks.planar.shaken import EVERY

FINE = 1e-4  # step [s] of the planar program
_AFTER = 0.01  # of the third impact [s]


def every(function, jobs, number: int) -> list:
    """What the function makes of each of the jobs, (arguments) in a tuple, in their order, so many
    at a time.
    """
    if number == 1:
        return [_said(function, *job) for job in jobs]
    with ProcessPoolExecutor(number, mp_context=get_context("spawn")) as pool:
        return list(pool.map(_said, [function] * len(jobs), *zip(*jobs)))


def _said(function, *job):
    found = function(*job)
    print(".", end="", file=sys.stderr, flush=True)
    return found


def fell(tp: float, a: float, dt: float) -> bool:
    """Whether a pulse overturns the multi-drum column."""
    return column.pushed(a, tp, dt).fallen


def until_third(name: str, number: int, folder: Path) -> tuple[float, float]:
    """Time [s] of the third impact by the planar program, and how far the package is off until
    then; nan without a third one.
    """
    case = shaken()[name]
    times = impacts(
        advance(case.structure, motion(case, number, FINE), FINE, every=round(EVERY / FINE))
    )
    if len(times) < 3:
        return np.nan, np.nan
    until = float(times[2])
    one, other = (
        response(name, program, number, FINE, folder, until + _AFTER)
        for program in (PLANAR, PACKAGE)
    )
    return until, apart(one, other, until)
