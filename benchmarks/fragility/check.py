"""What shorter steps, and following all to rest, change of the fragilities.

    ./containers/run python -m benchmarks.fragility check [STRUCTURE ...] [-n MOTIONS] [-j N]
        [-o DIR] [--report]

The first motions again, with half of the step, and followed for LONGER after the motion unless all
is at rest before; one table, beside the rows that come with the repository. The same command goes
on where it was stopped.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from benchmarks.fragility.report import beside, lost
from benchmarks.fragility.run import REST_S, STEP_S, rows_of
from benchmarks.fragility.structures import NAMES
from fecolumn.engines.ending import STILL_ROCKING
from fecolumn.foundation.cores import usable_cores
from fecolumn.study.store import FAILED

#: Structures that are checked unless others are named.
CHECKED = ("monolith", "2 drums", "4 drums", "trilith")
#: Longest time [s] followed after the motion where all is to come to rest.
LONGER = 60.0
#: Step [s] and time [s] followed, by what is changed.
CHECKS = {
    f"steps of {STEP_S / 2:g} s, not {STEP_S:g} s": (STEP_S / 2, REST_S),
    f"followed for {LONGER:g} s, not {REST_S:g} s": (STEP_S, LONGER),
}
HEAD = (
    "structure and what is changed",
    "motions",
    "lost before",
    "lost with the change",
    "lost before alone",
    "lost with it alone",
    "p (McNemar)",
    "still rocking before",
    "still rocking with it",
    "shift of those that stand in both, median before [m]",
    "median with it [m]",
    "shift that differs by more than a tenth",
)


def line(name: str, before: list[dict], after: list[dict]) -> tuple:
    """A row of the table."""
    first, second = ({row["motion"]: row for row in rows} for rows in (before, after))
    both = [
        (first[n], second[n])
        for n in sorted(first.keys() & second.keys())
        if FAILED not in (first[n]["outcome"], second[n]["outcome"])
    ]
    if not both:
        return (name, 0, *("-",) * (len(HEAD) - 2))
    sides = list(zip(*both))
    stand = [(a["shift_m"], b["shift_m"]) for a, b in both if not lost(a) and not lost(b)]
    a, b = np.array(stand or [(np.nan, np.nan)]).T
    count, alone, other, p = beside(*map(list, sides))
    return (
        name,
        count,
        *(sum(map(lost, side)) for side in sides),
        alone,
        other,
        p,
        *(sum(row["outcome"] == STILL_ROCKING for row in side) for side in sides),
        *(f"{np.median(one):.2g}" for one in (a, b)),
        int((np.abs(b - a) > 0.1 * a).sum()),
    )


def main(arguments) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.fragility check",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("structures", nargs="*", metavar="STRUCTURE", help=", ".join(NAMES))
    parser.add_argument("-n", type=int, default=200, metavar="MOTIONS")
    parser.add_argument("-j", "--jobs", type=int, default=usable_cores())
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, default=Path("results/fragility")
    )
    parser.add_argument("--report", action="store_true", help="compute nothing, tell what is done")
    args = parser.parse_args(arguments)
    if unknown := set(args.structures) - set(NAMES):
        parser.error(f"{', '.join(sorted(unknown))}: must be of {', '.join(NAMES)}")
    lines = []
    for name in args.structures or CHECKED:
        before = rows_of(name, args.output, args.n, STEP_S, 0)
        for what, (dt, rest_s) in CHECKS.items():
            print(f"{name}, {what}", file=sys.stderr, flush=True)
            workers = 0 if args.report else args.jobs
            after = rows_of(name, args.output, args.n, dt, workers, rest_s)
            if before and after:
                lines.append(line(f"{name}, {what}", before, after))
    print(markdown(HEAD, lines) if lines else "nothing is done yet")
    return 0
