"""What the reduced engine costs on the specimen's own mesh.

Meant for a machine that does nothing else.
"""

from __future__ import annotations

import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.engines.motions import RESULTS
from benchmarks.engines.pair import case_of, engine
from fecolumn.foundation.cores import usable_cores
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.store import DONE

FOLDER = Path(__file__).parent
CORES = 2


def speed():
    """Time of a step while rocking and while standing on all nodes, of a whole motion, and the
    memory of a worker.
    """
    rocking = engine(case_of(initial={"tilt_rad": 0.03}, contact={"friction_coefficient": 0.8}))
    # short runs between two impacts: the least of many is what the step costs where others use the
    # machine too
    spent = best(lambda: rocking.advance(np.zeros((100, 3))), 30) / 100
    yield "rocking: microseconds a step", 25.0, 1e6 * spent, spent <= 25e-6
    upright = engine(case_of())
    spent = best(lambda: upright.advance(np.zeros((100, 3))), 30) / 100
    yield "standing on all nodes: microseconds a step", 150.0, 1e6 * spent, spent <= 150e-6
    case = case_of(motion={"source": "lick:1"}, integration={"duration_s": 0.0})
    with (
        tempfile.TemporaryDirectory() as folder,
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as worker,
    ):
        runs = [worker.submit(analysis, case, Path(folder) / str(k)).result() for k in range(3)]
    steps, fastest, memory = runs[0][0], min(run[1] for run in runs), runs[-1][2]
    yield (
        f"a motion of {steps * case.integration.dt_s:.3g} s, {steps} steps, with its files [s]",
        1.5,
        fastest,
        fastest <= 1.5,
    )
    yield "memory of its worker [GiB]", 1.0, memory, memory < 1


def best(run, times: int) -> float:
    """Least wall time [s] of some runs."""
    spent = []
    for _ in range(times):
        began = time.perf_counter()
        run()
        spent.append(time.perf_counter() - began)
    return min(spent)


def analysis(case, folder) -> tuple[int, float, float]:
    """Steps of one analysis, its wall time [s] and the largest memory of this process so far
    [GiB].
    """
    from mpi4py import MPI

    from fecolumn import simulation

    began = time.perf_counter()
    summary = simulation.run(case, folder, comm=MPI.COMM_SELF, quiet=True)
    spent = time.perf_counter() - began
    peak = next(
        line
        for line in Path("/proc/self/status").read_text().splitlines()
        if line.startswith("VmHWM")
    )
    return summary["steps"], spent, int(peak.split()[1]) / 2**20


def motions115():
    """The seeded ensemble at one (dt, alpha)."""
    yield from _study("motions115.toml", 90.0)


def paper():
    """The 1,725 analyses of the study: 115 motions at each of 15 (dt, alpha)."""
    yield from _study("../paper_study.toml", 3600.0)


def _study(name: str, limit: float):
    plan = read_plan(FOLDER / name)
    RESULTS.mkdir(parents=True, exist_ok=True)
    # a fresh folder each time: what is done already would not be timed
    with tempfile.TemporaryDirectory(dir=RESULTS) as folder:
        began = time.perf_counter()
        rows = complete_study(plan, Path(folder) / "study", workers=min(CORES, usable_cores()))
        spent = time.perf_counter() - began
    done = sum(row["state"] == DONE for row in rows)
    yield (
        f"{plan.title}: {done} of {len(rows)} analyses, {CORES} cores [s]",
        limit,
        spent,
        done == len(rows) and spent <= limit,
    )
