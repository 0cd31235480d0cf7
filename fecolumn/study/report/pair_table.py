"""Settings compared in pairs, as a table."""

from __future__ import annotations

from fecolumn.study.report.document import PageColumn, PageTable
from fecolumn.study.report.notation import axis_name, fixed, level_text, p_value
from fecolumn.study.report.pair import ComparedPair
from fecolumn.study.report.setting_columns import setting_words
from fecolumn.study.report.sweep import Sweep

#: Rows of a table that is not folded
_FOLD = 20


def pair_table(sweep: Sweep, pairs: list[ComparedPair]) -> PageTable:
    """The table: distances, p and motions that are lost in one of two settings alone."""
    rows = []
    zipped = any(pair.partners for pair in pairs)
    shared = any(pair.comparison.records_a < pair.comparison.n_a for pair in pairs)
    for pair in pairs:
        it = pair.comparison
        rows.append(
            (
                pair.axis,
                pair.low,
                pair.high,
                *((_partners(pair),) if zipped else ()),
                {key: value for key, value in pair.others.items() if key in sweep.varied},
                it.n_a,
                *((it.records_a,) if shared else ()),
                it.ks,
                it.ks_p,
                it.ks_evidence,
                it.paired_p,
                pair.p_holm,
                it.ad_p,
                it.cvm_p,
                it.e50,
                it.correlation,
                it.flips,
                it.mcnemar_p,
                pair.bound,
            )
        )
    columns = (
        PageColumn("axis a b", "a against b", _levels, text=True),
        *((PageColumn("with", "with", text=True),) if zipped else ()),
        PageColumn("at", "at", setting_words, text=True),
        PageColumn("n", "n"),
        *((PageColumn("records", "records"),) if shared else ()),
        PageColumn("ks", "D", fixed),
        PageColumn("ks_p", "p", p_value),
        PageColumn("ks_evidence", "evidence", text=True),
        PageColumn("paired_p", "paired p", p_value),
        PageColumn("p_holm", "p (Holm)", p_value),
        PageColumn("ad_p", "AD p", p_value),
        PageColumn("cvm_p", "CvM p", p_value),
        PageColumn("e50", "e₅₀", fixed),
        PageColumn("correlation", "R", fixed),
        PageColumn("flips", "flips"),
        PageColumn("mcnemar_p", "McNemar p", p_value),
        PageColumn("bound_95", "D not excluded", fixed),
    )
    return PageTable(
        "comparisons",
        columns,
        rows,
        "Settings compared in pairs: Kolmogorov-Smirnov distance D with p of "
        "independent samples and "
        "the field's word for the evidence against one distribution; p of paired permutations; "
        "Anderson-Darling and Cramér-von Mises as independent samples; error of the median e₅₀ (a "
        "against b); correlation R with lost runs (overturned or slid off) at the "
        "limit; motions lost in one "
        "setting alone (flips) with McNemar's p."
        + (" Runs of one record are swapped together: p counts records." if shared else ""),
        folded=len(rows) > _FOLD,
    )


def _levels(axis: str, low: object, high: object) -> str:
    return f"{axis_name(axis)}: {level_text(axis, low)}, {level_text(axis, high)}"


def _partners(pair: ComparedPair) -> str:
    """Values of the axes that go with the axis of a pair."""
    return "; ".join(_levels(key, *values) for key, values in pair.partners.items())
