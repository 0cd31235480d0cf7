"""`fecolumn study`: run a study, or what is missing of it, and show its table and its figure."""

from __future__ import annotations

import os
import signal
import sys


def add_arguments(parser) -> None:
    """Arguments of `fecolumn study`."""
    parser.add_argument("study", metavar="STUDY.toml", help="study file: title, case and [axes]")
    parser.add_argument("-o", "--output", metavar="DIR", required=True, help="folder of the study; an unfinished one is resumed")
    parser.add_argument("-j", "--jobs", metavar="N", type=int, default=os.cpu_count() or 1,
                        help="analyses at a time (default: %(default)s)")
    parser.add_argument("--retry-failed", action="store_true", help="run the analyses again that failed before")
    parser.add_argument("--entry", metavar="MODULE:FUNCTION", default=None, help="analysis function (default: fecolumn.simulation:run)")


def main(args) -> int:
    """Run the study; 0 when every analysis is done, 1 when some failed, 130 after Ctrl-C.

    Raises:
        InputError: study file or folder cannot be used.
    """
    from fecolumn.schema import InputError
    from fecolumn.study.plan import read_plan
    from fecolumn.study.run import ENTRY, StudyError, check_motions, run_study
    from fecolumn.study.store import DONE, FAILED

    if args.jobs < 1:
        raise InputError("fecolumn study", "-j", args.jobs, "must be at least 1")
    plan = read_plan(args.study)
    if args.entry is None:  # an analysis function of the user's may read motions this package does not know
        check_motions(plan)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # a batch system's stop is answered like Ctrl-C
    try:
        rows = run_study(plan, args.output, workers=args.jobs, entry=args.entry or ENTRY, retry_failed=args.retry_failed)
    except KeyboardInterrupt:
        print("stopped; what is done is kept, the same command does the rest", file=sys.stderr)
        return 130
    except StudyError as error:
        print(f"{error}; nothing done is lost, the same command does the rest", file=sys.stderr)
        return 1
    from fecolumn.study.table import table_text, write_figure, write_tables  # matplotlib and scipy only now

    write_tables(plan, rows, args.output)
    files = write_figure(plan, rows, args.output)
    print(f"{plan.title}: {sum(row['state'] == DONE for row in rows)} of {len(rows)} analyses done\n{table_text(plan, rows)}")
    print("\n".join(f"wrote {file}" for file in [os.path.join(args.output, "table.csv"), *files]))
    failed = [row for row in rows if row["state"] == FAILED]
    for row in failed:
        values = ", ".join(f"{key} = {value}" for key, value in row["axes"].items())
        print(f"failed: {values}: {row['reason']} ({os.path.join(args.output, 'logs', row['id'] + '.log')})", file=sys.stderr)
    if failed:
        print(f"{len(failed)} failed; add --retry-failed to run them again", file=sys.stderr)
    return 1 if failed else 0
