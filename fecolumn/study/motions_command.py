"""`fecolumn motions`: make, fit, look at and convert ensembles of ground motions."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fecolumn.motions import lick, makers
from fecolumn.study.match_command import add_match_actions
from fecolumn.study.motion_files import (
    add_components,
    add_output,
    add_unit_and_step,
    ensemble_path,
    read_record,
    refuse_foreign,
    store,
)
from fecolumn.study.motion_look_command import add_look_actions

if TYPE_CHECKING:
    from fecolumn.motions.seeded import Components
    from fecolumn.motions.target import Target

_LICK = "lick"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn motions`."""
    actions = parser.add_subparsers(required=True, metavar="ACTION")
    make = actions.add_parser("make", help="make an ensemble: one HDF5 file and its summary table")
    kinds = make.add_subparsers(required=True, metavar="KIND")

    seeded = kinds.add_parser(
        "seeded", help="stochastic motions of a fitted model (default: the Lick ensemble)"
    )
    seeded.add_argument(
        "model",
        nargs="?",
        default=_LICK,
        metavar="MODEL.toml",
        help="parameter file of `motions fit`, or lick (default)",
    )
    add_output(seeded)
    seeded.add_argument(
        "-n",
        "--count",
        metavar="N",
        type=int,
        default=lick.COUNT,
        help="number of motions (default: %(default)s)",
    )
    seeded.add_argument(
        "--seed",
        type=int,
        default=lick.SEED,
        help="seed of the random numbers (default: %(default)s)",
    )
    seeded.add_argument(
        "--variability",
        choices=("fixed", "drawn"),
        default="fixed",
        help="fixed: one set of parameters for all motions; drawn: parameters drawn for each "
        "motion after Dabaghi and Der Kiureghian (default: %(default)s)",
    )
    seeded.add_argument(
        "--time-scale",
        type=float,
        default=lick.TIME_SCALE,
        help="factor on time, with accelerations unchanged; 0.5 is right for a specimen of a "
        "quarter of the size (default: %(default)s)",
    )
    seeded.set_defaults(command=_make_seeded)
    makers.add_kinds(kinds, add_output, store)

    fit = actions.add_parser(
        "fit",
        help="fit the stochastic model to a record of two components, or to a table of "
        "target figures",
    )
    fit.add_argument(
        "source",
        metavar="RECORD",
        help="record, as in motion.source of a case; or a table of target figures, TARGET.toml; "
        "or lick",
    )
    add_components(fit)
    add_unit_and_step(fit)
    fit.set_defaults(source_name="RECORD")
    fit.add_argument(
        "-n",
        "--count",
        metavar="N",
        type=int,
        default=800,
        help="number of motions in the ensemble used for the fit (default: %(default)s)",
    )
    fit.add_argument(
        "--iterations",
        type=int,
        default=14,
        help="number of iterations of the fit (default: %(default)s)",
    )
    fit.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="MODEL.toml",
        help="parameter file for `motions make seeded`",
    )
    fit.set_defaults(command=_fit)

    add_look_actions(actions)
    add_match_actions(actions)


def _make_seeded(args: argparse.Namespace) -> int:
    from fecolumn.foundation.schema import InputError
    from fecolumn.motions.seeded import LICK, read_model, seeded_ensemble

    for key, value, low in (("-n", args.count, 1), ("--seed", args.seed, 0)):
        if value < low:
            raise InputError("fecolumn motions make", key, value, f"must be at least {low}")
    if not 0 < args.time_scale <= 1000:
        raise InputError(
            "fecolumn motions make",
            "--time-scale",
            args.time_scale,
            "must be greater than 0 and at most 1000",
        )
    ensemble_path(args.output)
    model = read_model(LICK if args.model == _LICK else args.model)
    return store(
        seeded_ensemble(model, args.count, args.seed, args.variability, args.time_scale),
        args.output,
    )


def _fit(args: argparse.Namespace) -> int:
    import dataclasses

    from fecolumn.foundation.schema import InputError
    from fecolumn.foundation.version import __version__
    from fecolumn.motions.fit import components_of_record, fit
    from fecolumn.motions.seeded import MODEL_HEAD, write_model
    from fecolumn.motions.target import target_of_record

    for key, value, low in (("-n", args.count, 20), ("--iterations", args.iterations, 1)):
        if value < low:
            raise InputError("fecolumn motions fit", key, value, f"must be at least {low}")
    if args.source == _LICK or args.source.endswith(".toml"):
        target, components = _read_target(args.source)
    else:
        motion = read_record(args.source, args)
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
    refuse_foreign(
        Path(args.output),
        MODEL_HEAD,
        "is there and no model of motions fit; move it away or give another name",
    )
    model = fit(
        target, components, args.count, args.iterations, report=lambda line: print(line, flush=True)
    )
    made_by = (
        f"fecolumn motions fit {args.source} -n {args.count} --iterations {args.iterations}, "
        f"version {__version__}"
    )
    write_model(dataclasses.replace(model, made_by=made_by), args.output)
    print(f"wrote {args.output}")
    return 0


def _read_target(source: str) -> tuple[Target, Components]:
    from fecolumn.foundation.schema import InputError, build
    from fecolumn.foundation.toml_file import read_toml
    from fecolumn.motions.seeded import TARGETS_FOLDER, Components, check_components, check_target
    from fecolumn.motions.target import Target

    path = TARGETS_FOLDER / "lick_target.toml" if source == _LICK else source
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
