"""What a step of a structure in full order costs: a slab on four columns by its degrees of freedom, in processor time and memory.

    ./containers/run python -m benchmarks.structures.full_order [elements along a side of the foot ...] [-o DIR]

The four columns share one factor, one filter and one set of operators. The frame rocks freely from a tilt. Each size runs in a process of its own, of which peak
memory is told; its processor time is that of all threads.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from fecolumn.atomic import write_csv

SIDES = (2, 4, 8, 12)
_STEPS = 40
_SIDE, _HEIGHT = 0.4, 2.4


def frame(side: int):
    """Case of the frame with so many elements along a side of a column's foot, and elements as long along the height."""
    from fecolumn.case import case_from_tables

    size, stone = _SIDE / side, dict(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
    at = [[x, y, 0.0] for x, y in ((1.2, 1.2), (-1.2, 1.2), (-1.2, -1.2), (1.2, -1.2))]
    return case_from_tables(dict(
        bodies=dict(column=dict(kind="block", length_m=_SIDE, width_m=_SIDE, height_m=_HEIGHT, element_size_m=size, coarse_size_m=size, copies_m=at) | stone,
                    slab=dict(kind="slab", length_m=3.2, width_m=3.2, thickness_m=0.3, coarse_size_m=max(size, 0.15), at_m=[0.0, 0.0, _HEIGHT]) | stone),
        interfaces=dict(feet=dict(slave="column", on="ground"), heads=dict(slave="column", on="slab")), contact=dict(friction_coefficient=0.7, interior_points=0),
        initial=dict(column=dict(tilt_rad=0.02)), integration=dict(engine="full", dt_s=1e-3, duration_s=1.0)), "frame")


def measure(side: int) -> list:
    """Degrees of freedom, different factors, processor seconds of making and of a step, iterations of a step, and peak memory [GB]."""
    from mpi4py import MPI

    from fecolumn.case import GRAVITY
    from fecolumn.dynamics.energy import Ledger
    from fecolumn.dynamics.hht import HHT
    from fecolumn.dynamics.stepper import Stepper
    from fecolumn.dynamics.structure import released, structure_system
    from fecolumn.structures.elements import structure_of_elements
    from fecolumn.structures.engine import upright

    case, began = frame(side), time.process_time()
    structure, meshed = structure_of_elements(case, MPI.COMM_SELF, "frame")
    system = structure_system(upright(case, structure), [one.body for one in meshed], HHT(1e-3, case.integration.alpha_hht), np.array([0.0, 0.0, -GRAVITY]),
                              nodes=[one.nodes for one in meshed])
    made, factors = time.process_time() - began, system.factorizations - 1
    state, ledger = released(system, structure.parts, None), Ledger(system)
    ledger.open(state)
    stepper = Stepper(system, ledger)
    for _ in range(3):  # compiled once
        state = stepper.step(state, np.zeros(3))
    began, before = time.process_time(), stepper.record.iterations
    for _ in range(_STEPS):
        state = stepper.step(state, np.zeros(3))
    spent = (time.process_time() - began) / _STEPS
    return [3 * system.column.n_nodes, factors, made, spent, (stepper.record.iterations - before) / _STEPS, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("sides", nargs="*", type=int, metavar="SIDE", help=f"elements along a side of the foot (default: {', '.join(map(str, SIDES))})")
    parser.add_argument("-o", "--output", metavar="DIR", default="results/structures")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.one:
        print(*measure(args.sides[0]))
        return
    rows = []
    print("| degrees of freedom | factors | making [CPU s] | a step [CPU s] | iterations of a step | memory [GB] |\n|---:|---:|---:|---:|---:|---:|", flush=True)
    for side in args.sides or SIDES:
        done = subprocess.run([sys.executable, "-m", "benchmarks.structures.full_order", str(side), "--one"], capture_output=True, text=True, check=True)
        dofs, factors, made, spent, iterations, memory = (float(value) for value in done.stdout.split()[-6:])
        rows.append([int(dofs), int(factors), made, spent, iterations, memory])
        print(f"| {dofs:,.0f} | {factors:.0f} | {made:.1f} | {spent:.3f} | {iterations:.1f} | {memory:.2f} |", flush=True)
    write_csv(Path(args.output) / "full_order.csv", [["dofs", "factors", "making_cpu_s", "step_cpu_s", "iterations", "memory_gb"], *rows])


if __name__ == "__main__":
    main()
