"""The contact solver beside Siconos on friction problems of many bodies: who solves which, how well, in what time.

    ./containers/run python -m benchmarks.friction [--own SHARE] [--every] [-o DIR] [FILE ...]

Without files: assemblies of rigid bodies (assemblies.py), every one from rest, shaken and thrown, with coefficients from 0 to 1.2. With files:
problems of the Friction Contact Library (HDF5) or of Siconos' own tests (.dat). Siconos runs if Debian's python3-siconos is installed
(python -m benchmarks.peers --install), its nonsmooth Gauss-Seidel (NSGS) and nonsmooth Newton of Alart and Curnier, to 1e-12 or 5,000 and 200 iterations.
All start from zero forces. Every solver's forces are judged by the same natural map (problem.py), relative to the largest |q|.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.friction.assemblies import problems
from benchmarks.friction.fclib import read_problem
from benchmarks.friction.problem import Problem, violation
from benchmarks.peers.child import run_child
from benchmarks.peers.install import SYSTEM_PYTHON
from fecolumn.atomic import write_json
from fecolumn.contact.friction import prepare_solver, solve_contact

# Violation of the laws over max |q| below which a problem counts as solved: 1e-13 m on the tenth of a millimetre that bodies fall in a step, a
# tenth of what the engines ask for; rounding of W r costs 1e-15 to 1e-14
SOLVED = 1e-9
# What the solver is asked for, over max |q|
TOLERANCE = 1e-12
LIMIT_CPU_S = 3600.0
LABELS = {"fecolumn": "fecolumn", "nsgs": "Siconos NSGS", "newton": "Siconos Newton"}


def ours(problem: Problem) -> dict:
    """Forces, seconds and iterations of `solve_contact`."""
    if np.ndim(problem.mu):  # the solver has one coefficient for all points
        return {}
    began = time.perf_counter()
    found = solve_contact(problem.W, problem.q, problem.mu, np.zeros_like(problem.q), TOLERANCE * np.abs(problem.q).max())
    return dict(forces=found.forces, seconds=time.perf_counter() - began, iterations=found.iterations, sweeps=found.sweeps)


def siconos(given: list[Problem], folder: Path) -> tuple[list[dict], str]:
    """Results of Siconos by solver, one a problem, {} where it gave none; and a remark on what went wrong, if anything did."""
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.npz"):
        old.unlink()
    for k, problem in enumerate(given):
        np.savez(folder / f"{k:04d}.problem.npz", W=problem.W, q=problem.q, mu=problem.mu)
    try:
        ended = run_child([SYSTEM_PYTHON, "-P", str(Path(__file__).with_name("siconos.py")), str(folder)], folder, LIMIT_CPU_S)
    except OSError as error:
        return [{} for _ in given], f"Siconos cannot run: {error}"
    found = []
    for k in range(len(given)):
        paths = {name: folder / f"{k:04d}.{name}.npz" for name in LABELS if name != "fecolumn"}
        found.append({name: dict(np.load(path)) for name, path in paths.items() if path.exists()})
    return found, "" if ended.code == 0 else f"Siconos ended with code {ended.code}: {ended.words}"


def compared(given: list[Problem], folder: Path) -> tuple[list[dict], str]:
    """A record a problem: what it is, and of every solver violation, seconds and iterations; and Siconos' remark."""
    prepare_solver(lambda text: print(text, file=sys.stderr))
    others, remark = siconos(given, folder)
    records = []
    for problem, other in zip(given, others):
        record = dict(name=problem.name, points=problem.points, rank=problem.rank, mu=np.unique(problem.mu).tolist(), solvers={})
        for name, found in ({"fecolumn": ours(problem)} | other).items():
            if found:
                record["solvers"][name] = {key: float(value) for key, value in found.items() if key != "forces"}
                record["solvers"][name]["violation"] = violation(problem, found["forces"])
        records.append(record)
    return records, remark


def _table(rows) -> str:
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]])


def summary(records) -> str:
    """A row an assembly: problems solved, worst violation, median and longest time of each solver."""
    rows = [("assembly", "points", "3 n", "rank", *(f"{label}: solved, worst, ms median, longest" for label in LABELS.values()))]
    for name, group in itertools.groupby(records, key=lambda record: record["name"].split(",")[0]):
        group, cells = list(group), []
        for solver in LABELS:
            found = [record["solvers"][solver] for record in group if solver in record["solvers"]]
            bad, ms = [one["violation"] for one in found], [1e3 * one["seconds"] for one in found]
            cells.append(f"{sum(v <= SOLVED for v in bad)}/{len(group)}, {np.max(bad):.0e}, {np.median(ms):.2g}, {max(ms):.2g}" if found else "-")
        rows.append((name, str(group[0]["points"]), str(3 * group[0]["points"]), str(group[0]["rank"]), *cells))
    return _table(rows)


def detail(records) -> str:
    """A row a problem: violation, ms and iterations of each solver."""
    rows = [("problem", "points", "3 n", "rank", "mu", *(f"{label}: violation, ms, iterations" for label in LABELS.values()))]
    for record in records:
        cells = []
        for solver in LABELS:
            one = record["solvers"].get(solver)
            others = f" + {one['sweeps']:.0f}" if one and one.get("sweeps") else ""
            cells.append(f"{one['violation']:.1e}, {1e3 * one['seconds']:.2g}, {one['iterations']:.0f}{others}" if one else "-")
        mu = " to ".join(f"{value:.3g}" for value in sorted({record["mu"][0], record["mu"][-1]}))
        rows.append((record["name"], str(record["points"]), str(3 * record["points"]), str(record["rank"]), mu, *cells))
    return _table(rows)


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.friction", description=__doc__.split("\n\n")[0])
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="problems of FCLIB (.hdf5) or of Siconos' tests (.dat)")
    parser.add_argument("--own", type=float, default=0.0, metavar="SHARE",
                        help="a compliance of each point's own, as a share of W's mean diagonal, >= 0 (%(default)g)")
    parser.add_argument("--every", action="store_true", help="a row for every problem, not only for those that somebody does not solve")
    parser.add_argument("-o", "--output", type=Path, default=Path("results/friction"), help="folder (%(default)s)")
    given = parser.parse_args(arguments)
    if not given.own >= 0:
        parser.error(f"--own: {given.own:g}: must be >= 0")
    chosen = []
    for path in given.files:
        try:
            chosen.append(read_problem(path))
        except ValueError as error:
            print(error, file=sys.stderr)
    chosen = chosen if given.files else problems()
    if not chosen:
        return 2
    chosen = [problem.softened(given.own) if given.own else problem for problem in chosen]
    folder = given.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    records, remark = compared(chosen, folder / "siconos")
    write_json(folder / "friction.json", records)
    if not given.files:
        print(summary(records), end="\n\n")
    failed = [record for record in records if any(not one["violation"] <= SOLVED for one in record["solvers"].values())]
    if shown := records if given.files or given.every else failed:
        print(detail(shown), end="\n\n")
    for solver, label in LABELS.items():
        found = [record["solvers"][solver]["violation"] for record in records if solver in record["solvers"]]
        print(f"{label}: {sum(v <= SOLVED for v in found)} of {len(found)} solved to {SOLVED:g}")
    if remark:
        print(remark, file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
