"""What is computed motion by motion, in several processes if wanted: functions that a new process
can import.
"""

from __future__ import annotations

import functools
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.planar import column
from benchmarks.planar.advance import advance
from benchmarks.planar.compare import apart, impacts
from benchmarks.planar.ensembles import PACKAGE, PLANAR, motion, response, shaken
from benchmarks.planar.shaken import EVERY
from fecolumn.case.case import Case
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.model import StructureModel
from fecolumn.structures.structure import structure_model
from fecolumn.verification.multi_drum import drum_case, drum_pulse

FINE = 1e-4  # step [s] of the planar program
_FOLLOWED = 12.0  # from the start of a pulse, by the package [s]
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


@functools.cache
def _case_of_package() -> tuple[Case, StructureModel]:
    with tempfile.TemporaryDirectory() as folder:
        case = drum_case(Path(folder))
        return case, structure_model(case)


def fell_in_package(tp: float, a: float) -> bool:
    """Whether it does by the package, rigid, with its steps of `multi_drum.DRUMS_DT`."""
    engine = engine_of(*_case_of_package(), "column")
    return bool(engine.advance(drum_pulse(a, tp, _FOLLOWED - 3 * tp))[1])


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
