"""fecolumn mesh: the meshes of a case, built, checked and drawn."""

from __future__ import annotations

import argparse
import functools
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from fecolumn.foundation.schema import InputError

if TYPE_CHECKING:
    from fecolumn.case.case import Case


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("case", metavar="CASE.toml", help="case file whose meshes are built")
    parser.add_argument(
        "-o", "--output", required=True, metavar="DIR", help="folder for meshes, picture and table"
    )


def main(args: argparse.Namespace) -> int:
    """Run the command; returns 0.

    Raises
    ------
    InputError
        the case, its meshes or the folder cannot be used.
    """
    from fecolumn.case.case import load_case
    from fecolumn.foundation.folder import written
    from fecolumn.pictures.mesh_report import FILES, mesh_report

    case = load_case(args.case)
    for table in case.own:
        told = "is a rocking model of rigid bodies, which has no mesh; fecolumn rocking tells its "
        raise InputError(args.case, table, None, told + "parameters")
    _warn_of_motion(case, args.case)
    with written(args.output, "mesh", names=FILES) as draft:
        tell = functools.partial(print, file=sys.stderr, flush=True)
        print(mesh_report(case, args.case, draft, tell))
    return 0


def _warn_of_motion(case: Case, file: Path | str) -> None:
    """Tell of a motion that an analysis of the case would cut short, or could not use; its mesh may
    be looked at all the same.
    """
    from fecolumn.engines.ending import cut_text
    from fecolumn.motions.load import unsampled

    if case.motion is None:
        return
    try:
        motion_s, end_s = unsampled(case.motion, file).duration, case.integration.duration_s
    except InputError as error:
        warnings.warn(str(error), stacklevel=2)
        return
    if 0 < end_s < motion_s - case.integration.shortest_s:
        warnings.warn(cut_text(file, end_s, motion_s), stacklevel=2)
