"""Two ensembles of the same motions, one in each engine: are they one distribution?"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from scipy.stats import ks_2samp

from benchmarks.engines.motions import RESULTS, seeded_file
from fecolumn.study.plan import read_plan
from fecolumn.study.run import run_study
from fecolumn.study.store import DONE

STUDY = Path(__file__).with_name("ensemble.toml")


def maxima(workers: int) -> dict[str, np.ndarray]:
    """Largest top displacement (n,) [m] of each motion by engine, an overturned column's at the limit; what is done is not repeated."""
    seeded_file()
    plan = read_plan(STUDY)
    rows = {row["id"]: row for row in run_study(plan, RESULTS / "ensemble", workers=workers, retry_failed=True)}
    found = {}
    for analysis in plan.analyses:
        row, limit = rows[analysis.id], analysis.case.overturn.displacement_m
        if row["state"] != DONE:
            raise RuntimeError(f"{row['axes']}: {row['reason']}")
        summary = row["summary"]
        found.setdefault(analysis.case.integration.engine, []).append(limit if summary["overturned"] else summary["u_max_m"])
    return {engine: np.array(values) for engine, values in found.items()}


def ensemble():
    """Kolmogorov-Smirnov test and medians; also how far apart single motions are at the end, which nobody can demand to agree."""
    found = maxima(int(os.environ.get("ENGINES_JOBS", "1")))
    full, reduced = found["full"], found["reduced"]
    p, middle = ks_2samp(full, reduced).pvalue, np.median(full)
    n, apart = len(full), np.abs(reduced / full - 1)
    yield f"{n} motions, coarse mesh: p of Kolmogorov-Smirnov [-]", 1.0, p, p > 0.5
    yield f"{n} motions, coarse mesh: median of u_max [m]", middle, np.median(reduced), abs(np.median(reduced) / middle - 1) < 0.1
    yield f"{n} motions, coarse mesh: u_max off, median of the motions [-]", 0.0, np.median(apart), None
