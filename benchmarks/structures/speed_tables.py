"""Tables of what a step of a structure costs, and how the cost grows."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.structures import speed
from fecolumn.foundation.atomic import write_csv


def shaken(folder: Path) -> None:
    """Of the frame of four columns and of eight drums alone: the rows that RESULTS prints."""
    _costs(folder / "shaken.csv", [row for row in speed.ROWS if row[:2] in speed.PRINTED])


def speeds(folder: Path) -> None:
    """Of structures of 1 to 16 columns or drums that stand, slide, lift and land, rigid and with
    ten modes a body, beside MuJoCo; and what the time buys.
    """
    _costs(folder / "speed.csv", speed.ROWS)
    _exact()


def _costs(file: Path, asked) -> None:
    """Print and write the rows that are asked for."""
    print(
        "\n| structure | rigid [us] | rigid, median [us] | ten modes [us] | ten modes, median [us] "
        "| MuJoCo [us] | MuJoCo, stiff [us] | MuJoCo, best [us] | peak, rigid [m] "
        "| peak, ten modes [m] | peak, MuJoCo [m] | peak, MuJoCo, stiff [m] "
        "| peak, MuJoCo, best [m] | closure, rigid | closure, ten modes |\n" + "|---" * 15 + "|"
    )
    table = []
    for kind, number, factor in asked:
        rigid, elastic = (
            speed.cost(kind, number, factor, engine) for engine in ("rigid", "reduced")
        )
        theirs = [
            speed.mujoco_cost(kind, number, factor, settings) or dict(us=np.nan, peak_m=np.nan)
            for settings in ("default", "stiff", "best")
        ]
        every = (rigid, elastic, *theirs)
        costs = [rigid["us"], rigid["median_us"], elastic["us"], elastic["median_us"]]
        costs += [one["us"] for one in theirs]
        peaks, closures = [one["peak_m"] for one in every], [one["closure"] for one in every[:2]]
        table.append([kind, number, factor, *costs, *peaks, *closures])
        print(
            f"| {kind} of {number}, {f'shaken by {factor} of uplift' if factor else 'let go'} | "
            + " | ".join(f"{us:.0f}" for us in costs)
            + "".join(f" | {value:.2g}" for value in (*peaks, *closures))
            + " |",
            flush=True,
        )
    if np.isnan(table[0][7]):
        print("MuJoCo is not installed: python -m benchmarks.peers --install")
    names = ("rigid", "modes", "mujoco", "mujoco_stiff", "mujoco_best")
    head = ["rigid_us", "rigid_median_us", "modes_us", "modes_median_us"]
    head += [f"{name}_us" for name in names[2:]] + [f"{name}_peak_m" for name in names]
    head += ["rigid_closure", "modes_closure"]
    write_csv(file, [["structure", "number", "factor", *head], *table])


def _exact() -> None:
    """Print how far a cube slides and a stack creeps."""
    print(
        "\n| exact or wanted | rigid | ten modes | MuJoCo | MuJoCo, stiff |\n|---|---|---|---|---|"
    )
    stands = f"{speed.CREEPS} drums stand for {speed.STANDS:g} s and move [m]"
    for told, exact, own, theirs in (
        (
            f"a cube slides at {speed.SLIDES:g} m/s [m]",
            speed.slid_exactly(),
            speed.slid,
            speed.mujoco_slid,
        ),
        (stands, 0.0, speed.crept, speed.mujoco_crept),
    ):
        found = [*map(own, ("rigid", "reduced")), *map(theirs, ("default", "stiff"))]
        print(f"| {told}: {exact:.5g} | " + " | ".join(f"{value:.6g}" for value in found) + " |")


def growths(folder: Path) -> None:
    """Of drums on one another, by their number and by the points of a face."""
    print(
        "\n| grows with | engine | regime | costs of a step [us] | exponent |\n" + "|---" * 5 + "|"
    )
    table = []
    for engine in ("rigid", "reduced"):
        for told, numbers, given in (
            ("drums", speed.DRUMS, lambda n: (n, None)),
            ("points a face, 2 drums", speed.POINTS_A_FACE, lambda n: (2, n)),
        ):
            for factor in speed.FACTORS:
                costs = []
                for n in numbers:
                    number, points = given(n)
                    costs.append(speed.cost("drums", number, factor, engine, points)["us"])
                slope = speed.growth(numbers, costs)
                regime = f"shaken by {factor} of uplift" if factor else "let go"
                table.append([told, engine, regime, *costs, slope])
                print(
                    f"| {told}: {', '.join(map(str, numbers))} | {engine} | {regime} | "
                    + ", ".join(f"{us:.0f}" for us in costs)
                    + f" | {slope:.2f} |",
                    flush=True,
                )
    write_csv(folder / "growth.csv", table)
