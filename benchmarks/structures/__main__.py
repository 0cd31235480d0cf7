"""Finite elements beside the models: forces and free motion of the restrained wobbling frame,
impacts of the rocking podium; and what a step costs.

    ./containers/run python -m benchmarks.structures [forces planar rolled impacts rocking shaken
        speed growth apart walls large] [-o DIR]
    ./containers/run mpirun -n 2 python -m benchmarks.structures large

Writes the rows of what was asked for into DIR as CSV, draws structures.png (and .pdf) from all that
is there, and prints the tables. The first run makes the meshes and compiles; after it some minutes.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from mpi4py import MPI

from benchmarks.structures import apart, frame, large, podium
from benchmarks.structures.figure import draw
from benchmarks.structures.speed_tables import growths, shaken, speeds
from fecolumn.case.model_sections import LAWS
from fecolumn.foundation.atomic import write_csv

TERMS = ("kinetic", "strain", "gravity", "friction", "impact", "contact", "algorithmic")


def forces(folder: Path) -> None:
    found = frame.forces()
    write_csv(
        folder / "forces.csv",
        [["tendons", "tilt_rad", "slab_m", "virtual_work_n", "slender_n", "elements_n"], *found],
    )
    print(
        "\n| tendons | tilt [rad] | slab [m] | virtual work [N] | slender [N] | finite "
        "elements [N] | off |\n|---|---|---|---|---|---|---|"
    )
    for held, tilt, moved, exact, slender, elements in found:
        print(
            f"| {'yes' if held else 'no'} | {tilt:g} | {moved:.4f} | {exact:.0f} | "
            f"{slender:.0f} | {elements:.0f} | {elements / exact - 1:+.1%} |"
        )


def _written(folder: Path, name: str, rows: dict, model) -> None:
    """Way of the slab and energies, each 5 ms."""
    moved, every = rows["body/slab/displacement"], slice(None, None, 10)
    table = np.column_stack(
        [
            rows["time"],
            moved[:, :2],
            model,
            rows["twist"],
            *(rows[f"energy/{term}"] for term in TERMS),
        ]
    )[every]
    write_csv(
        folder / f"{name}.csv",
        [
            [
                "time_s",
                "x_m",
                "y_m",
                "model_x_m",
                "model_y_m",
                "twist_rad",
                *(f"{term}_j" for term in TERMS),
            ],
            *table.tolist(),
        ],
    )
    total = sum(rows[f"energy/{term}"] for term in TERMS[:3])
    print(
        f"energy {total[0]:.1f} J, after {rows['time'][-1]:g} s {total[-1]:.1f} J: "
        + ", ".join(f"{term} {rows[f'energy/{term}'][-1]:.1f}" for term in TERMS[3:])
        + f" J; twist of the slab at most {np.abs(rows['twist']).max():.2g} rad"
    )


def planar(folder: Path) -> None:
    rows, model, impacts, exact = frame.planar()
    print(
        "\n| impact at [s] | share of the energy kept | plane, rigid | wobbling model "
        "|\n|---|---|---|---|"
    )
    for time, kept in impacts:
        print(f"| {time:.3f} | {kept:.3f} | {exact:.3f} | 1 |")
    _written(folder, "planar", rows, model)


def rolled(folder: Path) -> None:
    rows, model = frame.rolled()
    off = np.linalg.norm(rows["body/slab/displacement"][:, :2] - model, axis=1)
    print(
        "\nrolling round: slab off the model's way over its reach: "
        + ", ".join(
            f"{off[rows['time'] <= until].max() / np.abs(model).max():.1%} in {until:g} s"
            for until in (0.5, 1.0, 2.0, 3.0)
        )
    )
    _written(folder, "rolled", rows, model)


def impacts(folder: Path) -> None:
    table = []
    print(
        "\n| points and columns | period of the building [s] | velocity kept | root of "
        "the energy at the next top | CRV | CAV |\n|---|---|---|---|---|---|"
    )
    for concrete in (False, True):
        for period, rate, top in podium.impacts(concrete=concrete):
            kind, crv, cav = "concrete" if concrete else "rigid", *podium.laws(3)
            table.append([kind, period, rate, top, crv, cav])
            print(
                f"| {kind} | {period} | {rate:.3f} | {top:.3f} | {crv:.3f} | {cav:.3f} |",
                flush=True,
            )
    write_csv(
        folder / "impacts.csv",
        [["kind", "period_s", "rate_kept", "root_of_energy_kept", "crv", "cav"], *table],
    )


def rocking(folder: Path) -> None:
    print(
        "\n| storeys | concrete: next tops over alpha | rigid columns | CRV | CAV "
        "|\n|---|---|---|---|---|"
    )
    for floors in (3, 6, 9):
        tilts = [
            (rows["time"], podium.tilt_of(rows))
            for rows in (podium.rocking(floors, concrete) for concrete in (True, False))
        ]
        tilts += [
            (one.time, one.coordinates["theta"])
            for one in (podium.model_rocking(floors, law, floors / 10, 0.9, 4.0) for law in LAWS)
        ]
        time = np.arange(0, 4.0, 0.005)
        write_csv(
            folder / f"podium_{floors}.csv",
            [
                ["time_s", "concrete_rad", "rigid_rad", "crv_rad", "cav_rad"],
                *np.column_stack([time, *(np.interp(time, *one) for one in tilts)]).tolist(),
            ],
        )
        print(
            f"| {floors} | "
            + " | ".join(", ".join(f"{top:.3f}" for top in podium.tops(tilt)) for _, tilt in tilts)
            + " |",
            flush=True,
        )


def apart_costs(folder: Path) -> None:
    """Of pairs that are apart: beside two standing blocks, and in rows of blocks."""
    print("\n| engine | blocks | no pairs [us] | joints [us] | found [us] |\n|---|---|---|---|---|")
    table = []
    for engine in apart.ENGINES:
        for number in (2, *apart.NUMBERS):
            found = apart.in_turns(number, engine)
            table.append([engine, number, *found.values()])
            print(
                f"| {engine} | {number} | "
                + " | ".join(f"{us:.1f}" for us in found.values())
                + " |",
                flush=True,
            )
    head = ["engine", "blocks", "absent_us", "joint_us", "found_us"]
    write_csv(folder / "apart.csv", [head, *table])


def wall_costs(folder: Path) -> None:
    """Of walls whose stones touch everywhere, and of one with open head joints."""
    print(
        "\n| engine | courses | stones of the lowest | gap [m] | start [s] | step at rest [ms] | "
        "shaken [ms] |\n|---|---|---|---|---|---|---|"
    )
    table = []
    for engine in apart.ENGINES:
        for courses, stones, gap in apart.WALLS:
            found = apart.wall_costs(courses, stones, gap, engine)
            table.append([engine, courses, stones, gap, *found.values()])
            print(
                f"| {engine} | {courses} | {stones} | {gap:g} | "
                + " | ".join(f"{value:.3g}" for value in found.values())
                + " |",
                flush=True,
            )
    head = ["engine", "courses", "stones", "gap_m", "start_s", "rest_ms", "shaken_ms"]
    write_csv(folder / "walls.csv", [head, *table])


def large_costs(folder: Path) -> None:
    """Of a large structure in full order, on all ranks."""
    found = large.costs(MPI.COMM_WORLD)
    parts = found.pop("parts")
    if MPI.COMM_WORLD.rank == 0:
        write_csv(folder / "large.csv", [list(found), list(found.values())])
        print(
            "\n| degrees of freedom | ranks | first step after [s] | standing: s a "
            "step, iterations | rocking, at most [rad] | s a step, iterations "
            "|\n|---|---|---|---|---|---|"
        )
        print(
            f"| {found['dofs']:,} | {found['ranks']} | {found['start_s']:.0f} | "
            f"{found['standing_s']:.3f}, {found['standing_iterations']:.2f} | "
            f"{found['tilt_rad']:.4f} "
            f"| {found['rocking_s']:.3f}, {found['rocking_iterations']:.2f} |"
        )
        print("\n| what a step goes to | standing [%] | rocking [%] |\n|---|---:|---:|")
        for name in parts[0]:
            print(f"| {name} | " + " | ".join(f"{100 * part[name]:.0f}" for part in parts) + " |")


PARTS = dict(
    speed=speeds,
    shaken=shaken,
    growth=growths,
    apart=apart_costs,
    walls=wall_costs,
    large=large_costs,
    forces=forces,
    planar=planar,
    rolled=rolled,
    impacts=impacts,
    rocking=rocking,
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)} (default: all)"
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/structures")
    args = parser.parse_args()
    if unknown := set(args.parts) - set(PARTS):
        parser.error(f"no such part: {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}")
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    for name in args.parts or PARTS:
        PARTS[name](folder)
    if MPI.COMM_WORLD.rank == 0 and (drawn := draw(folder)):
        print("wrote", ", ".join(map(str, drawn)))


if __name__ == "__main__":
    main()
