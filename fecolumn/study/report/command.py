"""`fecolumn report`: the report of a study folder."""

from __future__ import annotations

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn report`."""
    parser.add_argument(
        "study",
        metavar="DIR",
        help="folder of fecolumn study, finished or not; the report goes to DIR/report",
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", default=None, help="another folder for the report"
    )


def main(args: argparse.Namespace) -> int:
    """Write the report; 0 when it is written.

    Raises
    ------
    InputError
        the folder holds no study, or nothing of it is done yet.
    """
    from fecolumn.study.report.page import write_report

    print(f"wrote {write_report(args.study, args.output)}")
    return 0
