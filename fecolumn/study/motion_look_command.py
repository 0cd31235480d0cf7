"""`fecolumn motions info | correct | plot | convert`."""

from __future__ import annotations

import argparse
import math
import warnings
from pathlib import Path
from typing import Any

from fecolumn.motions.formats import FORMATS
from fecolumn.study.motion_files import (
    add_components,
    add_unit_and_step,
    all_of,
    ensemble_path,
    read_record,
    stated_motion,
    store,
    stored_ensemble,
    told_by_flags,
)


def add_look_actions(actions: Any) -> None:
    """Actions of `fecolumn motions` that look at motions and convert them."""
    info = actions.add_parser(
        "info",
        help="describe a file (format, unit, peaks, and what looks wrong) or an ensemble "
        "(medians, spread)",
        epilog=f"Files that are read: {FORMATS}.",
    )
    info.add_argument(
        "ensemble", metavar="FILE", help="ENSEMBLE.h5, or a motion as in motion.source of a case"
    )
    add_components(info)
    add_unit_and_step(info)
    info.set_defaults(source_name="FILE")
    info.set_defaults(command=_info)

    correct = actions.add_parser(
        "correct",
        help="remove the drift of a record: baseline correction and band-pass filter, "
        "with a picture",
    )
    correct.add_argument("source", metavar="SOURCE", help="record, as in motion.source of a case")
    add_components(correct)
    add_unit_and_step(correct)
    correct.add_argument(
        "--high-pass",
        type=float,
        default=0.1,
        metavar="HZ",
        help="corner frequency of the high-pass filter, 0: none (default: %(default)s)",
    )
    correct.add_argument(
        "--low-pass",
        type=float,
        default=0.0,
        metavar="HZ",
        help="corner frequency of the low-pass filter, 0: none (default: %(default)s)",
    )
    correct.add_argument(
        "--order",
        type=int,
        default=4,
        help="order of the filter, which is run forwards and backwards (default: %(default)s)",
    )
    correct.add_argument(
        "--degree",
        type=int,
        default=1,
        help="degree of the polynomial that is subtracted first, -1: none (default: %(default)s)",
    )
    correct.add_argument(
        "-o", "--output", required=True, metavar="DIR", help="folder of the motion and the picture"
    )
    correct.set_defaults(command=_correct)

    plot = actions.add_parser(
        "plot",
        help="draw figures of an ensemble: three motions, spectra, distributions, rocking spectra",
    )
    plot.add_argument(
        "ensemble",
        metavar="ENSEMBLE.h5",
        help="ensemble written by motions make, convert, scale or select",
    )
    plot.add_argument(
        "-o", "--output", required=True, metavar="DIR", help="folder of the figures, PNG and PDF"
    )
    plot.add_argument(
        "--show",
        type=int,
        nargs="+",
        metavar="NUMBER",
        help="numbers of motions to show, counted from 1 (default: those of small, median and "
        "large PGV)",
    )
    plot.add_argument(
        "--slenderness",
        type=float,
        default=0.1,
        metavar="ALPHA",
        help="slenderness alpha of the blocks of the rocking spectra, tan alpha = width/height "
        "[rad] (default: %(default)s)",
    )
    plot.set_defaults(command=_plot)

    convert = actions.add_parser(
        "convert", help="write any motions as an ensemble (.h5), or as text files in a folder"
    )
    convert.add_argument(
        "sources",
        nargs="+",
        metavar="SOURCE",
        help="motion, as in motion.source of a case; ensemble.h5#*: all motions of the ensemble",
    )
    add_components(convert, ", with one SOURCE")
    add_unit_and_step(convert, "a file")
    convert.add_argument(
        "--format",
        choices=("csv", "at2"),
        default="csv",
        help="format of the text files (default: %(default)s)",
    )
    convert.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="ENSEMBLE.h5|DIR",
        help="ensemble to write, if the name ends in .h5; otherwise a folder, with one text file "
        "for each motion",
    )
    convert.set_defaults(command=_convert)


def _info(args: argparse.Namespace) -> int:
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.ensemble_file import is_foreign_hdf5, is_hdf5_name, summary
    from fecolumn.motions.ensemble_report import report

    if not is_hdf5_name(args.ensemble) or is_foreign_hdf5(args.ensemble):
        return _info_of_motion(args)
    for key, value in (("--source-y", args.source_y), ("--source-z", args.source_z)):
        if value:
            told = f"goes with a file of one component; {args.ensemble} is an ensemble"
            raise InputError("fecolumn motions", key, value, told)
    ensemble = stored_ensemble(args.ensemble)
    print(report(ensemble, summary(ensemble)))
    return 0


def _info_of_motion(args: argparse.Namespace) -> int:
    from fecolumn.motions.inspection import file_lines, oddities, peak_lines, peaks_by_unit
    from fecolumn.motions.load import recording_of

    with told_by_flags(args):
        motion = stated_motion(args.ensemble, args)
        keys = [key for key in ("source", "source_y", "source_z") if getattr(motion, key)]
        recordings = [recording_of(motion, key, "fecolumn motions info") for key in keys]
    for one in recordings:
        print("\n".join(file_lines(one, one.dt or args.dt, args.units)))
    no_step = any(not (one.dt or args.dt) for one in recordings)
    no_unit = [one for one in recordings if not (one.units or args.units)]
    if no_step:
        print("its step is not stated: --dt says it")
    elif no_unit:
        for one in no_unit:
            print(peaks_by_unit(one))
        print("--units says it, and motion.units in a case")
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # told below
            ground = read_record(args.ensemble, args)
        print("\n".join(peak_lines(ground)))
        for odd in oddities(ground):
            print(f"warning: {odd}")
    return 0


def _correct(args: argparse.Namespace) -> int:
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.correction import WrongCorner, corrected, end_of
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
    before = read_record(args.source, args)
    try:
        after = corrected(before, args.high_pass, args.low_pass, args.order, args.degree)
    except WrongCorner as error:
        key = f"--{error.key.replace('_', '-')}"
        raise InputError(
            "fecolumn motions correct", key, error.value, f"{error.allowed} of {args.source}"
        ) from None
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
    ensemble = stored_ensemble(args.ensemble)
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


def _convert(args: argparse.Namespace) -> int:
    from fecolumn.foundation.folder import written
    from fecolumn.motions.ensemble import Ensemble
    from fecolumn.motions.ensemble_file import is_hdf5_name
    from fecolumn.motions.export import write_text_files

    whole = is_hdf5_name(args.output)
    if whole:
        ensemble_path(args.output)
    motions = all_of(args)
    if whole:
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
