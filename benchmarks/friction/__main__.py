"""The contact solver beside Siconos on friction problems of many bodies: who solves which, how
well, in what time.

    ./containers/run python -m benchmarks.friction [--column CASE] [--sample N] [--own SHARE]
        [--every] [-o DIR] [FILE ...]

Without files: assemblies of rigid bodies (assemblies.py), every one from rest, shaken and thrown,
with coefficients from 0 to 1.2, and problems recorded from steps of the reduced engine
(recorded.py), with --column those of a case's column, too. With files: problems of the Friction
Contact Library (HDF5) or of Siconos' own tests (.dat). Siconos runs if Debian's python3-siconos is
installed (python -m benchmarks.peers --install): its nonsmooth Gauss-Seidel (NSGS), nonsmooth
Newton of Alart and Curnier (NSN_AC) and ADMM, to 1e-12 or 20,000, 200 and 20,000 iterations. All
start from zero forces. Every solver's forces are judged by the same natural map (problem.py),
relative to the largest |q|; Siconos' own error of all of them is in friction.json. Times are of the
CPU.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from benchmarks.friction.assemblies import problems
from benchmarks.friction.fclib import read_problem
from benchmarks.friction.figure import performance_figure
from benchmarks.friction.problem import Problem, violation
from benchmarks.friction.recorded import column, structures
from benchmarks.peers.child import run_child
from benchmarks.peers.install import SYSTEM_PYTHON
from fecolumn.contact.friction import solve_contact
from fecolumn.foundation.atomic import write_json

# Violation of the laws over max |q| below which a problem counts as solved: 1e-14 m on the tenth of
# a millimetre that bodies fall in a step, a hundredth of what the engines ask for; rounding of W r
# costs 1e-15 to 1e-14
SOLVED = 1e-10
# What the solver is asked for, over max |q|
TOLERANCE = 1e-12
LIMIT_CPU_S = 3600.0
# What is faster is done so often that it takes so long: the clock of the CPU has ticks [s]
LEAST_S = 0.02
LABELS = {
    "fecolumn": "fecolumn",
    "nsgs": "Siconos NSGS",
    "newton": "Siconos Newton",
    "admm": "Siconos ADMM",
}
# Siconos' solvers one after the other, the fastest first, until one has solved a problem
IN_TURN = ("newton", "nsgs", "admm")
MISSING = "without Siconos: python -m benchmarks.peers --install installs Debian's python3-siconos"


def ours(problem: Problem) -> dict:
    """Forces, seconds of CPU and iterations of `solve_contact`; also the seconds from the guess of
    the engine, where the problem has one.
    """
    tolerance, times = TOLERANCE * np.abs(problem.q).max(), []
    for start in (problem.start, np.zeros_like(problem.q)):
        began, seconds, made = time.process_time(), 0.0, 0
        while start is not None and seconds < LEAST_S:
            found = solve_contact(problem.W, problem.q, problem.mu, start, tolerance)
            seconds, made = time.process_time() - began, made + 1
        times.append(seconds / max(made, 1))
    result = dict(
        forces=found.forces, seconds=times[1], iterations=found.iterations, sweeps=found.sweeps
    )
    return result if problem.start is None else result | dict(seconds_from_guess=times[0])


def siconos(given: list[Problem], folder: Path, own=()) -> tuple[list[dict], str]:
    """Results of Siconos by solver, one a problem, {} where it gave none; and a remark on what went
    wrong, if anything did.

    own: forces (n, 3) of each problem that Siconos shall judge, too: its error is that of
    "fecolumn".
    """
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.npz"):
        old.unlink()
    for k, problem in enumerate(given):
        np.savez(
            folder / f"{k:04d}.problem.npz",
            W=problem.W,
            q=problem.q,
            mu=problem.mu,
            **(dict(ours=own[k]) if len(own) else {}),
        )
    try:
        ended = run_child(
            [SYSTEM_PYTHON, "-P", str(Path(__file__).with_name("siconos.py")), str(folder)],
            folder,
            LIMIT_CPU_S,
        )
    except OSError as error:
        return [{} for _ in given], f"{MISSING} (Siconos cannot run: {error})"
    found = []
    for k in range(len(given)):
        paths = {
            name: folder / f"{k:04d}.{'judged' if name == 'fecolumn' else name}.npz"
            for name in LABELS
        }
        found.append({name: dict(np.load(path)) for name, path in paths.items() if path.exists()})
    if ended.code == 0:
        return found, ""
    hint = f"; {MISSING}" if not any(found) else ""
    return found, f"Siconos ended with code {ended.code}: {ended.words}{hint}"


def compared(given: list[Problem], folder: Path) -> tuple[list[dict], str]:
    """A record a problem: what it is, and of every solver violation, seconds and iterations; and
    Siconos' remark.
    """
    # compiled, so that the first problem costs what all cost
    solve_contact(np.eye(3), np.zeros((1, 3)), 0.0, np.zeros((1, 3)))
    own = [ours(problem) for problem in given]
    others, remark = siconos(given, folder, [one["forces"] for one in own])
    records = []
    for problem, mine, other in zip(given, own, others):
        record = dict(
            name=problem.name,
            points=problem.points,
            rank=problem.rank,
            mu=np.unique(problem.mu).tolist(),
            solvers={},
        )
        for name, found in (other | {"fecolumn": other.get("fecolumn", {}) | mine}).items():
            record["solvers"][name] = {
                key: float(value) for key, value in found.items() if key != "forces"
            }
            record["solvers"][name]["violation"] = violation(problem, found["forces"])
        records.append(record)
    return records, remark


def summary(records) -> str:
    """A row an assembly or structure: problems solved, worst violation, median and longest time of
    each solver.
    """
    rows = [
        (
            "assembly",
            "points",
            "3 n",
            "rank",
            *(f"{label}: solved, worst, ms median, longest" for label in LABELS.values()),
        )
    ]
    for name, records_of_it in itertools.groupby(
        records, key=lambda record: record["name"].split(",")[0]
    ):
        group, cells = list(records_of_it), []
        for solver in LABELS:
            found = [record["solvers"][solver] for record in group if solver in record["solvers"]]
            bad, ms = [one["violation"] for one in found], [1e3 * one["seconds"] for one in found]
            cells.append(
                f"{sum(v <= SOLVED for v in bad)}/{len(group)}, {np.max(bad):.0e}, "
                f"{np.median(ms):.2g}, {max(ms):.2g}"
                if found
                else "-"
            )
        sizes = (
            _range(factor * record[key] for record in group)
            for factor, key in ((1, "points"), (3, "points"), (1, "rank"))
        )
        rows.append((name, *sizes, *cells))
    return markdown(rows[0], rows[1:])


def _range(values) -> str:
    """ "3", or "3 to 5"."""
    values = sorted(set(values))
    return " to ".join(f"{value:.3g}" for value in sorted({values[0], values[-1]}))


def shares(records) -> str:
    """A row a solver: share solved, median CPU time of all problems, worst problem, and Siconos'
    own error of its forces, median and largest of the solved.
    """
    rows = [
        (
            "solver",
            f"solved to {SOLVED:g}",
            "ms of CPU: median, all",
            "worst violation, of",
            "Siconos' own error of what it solves: median, largest",
        )
    ]
    for solver, label in (LABELS | {"in turn": "Siconos, its three in turn"}).items():
        found = [
            (record["name"] + f", mu {_range(record['mu'])}", one)
            for record in records
            if (one := _in_turn(record) if solver == "in turn" else record["solvers"].get(solver))
        ]
        if not found:
            continue
        solved = [one for _, one in found if one["violation"] <= SOLVED]
        name, worst = max(found, key=lambda pair: pair[1]["violation"])
        judged = [one["own_error"] for one in solved if "own_error" in one]
        times = [1e3 * one["seconds"] for _, one in found]
        rows.append(
            (
                label,
                f"{len(solved)} of {len(found)}",
                f"{np.median(times):.2g}, {sum(times):.3g}",
                f"{worst['violation']:.0e}, {name}",
                f"{np.median(judged):.0e}, {max(judged):.0e}" if judged else "-",
            )
        )
    return markdown(rows[0], rows[1:])


def _in_turn(record) -> dict | None:
    """Of the solvers of Siconos, what the first gives that solves a problem, else the best; with
    the time of all that were tried.
    """
    tried = []
    for name in IN_TURN:
        if name in record["solvers"]:
            tried.append(record["solvers"][name])
            if tried[-1]["violation"] <= SOLVED:
                break
    if not tried:
        return None
    best = min(tried, key=lambda one: one["violation"])
    return best | dict(seconds=sum(one["seconds"] for one in tried))


def detail(records) -> str:
    """A row a problem: violation, ms and iterations of each solver."""
    rows = [
        (
            "problem",
            "points",
            "3 n",
            "rank",
            "mu",
            *(f"{label}: violation, ms, iterations" for label in LABELS.values()),
        )
    ]
    for record in records:
        cells = []
        for solver in LABELS:
            one = record["solvers"].get(solver)
            others = f" + {one['sweeps']:.0f}" if one and one.get("sweeps") else ""
            cells.append(
                f"{one['violation']:.1e}, {1e3 * one['seconds']:.2g}, "
                f"{one['iterations']:.0f}{others}"
                if one
                else "-"
            )
        rows.append(
            (
                record["name"],
                str(record["points"]),
                str(3 * record["points"]),
                str(record["rank"]),
                _range(record["mu"]),
                *cells,
            )
        )
    return markdown(rows[0], rows[1:])


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.friction", description=__doc__.split("\n\n")[0]
    )
    parser.add_argument(
        "files",
        nargs="*",
        type=Path,
        metavar="FILE",
        help="problems of FCLIB (.hdf5) or of Siconos' tests (.dat)",
    )
    parser.add_argument(
        "--column",
        type=Path,
        metavar="CASE",
        help="case file of a column whose steps are recorded, too",
    )
    parser.add_argument(
        "--sample",
        type=int,
        default=1,
        metavar="N",
        help="only every N-th problem, >= 1 (%(default)s); all take Siconos some five "
        "minutes of CPU time",
    )
    parser.add_argument(
        "--own",
        type=float,
        default=0.0,
        metavar="SHARE",
        help="a compliance of each point's own, as a share of W's mean diagonal, >= 0 "
        "(%(default)g)",
    )
    parser.add_argument(
        "--every",
        action="store_true",
        help="a row for every problem, not only for those that somebody does not solve",
    )
    parser.add_argument(
        "-o", "--output", type=Path, default=Path("results/friction"), help="folder (%(default)s)"
    )
    given = parser.parse_args(arguments)
    if given.sample < 1:
        parser.error(f"--sample: {given.sample}: must be >= 1")
    if not given.own >= 0:
        parser.error(f"--own: {given.own:g}: must be >= 0")
    chosen = []
    for path in given.files:
        try:
            chosen.append(read_problem(path))
        except ValueError as error:
            print(error, file=sys.stderr)
    if not given.files:
        chosen = [*problems(), *structures(), *(column(given.column) if given.column else ())]
    if not chosen:
        return 2
    chosen = chosen[:: given.sample]
    chosen = [problem.softened(given.own) if given.own else problem for problem in chosen]
    folder = given.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    records, remark = compared(chosen, folder / "siconos")
    write_json(folder / "friction.json", records)
    if not given.files:
        print(summary(records), end="\n\n")
    failed = [
        record
        for record in records
        if any(not one["violation"] <= SOLVED for one in record["solvers"].values())
    ]
    if shown := records if given.files or given.every else failed:
        print(detail(shown), end="\n\n")
    print(shares(records))
    performance_figure(records, LABELS, SOLVED, folder / "friction")
    if remark:
        print(remark, file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
