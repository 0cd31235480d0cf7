"""`fecolumn risk`: how often a limit state is reached at a site, from runs or a fragility and a
hazard curve.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import Any

from fecolumn.foundation.older_option import OlderOption

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
        help="table with an intensity and annual_frequency (or return_period_years, "
        "probability_50_years), such as pga_g,annual_frequency; or a hazard curve exported "
        "by OpenQuake",
    )
    parser.add_argument(
        "--event",
        metavar="EVENT",
        default="overturn",
        help="limit state, with a study: overturn (default), lost, top > 50 mm, slide > 5 mm ...",
    )
    parser.add_argument("--limit", dest="event", action=OlderOption, newer="--event")
    parser.add_argument(
        "--years",
        metavar="T",
        type=float,
        default=50.0,
        help="exposure time in years (default: 50)",
    )
    parser.add_argument(
        "--site",
        metavar="N",
        type=int,
        default=1,
        help="number of the site's line in OpenQuake's file (default: 1)",
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", required=True, help="folder for tables and figures"
    )


def main(args: argparse.Namespace) -> int:
    """Integrate, tell and draw; 0, or 1 where analyses of the study failed.

    Raises
    ------
    InputError
        hazard, runs or fragility cannot be used.
    """
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.hazard_table import read_hazard
    from fecolumn.study.questions.fragilities import fragilities_of

    if not 0 < args.years <= 1e6:
        raise InputError(_COMMAND, "--years", args.years, "must be greater than 0, at most 1e6")
    curve = read_hazard(args.hazard, args.site)
    sets = fragilities_of(args.source, args.event, curve.measure)
    with written(args.output, "risk", names=("risk.csv",)) as draft:
        _write(sets, curve, args, draft)
    print(f"wrote {args.output}")
    return 1 if any(one.failed for one in sets.values()) else 0


def _write(sets: dict[str, Any], curve: Any, args: Any, folder: Path) -> None:
    """Sentences, tables and a figure for each setting."""
    import numpy as np

    from fecolumn.foundation.atomic import write_csv
    from fecolumn.pictures.figures.risk_figure import risk_figure
    from fecolumn.statistics.hazard import (
        annual_frequency,
        lognormal_probabilities,
        probability_in_years,
        probit_probabilities,
    )
    from fecolumn.study.report.fragility_command import words

    years = f"{args.years:g}"
    table: list[list[Any]] = [
        [
            *("setting", f"median_{curve.measure}", "beta", "annual_frequency"),
            *("annual_frequency_low", "annual_frequency_high", "years"),
            *("probability", "probability_low", "probability_high", "return_period_years"),
            *("beyond_curve_most", "outside_runs_share"),
        ]
    ]
    ends = (f"{curve.measure}_from", f"{curve.measure}_to")
    parts: list[list[Any]] = [["setting", *ends, "annual_frequency", "share"]]
    for number, (label, one) in enumerate(sets.items(), 1):
        best = annual_frequency(curve, lognormal_probabilities(one.median, one.beta))
        value = float(best.value[0])
        around = np.concatenate(
            [annual_frequency(curve, probit_probabilities(lines)).value for lines in one.regions]
        )
        low, high = min(value, around.min()), max(value, around.max())
        p = [float(x) for x in probability_in_years([value, low, high], args.years)]
        share = best.parts[0] / value if value > 0 else best.parts[0]
        name = label or "all"
        table.append(
            [
                name,
                *(f"{x:.6g}" for x in (one.median, one.beta, value, low, high)),
                years,
                *(f"{x:.6g}" for x in p),
                f"{1 / value:.6g}" if value > 0 else "inf",
                f"{best.beyond[0]:.6g}",
                "" if one.runs is None else f"{_outside(curve, one, value):.4f}",
            ]
        )
        for place, contribution in enumerate(best.parts[0]):
            cells = (best.edges[place], best.edges[place + 1], contribution, share[place])
            parts.append([name, *(f"{x:.6g}" for x in cells)])
        where = ""
        if value > 0:
            half = _middle(best.edges, share)
            where = (
                f"; half of it comes from {curve.measure} between {half[0]:.3g} and {half[1]:.3g}"
            )
        print(
            f"{label + ': ' if label else ''}{args.event} has a mean annual frequency of "
            f"{value:.3g} [{low:.3g}, {high:.3g}] a year and a probability of {100 * p[0]:.3g} % "
            f"[{100 * p[1]:.3g}, {100 * p[2]:.3g}] in {years} years (95 % intervals){where}."
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
        risk_figure(curve, one, best, (args.event, words(curve.measure)), folder / file)
    write_csv(folder / "risk.csv", table)
    write_csv(folder / "deaggregation.csv", parts)


def _outside(curve: Any, one: Any, value: float) -> float:
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
