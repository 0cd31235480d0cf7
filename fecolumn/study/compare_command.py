"""`fecolumn compare`: two analyses, or two ensembles of peak displacements: settings of a study,
studies, or computation and experiment.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fecolumn.statistics.compare import Comparison
    from fecolumn.statistics.sample import Sample

ANALYSIS = "an analysis"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn compare`."""
    form = (
        "folder of an analysis; or of a study, with selected settings as "
        "DIR@integration.dt_s=1e-3,integration.alpha_hht=-0.2; or CSV file of maxima"
    )
    parser.add_argument("a", metavar="A", help=form)
    parser.add_argument("b", metavar="B", help="the reference, in the same form")
    parser.add_argument("-o", "--output", metavar="DIR", help="folder for tables and figure")
    parser.add_argument(
        "--unpaired", action="store_true", help="do not pair the runs of A and B by motion"
    )
    parser.add_argument(
        "--cap-m",
        type=float,
        default=None,
        metavar="M",
        help="cap on displacements in the correlation R, and displacement there of runs that "
        "overturned or slid off; 0.25 in Katsamakas and Vassiliou (default: the largest "
        "peak of the runs that stayed standing)",
    )
    # its name until 0.10
    parser.add_argument("--cap-mm", type=float, default=None, help=argparse.SUPPRESS)
    parser.add_argument(
        "--seed", type=int, default=0, help="seed of the permutations (default: %(default)s)"
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        default=None,
        metavar="SHARE",
        help="of two analyses: difference, divided by the larger peak, at which they count as "
        "parted, above 0 and at most 1 (default: 0.05)",
    )


def main(args: argparse.Namespace) -> int:
    """Print the comparison, and write it where a folder is given; returns 0.

    Raises
    ------
    InputError
        A or B cannot be used, or an option is of the other kind of comparison.
    """
    if _are_analyses(args):
        from fecolumn.study.results.compare_command import compare_analyses

        compare_analyses((args.a, args.b), args.tolerance, args.output)
        return 0
    from fecolumn.foundation.deprecated import warn_of_older_name
    from fecolumn.foundation.folder import written
    from fecolumn.foundation.schema import InputError
    from fecolumn.statistics.compare import compare
    from fecolumn.statistics.ecdf import largest_peak
    from fecolumn.study.sample import read_sample

    if args.cap_mm is not None:
        warn_of_older_name("fecolumn compare", "--cap-mm", "--cap-m")
        args.cap_m = 1e-3 * args.cap_mm
    if args.cap_m is not None and not (math.isfinite(args.cap_m) and args.cap_m > 0):
        raise InputError("fecolumn compare", "--cap-m", args.cap_m, "must be greater than 0 [m]")
    if args.seed < 0:
        raise InputError("fecolumn compare", "--seed", args.seed, "must be at least 0")
    a, b = read_sample(args.a), read_sample(args.b)
    a, b, paired, notes = matched(a, b, args.unpaired)
    cap_m = args.cap_m or largest_peak((a.u_max, a.lost), (b.u_max, b.lost))
    result = compare(
        a.u_max,
        a.lost,
        b.u_max,
        b.lost,
        paired=paired,
        cap_m=cap_m,
        seed=args.seed,
        records=(a.records, b.records),
    )
    names = _names(a, b)
    print(f"A  {a.source}: {names[0]}\nB  {b.source}: {names[1]}  (reference)")
    print("\n".join(notes) + "\n")
    print(comparison_text(result, a, b, cap_m))
    if args.output:
        with written(args.output, "compare") as draft:
            files = _write(draft, result, a, b, paired)
        for file in files:
            print(f"wrote {Path(args.output) / file.name}")
    return 0


def _are_analyses(args: argparse.Namespace) -> bool:
    """Whether A and B are folders of analyses.

    Raises
    ------
    InputError
        only one of them is, or an option does not fit what they are.
    """
    from fecolumn.foundation.schema import InputError

    kinds = [_kind(place) for place in (args.a, args.b)]
    analyses = ANALYSIS in kinds
    if analyses and kinds[0] != kinds[1]:
        told = ", ".join(
            f"{letter}, {place}, is {kind}"
            for letter, place, kind in zip("AB", (args.a, args.b), kinds)
        )
        raise InputError(
            "fecolumn compare",
            "A, B",
            None,
            f"{told}: give two analyses, or two ensembles (studies or CSV files)",
        )
    if analyses:
        for option, value in (
            ("--unpaired", args.unpaired or None),
            ("--cap-m", args.cap_m),
            ("--seed", args.seed or None),
        ):
            if value is not None:
                raise InputError(
                    "fecolumn compare", option, value, "is for ensembles; these are two analyses"
                )
        if args.tolerance is not None and not 0 < args.tolerance <= 1:
            raise InputError(
                "fecolumn compare",
                "--tolerance",
                args.tolerance,
                "must be greater than 0 and at most 1",
            )
    elif args.tolerance is not None:
        raise InputError(
            "fecolumn compare",
            "--tolerance",
            args.tolerance,
            "is for two analyses; these are ensembles",
        )
    return analyses


