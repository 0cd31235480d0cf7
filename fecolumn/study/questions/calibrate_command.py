"""`fecolumn calibrate`: which values of keys fit a measured free-rocking test, and which of them
the test cannot tell.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import Any

from fecolumn.foundation.interrupt import termination_as_interrupt
from fecolumn.foundation.range_option import take_values_below_zero

_COMMAND = "fecolumn calibrate"
_MOST = 4  # keys: each one more doubles the runs
# Sections of which no key belongs to the object
_NO_PART = ("motion", "integration", "output", "overturn", "mesh")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn calibrate`."""
    take_values_below_zero(parser)
    parser.add_argument("case", metavar="CASE.toml", help="case file; its motion is not used")
    parser.add_argument(
        "--test",
        metavar="TEST.csv",
        required=True,
        help="table with columns time_s and tilt_rad (or tilt_deg), from the release on",
    )
    parser.add_argument(
        "--fit",
        nargs=2,
        action="append",
        metavar=("KEY", "LO:HI"),
        default=None,
        help="key to fit and its range; may be repeated (default: restitution of a [block]; of "
        "finite elements and rigid bodies contact.restitution, friction, and contact "
        "stiffness and edge radius where the case states them)",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        required=True,
        help="folder of the runs and the answer; an unfinished one is continued",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")


@termination_as_interrupt()
def main(args: argparse.Namespace) -> int:
    """Fit, tell and draw; returns 0, 130 after Ctrl-C.

    Raises
    ------
    InputError
        case, test, keys or folder cannot be used.
    """
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.progress import CountProgress
    from fecolumn.statistics.profile import most_runs, profiled_fit
    from fecolumn.statistics.rocking_test import read_rocking_test
    from fecolumn.study.questions.calibration import RockingCalibration
    from fecolumn.study.questions.given import case_tables

    tables = case_tables(args.case)
    ranges = _ranges(args, tables)
    test = read_rocking_test(args.test)
    names = ("calibrate.csv", "profile.csv", "fitted.toml")
    with written(args.output, "calibrate", names=names) as draft:
        question = RockingCalibration(tables, args.case, ranges, test, Path(args.output) / "runs")
        question.check()
        progress = CountProgress(most_runs(len(ranges)), "runs", args.quiet)

        def residuals(u: Any) -> Any:
            found = question.residuals(u)
            if question.runs > progress.total:  # many minima
                progress.total = int(1.5 * progress.total)
            progress.show(question.runs)
            return found

        fit = profiled_fit(residuals, len(ranges))
        progress.end()
        _write(question, fit, os.path.abspath(args.case), draft)
    for sentence in question.sentences(fit):
        print(sentence)
    print(f"wrote {args.output}")
    return 0


def _ranges(args: argparse.Namespace, tables: dict[str, Any]) -> dict[str, tuple[float, float]]:
    """Keys to fit with their ranges.

    Raises
    ------
    InputError
        of --fit, or, where that is left out, of the case; or there are too many keys.
    """
    from fecolumn.case.case import case_from_tables
    from fecolumn.foundation.schema import InputError
    from fecolumn.study.questions.calibration import usual_ranges
    from fecolumn.study.questions.given import read_range

    if args.fit is None:
        rest = {key: table for key, table in tables.items() if key != "motion"}
        case_from_tables(rest, args.case)
        found = usual_ranges(rest, args.case)
        if len(found) > _MOST:
            told = f"has {len(found)} keys to fit, {', '.join(found)}; at most {_MOST}: name them"
            raise InputError(args.case, "", None, f"{told} by --fit")
        if not args.quiet:
            print(f"fitting {', '.join(found)}", file=sys.stderr, flush=True)
        return found
    found = {}
    for key, text in args.fit:
        if key in found:
            raise InputError(_COMMAND, "--fit", key, "stands twice")
        low, high, kind = read_range(key, text, "--fit", _COMMAND)
        if kind is not float or key.partition(".")[0] in _NO_PART:
            raise InputError(
                _COMMAND,
                f"--fit {key}",
                text,
                "must be a number of the object or of its start that varies continuously, such as "
                "block.restitution, joints.foot.friction_coefficient or initial.tilt_rad",
            )
        found[key] = low, high
    if len(found) > _MOST:
        raise InputError(_COMMAND, "--fit", ", ".join(found), f"must be at most {_MOST} keys")
    return found


def _write(question: Any, fit: Any, case: str, folder: Path) -> None:
    """Tables, the fitted case and the figure."""
    import tomli_w

    from fecolumn.foundation.atomic import write_bytes, write_csv
    from fecolumn.foundation.toml_file import merge, nested
    from fecolumn.pictures.figures.axis_text import axis_unit
    from fecolumn.pictures.figures.calibration_figure import calibration_figure

    best = question.values(fit.best)
    rows: list[list[Any]] = [["key", "unit", "value", "low", "high", "identified"]]
    profiles: list[list[Any]] = [["key", "value", "deviance"]]
    for key, one in zip(question.ranges, fit.parameters):
        ends = [
            "" if end is None else f"{question.at(key, end):.6g}" for end in (one.low, one.high)
        ]
        rows.append([key, axis_unit(key), f"{best[key]:.6g}", *ends, int(one.identified)])
        profiles += [
            [key, f"{question.at(key, at):.6g}", f"{deviance:.5g}"]
            for at, deviance in zip(one.at, one.deviance)
        ]
    write_csv(folder / "calibrate.csv", rows)
    write_csv(folder / "profile.csv", profiles)
    fitted: dict[str, Any] = {"extends": case}
    for key, value in best.items():
        fitted = merge(fitted, nested(key, value))
    write_bytes(folder / "fitted.toml", tomli_w.dumps(fitted).encode())
    calibration_figure(
        question.test,
        question.tilt(fit.best),
        question.ranges,
        question.at,
        fit,
        folder / "calibrate",
    )
