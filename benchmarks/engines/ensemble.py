"""The same motions in each engine: are their peaks of one distribution?"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from benchmarks.engines.motions import RESULTS
from fecolumn.engines.ending import lost
from fecolumn.statistics.bands import dkw_distance
from fecolumn.statistics.ecdf import censored, percentile
from fecolumn.statistics.two_sample import kolmogorov_smirnov, paired_kolmogorov_smirnov
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study
from fecolumn.study.store import DONE

STUDY = Path(__file__).with_name("ensemble.toml")


def peaks(workers: int) -> dict[str, np.ndarray]:
    """Largest top displacement (n,) [m] of each motion by engine, inf where it was lost; what is
    done is not repeated.
    """
    plan, found = read_plan(STUDY), {}
    rows = {
        row["id"]: row
        for row in complete_study(plan, RESULTS / "ensemble", workers=workers, retry_failed=True)
    }
    for analysis in plan.analyses:
        row = rows[analysis.id]
        if row["state"] != DONE:
            raise RuntimeError(f"{row['axes']}: {row['reason']}")
        found.setdefault(analysis.case.integration.engine, []).append(
            (row["summary"]["u_max_m"], lost(row["summary"]))
        )
    return {engine: censored(*zip(*pairs)) for engine, pairs in found.items()}


def ensemble():
    """Tests, the band of the reduced engine's distribution, medians; also how far apart single
    motions are, which nobody can demand to agree.
    """
    found = peaks(int(os.environ.get("ENGINES_JOBS", "1")))
    full, reduced = found["full"], found["reduced"]
    n, text = len(full), f"{len(full)} motions, coarse mesh"
    alone, paired = kolmogorov_smirnov(full, reduced), paired_kolmogorov_smirnov(full, reduced)
    yield f"{text}: p of Kolmogorov-Smirnov [-]", 1.0, alone.p, alone.p > 0.5
    yield f"{text}: p of it by swapping engines within motions [-]", 1.0, paired.p, paired.p > 0.5
    yield (
        f"{text}: distance of the CDFs, band of 95 % [-]",
        dkw_distance(n),
        alone.statistic,
        alone.statistic <= dkw_distance(n),
    )
    yield (
        f"{text}: lost, overturned or slid off",
        np.isinf(full).sum(),
        np.isinf(reduced).sum(),
        None,
    )
    middle = percentile(full, np.isinf(full), fraction=0.5)
    yield (
        f"{text}: median of u_max [m]",
        middle,
        (other := percentile(reduced, np.isinf(reduced), fraction=0.5)),
        abs(other / middle - 1) < 0.1,
    )
    stood = np.isfinite(full) & np.isfinite(reduced)
    yield f"{text}: lost in one engine only", 0, (np.isinf(full) != np.isinf(reduced)).sum(), None
    yield (
        f"{text}: u_max off, median of the motions [-]",
        0.0,
        np.median(abs(reduced[stood] / full[stood] - 1)),
        None,
    )