def _kind(place: str) -> str:
    """What a place is, in words."""
    folder = Path(
        place.rpartition("@")[0] if "=" in place.rpartition("@")[2] and "@" in place else place
    )
    if (folder / "study.json").is_file():
        return "a study"
    if (folder / "case.json").is_file():
        return ANALYSIS
    return (
        "a file" if folder.is_file() else "a folder of neither" if folder.is_dir() else "not there"
    )


def matched(a: Sample, b: Sample, unpaired: bool) -> tuple[Sample, Sample, bool, list[str]]:
    """Both samples motion by motion where they have motions in common: (a, b, paired, notes for the
    reader).
    """
    from fecolumn.statistics.records import run_count

    notes = [
        f"{name}: {sample.missing} analyses of this choice are not done"
        for name, sample in (("A", a), ("B", b))
        if sample.missing
    ]
    notes += [f"{name}: {sample.cut}" for name, sample in (("A", a), ("B", b)) if sample.cut]
    in_b = set(b.motions)
    common = [motion for motion in a.motions if motion in in_b]
    unique = all(len(set(sample.motions)) == len(sample.motions) for sample in (a, b))
    if unpaired or not unique:
        return a, b, False, [*notes, "independent ensembles"]
    others = _other_contents(a.take(common), b.take(common))
    if others:
        first, *more = others
        said = f"{first} has one name in both and comes from files that differ"
        if more:
            said = f"{len(others)} motions have one name in both and come from files that differ, "
            said += f"such as {first}"
        common = [motion for motion in common if motion not in others]
        notes.append(said if len(common) < 2 else f"{said}: left out")
    if len(common) < 2:
        return a, b, False, [*notes, "independent ensembles"]
    alone = [
        f"{count} only in {name}"
        for name, sample in (("A", a), ("B", b))
        if (count := len(sample.motions) - len(common) - len(others))
    ]
    return (
        a.take(common),
        b.take(common),
        True,
        [
            *notes,
            f"{run_count(len(common), a.take(common).records, 'motion')} in both, "
            "compared one by one" + (f"; left out: {', '.join(alone)}" if alone else ""),
        ],
    )


def _other_contents(a: Sample, b: Sample) -> list[str]:
    """Motions of both samples, in one order, that hold different things, where that is known."""
    if a.contents is None or b.contents is None:
        return []
    pairs = zip(a.motions, a.contents, b.contents)
    return [name for name, one, other in pairs if one and other and one != other]


def comparison_text(result: Comparison, a: Sample, b: Sample, cap_m: float) -> str:
    """The comparison for a reader, with units, intervals and evidence in words."""
    from fecolumn.engines.ending import P_LOST, P_OVERTURN
    from fecolumn.statistics.compare import evidence
    from fecolumn.statistics.flips import contingency

    def tested(name: str, value: str, p: float) -> list[str]:
        return [name, value, _p(p), evidence(p)]

    slides = _slides(a, b)
    shared = (result.records_a, result.records_b) != (result.n_a, result.n_b)
    of_each = [
        ["", "A", "B"],
        ["runs", str(result.n_a), str(result.n_b)],
        *([["records", str(result.records_a), str(result.records_b)]] if shared else []),
        [f"{P_OVERTURN} [95 % Wilson]", *(_share(one.lost & ~one.slid_off, one) for one in (a, b))],
        *([[f"{P_LOST} [95 % Wilson]", *(_share(one.lost, one) for one in (a, b))]] * slides),
        [
            "median u_max [mm]",
            _millimetres(result.median_a_m, slides),
            _millimetres(result.median_b_m, slides),
        ],
    ]
    of_both = [
        ["A against B", "value", "p", "evidence of a difference"],
        ["Kolmogorov-Smirnov, D", f"{result.ks:.3f}", _p(result.ks_p), result.ks_evidence],
        tested("Anderson-Darling, A2", f"{result.ad:.3f}", result.ad_p),
        tested("Cramer-von Mises, T", f"{result.cvm:.3f}", result.cvm_p),
    ]
    if not (result.paired_p is None or result.mcnemar_p is None or result.correlation is None):
        table = contingency(a.lost, b.lost)
        of_both += [
            tested("same motions: D, settings swapped", f"{result.ks:.3f}", result.paired_p),
            tested(
                f"{'lost' if slides else 'overturns'} in A alone / B alone",
                f"{table[1, 0]} / {table[0, 1]}",
                result.mcnemar_p,
            ),
            [f"correlation R, cap {1e3 * cap_m:.4g} mm", _defined(result.correlation), "", ""],
        ]
    of_both.append(["median error e50 = |A - B| / B", _defined(result.e50), "", ""])
    text = f"{_columns(of_each)}\n\n{_columns(of_both)}"
    if result.paired_p is not None:
        text += (
            "\nThe first three tests take A and B for independent; for the same "
            "motions in both their p is too large,"
            "\nand the one with settings swapped within motions is to be judged by."
        )
    if shared:
        text += "\nRuns of one record are drawn and swapped together: all p count records."
    return text


