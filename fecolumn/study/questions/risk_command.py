"""`fecolumn risk`: how often a limit state is reached at a site, from runs or a fragility and a
hazard curve.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

_COMMAND = "fecolumn risk"
_LITTLE = 0.01  # share of the frequency that may lie outside of the hazard curve in silence
_MUCH = 0.1  # the same, outside of the intensities of the runs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn risk`."""
    parser.add_argument(
        "source",
        metavar="STUDY|FILE.csv",
        help="folder of a study; or a table of runs, such as responses.csv of fecolumn rocking; or "
        "fragility.csv of fecolumn fragility over one measure",
    )
    parser.add_argument(
        "--hazard",
        metavar="CURVE.csv",
        required=True,
        help="intensity and annual_frequency (or return_period_years, probability_50_years), such "
        "as pga_g,annual_frequency; or OpenQuake's export of a hazard curve",
    )
    parser.add_argument(
        "--limit",
        metavar="EVENT",
        default="overturn",
        help="of a study: overturn (default), lost, top > 50 mm, slide > 5 mm ...",
    )
    parser.add_argument(
        "--years", metavar="T", type=float, default=50.0, help="time of exposure (default: 50)"
    )
    parser.add_argument(
        "--site", metavar="N", type=int, default=1, help="line of OpenQuake's file (default: 1)"
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", required=True, help="folder for tables and figures"
    )


@dataclass(frozen=True, slots=True)
class KnownFragility:
    """A lognormal fragility: its median and dispersion, r of them (r, 2) that say how well they are
    known, and the least and the largest intensity of its runs, None where they are not known.
    """

    median: float
    beta: float
    drawn: Any
    runs: tuple[float, float] | None = None


def main(args: argparse.Namespace) -> int:
    """Integrate, tell and draw; returns 0.

    Raises
    ------
    InputError
        hazard, runs or fragility cannot be used.
    """
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.hazard_table import read_hazard

    if not 0 < args.years <= 1e6:
        raise InputError(_COMMAND, "--years", args.years, "must be greater than 0, at most 1e6")
    curve = read_hazard(args.hazard, args.site)
    sets = _fragilities(args.source, args.limit, curve.measure)
    with written(args.output, "risk", names=("risk.csv",)) as draft:
        _write(sets, curve, args, draft)
    print(f"wrote {args.output}")
    return 0


def _fragilities(source: str, limit: str, measure: str) -> dict[str, KnownFragility]:
    """Fragility over the hazard's measure of each setting of the source."""
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.fragility import DegenerateData, bootstrap, lognormal
    from fecolumn.study.questions.limit import read_event
    from fecolumn.study.report.fragility_command import runs_by_setting

    if not Path(source).is_dir() and (found := _stated(source, measure)):
        return found
    event = read_event(limit, _COMMAND)
    happened = None if event.quantity == "overturn" else event.happened
    fitted, refused = {}, {}
    for label, table in runs_by_setting(source, (measure,), happened).items():
        im = table.measures[measure]
        try:
            fit = lognormal(im, table.overturned, table.records)
            drawn = bootstrap(im, table.overturned, lognormal, table.records)
        except DegenerateData as error:
            refused[label] = str(error)
            continue
        fitted[label] = KnownFragility(
            fit.median, fit.beta, drawn.parameters, (float(im.min()), float(im.max()))
        )
        if drawn.refused > 0.05 * (drawn.refused + len(drawn.parameters)):
            print(
                f"fecolumn: warning: {label + ': ' if label else ''}{drawn.refused} of "
                f"{drawn.refused + len(drawn.parameters)} samples of the bootstrap bound no "
                "fragility: the interval is too narrow; more runs are needed",
                file=sys.stderr,
            )
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
    from fecolumn.statistics.hazard import drawn_parameters

    header, rows = read_csv(Path(source), "runs, or what fecolumn fragility writes")
    medians = [name for name in header if name.startswith("median_")]
    if not {"beta", "beta_low", "beta_high", "low", "high"} <= set(header) or len(medians) != 1:
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
        values = []
        for name in (medians[0], "low", "high", "beta", "beta_low", "beta_high"):
            try:
                values.append(float(cells[name]))
            except ValueError:
                values.append(math.nan)
            if not 0 < values[-1] < math.inf:
                raise InputError(
                    source, f"line {number}, {name}", cells[name], "must be a number above 0"
                )
        for (value, low, high), name in ((values[:3], medians[0]), (values[3:], "beta")):
            if not low <= value <= high:
                raise InputError(
                    source, f"line {number}, {name}", value, f"must lie in [{low:g}, {high:g}]"
                )
        median, beta = (values[0], values[1], values[2]), (values[3], values[4], values[5])
        name = cells.get("setting", "")
        found["" if name == "all" else name] = KnownFragility(
            median[0], beta[0], drawn_parameters(median, beta)
        )
    return found


