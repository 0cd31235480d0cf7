"""Records and ensembles that the commands of ground motions read and write."""

from __future__ import annotations

import argparse
import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fecolumn.case.sections import Motion
    from fecolumn.motions.ensemble import Ensemble
    from fecolumn.motions.record import GroundMotion


_COMMAND = "fecolumn motions"
# Flags of the commands for the keys of a case; `source_name` of the arguments is that of
# motion.source
_FLAGS = {
    "motion.units": "--units",
    "motion.dt_s": "--dt",
    "motion.source_y": "--source-y",
    "motion.source_z": "--source-z",
}


def add_output(parser: argparse.ArgumentParser) -> None:
    """Flag of the ensemble that is written."""
    parser.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="ENSEMBLE.h5",
        help="ensemble to write; its table is written beside it, ENSEMBLE.csv",
    )


def add_unit_and_step(parser: argparse.ArgumentParser, file: str = "the file") -> None:
    """Flags for what a file does not state."""
    parser.add_argument(
        "--units",
        default="",
        help=f"unit of the accelerations where {file} does not state it: g, %%g, mg, m/s2, cm/s2, "
        "mm/s2, ft/s2 or in/s2",
    )
    parser.add_argument(
        "--dt",
        type=float,
        default=0.0,
        help=f"sampling step where {file} does not state it, up to 10 [s]",
    )


def add_components(parser: argparse.ArgumentParser, of: str = "") -> None:
    """Flags of the other components of a record; of: where they are taken, for the help."""
    for axis in "yz":
        parser.add_argument(
            f"--source-{axis}",
            default="",
            metavar="FILE",
            help=f"file of the {axis} component, where each component has its own file{of}",
        )


def store(ensemble: Ensemble, output: Path | str) -> int:
    """Write an ensemble and its table, and say what it is."""
    from fecolumn.motions.ensemble_file import summary, write_ensemble, write_summary
    from fecolumn.motions.ensemble_report import report

    path = ensemble_path(output)
    columns = summary(ensemble)
    write_ensemble(ensemble, path)
    write_summary(ensemble, columns, path.with_suffix(".csv"))
    print(report(ensemble, columns))
    print(f"wrote {path}\nwrote {path.with_suffix('.csv')}")
    return 0


def ensemble_path(output: Path | str) -> Path:
    """Path of an ensemble that may be written; its folder is there."""
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import TABLE_HEADS, is_ensemble, is_hdf5_name

    path = Path(output)
    if not is_hdf5_name(path):
        raise InputError("fecolumn motions", "-o", str(output), "must end in .h5")
    path.parent.mkdir(parents=True, exist_ok=True)
    if os.path.lexists(path) and not is_ensemble(path):
        raise InputError(
            "fecolumn motions",
            "-o",
            str(output),
            "is there and no ensemble of motions; move it away or give another name",
        )
    table = path.with_suffix(".csv")
    refuse_foreign(
        table,
        TABLE_HEADS,
        "is there and no table of an ensemble; move it away or give the ensemble another name",
    )
    return path


def refuse_foreign(path: Path, head: str | tuple[str, ...], allowed: str) -> None:
    """Refuse to write over a file that does not begin as ours do: by `head`, or one of several."""
    from fecolumn.foundation.files import Unreadable, read_bytes
    from fecolumn.foundation.schema import InputError

    heads = (head,) if isinstance(head, str) else head
    begins = tuple(one.encode() for one in heads)
    try:
        own = not os.path.lexists(path) or read_bytes(path).startswith(begins)
    except Unreadable:
        own = False
    if not own:
        raise InputError("fecolumn motions", "-o", str(path), allowed)


def read_record(source: str, args: argparse.Namespace) -> GroundMotion:
    """One motion as recorded, with the components, unit and step that the options state.

    Raises
    ------
    InputError
        it cannot be used; names options.
    """
    from fecolumn.motions.load import read_motion

    with told_by_flags(args):
        return read_motion(stated_motion(source, args), _COMMAND)


def stated_motion(source: str, args: argparse.Namespace) -> Motion:
    """The motion that the options state; InputError as of a case's [motion]."""
    from fecolumn.case.sections import Motion

    return Motion(
        source,
        source_y=getattr(args, "source_y", ""),
        source_z=getattr(args, "source_z", ""),
        units=args.units,
        dt_s=args.dt,
    )


@contextlib.contextmanager
def told_by_flags(args: argparse.Namespace) -> Iterator[None]:
    """Refusals that name the flags of a command, not the keys of a case."""
    from fecolumn.foundation.schema import InputError

    flags = _FLAGS | {"motion.source": getattr(args, "source_name", "SOURCE")}

    def told(text: str) -> str:
        for key, flag in flags.items():
            text = text.replace(key, flag)
        return text

    def of_command(one: InputError) -> InputError:
        file = _COMMAND if one.file == "case" else one.file
        return InputError(file, told(one.key), one.value, told(one.allowed))

    try:
        yield
    except InputError as error:
        raise InputError.of_several([of_command(one) for one in error.all]) from None


def stored_ensemble(path: Path | str) -> Ensemble:
    """An ensemble in a file."""
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import read_ensemble
    from fecolumn.motions.record import UnusableRecord

    try:
        return read_ensemble(path)
    except UnusableRecord as error:
        raise InputError(path, "", None, str(error)) from None


def all_of(args: argparse.Namespace) -> list[GroundMotion]:
    """The motions of args.sources; InputError where they cannot be used."""
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.chosen import chosen_motions

    name = getattr(args, "source_name", "SOURCE")
    found = [one for source in args.sources for one in chosen_motions(source, name, _COMMAND)]
    for key in ("source_y", "source_z"):
        if len(found) > 1 and (value := getattr(args, key, "")):
            told = f"goes with one {name}, not with {len(found)} motions"
            raise InputError(_COMMAND, f"--{key.replace('_', '-')}", value, told)
    return [read_record(one, args) for one in found]