def _write(folder: Path, result: Comparison, a: Sample, b: Sample, paired: bool) -> list[Path]:
    from fecolumn.foundation.atomic import write_csv
    from fecolumn.pictures.figures.compare_figure import compare_figure

    files = [folder / "comparison.csv"]
    values = [
        [key, "" if value is None else value] for key, value in dataclasses.asdict(result).items()
    ]
    values += [
        [f"p_overturn_{name}", float((sample.lost & ~sample.slid_off).mean())]
        for name, sample in (("a", a), ("b", b))
    ]
    write_csv(files[0], [["quantity", "value"], *values])
    if paired:
        files.append(folder / "pairs.csv")
        u = [
            ["" if fallen else f"{value:.6e}" for value, fallen in zip(sample.u_max, sample.lost)]
            for sample in (a, b)
        ]
        write_csv(
            files[1],
            [
                [
                    "motion",
                    "u_max_a_m",
                    "overturned_a",
                    "slid_off_a",
                    "u_max_b_m",
                    "overturned_b",
                    "slid_off_b",
                ],
                *zip(a.motions, u[0], *_ends(a), u[1], *_ends(b)),
            ],
        )
    return files + compare_figure(
        (a.u_max, a.lost),
        (b.u_max, b.lost),
        _labels(a, b),
        paired=paired,
        correlation=result.correlation,
        path=folder / "comparison",
        slides=_slides(a, b),
        records=(a.records, b.records),
    )


def _slides(a: Sample, b: Sample) -> bool:
    """Whether a column of either sample slid off its base."""
    return bool(a.slid_off.any() or b.slid_off.any())


def _ends(sample: Sample) -> tuple[NDArray[Any], NDArray[Any]]:
    """Whether each run overturned, and whether it slid off, as 0 and 1."""
    return (sample.lost & ~sample.slid_off).astype(int), sample.slid_off.astype(int)


def _names(a: Sample, b: Sample) -> tuple[str, str]:
    """Title, and chosen settings as they are typed."""

    def name(sample: Sample) -> str:
        return ", ".join(
            [sample.title, *(f"{key} = {value}" for key, value in sample.choice.items())]
        )

    return name(a), name(b)


def _labels(a: Sample, b: Sample) -> tuple[str, str]:
    """What tells a from b, for a figure: the settings that differ, or else the titles, or else the
    places.
    """
    from fecolumn.pictures.figures.axis_text import axis_text

    if a.title == b.title and a.choice != b.choice:
        first, second = (
            ", ".join(
                axis_text(key, value)
                for key, value in sample.choice.items()
                if other.choice.get(key) != value
            )
            or "all else"
            for sample, other in ((a, b), (b, a))
        )
        return first, second
    return (a.title, b.title) if a.title != b.title else (f"A, {a.title}", f"B, {b.title}")


def _share(lost: NDArray[Any], sample: Sample) -> str:
    from fecolumn.statistics.ecdf import share_interval

    k, n = int(lost.sum()), lost.size
    low, high = share_interval(lost, sample.records)
    return f"{100 * k / n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]"


def _columns(lines: Iterable[Iterable[Any]]) -> str:
    """First column to the left, figures to the right, words of the fourth to the left."""
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join(
        "  ".join(
            cell.ljust(width) if place in (0, 3) else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(line, widths))
        ).rstrip()
        for line in lines
    )


def _p(p: float) -> str:
    return f"{p:.4f}" if p >= 1e-4 else f"{p:.1e}"


def _defined(value: float) -> str:
    return f"{value:.3f}" if math.isfinite(value) else "undefined"


def _millimetres(u_m: float, slides: bool) -> str:
    return f"{1e3 * u_m:.2f}" if math.isfinite(u_m) else "lost" if slides else "overturn"