def _write(sets: dict[str, KnownFragility], curve: Any, args: Any, folder: Path) -> None:
    """Sentences, tables and a figure for each setting."""
    import numpy as np

    from fecolumn.foundation.atomic import write_csv
    from fecolumn.pictures.figures.risk_figure import risk_figure
    from fecolumn.statistics.hazard import (
        annual_frequency,
        lognormal_probabilities,
        probability_in_years,
    )
    from fecolumn.study.report.fragility_command import words

    years = f"{args.years:g}"
    table: list[list[Any]] = [
        [
            *("setting", f"median_{curve.measure}", "beta", "annual_frequency", "low", "high"),
            *(f"p_{years}_years", "p_low", "p_high", "return_period_years", "beyond_curve_most"),
            "outside_runs_share",
        ]
    ]
    parts: list[list[Any]] = [["setting", "from", "to", "annual_frequency", "share"]]
    for number, (label, one) in enumerate(sets.items(), 1):
        best = annual_frequency(curve, lognormal_probabilities(one.median, one.beta))
        drawn = annual_frequency(curve, lognormal_probabilities(*one.drawn.T)).value
        value = float(best.value[0])
        low, high = np.quantile(drawn, (0.025, 0.975))
        p = [float(x) for x in probability_in_years([value, low, high], args.years)]
        share = best.parts[0] / value if value > 0 else best.parts[0]
        name = label or "all"
        table.append(
            [
                name,
                *(f"{x:.6g}" for x in (one.median, one.beta, value, low, high, *p)),
                f"{1 / value:.6g}" if value > 0 else "inf",
                f"{best.beyond[0]:.6g}",
                "" if one.runs is None else f"{_outside(curve, one, value):.4f}",
            ]
        )
        for place, contribution in enumerate(best.parts[0]):
            cells = (best.edges[place], best.edges[place + 1], contribution, share[place])
            parts.append([name, *(f"{x:.6g}" for x in cells)])
        half = _middle(best.edges, share)
        print(
            f"{label + ': ' if label else ''}{args.limit} has a mean annual frequency of "
            f"{value:.3g} [{low:.3g}, {high:.3g}] a year and a probability of {100 * p[0]:.3g} % "
            f"[{100 * p[1]:.3g}, {100 * p[2]:.3g}] in {years} years (95 % intervals); half of it "
            f"comes from {curve.measure} between {half[0]:.3g} and {half[1]:.3g}."
        )
        _warn(best, value, curve)
        if one.runs and (outside := _outside(curve, one, value)) > _MUCH:
            print(
                f"fecolumn: warning: {label + ': ' if label else ''}{100 * outside:.0f} % of it "
                f"comes from intensities that no run had, outside {one.runs[0]:.3g} to "
                f"{one.runs[1]:.3g}: scale the motions to those of the last sentence",
                file=sys.stderr,
            )
        file = "risk" if len(sets) == 1 else f"risk{number}"
        risk_figure(curve, one, best, (args.limit, words(curve.measure)), folder / file)
    write_csv(folder / "risk.csv", table)
    write_csv(folder / "deaggregation.csv", parts)


def _outside(curve: Any, one: KnownFragility, value: float) -> float:
    """Share of the frequency from intensities that no run had."""
    import numpy as np

    from fecolumn.statistics.hazard import annual_frequency, lognormal_probabilities

    low, high = one.runs or (0.0, math.inf)
    p = lognormal_probabilities(one.median, one.beta)
    there = annual_frequency(
        curve, lambda im: np.where((np.asarray(im) >= low) & (np.asarray(im) <= high), p(im), 0.0)
    )
    return 1 - float(there.value[0]) / value if value > 0 else 0.0


def _middle(edges: Any, share: Any) -> tuple[float, float]:
    """Intensities between which the middle half of the frequency comes from."""
    import numpy as np

    total = np.append(0.0, np.cumsum(share))
    low, high = np.exp(np.interp((0.25, 0.75), total, np.log(edges)))
    return float(low), float(high)


def _warn(best: Any, value: float, curve: Any) -> None:
    """Tell of intensities outside of the curve that may matter."""
    if best.beyond[0] > _LITTLE * value:
        print(
            f"fecolumn: warning: intensities above the hazard curve's last, {curve.im[-1]:.3g}, "
            f"may add up to {best.beyond[0]:.2g} a year: give the curve more points",
            file=sys.stderr,
        )
    if best.below[0] > _LITTLE:
        print(
            f"fecolumn: warning: the hazard curve begins at {curve.im[0]:.3g}, where the fragility "
            "is not yet nothing: weaker and more frequent motions are left out",
            file=sys.stderr,
        )
