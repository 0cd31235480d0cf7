"""`fecolumn motions scale | select`: motions that fit a target response spectrum."""

from __future__ import annotations

import argparse
import dataclasses
import functools
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fecolumn.motions.record import GroundMotion
    from fecolumn.motions.spectral_match import TargetSpectrum

from fecolumn.study.motion_files import (
    add_components,
    add_unit_and_step,
    all_of,
    ensemble_path,
    store,
)

# Beyond it, and below one over it, a factor is told
_FACTOR = 4.0


def add_match_actions(actions: Any) -> None:
    """Actions of `fecolumn motions` that fit motions to a spectrum; actions: its subparsers."""
    for name, words in (
        ("scale", "scale motions so that each fits a target response spectrum best"),
        (
            "select",
            "select from many motions those that together fit a target spectrum and its dispersion",
        ),
    ):
        parser = actions.add_parser(name, help=words)
        parser.add_argument(
            "sources",
            nargs="+",
            metavar="SET",
            help="motion, as in motion.source of a case; ensemble.h5#*, lick:*: all motions of a "
            "set",
        )
        parser.add_argument(
            "--to-spectrum",
            required=True,
            metavar="TARGET.csv",
            help="table with columns period_s, sa_g or sa_m_s2 (median, 5 %% damping) and, if "
            "the dispersion should fit as well, sigma_ln",
        )
        parser.add_argument(
            "--periods",
            type=float,
            nargs=2,
            metavar=("LOW", "HIGH"),
            help="range of periods in which the spectra should fit [s] (default: that of the "
            "target)",
        )
        parser.add_argument(
            "--most-factor",
            type=float,
            default=0.0,
            metavar="F",
            help="leave out motions whose scale factor is not between 1/F and F (default: none)",
        )
        if name == "scale":
            add_components(parser, ", with one SET")
        add_unit_and_step(parser, "a file")
        parser.set_defaults(source_name="SET")
        if name == "select":
            parser.add_argument(
                "-n",
                "--count",
                metavar="N",
                type=int,
                required=True,
                help="how many motions to select, 1 or more",
            )
            parser.add_argument(
                "--scaled",
                action="store_true",
                help="scale each motion to the target first (default: motions are not scaled)",
            )
        parser.add_argument(
            "-o",
            "--output",
            required=True,
            metavar="ENSEMBLE.h5",
            help="ensemble to write; its table and a figure of the spectra are written beside it",
        )
        parser.set_defaults(command=functools.partial(_match, name))


def _match(name: str, args: argparse.Namespace) -> int:
    import numpy as np

    from fecolumn.motions.ensemble import Ensemble
    from fecolumn.motions.processing import scale
    from fecolumn.motions.spectra import horizontal_spectrum
    from fecolumn.motions.spectral_match import misfits, scale_factors, select_motions
    from fecolumn.pictures.figures.match_figure import match_figure

    told = f"fecolumn motions {name}"
    target = _target(args, told)
    if args.most_factor and args.most_factor < 1:
        _refuse(told, "--most-factor", args.most_factor, "must be at least 1, or 0 for any")
    ensemble_path(args.output)
    motions = all_of(args)
    if name == "select" and not 1 <= args.count <= len(motions):
        _refuse(
            told, "-n", args.count, f"must be a number from 1 to {len(motions)}, as many as SET has"
        )
    spectra = np.array([horizontal_spectrum(motion, target.periods) for motion in motions])
    for motion, spectrum in zip(motions, spectra):
        if not (spectrum > 0).all():
            _refuse(told, "SET", motion.name, "is no motion: it has no horizontal acceleration")
    factors = scale_factors(spectra, target.sa)
    if name == "select" and not args.scaled:
        factors = np.ones(len(motions))
    kept = np.arange(len(motions))
    if args.most_factor:
        fits = np.maximum(factors, 1 / factors) <= args.most_factor
        kept = np.flatnonzero(fits)
        if len(kept) < (args.count if name == "select" else 1):
            _refuse(
                told,
                "--most-factor",
                args.most_factor,
                f"leaves {len(kept)} of {len(motions)} motions; the factors are "
                f"{factors.min():.3g} to {factors.max():.3g}",
            )
    scaled = spectra * factors[:, None]
    if name == "select":
        kept = kept[select_motions(scaled[kept], target, args.count)]
    found = Ensemble(
        Path(args.output).stem,
        tuple(_scaled(scale, motions[row], float(factors[row])) for row in kept),
        {"scale_factor": factors[kept], "misfit_ln": misfits(scaled[kept], target.sa)},
        {
            "model": "selected" if name == "select" else "scaled",
            "sources": list(args.sources),
            "to_spectrum": str(args.to_spectrum),
            "periods_s": [float(target.periods[0]), float(target.periods[-1])],
        },
    )
    status = store(found, args.output)
    for file in match_figure(target, scaled[kept], Path(args.output).with_suffix("")):
        print(f"wrote {file}")
    print(_summary(target, scaled[kept], factors[kept], len(motions)))
    return status


def _scaled(scale: Any, motion: GroundMotion, factor: float) -> GroundMotion:
    found: GroundMotion = motion if factor == 1 else scale(motion, factor)
    return dataclasses.replace(found, name=motion.name)


def _target(args: argparse.Namespace, told: str) -> TargetSpectrum:
    from fecolumn.motions.spectral_match import read_target_spectrum

    target = read_target_spectrum(args.to_spectrum)
    low, high = args.periods or (target.periods[0], target.periods[-1])
    first, last = float(target.periods[0]), float(target.periods[-1])
    if not first <= low < high <= last:
        _refuse(
            told,
            "--periods",
            [low, high],
            f"must be two rising periods within those of the target, {first:g} to {last:g} s",
        )
    return target.within(low, high)


def _summary(
    target: TargetSpectrum, spectra: NDArray[Any], factors: NDArray[Any], count: int
) -> str:
    """What fits how well, in a sentence."""
    import numpy as np

    logs = np.log(spectra)
    off = np.exp(np.abs(logs.mean(axis=0) - np.log(target.sa)).max()) - 1
    text = (
        f"{len(spectra)} of {count} motions: their mean is within {100 * off:.3g} % of the target "
        f"from {target.periods[0]:g} to {target.periods[-1]:g} s"
    )
    if len(spectra) > 1:
        spread = logs.std(axis=0, ddof=1)
        text += f", sigma of ln Sa {spread.min():.2g} to {spread.max():.2g}"
        if target.sigma is not None:
            text += f" (target {target.sigma.min():.2g} to {target.sigma.max():.2g})"
    text += f"; factors {factors.min():.3g} to {factors.max():.3g}"
    if max(factors.max(), 1 / factors.min()) > _FACTOR:
        text += (
            f"\nwarning: factors beyond {_FACTOR:g} make motions of another earthquake: "
            "--most-factor leaves them out"
        )
    return text


def _refuse(told: str, key: str, value: Any, allowed: str) -> None:
    from fecolumn.foundation.schema import InputError

    raise InputError(told, key, value, allowed)
