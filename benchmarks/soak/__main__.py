"""Very many analyses of drawn cases, with kills: none may be lost, nothing may grow, and what fails
is told.

    # a worker or the driver is killed about every five minutes
    python -m benchmarks.soak -n 2000 -j 1 -o results/soak --kill 5
    # goes on with the same analyses, and more
    python -m benchmarks.soak -n 100000 -j 2 -o results/soak
    # what has come of it so far
    python -m benchmarks.soak -o results/soak --report
    # one of them alone, into results/soak/only-1234
    python -m benchmarks.soak -o results/soak --only 1234

Analyses are short, a tenth of a second each: 10^5 take about three hours of processor time, and the
models of the first hundreds some minutes. Models of the specimens are kept in FECOLUMN_CACHE, or
~/.cache/fecolumn.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from benchmarks.soak import specimens
from benchmarks.soak.watch import keep_running
from fecolumn.foundation.cores import usable_cores

_SETTINGS = "soak.json"


def main(argv=None) -> int:
    """Do what is missing and print the report; 0 where no analysis failed or was lost."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.soak",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-n", type=int, default=100_000, help="analyses (default: %(default)s)")
    parser.add_argument(
        "-j", type=int, default=usable_cores(), help="workers (default: one a core)"
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        required=True,
        type=Path,
        help="folder; what is done there is kept",
    )
    parser.add_argument(
        "--kill",
        metavar="MINUTES",
        type=float,
        default=0.0,
        help="mean time between kills with SIGKILL (default: none)",
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="of the random numbers (default: %(default)s)"
    )
    parser.add_argument(
        "--specimens",
        type=int,
        default=specimens.COUNT,
        help="number of specimens, each with a model to make (default: %(default)s)",
    )
    parser.add_argument(
        "--report", action="store_true", help="only print what has come of it so far"
    )
    parser.add_argument(
        "--only", type=int, metavar="NUMBER", help="only this analysis, as fecolumn run does it"
    )
    args = parser.parse_args(argv)
    args.output.mkdir(parents=True, exist_ok=True)
    settings = _settings(args)
    if args.only is not None:
        return _alone(args.output, args.only, **settings)
    if not args.report:
        if code := keep_running(
            args.output, [args.n, args.j, settings["seed"], settings["specimens"]], 60 * args.kill
        ):
            print(
                f"the driver ended with exit code {code}: {args.output / 'driver.log'}",
                file=sys.stderr,
            )
            return 1
    from benchmarks.soak.report import report

    return report(args.output, **settings)


def _settings(args) -> dict[str, int]:
    """Seed and number of specimens: those with which the folder was begun."""
    file = args.output / _SETTINGS
    if not file.exists():
        file.write_text(json.dumps({"seed": args.seed, "specimens": args.specimens}) + "\n")
    return json.loads(file.read_text())


def _alone(folder: Path, number: int, seed: int, specimens: int) -> int:
    from benchmarks.soak.cases import case_of
    from fecolumn.engines.ending import ending_text
    from fecolumn.simulation import AnalysisFailed, run

    case = case_of(number, folder, seed, specimens)
    try:
        summary = run(case, folder / f"only-{number}")
    except AnalysisFailed as error:
        print(error, file=sys.stderr)
        return 1
    print(
        f"{folder / f'only-{number}'}: {ending_text(summary)}; energy closure "
        f"{summary['energy_closure_rel']:.1e}, {summary['cuts']} cuts"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
