"""The planar program alone and beside the package.

    ./containers/run python -m benchmarks.planar [column beside histories] [STRUCTURE ...] [PROGRAM
        ...] [-n N] [--dt S] [-j JOBS] [-o DIR]

column     which accelerations of a pulse overturn the multi-drum column, by the planar program at
    --dt and by the package, rigid, at 1e-3 s: column.csv, column.png (half an hour of one core)
beside     overturned, distance of the peaks' distributions and outcomes that differ, planar program
    and others: beside.csv, beside.png
histories  how many single histories agree until the third impact, planar program and package at
    1e-4 s: histories.csv

The planar program makes steps of 1e-4 s, the package of --dt (1e-3 s), Siconos of --dt (1e-4 s:
impacts of its scheme err by the step, at 1e-3 s every third outcome of two blocks is another one).
Structures by name in quotes, such as "two blocks"; none means all. Programs beside the planar one
are fecolumn, Siconos (of other authors; on two blocks, five drums and trilith; `python -m
benchmarks.peers --install` installs it, it is left out where it is missing) and "equivalent block"
(closed form, on the frame); none means all. Siconos on its three structures, hours of one core:

    ./containers/run python -m benchmarks.planar beside "two blocks" "five drums" trilith Siconos

What is done is kept in DIR/runs: the same command goes on after a kill, one with more motions makes
only what is missing, other sources make all anew.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import astuple, fields
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from benchmarks.peers.peer import Missing
from benchmarks.planar import column as columns
from benchmarks.planar import peer
from benchmarks.planar.compare import AGREE, Compared, compared
from benchmarks.planar.ensembles import BLOCK, PACKAGE, PLANAR, SICONOS, response, shaken
from benchmarks.planar.figure import collapse, distributions
from benchmarks.planar.jobs import FINE, every, fell, fell_in_package, until_third
from fecolumn.foundation.atomic import write_csv

PARTS = ("column", "beside", "histories")
PROGRAMS = (PACKAGE, SICONOS, BLOCK)
#: Steps unless told otherwise [s]
_STEPS = {PACKAGE: 1e-3, SICONOS: FINE}
#: Structures on which Siconos is run
_PEER = ("two blocks", "five drums", "trilith")


def column(args, folder: Path) -> None:
    """Scan the accelerations of `column.SCANS` by both programs."""
    table, lines = [], []
    for tp, accelerations in columns.SCANS.items():
        tried = [float(a) for a in accelerations]
        planar = every(fell, [(tp, a, args.dt or FINE) for a in tried], args.jobs)
        package = every(fell_in_package, [(tp, a) for a in tried], args.jobs)
        table += [[tp, f"{a:.4g}", int(b), int(c)] for a, b, c in zip(tried, planar, package)]
        found = [columns.windows(tried, fallen) for fallen in (planar, package)]
        lines.append((f"{tp:g}", *(f"{one:g}" for one in columns.OTHERS[tp]), *found))
    head = ("tp [s]", "UDEC [g]", "HybriDFEM [g]", "LMGC90 [g]")
    print(f"\n{markdown((*head, 'planar program, falls at [g]', 'fecolumn, falls at [g]'), lines)}")
    write_csv(folder / "column.csv", [["tp_s", "a_g", "planar", "fecolumn"], *table])
    print("wrote", *collapse(columns.pushed(0.44, 0.34, FINE), folder / "column"))


def beside(args, folder: Path) -> None:
    """The planar program and the others on the whole motions."""
    table, panels, programs = [], {}, there(args.programs)
    head = (
        "structure",
        "program",
        "step [s]",
        "motions",
        "overturned: planar",
        "it",
        "D of peaks [-]",
        "p",
        "outcomes differ",
        "McNemar's p",
        "peaks off, median [-]",
        "failed",
        "steps unsolved",
    )
    print("", f"| {' | '.join(head)} |", "|---" * len(head) + "|", sep="\n")
    for name in args.structures:
        case = shaken()[name]
        found, numbers = {}, range(1, min(args.n, case.motions) + 1)
        for program in (PLANAR, *programs):
            if (program == BLOCK and not case.closed) or (program == SICONOS and name not in _PEER):
                continue
            dt = args.dt or _STEPS[program] if program in (PACKAGE, SICONOS) else FINE
            found[program] = every(
                response, [(name, program, number, dt, folder) for number in numbers], args.jobs
            )
            if program == PLANAR:
                continue
            one = compared(found[PLANAR], found[program])
            table.append([name, program, f"{dt:g}", one.n, *one.fallen, *astuple(one)[2:]])
            cells = (
                name,
                program,
                f"{dt:g}",
                one.n,
                *one.fallen,
                f"{one.distance:.3f}",
                f"{one.p:.2g}",
                one.differ,
                f"{one.mcnemar:.2g}",
                f"{one.off:.2g}",
                one.failed,
                one.unsolved,
            )
            print(f"\r| {' | '.join(map(str, cells))} |", flush=True)
        panels[name] = found
    names = [field.name for field in fields(Compared)]
    write_csv(
        folder / "beside.csv",
        [
            ["structure", "program", "dt_s", "n", "fallen_planar", "fallen_program", *names[2:]],
            *table,
        ],
    )
    print("wrote", *distributions(panels, folder / "beside"))


def there(programs: list[str]) -> list[str]:
    """Those of the programs that can be run; Siconos is said to be left out where it is not
    installed.
    """
    if SICONOS in programs:
        try:
            peer.version()
        except Missing as error:
            print(
                f"Siconos is left out: {error} (python -m benchmarks.peers --install)",
                file=sys.stderr,
            )
            return [program for program in programs if program != SICONOS]
    return programs


def histories(args, folder: Path) -> None:
    """Single motions at 1e-4 s."""
    table = []
    print(
        f"\n| structure | motions with three impacts | agree to {AGREE:.0%} until the "
        "third | off, median [-] | most [-] |\n|---|---|---|---|---|"
    )
    for name in args.structures:
        numbers = range(1, min(args.n, shaken()[name].motions) + 1)
        found = np.array(
            every(until_third, [(name, number, folder) for number in numbers], args.jobs)
        )
        table += [[name, number, *row] for number, row in zip(numbers, found.tolist())]
        off = found[np.isfinite(found[:, 1]), 1]
        print(
            f"\r| {name} | {len(off)} | {(off <= AGREE).sum()} | "
            f"{np.median(off) if len(off) else np.nan:.2g} | {off.max(initial=0.0):.2g} "
            "|",
            flush=True,
        )
    write_csv(folder / "histories.csv", [["structure", "motion", "third_impact_s", "off"], *table])


def main(arguments=None) -> int:
    names = list(shaken())
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.planar", description=__doc__.split("\n")[0]
    )
    parser.add_argument(
        "names",
        nargs="*",
        metavar="NAME",
        help=f"of {', '.join(PARTS)}; of {', '.join(names)}; of {', '.join(PROGRAMS)}",
    )
    parser.add_argument(
        "-n",
        type=int,
        default=100,
        help="motions of each structure, 1 to 115 (default: %(default)s)",
    )
    parser.add_argument(
        "--dt",
        type=float,
        help="step [s] of the package (1e-3) and of Siconos (1e-4) in `beside`, of the "
        "planar program in `column` (1e-4)",
    )
    parser.add_argument(
        "-j", "--jobs", type=int, default=1, help="analyses at a time (default: %(default)s)"
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/planar")
    args = parser.parse_args(arguments)
    if unknown := [name for name in args.names if name not in (*PARTS, *names, *PROGRAMS)]:
        parser.error(f"{', '.join(unknown)}: must be of {', '.join((*PARTS, *names, *PROGRAMS))}")
    if not 1 <= args.n <= 115:
        parser.error(f"-n {args.n}: must be in [1, 115]")
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    args.structures = [name for name in names if name in args.names] or names
    args.programs = [name for name in PROGRAMS if name in args.names] or list(PROGRAMS)
    for part in [part for part in PARTS if part in args.names] or PARTS:
        globals()[part](args, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
