"""`fecolumn rocking`: a rocking model in one motion or an ensemble, or the pulses that overturn a
block.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fecolumn.case.model_names import TABLES

if TYPE_CHECKING:
    from fecolumn.engines.rocking.case import ModelCase
    from fecolumn.engines.rocking.model import ModelResponse
    from fecolumn.engines.rocking.overturning import Band
    from fecolumn.motions.record import GroundMotion

_SPECTRUM = "spectrum"
_MEASURES = ("pga_m_s2", "pgv_m_s", "pgd_m")  # of motions.intensity.peak_values


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn rocking`."""
    parser.add_argument(
        "model",
        nargs="?",
        choices=(*TABLES.values(), _SPECTRUM),
        metavar="MODEL",
        help=f"{', '.join(TABLES.values())}; or {_SPECTRUM}: which pulses "
        "overturn the [block] of CASE (default: the model of the case's own table, or of its "
        "integration.engine)",
    )
    parser.add_argument(
        "case",
        metavar="CASE.toml",
        help="file with the model's table, such as [block] or [frame], and [motion]; or a case "
        'of fecolumn run. With motion.source = "ensemble.h5#*" or "lick:1-40" the model '
        "runs in an ensemble",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        required=True,
        help="folder for tables, histories and figures",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")


def main(args: argparse.Namespace) -> int:
    """Run the model; returns 0.

    Raises
    ------
    InputError
        the case cannot be used.
    """
    from fecolumn.foundation.folder import written

    args.model = args.model or _model_of(args.case)
    with written(args.output, "rocking", names=("parameters.csv",)) as draft:
        if args.model == _SPECTRUM:
            _spectrum(args, draft)
        else:
            _run(args, draft)
    print(f"wrote {args.output}")
    return 0


def _model_of(file: str) -> str:
    """The model that a case names, by a table of its own or by its engine.

    Raises
    ------
    InputError
        it names none, or several.
    """
    from fecolumn.case.model_names import model_engine_of
    from fecolumn.case.sections import MODEL_ENGINES
    from fecolumn.foundation.schema import InputError
    from fecolumn.foundation.toml_file import read_toml

    tables = read_toml(file)
    plan = tables.get("integration")
    engine = plan.get("engine") if isinstance(plan, dict) else None
    found = model_engine_of(tables, file) or engine
    if found in MODEL_ENGINES:
        return str(found)
    raise InputError(
        "fecolumn rocking",
        "MODEL",
        None,
        f"must be one of {', '.join((*TABLES.values(), _SPECTRUM))}: {file} has no table of a "
        "model and no such integration.engine",
    )


def _spectrum(args: argparse.Namespace, folder: Path) -> None:
    from fecolumn.engines.rocking.block import RockingBlock
    from fecolumn.engines.rocking.case import read_model_case
    from fecolumn.engines.rocking.spectra_table import FREQUENCIES, PULSE_SHAPES, spectra_table
    from fecolumn.engines.rocking.swing_equations import FASTEST
    from fecolumn.foundation.atomic import write_csv
    from fecolumn.foundation.schema import InputError
    from fecolumn.pictures.figures.overturning_figure import overturning_figure, slenderness_figure

    case = read_model_case("housner", args.case)
    assert isinstance(case.model, RockingBlock)  # what "housner" names
    plane = case.model.planes[0]
    if (
        plane.row[FASTEST] ** 2 > plane.p2[0] * (1 + 1e-12)
        or plane.only
        or plane.alpha[0] != plane.alpha[1]
    ):
        raise InputError(
            args.case,
            "block",
            None,
            "must be a free symmetric block that leans to both sides: spectra are of such blocks",
        )
    _parameters(case, folder)

    def show(text: str) -> None:
        if not args.quiet:
            print(text, file=sys.stderr, flush=True)

    show(
        f"{len(PULSE_SHAPES)} pulses at {len(FREQUENCIES)} frequencies, "
        "amplitudes up to 14 g tan(alpha)"
    )
    rows = spectra_table(plane.alpha[0], plane.restitution[0], show=show)
    write_csv(
        folder / "overturning.csv",
        [
            [
                "pulse",
                "omega_p_over_p",
                "a_p_over_g_tan_alpha_low",
                "a_p_over_g_tan_alpha_high",
                "impacts_before_overturning",
            ],
            *(
                [shape, f"{frequency:g}", f"{band.low:.6g}", f"{band.high:.6g}", band.impacts]
                for shape, frequency, band in rows
            ),
        ],
    )
    overturning_figure(rows, plane.alpha[0], folder / "overturning")
    slenderness_figure(folder / "slenderness")
    lowest: dict[tuple[str, float], Band] = {}
    for shape, frequency, band in rows:
        lowest.setdefault((shape, frequency), band)
    p = plane.p2[0] ** 0.5
    print(
        f"{'pulse':<22}{'w_p/p':>7}{'T_p [s]':>9}{'a_p/(g tan alpha)':>19}{'a_p [g]':>9} "
        " impacts before overturning"
    )
    for (shape, frequency), band in lowest.items():
        if frequency in (1.0, 2.0, 4.0, 6.0, 8.0):
            print(
                f"{shape:<22}{frequency:>7g}{2 * math.pi / (frequency * p):>9.3g}"
                f"{band.low:>19.4f}{band.low * math.tan(plane.alpha[0]):>9.3g}  {band.impacts}"
            )


def _parameters(case: ModelCase, folder: Path) -> None:
    from fecolumn.foundation.atomic import write_csv

    found = case.model.describe()
    for name, (value, unit) in found.items():
        print(f"{name:<46}{value:>12.5g}{'' if unit == '-' else ' ' + unit}")
    write_csv(
        folder / "parameters.csv",
        [
            ["parameter", "value", "unit"],
            *([name, f"{value:.8g}", unit] for name, (value, unit) in found.items()),
        ],
    )


def _run(args: argparse.Namespace, folder: Path) -> None:
    import time

    from fecolumn.engines.rocking.case import read_model_case
    from fecolumn.foundation.atomic import write_csv
    from fecolumn.foundation.progress import CountProgress
    from fecolumn.pictures.figures.model_figures import ensemble_figure, response_figure

    case = read_model_case(args.model, args.case)
    _parameters(case, folder)
    responses, notes, progress = (
        [],
        [],
        CountProgress(len(case.sources), "motions", quiet=args.quiet or len(case.sources) < 2),
    )
    # compiles what is missing on this machine
    case.model.respond(case.response(case.sources[0] if case.sources else None)[0])
    began = time.process_time()
    for number, source in enumerate(case.sources or (None,), 1):
        motion, response = case.response(source)
        responses.append((motion, response))
        notes += [f"{motion.name}: {note}" for note in response.notes]
        progress.show(number)
    progress.end()
    spent = (time.process_time() - began) / len(responses)
    _table(responses, case.model.energy_to_overturn, folder, spent)
    for note in notes[:5]:
        print(f"fecolumn: warning: {note}", file=sys.stderr)
    if len(notes) > 5:
        print(f"fecolumn: warning: so do {len(notes) - 5} more, see responses.csv", file=sys.stderr)
    if len(responses) == 1:
        motion, response = responses[0]
        names = [f"{name} [{response.units[name]}]" for name in response.coordinates]
        columns = [
            response.time,
            *response.coordinates.values(),
            *response.u_top.T,
            response.tilt,
            *response.energy.values(),
        ]
        write_csv(
            folder / "history.csv",
            [
                [
                    "time [s]",
                    *names,
                    "u_x [m]",
                    "u_y [m]",
                    "u_z [m]",
                    "tilt [rad]",
                    *(f"{name} [J]" for name in response.energy),
                ],
                *([f"{value:.9g}" for value in row] for row in zip(*columns)),
            ],
        )
        response_figure(motion, response, case.model, folder / "history", case.title)
    else:
        ensemble_figure(responses, args.model, folder / "cdf")


def _table(
    responses: list[tuple[GroundMotion, ModelResponse]],
    energy_to_overturn: float,
    folder: Path,
    spent: float,
) -> None:
    import numpy as np

    from fecolumn.foundation.atomic import write_csv
    from fecolumn.motions.intensity import peak_values
    from fecolumn.statistics.ecdf import percentile, proportion_interval

    peaks = list(dict.fromkeys(name for _, response in responses for name in response.peaks))
    lines: list[list[Any]] = [
        [
            "motion",
            "outcome",
            "u_max_m",
            "u_max_censored",
            "tilt_max_rad",
            "impacts",
            "duration_s",
            "overturned",
            *_MEASURES,
            *peaks,
            "notes",
        ]
    ]
    for motion, response in responses:
        lines.append(
            [
                motion.name,
                response.outcome(energy_to_overturn),
                "" if response.overturned else f"{response.u_max:.6g}",
                int(response.overturned),
                f"{response.tilt.max():.6g}",
                len(response.impact_times),
                f"{response.time[-1]:.6g}",
                int(response.overturned),
                *(f"{value:.6g}" for value in peak_values(motion)),
                *(f"{response.peaks.get(name, float('nan')):.6g}" for name in peaks),
                "; ".join(response.notes),
            ]
        )
    write_csv(folder / "responses.csv", lines)
    if len(responses) <= 12:
        print(f"\n{'motion':<34}{'outcome':>14}{'u_max [mm]':>12}{'tilt [rad]':>12}{'impacts':>9}")
        for (_, response), line in zip(responses, lines[1:]):
            largest = f"{'> ' if response.overturned else ''}{1e3 * response.u_max:.4g}"
            print(
                f"{line[0][:33]:<34}{line[1]:>14}{largest:>12}{float(line[4]):>12.4g}{line[5]:>9}"
            )
    u_max = np.array([response.u_max for _, response in responses])
    overturned = np.array([response.overturned for _, response in responses])
    if len(responses) > 1:
        low, high = proportion_interval(int(overturned.sum()), len(overturned))
        shown = [percentile(u_max, overturned, fraction=share) for share in (0.16, 0.5, 0.84)]
        words = ["overturn" if np.isinf(one) else f"{1e3 * one:.4g} mm" for one in shown]
        print(
            f"\n{len(responses)} motions: {overturned.sum()} overturned, P = "
            f"{overturned.mean():.1%} [{low:.1%}, {high:.1%}]; u16, u50, u84 = "
            f"{', '.join(words)}"
        )
    print(f"{1e3 * spent:.3g} ms of processor time a motion")
