"""What an ensemble of motions says about one combination of parameters, in one row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.statistics.ecdf import percentile, share_interval
from fecolumn.statistics.records import Records, record_count


@dataclass(frozen=True, slots=True)
class EnsembleSummary:
    """One row of a study's table.

    Attributes
    ----------
    n
        runs that ended, standing, overturned or slid off.
    overturned
        runs that overturned.
    slid_off
        runs that slid off their base.
    p_overturn
        overturned / n, with Wilson's and Clopper and Pearson's 95 % intervals, which count runs of
        one record as `ecdf.share_interval` does.
    u16_m, u50_m, u84_m
        percentiles of u_max [m]; inf where that fraction of the runs does not stand. What slid off
        is beyond every run that stood, as what overturned is: nobody knows how far it would have
        gone.
    energy_closure_worst
        largest magnitude of the relative closure error of the energy ledger [-].
    s_per_step
        mean wall time of a step [s].
    records
        different records of the runs; n where each has its own.
    """

    n: int
    overturned: int
    p_overturn: float
    wilson: tuple[float, float]
    exact: tuple[float, float]
    u16_m: float
    u50_m: float
    u84_m: float
    energy_closure_worst: float
    s_per_step: float
    slid_off: int = 0
    records: int = 0


def summarize(
    u_max: ArrayLike,
    overturned: ArrayLike,
    energy_closure_rel: ArrayLike,
    s_per_step: ArrayLike,
    slid_off: ArrayLike = False,
    records: Records = None,
) -> EnsembleSummary:
    """Row of an ensemble of n runs.

    Parameters
    ----------
    u_max
        (n,) [m] peak displacement of the top; ignored where the run overturned or slid off.
    overturned
        (n,) True where the column overturned.
    energy_closure_rel
        (n,) [-] closure error of the energy ledger.
    s_per_step
        (n,) [s] wall time of a step.
    slid_off
        (n,) True where the column slid off its base.
    records
        (n,) record of each run, None where each has its own.
    """
    overturned = np.asarray(overturned, bool)
    slid_off = np.broadcast_to(np.asarray(slid_off, bool), overturned.shape)
    lost = overturned | slid_off
    n, k = overturned.size, int(overturned.sum())
    u16, u50, u84 = (percentile(u_max, lost, fraction=fraction) for fraction in (0.16, 0.50, 0.84))
    return EnsembleSummary(
        n,
        k,
        k / n,
        share_interval(overturned, records),
        share_interval(overturned, records, method="exact"),
        u16,
        u50,
        u84,
        float(np.max(np.abs(energy_closure_rel))),
        float(np.asarray(s_per_step, float).mean()),
        int(slid_off.sum()),
        record_count(records, n),
    )
