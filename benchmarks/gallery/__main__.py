"""Every figure of README and manual, made again in its place.

    ./containers/run python -m benchmarks.gallery [FIGURE ...] [-o DIR] [-j N] [--study DIR]

Analyses go to DIR and are gone on with there. Figures of benchmarks that take hours are drawn from
their tables in benchmarks/. `cdf` runs the 80 analyses of benchmarks/quick_study.toml, or draws the
finished study of --study. Ten minutes on two cores; each figure says what it was made from, and
benchmarks/tables/figures.csv by which code.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from benchmarks.gallery.figures import FIGURES, Work, make
from benchmarks.gallery.made import note
from fecolumn.foundation.cores import usable_cores


def main(argv) -> int:
    """Make the figures that are named, all where none is; 0."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gallery",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "figures", nargs="*", metavar="FIGURE", help=f"of {', '.join(FIGURES)} (default: all)"
    )
    parser.add_argument("-o", "--output", metavar="DIR", type=Path, default=Path("results/gallery"))
    parser.add_argument(
        "-j",
        "--jobs",
        metavar="N",
        type=int,
        default=usable_cores(),
        help="analyses at a time (default: %(default)s)",
    )
    parser.add_argument(
        "--study",
        metavar="DIR",
        type=Path,
        help="folder of a study for the figure cdf, instead of running the quick study",
    )
    args = parser.parse_args(argv)
    if unknown := set(args.figures) - set(FIGURES):
        parser.error(f"FIGURE: {', '.join(sorted(unknown))}: must be of {', '.join(FIGURES)}")
    if args.study and not (args.study / "study.json").is_file():
        parser.error(f"--study: {args.study}: holds no study (no study.json)")
    for name in args.figures or FIGURES:
        print(make(name, Work(args.output, args.jobs, args.study)), flush=True)
        note(name)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
