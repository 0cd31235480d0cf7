"""`fecolumn study`: run a study, or what is missing of it, and show its table and its figure."""

from __future__ import annotations

import argparse
import os
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fecolumn.foundation.cores import usable_cores

if TYPE_CHECKING:
    from fecolumn.study.plan import Plan
    from fecolumn.study.sequential import Rule, Verdict
    from fecolumn.study.team import Team


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn study`."""
    parser.add_argument(
        "study",
        metavar="STUDY.toml",
        help="study file, with title, case, and [axes], [[zip]], [latin_hypercube] as needed",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        required=True,
        help="folder of the study; an unfinished one is resumed",
    )
    parser.add_argument(
        "-j",
        "--jobs",
        metavar="N",
        type=int,
        default=None,
        help="number of analyses at a time on this machine (default: one per core); under mpirun "
        "every rank except the first runs one",
    )
    parser.add_argument(
        "--array-index",
        metavar="I",
        type=int,
        default=None,
        help="run only this share of the analyses, counted from 0, as a task of a job array",
    )
    parser.add_argument(
        "--array-size",
        metavar="N",
        type=int,
        default=None,
        help="number of shares; all tasks may run at the same time in one DIR",
    )
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        default=None,
        help="run the analyses on the workers of a dask scheduler, such as tcp://node7:8786; all "
        "workers must see DIR",
    )
    parser.add_argument(
        "--until",
        choices=["decided"],
        default=None,
        help="add motions of the ensemble in stages, 40, 80, 160, ..., until each pair of "
        "settings is found to be different or alike",
    )
    parser.add_argument(
        "--margin",
        metavar="D",
        type=float,
        default=None,
        help="with --until: largest distance of two CDFs that count as alike (default: 0.1)",
    )
    parser.add_argument(
        "--error",
        metavar="P",
        type=float,
        default=None,
        help="with --until: probability of error allowed for each statement, over all stages "
        "together (default: 0.05)",
    )
    parser.add_argument(
        "--most",
        metavar="N",
        type=int,
        default=None,
        help="with --until: largest number of motions in each setting (default: 1000)",
    )
    parser.add_argument("--retry-failed", action="store_true", help="run failed analyses again")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")
    parser.add_argument(
        "--entry",
        metavar="MODULE:FUNCTION",
        default=None,
        help="function that runs an analysis (default: fecolumn.simulation:run)",
    )


def main(args: argparse.Namespace) -> int:
    """Run the study; 0 when every analysis is done, 1 when some failed or the disk is full, 130
    after Ctrl-C.

    Raises
    ------
    InputError
        study file or folder cannot be used.
    """
    from fecolumn.foundation.schema import InputError
    from fecolumn.study import mpi

    if args.jobs is not None and args.jobs < 1:
        raise InputError("fecolumn study", "-j", args.jobs, "must be at least 1")
    share = _share(args)
    if args.scheduler is not None:
        return _run_on_scheduler(args, share)
    if not mpi.under_mpirun():
        return _run(args, share)[0]
    if args.jobs is not None:
        raise InputError(
            "fecolumn study",
            "-j",
            args.jobs,
            "is for one machine; here mpirun -n says how many, one more than analyses at a time",
        )
    with mpi.executor() as pool:
        if pool is None:
            return 0
        from mpi4py import MPI

        code, stopped = _run(
            args, share, lambda *told: mpi.MpiTeam(pool, MPI.COMM_WORLD.size - 1, *told)
        )
        if stopped:  # the other ranks are at work
            mpi.abort(code)
    return code


def _run_on_scheduler(args: argparse.Namespace, share: tuple[int, int] | None) -> int:
    from fecolumn.foundation.schema import InputError
    from fecolumn.study import dask, mpi

    if mpi.under_mpirun():
        raise InputError(
            "fecolumn study",
            "--scheduler",
            args.scheduler,
            "goes without mpirun: the workers of the scheduler do the analyses",
        )
    if args.jobs is not None:
        raise InputError(
            "fecolumn study",
            "-j",
            args.jobs,
            "is for one machine; here the scheduler's workers say how many analyses at a time",
        )
    with dask.connected(args.scheduler) as client:
        return _run(args, share, lambda *told: dask.DaskTeam(client, *told))[0]


def _share(args: argparse.Namespace) -> tuple[int, int] | None:
    from fecolumn.foundation.schema import InputError

    index, size = args.array_index, args.array_size
    if index is None and size is None:
        return None
    if size is None or size < 1:
        raise InputError(
            "fecolumn study",
            "--array-size",
            size,
            "must be at least 1, and goes with --array-index",
        )
    if index is None or not 0 <= index < size:
        raise InputError(
            "fecolumn study",
            "--array-index",
            index,
            f"must lie in [0, {size - 1}]: the shares are counted from 0",
        )
    return index, size


def _run(
    args: argparse.Namespace,
    share: tuple[int, int] | None,
    team_of: Callable[[str, str, tuple[int, int] | None, Path], Team] | None = None,
) -> tuple[int, bool]:
    """Run the study by the team that `team_of` makes, else in processes of this machine; exit code,
    and whether it was stopped.
    """
    from fecolumn.study.plan import read_plan
    from fecolumn.study.run import (
        ENTRY,
        StudyError,
        check_motions,
        complete_study,
        stop_code,
    )
    from fecolumn.study.sequential import progress_text, until_decided

    plan = read_plan(args.study)
    # an analysis function of the user's may read motions this package does not know
    if args.entry is None:
        from fecolumn.case.sections import MODEL_ENGINES
        from fecolumn.structures.size import expected_of_all

        check_motions(plan)
        meshed = [
            analysis.case
            for analysis in plan.analyses
            if analysis.case.integration.engine not in MODEL_ENGINES
        ]
        if meshed and not args.quiet:
            print(expected_of_all(meshed, args.study), file=sys.stderr, flush=True)
    entry, rule = args.entry or ENTRY, _rule(args, share, plan)
    tried: set[str] = set()

    def work(only: set[str] | None = None) -> list[dict[str, Any]]:
        team = team_of(entry, args.output, share, plan.file) if team_of else None
        every = {one.id for one in plan.analyses} if only is None else only
        again = every - tried  # each once, not at each stage
        tried.update(every)
        return complete_study(
            plan,
            args.output,
            workers=team or args.jobs or usable_cores(),
            entry=entry,
            retry_failed=again if args.retry_failed else False,
            stream=None if args.quiet else sys.stderr,
            share=share,
            only=only,
        )

    verdicts: list[Verdict] = []
    try:
        if rule:
            for stage in until_decided(plan, rule, work):
                motions, verdicts, rows = stage
                if not args.quiet:
                    print(progress_text(motions, verdicts), file=sys.stderr, flush=True)
        else:
            rows = work()
    except (KeyboardInterrupt, StudyError) as error:
        return stop_code(error), True
    code = _show(plan, rows, args.output, share)
    if rule:
        for verdict in verdicts:
            print(verdict.text(rule))
    return code, False


def _rule(args: argparse.Namespace, share: tuple[int, int] | None, plan: Plan) -> Rule | None:
    """The `sequential.Rule` of the options, None without --until."""
    from fecolumn.foundation.schema import InputError
    from fecolumn.study.sequential import Rule, stages

    given = {
        name: value
        for name in ("margin", "error", "most")
        if (value := getattr(args, name)) is not None
    }
    if args.until is None:
        for name, value in given.items():
            raise InputError("fecolumn study", f"--{name}", value, "goes with --until decided")
        return None
    if share:
        raise InputError(
            "fecolumn study",
            "--until",
            args.until,
            "is for one driver that sees all results, not for a share of a job array",
        )
    rule = Rule(**given)
    rule.check("fecolumn study")
    stages(plan, rule)
    return rule


def _show(
    plan: Plan, rows: list[dict[str, Any]], folder: Path | str, share: tuple[int, int] | None
) -> int:
    """Tables and figure, or for a share only its count; 1 when some failed."""
    from fecolumn.engines.ending import cut_short
    from fecolumn.study.failures import what_to_do
    from fecolumn.study.setting_rows import failed_of
    from fecolumn.study.store import DONE

    done = f"{sum(row['state'] == DONE for row in rows)} of {len(rows)} analyses done"
    if share:
        print(
            f"{plan.title}: share {share[0]} of {share[1]}: {done}; when all shares "
            "are, the command without --array-index makes the tables"
        )
    else:
        from fecolumn.study.conclusion import conclusion

        # matplotlib and scipy only now
        from fecolumn.study.table import (
            table_text,
            write_figure,
            write_tables,
        )

        write_tables(plan, rows, folder)
        files = write_figure(plan, rows, folder)
        print(f"{plan.title}: {done}\n{table_text(plan, rows)}")
        for said in (
            cut_short(row["summary"] for row in rows if row["state"] == DONE),
            conclusion(plan, rows),
        ):
            if said:
                print(textwrap.fill(said, 110))
        print("\n".join(f"wrote {file}" for file in [os.path.join(folder, "table.csv"), *files]))
    failed = failed_of(rows)
    for row in failed:
        values = ", ".join(f"{key} = {value}" for key, value in row["axes"].items())
        print(
            f"failed: {values}: {row['reason']} ({os.path.join(folder, row['log'])})",
            file=sys.stderr,
        )
    if failed:
        print(f"{len(failed)} failed: {what_to_do(failed)}", file=sys.stderr)
    return 1 if failed else 0
