"""`fecolumn completion SHELL`: commands, options, choices and names of files completed by the Tab
key, as the parser declares them.
"""

from __future__ import annotations

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn completion`."""
    parser.add_argument(
        "shell",
        choices=("bash", "zsh", "fish"),
        help="shell for which the script is printed, one of %(choices)s",
    )


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The script for a shell, by shtab; where a value is no word of a list, names of files are
    offered.
    """
    import shtab

    _offer_files(parser, shtab.FILE)
    return shtab.complete(parser, shell=shell)


def _offer_files(parser: argparse.ArgumentParser, files: dict[str, str | dict[str, str]]) -> None:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                _offer_files(below, files)
        elif not action.choices and action.nargs != 0:
            action.complete = files  # type: ignore[attr-defined]  # by which shtab is told
