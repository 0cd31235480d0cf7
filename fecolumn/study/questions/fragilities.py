"""Fragilities for `fecolumn risk`: of runs, or as they are stated in a table."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray


# Columns of the interval of the median: now, and in earlier versions
_ENDS_OF_MEDIAN = (("median_low", "median_high"), ("low", "high"))


@dataclass(frozen=True, slots=True)
class KnownFragility:
    """A lognormal fragility: its median and dispersion, how well they are known, `regions` (r, 2)
    as of `Fragility.region`, and the least and the largest intensity of its runs, None where they
    are not known.

    Where runs failed, `failed` is their number, and there are two more regions, with none and with
    all of them beyond the limit.
    """

    median: float
    beta: float
    regions: tuple[NDArray[Any], ...]
    runs: tuple[float, float] | None = None
    failed: int = 0


def fragilities_of(source: str, limit: str, measure: str) -> dict[str, KnownFragility]:
    """Fragility over the hazard's measure of each setting of a study's folder, a table of runs, or
    what `fecolumn fragility` wrote.

    Raises
    ------
    InputError
        the source cannot be used, or bounds no fragility.
    """
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.fragility import DegenerateData, lognormal
    from fecolumn.study.questions.limit import read_event
    from fecolumn.study.report.failed_fragility import over_failed, warn_of_failed
    from fecolumn.study.report.fragility_command import runs_by_setting

    event = read_event(limit, "fecolumn risk")
    if not Path(source).is_dir() and (found := _stated(source, measure)):
        if event.quantity != "overturn":
            told = "must be overturn with a fragility, which is one of overturning: give the "
            raise InputError("fecolumn risk", "--event", limit, f"{told}folder of a study instead")
        return found
    happened, fit_curve = None, lognormal
    if event.quantity != "overturn":
        happened, fit_curve = event.happened, partial(lognormal, event=event.text)
    fitted, refused = {}, {}
    for label, table in runs_by_setting(source, (measure,), happened).items():
        im = table.measures[measure]
        try:
            fit = fit_curve(im, table.overturned, table.records)
            bounds = [one.region() for one in over_failed(table, measure, fit_curve)]
        except DegenerateData as error:
            refused[label] = str(error)
            continue
        fitted[label] = KnownFragility(
            fit.median,
            fit.beta,
            (fit.region(), *bounds),
            (float(im.min()), float(im.max())),
            table.failed.count if table.failed else 0,
        )
        warn_of_failed(label, table, bounded=True)
    for label, reason in refused.items():
        print(f"{label + ': ' if label else ''}no fragility: {reason}")
    if not fitted:
        raise InputError(
            source,
            "",
            None,
            f"its runs bound no fragility over {measure}, the measure of the hazard: "
            + "; ".join(dict.fromkeys(refused.values())),
        )
    return fitted


def _stated(source: str, measure: str) -> dict[str, KnownFragility]:
    """Fragilities of a file that `fecolumn fragility` wrote; none of another table."""
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.csv_table import check_row, read_csv
    from fecolumn.statistics.hazard import stated_region

    header, rows = read_csv(Path(source), "runs, or what fecolumn fragility writes")
    ends = next((ends for ends in _ENDS_OF_MEDIAN if set(ends) <= set(header)), None)
    medians = [
        name for name in header if name.startswith("median_") and name not in _ENDS_OF_MEDIAN[0]
    ]
    if not ends or not {"beta", "beta_low", "beta_high"} <= set(header) or len(medians) != 1:
        return {}
    if medians[0] != f"median_{measure}":
        raise InputError(
            source,
            "header",
            medians[0],
            f"must be median_{measure}, over the measure of the hazard curve",
        )
    found = {}
    for number, row in rows:
        check_row(Path(source), header, number, row)
        cells = dict(zip(header, row))
        _check_counts(source, number, cells)
        values = []
        for name in (medians[0], *ends, "beta", "beta_low", "beta_high"):
            try:
                values.append(float(cells[name]))
            except ValueError:
                values.append(math.nan)
            if not 0 < values[-1] < math.inf:
                raise InputError(
                    source,
                    f"line {number}, {name}",
                    cells[name],
                    "must be a number above 0; where an interval is not bounded give the study's "
                    "folder, or the table of runs",
                )
        for (value, low, high), name in ((values[:3], medians[0]), (values[3:], "beta")):
            if not low <= value <= high:
                raise InputError(
                    source, f"line {number}, {name}", value, f"must lie in [{low:g}, {high:g}]"
                )
        median, beta = (values[0], values[1], values[2]), (values[3], values[4], values[5])
        name = cells.get("setting", "")
        found["" if name == "all" else name] = KnownFragility(
            median[0], beta[0], (stated_region(median, beta),)
        )
    return found


def _check_counts(source: str, number: int, cells: dict[str, str]) -> None:
    """InputError where the counts of a line of a fragility table cannot be those of its runs."""
    from fecolumn.foundation.schema import InputError

    def refuse(name: str, allowed: str) -> InputError:
        return InputError(source, f"line {number}, {name}", cells[name], allowed)

    counts: dict[str, int] = {}
    for name in ("n", "records", "overturned"):
        if name not in cells:
            continue
        text = cells[name].strip()
        if not re.fullmatch(r"[0-9]{1,9}", text):
            raise refuse(name, "must be a whole number of at least 0")
        counts[name] = int(text)
    n, fallen = counts.get("n"), counts.get("overturned")
    if fallen == 0:
        raise refuse("overturned", "must be at least 1: none that overturned bounds no median")
    for name in ("overturned", "records"):
        if n is not None and counts.get(name, 0) > n:
            raise refuse(name, f"must be at most n = {n}")
