"""What is not known of the granite rock and of its table: within bounds that the literature or the
campaign's own files give, or that are assumed where these give none; no outcome enters.

| name | bounds | from |
|---|---|---|
| friction | 0.55 to 0.85 | dry granite: Barton and Choubey (1977) to Byerlee (1978) |
| restitution | 0 to 0.6 | of a point: see below |
| youngs | 30 to 70 GPa, log | granite (Jaeger, Cook and Zimmerman 2007, table 7.1) |
| softer | 1 to 10, log | compliance of a rough contact over that of a smooth one |
| rounding | 0 to 0.01 m | radius of the edges: assumed; no scan shows less than its triangles |
| direction | -5 to 5 degrees | assumed; the rock was put on the table by hand |
| crossover | 0.1 to 3 Hz, log | displacement of the table below it, its accelerometer above |
| upper | 25 to 100 Hz, log | the source's own filter, and one an octave above the table's band |

Basic friction angles of dry granite are 29 to 35 degrees, up to a coefficient of 0.85. With a
restitution of 0.6 a share of 0.36 of the energy of the approach is left, so that an impact takes
0.64 of Housner's loss; without restitution it takes all of it. Half of the stiff elastic bodies of
the map of impacts (benchmarks/RESULTS.md) lose 0.63 to 0.74 of it in the limit of short steps, and
rigid ones all.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.shake_table.campaign import BAND_HZ, TableView
from benchmarks.shake_table.rock import Stone
from benchmarks.soak.hypercube import hypercube

#: Of the draws
SEED = 1
#: Bounds of each uncertain quantity, and whether it is spread evenly in the logarithm.
BOUNDS = {
    "friction": (0.55, 0.85, False),
    "restitution": (0.0, 0.6, False),
    "youngs": (30e9, 70e9, True),
    "softer": (1.0, 10.0, True),
    "rounding": (0.0, 0.01, False),
    "direction": (-np.radians(5.0), np.radians(5.0), False),
    "crossover": (BAND_HZ[0], 3.0, True),
    "upper": (BAND_HZ[1], 100.0, True),
}
_STONE = ("friction", "restitution", "youngs", "softer", "rounding")


@dataclass(frozen=True)
class Setting:
    """A rock and how the table's motion is read."""

    stone: Stone
    view: TableView


def settings(stone: Stone, count: int, seed: int) -> list[Setting]:
    """So many draws within `BOUNDS` by a Latin hypercube, about the direction of `stone`; the
    same for a seed and a count.
    """
    made = []
    for draw in hypercube(BOUNDS, count, seed):
        values = {
            name: draw.log(name, low, high) if logarithmic else draw.even(name, low, high)
            for name, (low, high, logarithmic) in BOUNDS.items()
        }
        made.append(
            Setting(
                replace(
                    stone,
                    direction=stone.direction + values["direction"],
                    **{name: values[name] for name in _STONE},
                ),
                TableView(values["crossover"], values["upper"]),
            )
        )
    return made
