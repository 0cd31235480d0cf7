"""Two ensembles compared: settings of a study, studies, or computation and test."""

from __future__ import annotations

import math
from dataclasses import dataclass

from numpy.typing import ArrayLike

from fecolumn.statistics.correlation import correlation
from fecolumn.statistics.ecdf import censored, percentile
from fecolumn.statistics.flips import contingency, flips, flips_p
from fecolumn.statistics.records import Records, counted_unit, record_count
from fecolumn.statistics.two_sample import (
    anderson_darling,
    cramer_von_mises,
    kolmogorov_smirnov,
    paired_kolmogorov_smirnov,
)


@dataclass(frozen=True, slots=True)
class Comparison:
    """What two ensembles have in common.

    Attributes
    ----------
    n_a, n_b
        runs, overturned ones included.
    records_a, records_b
        different records of these; all p-values draw or swap whole records.
    ks, ks_p
        sup |F_a - F_b| and its p-value for independent samples. Of the same motions in both, p is
        too large (conservative), and paired_p is the one to judge by.
    ks_evidence
        evidence against one distribution in words, from ks_p.
    ad, ad_p
        Anderson and Darling's A^2 (mean 1 where the distributions are one), and its p-value for
        independent samples.
    cvm, cvm_p
        Cramer and von Mises' T, and its p-value for independent samples.
    paired_p
        p-value of ks by swapping the settings within motions; None of unpaired ensembles.
    median_a_m, median_b_m
        median of u_max [m]; inf where more than half of the runs
        overturned or slid off.
    e50
        |median_a - median_b| / median_b, b being the reference (the test); inf where a's median
        alone is infinite, nan where b's is.
    correlation
        R with overturned runs and larger displacements at the cap; None of unpaired ensembles, nan
        where undefined.
    flips
        motions that overturn in one ensemble alone; None of unpaired ensembles.
    mcnemar_p
        p-value of as many flips one way as the other; None of unpaired ensembles.
    p_lost_a, p_lost_b
        share of runs whose peak is not known, as they overturned or slid off; intervals:
        `ecdf.share_interval`.
    """

    n_a: int
    n_b: int
    ks: float
    ks_p: float
    ks_evidence: str
    ad: float
    ad_p: float
    cvm: float
    cvm_p: float
    paired_p: float | None
    median_a_m: float
    median_b_m: float
    e50: float
    correlation: float | None
    flips: int | None
    mcnemar_p: float | None
    p_lost_a: float
    p_lost_b: float
    records_a: int = 0
    records_b: int = 0

    @property
    def unit(self) -> str:
        """What the statistics count."""
        return counted_unit(self.n_a, self.records_a)


def compare(
    u_a: ArrayLike,
    overturned_a: ArrayLike,
    u_b: ArrayLike,
    overturned_b: ArrayLike,
    *,
    paired: bool,
    cap_m: float | None = None,
    seed: int = 0,
    records: tuple[Records, Records] = (None, None),
) -> Comparison:
    """Compare ensemble a with ensemble b, the reference.

    Parameters
    ----------
    u_a, u_b
        (n_a,) and (n_b,) [m] peak displacement; ignored where the run overturned.
    overturned_a, overturned_b
        (n_a,) and (n_b,) True where the column overturned.
    paired
        whether both hold the same motions, each at the same place.
    cap_m
        displacement of an overturned run in the correlation [m]; the largest peak of those that
        stood unless given.
    seed
        of the permutations.
    records
        of the runs of a and of b, None where each run has its own; of paired ensembles those of a
        are those of b.

    Raises
    ------
    ValueError
        as of `ecdf`; paired ensembles of different size.
    """
    a, b = censored(u_a, overturned_a), censored(u_b, overturned_b)
    if paired and a.size != b.size:
        raise ValueError(f"{a.size} and {b.size} runs: paired ensembles must hold the same motions")
    ks = kolmogorov_smirnov(a, b, records, seed=seed)
    ad = anderson_darling(a, b, seed=seed, records=records)
    cvm = cramer_von_mises(a, b, seed=seed, records=records)
    table = contingency(overturned_a, overturned_b) if paired else None
    median_a, median_b = (
        percentile(u_a, overturned_a, fraction=0.5),
        percentile(u_b, overturned_b, fraction=0.5),
    )
    return Comparison(
        a.size,
        b.size,
        ks.statistic,
        ks.p,
        evidence(ks.p),
        ad.statistic,
        ad.p,
        cvm.statistic,
        cvm.p,
        paired_kolmogorov_smirnov(a, b, seed=seed, records=records[0]).p if paired else None,
        median_a,
        median_b,
        median_error(median_a, median_b),
        correlation(u_a, overturned_a, u_b, overturned_b, cap_m) if paired else None,
        None if table is None else flips(table),
        flips_p(overturned_a, overturned_b, records[0]) if paired else None,
        float((a == math.inf).mean()),
        float((b == math.inf).mean()),
        record_count(records[0], a.size),
        record_count(records[1], b.size),
    )


def median_error(median: float, reference: float) -> float:
    """e50 = |median - reference| / reference; inf where the median alone is infinite, nan where the
    reference is or is 0.
    """
    if not math.isfinite(reference) or reference == 0:
        return math.nan
    return abs(median - reference) / reference


def evidence(p: float) -> str:
    """Evidence against "one distribution" in the words of the field's validation studies."""
    if not 0 <= p <= 1:
        raise ValueError(f"p = {p}: must lie in [0, 1]")
    return (
        "very strong"
        if p < 0.01
        else "strong"
        if p < 0.05
        else "medium-weak"
        if p <= 0.10
        else "small or none"
    )
