"""When are drums safer than a monolith? P(overturn) and residual shift of columns of 1 to 8 drums,
a trilith and a frame in near-fault motions, rigid and elastic, with exact friction.

    ./containers/run python -m benchmarks.fragility [STRUCTURE ...] [-n MOTIONS] [-j N] [--dt S]
        [-o DIR] [--report] [--keep]
    ./containers/run python -m benchmarks.fragility check --help

Each structure is a study of its own in DIR; the same command goes on where it was stopped. What
benchmarks/tables/fragility holds is not computed again; --keep writes what is done there. A motion
depends on its number alone, and all structures have the same ones. Writes outcomes.csv and
fragility.png (and .pdf) and prints four tables. Structures by name in quotes, such as "4 drums";
none means all. Elastic drums take three times as long as rigid ones.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from benchmarks.fragility import check
from benchmarks.fragility.figure import draw
from benchmarks.fragility.report import markdown
from benchmarks.fragility.run import COLUMNS, STEP_S, keep, rows_of
from benchmarks.fragility.structures import NAMES
from fecolumn.foundation.atomic import write_csv
from fecolumn.foundation.cores import usable_cores


def main(arguments=None) -> int:
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["check"]:
        return check.main(arguments[1:])
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.fragility",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("structures", nargs="*", metavar="STRUCTURE", help=", ".join(NAMES))
    parser.add_argument(
        "-n", type=int, default=1000, metavar="MOTIONS", help="(default: %(default)s)"
    )
    parser.add_argument("-j", "--jobs", type=int, default=usable_cores(), help="analyses at a time")
    parser.add_argument(
        "--dt", type=float, default=STEP_S, help="time step [s] (default: %(default)s)"
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, default=Path("results/fragility")
    )
    parser.add_argument("--report", action="store_true", help="compute nothing, tell what is done")
    parser.add_argument(
        "--keep", action="store_true", help="write rows into benchmarks/tables/fragility"
    )
    args = parser.parse_args(arguments)
    if args.keep and args.dt != STEP_S:
        parser.error(f"--dt {args.dt:g}: rows are kept of steps of {STEP_S:g} s only")
    if unknown := set(args.structures) - set(NAMES):
        parser.error(f"{', '.join(sorted(unknown))}: must be of {', '.join(NAMES)}")
    if min(args.n, args.jobs) < 1:
        parser.error("-n and -j: must be at least 1")
    found = {}
    for name in [name for name in NAMES if name in (args.structures or NAMES)]:
        print(name, file=sys.stderr, flush=True)
        workers = 0 if args.report else args.jobs
        found[name] = rows_of(name, args.output, args.n, args.dt, workers)
        if args.keep and found[name]:
            keep(name, found[name])
    rows = [[row[key] for key in COLUMNS] for rows in found.values() for row in rows]
    args.output.mkdir(parents=True, exist_ok=True)
    write_csv(args.output / "outcomes.csv", [COLUMNS, *rows])
    print(markdown(found))
    print("\nwrote", *draw(found, args.output / "fragility"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
