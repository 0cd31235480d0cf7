"""Analyses of a study that failed, in its fragilities: intervals reach over what they might have
been.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numpy as np

from fecolumn.statistics.fragility import DegenerateData, Fragility, lognormal
from fecolumn.statistics.intensity_table import FailedRuns, IntensityTable
from fecolumn.study.failures import why_failed
from fecolumn.study.plan import record_of
from fecolumn.study.report.intensity import NOT_FOUND

#: Ends of the intervals of the median and of the dispersion
CurveEnds = tuple[tuple[float, float], tuple[float, float]]
_Fit = TypeVar("_Fit")


def failed_runs(
    rows: list[dict[str, Any]],
    records: Any,
    wanted: tuple[str, ...],
    measures: Callable[[dict[str, Any]], dict[str, float]],
) -> FailedRuns | None:
    """Intensities of the analyses of a setting that failed, beside records of those that are done;
    rows: of the ledger; measures: function of a run. Motions of no intensity are left out.
    """
    if not rows:
        return None
    runs, why = [{"case_id": row["id"]} for row in rows], why_failed(rows)
    try:
        found = [measures(run) for run in runs]
        own = np.array([record_of(row["axes"]) for row in rows])
    except NOT_FOUND:  # it failed before its case was written
        return FailedRuns(None, records, len(rows), why)
    moved = np.array([all(one[name] > 0 for name in wanted) for one in found])
    known = {name: np.array([one[name] for one in found])[moved] for name in wanted}
    return FailedRuns(known, np.append(records, own[moved]), len(rows), why)


def warn_of_failed(label: str, table: IntensityTable, bounded: bool) -> None:
    """Tell how many analyses of a setting failed, and whether the intervals of its answer reach
    over what they might have been; nothing where none failed.
    """
    if not (failed := table.failed):
        return
    held = (
        "the intervals reach from none of them beyond the limit to all"
        if bounded and failed.measures is not None
        else "what is told is of the others alone, and may be biased, as analyses may fail by "
        "their response"
    )
    print(
        f"fecolumn: warning: {label + ': ' if label else ''}{failed.count} of "
        f"{failed.count + table.overturned.size} analyses failed: {held}. {failed.why}",
        file=sys.stderr,
    )


def over_failed(
    table: IntensityTable, name: str, fit: Callable[[Any, Any, Any], _Fit]
) -> Iterator[_Fit]:
    """What `fit` gives with none and with all of the failed runs beyond the limit; nothing where
    none failed.

    Parameters
    ----------
    name
        of the intensity measure.
    fit
        function of intensities, of whether each run is beyond the limit, and of their records.

    Raises
    ------
    DegenerateData
        some of what they might have been bounds no curve.
    """
    for other in table.bounds():
        try:
            yield fit(other.measures[name], other.overturned, other.records)
        except DegenerateData as error:
            raise DegenerateData(_refused(table, error)) from None


def curve_ends(table: IntensityTable, name: str, fit: Fragility) -> CurveEnds:
    """Ends of the intervals of a setting's median and dispersion, over none and all of its failed
    runs overturned.

    Raises
    ------
    DegenerateData
        some of what they might have been bounds no curve.
    """
    found = [fit, *over_failed(table, name, lognormal)]
    medians, betas = zip(*((one.median_interval(), one.beta_interval()) for one in found))
    return (
        (min(low for low, _ in medians), max(high for _, high in medians)),
        (min(low for low, _ in betas), max(high for _, high in betas)),
    )


def _refused(table: IntensityTable, error: Exception) -> str:
    """Why a setting has no fragility whose interval reaches over what its failed analyses might
    have been.
    """
    failed = table.failed
    count, why = (failed.count, failed.why) if failed else (0, "")
    return (
        f"{count} of {count + table.overturned.size} analyses failed, and with none, or all, of "
        f"them beyond the limit: {error}. {why}"
    ).strip()
