"""`fecolumn motions`: make, fit, look at and convert ensembles of ground motions."""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fecolumn.motions import lick, makers
from fecolumn.study.match_command import add_match_actions

if TYPE_CHECKING:
    from fecolumn.motions.ensemble import Ensemble
    from fecolumn.motions.record import GroundMotion
    from fecolumn.motions.seeded import Components
    from fecolumn.motions.target import Target

_LICK = "lick"
# As `load.FORMATS`, which it would take long to import
_FORMATS = (
    "PEER AT2, ESM ASC, columns of text (CSV, tabs, spaces; decimal comma or point); with the "
    "extra records K-NET, KiK-net, SAC, miniSEED, GSE2"
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn motions`."""
    actions = parser.add_subparsers(required=True, metavar="ACTION")
    make = actions.add_parser("make", help="make an ensemble: one HDF5 file and its summary table")
    kinds = make.add_subparsers(required=True, metavar="KIND")

    seeded = kinds.add_parser(
        "seeded", help="stochastic motions of a fitted model; the Lick ensemble by default"
    )
    seeded.add_argument(
        "model",
        nargs="?",
        default=_LICK,
        metavar="MODEL.toml",
        help="parameter file of `motions fit`, or lick (default)",
    )
    _add_output(seeded)
    seeded.add_argument(
        "-n", type=int, default=lick.COUNT, help="number of motions (default: %(default)s)"
    )
    seeded.add_argument(
        "--seed", type=int, default=lick.SEED, help="of the random numbers (default: %(default)s)"
    )
    seeded.add_argument(
        "--variability",
        choices=("fixed", "drawn"),
        default="fixed",
        help="one set of parameters for all motions, or drawn after Dabaghi and Der "
        "Kiureghian (default: %(default)s)",
    )
    seeded.add_argument(
        "--time-scale",
        type=float,
        default=lick.TIME_SCALE,
        help="factor on time, accelerations kept; 0.5 fits a specimen of a quarter of the "
        "size (default: %(default)s)",
    )
    seeded.set_defaults(command=_make_seeded)
    makers.add_kinds(kinds, _add_output, store)

    fit = actions.add_parser(
        "fit",
        help="fit the stochastic model to a record of two components, or to a table of "
        "target figures",
    )
    fit.add_argument(
        "source",
        metavar="RECORD",
        help="record as in motion.source of a case, TARGET.toml, or lick",
    )
    fit.add_argument(
        "--source-y",
        default="",
        metavar="FILE",
        help="file of the y component, for formats of one component a file",
    )
    fit.add_argument(
        "--units",
        default="",
        help="unit of the accelerations where the file does not state it: g, m/s2, cm/s2 or mm/s2",
    )
    fit.add_argument(
        "--dt", type=float, default=0.0, help="sampling step [s] where the file does not state it"
    )
    fit.add_argument(
        "-n", type=int, default=800, help="size of the ensemble fitted on (default: %(default)s)"
    )
    fit.add_argument(
        "--iterations", type=int, default=14, help="steps of the fit (default: %(default)s)"
    )
    fit.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="MODEL.toml",
        help="parameter file for `motions make seeded`",
    )
    fit.set_defaults(command=_fit)

    info = actions.add_parser(
        "info",
        help="what a file or an ensemble is: format, unit, peaks, and what is odd; medians, spread",
        epilog=f"Files that are read: {_FORMATS}.",
    )
    info.add_argument(
        "ensemble", metavar="FILE", help="ENSEMBLE.h5, or a motion as in motion.source of a case"
    )
    _add_unit_and_step(info)
    info.set_defaults(command=_info)

    correct = actions.add_parser(
        "correct", help="take the drift out of a record: baseline and band-pass, with a picture"
    )
    correct.add_argument("source", metavar="SOURCE", help="as in motion.source of a case")
    correct.add_argument(
        "--source-y", default="", metavar="FILE", help="file of the y component, if any"
    )
    _add_unit_and_step(correct)
    correct.add_argument(
        "--high-pass",
        type=float,
        default=0.1,
        metavar="HZ",
        help="corner below which it is taken out, 0 for none (default: %(default)s)",
    )
    correct.add_argument(
        "--low-pass",
        type=float,
        default=0.0,
        metavar="HZ",
        help="corner above which it is taken out, 0 for none (default: %(default)s)",
    )
    correct.add_argument(
        "--order", type=int, default=4, help="of the filter, run twice (default: %(default)s)"
    )
    correct.add_argument(
        "--degree",
        type=int,
        default=1,
        help="of the polynomial taken off first, -1 for none (default: %(default)s)",
    )
    correct.add_argument(
        "-o", "--output", required=True, metavar="DIR", help="folder of the motion and the picture"
    )
    correct.set_defaults(command=_correct)

    add_match_actions(actions, _all_of, store)

    plot = actions.add_parser(
        "plot",
        help="figures of an ensemble: three motions, spectra, distributions, rocking spectra",
    )
    plot.add_argument("ensemble", metavar="ENSEMBLE.h5")
    plot.add_argument(
        "-o", "--output", required=True, metavar="DIR", help="folder of the figures, PNG and PDF"
    )
    plot.add_argument(
        "--show",
        type=int,
        nargs="+",
        metavar="NUMBER",
        help="motions to show, counted from 1 (default: small, median and large PGV)",
    )
    plot.add_argument(
        "--slenderness",
        type=float,
        default=0.1,
        metavar="ALPHA",
        help="of the blocks of the rocking spectra, tan alpha = width/height [rad] "
        "(default: %(default)s)",
    )
    plot.set_defaults(command=_plot)

    convert = actions.add_parser(
        "convert", help="any motions into an ensemble (.h5), or into text files in a folder"
    )
    convert.add_argument(
        "sources",
        nargs="+",
        metavar="SOURCE",
        help="as in motion.source of a case; ensemble.h5#* are all of its motions",
    )
    convert.add_argument(
        "--units",
        default="",
        help="unit of the accelerations where a file does not state it: g, m/s2, cm/s2 or mm/s2",
    )
    convert.add_argument(
        "--dt", type=float, default=0.0, help="sampling step [s] where a file does not state it"
    )
    convert.add_argument(
        "--format",
        choices=("csv", "at2"),
        default="csv",
        help="of the text files (default: %(default)s)",
    )
    convert.add_argument("-o", "--output", required=True, metavar="ENSEMBLE.h5|DIR")
    convert.set_defaults(command=_convert)


def _add_unit_and_step(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--units",
        default="",
        help="unit of the accelerations where the file does not state it: g, m/s2, cm/s2 or mm/s2",
    )
    parser.add_argument(
        "--dt", type=float, default=0.0, help="sampling step [s] where the file does not state it"
    )


def _add_output(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="ENSEMBLE.h5",
        help="its table stands beside it, ENSEMBLE.csv",
    )


def store(ensemble: Ensemble, output: Path | str) -> int:
    """Write an ensemble and its table, and say what it is."""
    from fecolumn.motions.ensemble_file import summary, write_ensemble, write_summary
    from fecolumn.motions.ensemble_report import report

    path = _ensemble_path(output)
    columns = summary(ensemble)
    write_ensemble(ensemble, path)
    write_summary(ensemble, columns, path.with_suffix(".csv"))
    print(report(ensemble, columns))
    print(f"wrote {path}\nwrote {path.with_suffix('.csv')}")
    return 0


def _ensemble_path(output: Path | str) -> Path:
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import TABLE_HEAD, is_ensemble

    path = Path(output)
    if path.suffix not in (".h5", ".hdf5"):
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
    _refuse_foreign(
        table,
        TABLE_HEAD,
        "is there and no table of an ensemble; move it away or give the ensemble another name",
    )
    return path


def _refuse_foreign(path: Path, head: str, allowed: str) -> None:
    """Refuse to write over a file that does not begin as ours do."""
    from fecolumn.foundation.files import Unreadable, read_bytes
    from fecolumn.foundation.schema import InputError

    try:
        own = not os.path.lexists(path) or read_bytes(path).startswith(head.encode())
    except Unreadable:
        own = False
    if not own:
        raise InputError("fecolumn motions", "-o", str(path), allowed)


def _make_seeded(args: argparse.Namespace) -> int:
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.seeded import LICK, read_model, seeded_ensemble

    for key, value, low in (("-n", args.n, 1), ("--seed", args.seed, 0)):
        if value < low:
            raise InputError("fecolumn motions make", key, value, f"must be at least {low}")
    if not 0 < args.time_scale <= 1000:
        raise InputError(
            "fecolumn motions make",
            "--time-scale",
            args.time_scale,
            "must be greater than 0 and at most 1000",
        )
    _ensemble_path(args.output)
    model = read_model(LICK if args.model == _LICK else args.model)
    return store(
        seeded_ensemble(model, args.n, args.seed, args.variability, args.time_scale), args.output
    )


def _fit(args: argparse.Namespace) -> int:
    import dataclasses

    from fecolumn.foundation.schema import InputError
    from fecolumn.foundation.version import __version__
    from fecolumn.motions.fit import components_of_record, fit
    from fecolumn.motions.seeded import MODEL_HEAD, write_model
    from fecolumn.motions.target import target_of_record

    for key, value, low in (("-n", args.n, 20), ("--iterations", args.iterations, 1)):
        if value < low:
            raise InputError("fecolumn motions fit", key, value, f"must be at least {low}")
    if args.source == _LICK or args.source.endswith(".toml"):
        target, components = _read_target(args.source)
    else:
        motion = _read(args.source, args, source_y=args.source_y)
        if not motion.acceleration[:, :2].any(axis=0).all():
            raise InputError(
                "fecolumn motions fit",
                "RECORD",
                args.source,
                "must have two horizontal components (--source-y names a file of the second)",
            )
        motion, components = components_of_record(motion)
        target = target_of_record(motion)
    Path(args.output).parent.mkdir(parents=True, exist_ok=True)
    _refuse_foreign(
        Path(args.output),
        MODEL_HEAD,
        "is there and no model of motions fit; move it away or give another name",
    )
    model = fit(
        target, components, args.n, args.iterations, report=lambda line: print(line, flush=True)
    )
    made_by = (
        f"fecolumn motions fit {args.source} -n {args.n} --iterations {args.iterations}, "
        f"version {__version__}"
    )
    write_model(dataclasses.replace(model, made_by=made_by), args.output)
    print(f"wrote {args.output}")
    return 0


def _read_target(source: str) -> tuple[Target, Components]:
    from fecolumn.foundation.schema import InputError, build
    from fecolumn.foundation.toml_file import read_toml
    from fecolumn.motions.seeded import FOLDER, Components, check_components, check_target
    from fecolumn.motions.target import Target

    path = FOLDER / "lick_target.toml" if source == _LICK else source
    tables = read_toml(path)
    for name in ("target", "components"):
        if not isinstance(tables.get(name), dict):
            raise InputError(
                path,
                name,
                tables.get(name),
                "missing; a table of target figures has [target] and [components]",
            )
    target, components = (
        build(Target, tables["target"], path, "target."),
        build(Components, tables["components"], path, "components."),
    )
    check_target(target, path)
    check_components(components, path)
    return target, components


def _read(source: str, args: argparse.Namespace, **keys: Any) -> GroundMotion:
    """One motion as recorded."""
    from fecolumn.case.sections import Motion
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.load import read_motion
    from fecolumn.motions.record import METRES_PER_S2

    if args.units and args.units not in METRES_PER_S2:
        raise InputError(
            "fecolumn motions", "--units", args.units, f"must be one of {', '.join(METRES_PER_S2)}"
        )
    if not 0 <= args.dt <= 100:
        raise InputError("fecolumn motions", "--dt", args.dt, "must lie in [0, 100] s")
    motion = Motion(source, units=args.units, dt_s=args.dt, **keys)
    with _told_by_flags():
        return read_motion(motion, "fecolumn motions")


# Flags of the commands for the keys of a case
_FLAGS = {
    "motion.units": "--units",
    "motion.dt_s": "--dt",
    "motion.source_y": "--source-y",
    "motion.source": "SOURCE",
}


@contextlib.contextmanager
def _told_by_flags() -> Iterator[None]:
    """Refusals that name the flags of a command, not the keys of a case."""
    from fecolumn.foundation.schema import InputError

    def told(text: str) -> str:
        for key, flag in _FLAGS.items():
            text = text.replace(key, flag)
        return text

    try:
        yield
    except InputError as error:
        raise InputError(error.file, told(error.key), error.value, told(error.allowed)) from None


def _stored(path: Path | str) -> Ensemble:
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import read_ensemble
    from fecolumn.motions.record import UnusableRecord

    try:
        return read_ensemble(path)
    except UnusableRecord as error:
        raise InputError(path, "", None, str(error)) from None


def _info(args: argparse.Namespace) -> int:
    from fecolumn.motions.ensemble_file import summary
    from fecolumn.motions.ensemble_report import report

    if Path(args.ensemble).suffix not in (".h5", ".hdf5"):
        return _info_of_motion(args)
    ensemble = _stored(args.ensemble)
    print(report(ensemble, summary(ensemble)))
    return 0


def _info_of_motion(args: argparse.Namespace) -> int:
    from fecolumn.case.sections import Motion
    from fecolumn.motions.inspection import file_lines, oddities, peak_lines, peaks_by_unit
    from fecolumn.motions.load import recording_of

    with _told_by_flags():
        motion = Motion(args.ensemble, dt_s=args.dt)
        recording = recording_of(motion, "source", "fecolumn motions info")
    print("\n".join(file_lines(recording, recording.dt or args.dt)))
    if not (recording.dt or args.dt):
        print("its step is not stated: --dt says it")
    elif not (recording.units or args.units):
        print(peaks_by_unit(recording))
        print("--units says it, and motion.units in a case")
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # told below
            ground = _read(args.ensemble, args)
        print("\n".join(peak_lines(ground)))
        for odd in oddities(ground):
            print(f"warning: {odd}")
    return 0


def _correct(args: argparse.Namespace) -> int:
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.correction import corrected, end_of
    from fecolumn.motions.export import write_text_files
    from fecolumn.pictures.figures.correction_figure import correction_figure

    for key, value, low, high in (
        ("--high-pass", args.high_pass, 0, 1e4),
        ("--low-pass", args.low_pass, 0, 1e5),
        ("--order", args.order, 1, 10),
        ("--degree", args.degree, -1, 10),
    ):
        if not low <= value <= high:
            raise InputError(
                "fecolumn motions correct", key, value, f"must lie in [{low:g}, {high:g}]"
            )
    before = _read(args.source, args, source_y=args.source_y)
    try:
        after = corrected(before, args.high_pass, args.low_pass, args.order, args.degree)
    except ValueError as error:
        raise InputError("fecolumn motions correct", "SOURCE", args.source, str(error)) from None
    with written(args.output, "motions correct") as draft:
        files = [*write_text_files([after], draft, "csv")]
        files += correction_figure(before, after, draft)
    for name, one in (("before", before), ("after", after)):
        speed, way = end_of(one)
        print(f"{name}: ends at {100 * speed:.3g} cm/s and {100 * way:.3g} cm")
    for file in files:
        print(f"wrote {Path(args.output) / file.name}")
    return 0


def _plot(args: argparse.Namespace) -> int:
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import summary
    from fecolumn.pictures.figures.motion_figures import motion_figures

    if not 0 < args.slenderness < math.pi / 2:
        raise InputError(
            "fecolumn motions plot",
            "--slenderness",
            args.slenderness,
            "must lie between 0 and pi/2 rad",
        )
    ensemble = _stored(args.ensemble)
    for number in args.show or ():
        if not 1 <= number <= len(ensemble.motions):
            raise InputError(
                args.ensemble,
                "--show",
                number,
                f"must be a number from 1 to {len(ensemble.motions)}",
            )
    with written(args.output, "motions plot") as draft:
        files = motion_figures(ensemble, summary(ensemble), draft, args.show, args.slenderness)
    for file in files:
        print(f"wrote {Path(args.output) / file.name}")
    return 0


def _all_of(args: argparse.Namespace) -> list[GroundMotion]:
    """The motions of args.sources, where their ensemble is to be written in args.output."""
    from fecolumn.motions.chosen import chosen_motions

    if args.command is not _convert or Path(args.output).suffix in (".h5", ".hdf5"):
        _ensemble_path(args.output)
    return [
        _read(one, args)
        for source in args.sources
        for one in chosen_motions(source, "SOURCE", "fecolumn motions")
    ]


def _convert(args: argparse.Namespace) -> int:
    from fecolumn.foundation.folder import written
    from fecolumn.motions.ensemble import Ensemble
    from fecolumn.motions.export import write_text_files

    motions = _all_of(args)
    if Path(args.output).suffix in (".h5", ".hdf5"):
        return store(
            Ensemble(
                Path(args.output).stem,
                tuple(motions),
                {},
                {"model": "collected", "sources": args.sources},
            ),
            args.output,
        )
    with written(args.output, "motions convert") as draft:
        files = write_text_files(motions, draft, args.format)
    for file in files:
        print(f"wrote {Path(args.output) / file.name}")
    return 0
