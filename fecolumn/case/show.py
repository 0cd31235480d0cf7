"""`fecolumn show`: the full form of a case, which runs to the same digits as the short one."""

from __future__ import annotations

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn show`."""
    parser.add_argument("case", metavar="CASE.toml", help="case file to print")
    parser.add_argument("--all", action="store_true", help="print keys at their defaults as well")


def main(args: argparse.Namespace) -> int:
    """Print the full form; returns 0.

    Raises
    ------
    InputError
        the file holds no case.
    """
    import tomli_w

    from fecolumn.case.case import load_case
    from fecolumn.case.case_text import full_form

    print(tomli_w.dumps(full_form(load_case(args.case), args.all)), end="")
    return 0
