"""`fecolumn verify`: the verification cases, their table and figures."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace

from fecolumn.foundation.cores import usable_cores
from fecolumn.foundation.older_option import OlderOption
from fecolumn.verification import ALL_ENGINES, CASES, FULL


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `fecolumn verify`."""
    parser.add_argument(
        "-o", "--output", metavar="DIR", required=True, help="folder for table and figures"
    )
    parser.add_argument(
        "-k",
        "--name",
        metavar="NAME",
        default="",
        help=f"run only cases whose name contains NAME, of {', '.join(CASES)}",
    )
    parser.add_argument("--case", dest="name", action=OlderOption, newer="--name")
    parser.add_argument(
        "--engine",
        metavar="E",
        action="append",
        choices=("full", *ALL_ENGINES),
        help="run only this engine, of %(choices)s; full: both kinematics of the full engine, "
        "corotated and total_lagrangian (default: all)",
    )
    parser.add_argument(
        "-j",
        "--jobs",
        metavar="N",
        type=int,
        default=usable_cores(),
        help="number of cases at a time (default: %(default)s)",
    )
    parser.add_argument(
        "--long",
        action="store_true",
        help="finer meshes and smaller steps as well, about three hours on two cores",
    )
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="print only the verdict, not a row for each case"
    )


def main(args: Namespace) -> int:
    """Run the cases; 0 when every row holds, 1 when one does not.

    Raises
    ------
    InputError
        no case of that name, or a folder that cannot be written.
    """
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.verification.suite import tasks, verdict, verify

    engines = set(args.engine or ALL_ENGINES)
    if "full" in engines:
        engines |= set(FULL)
    pairs = tasks(args.name, engines)
    if not pairs:
        of = f" of engine {' or '.join(args.engine)}" if args.engine else ""
        known = ", ".join(dict.fromkeys(case for case, _ in tasks("", engines)))
        raise InputError(
            "fecolumn verify", "-k", args.name, f"must be part of the name of a case{of}: {known}"
        )
    if args.jobs < 1:
        raise InputError("fecolumn verify", "-j", args.jobs, "must be at least 1")
    with written(args.output, "verify", names=("table.csv", "table.txt")) as draft:
        findings = verify(
            pairs, draft, args.long, args.jobs, show=_nothing if args.quiet else _show
        )
    print(f"wrote {os.path.join(args.output, 'table.csv')}")
    print(verdict(findings))
    return 0 if all(finding.ok for finding in findings) else 1


def _show(text: str) -> None:
    print(text, flush=True)


def _nothing(text: str) -> None:
    """In the place of `_show` where nobody wants to see."""
