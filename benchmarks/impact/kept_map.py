"""The map of impacts as benchmarks/tables holds it: cells without their releases, the formula that
is fitted to them, and what others measured.

    ./containers/run python -m benchmarks.impact formula
"""

from __future__ import annotations

import re

from benchmarks import tables
from benchmarks.beside import markdown
from benchmarks.impact.formula import Formula, fit
from benchmarks.impact.grid import BESIDE
from benchmarks.impact.measured import MEASURED

_BODY = re.compile(r"(\w+), friction ([\d.]+), H/B ([\d.]+)")
_CELL = re.compile(r"([-\d.]+) ± ([\d.]+)(?: \((\d+)\))?")


def kept_cells() -> list[dict]:
    """Rows as of `grid.by_cell`, of those with a mean."""
    table, cells = tables.read("impact_map"), []
    groups = [float(column.split()[-1]) for column in table.columns[1:]]
    for name, *row in table.rows:
        shape, friction, ratio = _BODY.fullmatch(name).groups()
        for group, text in zip(groups, row):
            if found := _CELL.fullmatch(text):
                cells.append(
                    dict(
                        shape=shape,
                        friction=float(friction),
                        ratio=float(ratio),
                        group=group,
                        loss=float(found[1]),
                        half_width=float(found[2]),
                        releases=int(found[3] or BESIDE),
                    )
                )
    return cells


def kept_formula() -> Formula:
    """The formula that is fitted to them."""
    return fit(kept_cells())


def main() -> int:
    """Print the tables of the formula and of what others measured."""
    formula = kept_formula()
    measured = [
        [
            f"{one.source}, H/B {one.ratio:g}",
            _span(one.least, one.most),
            _span(*one.losses),
            one.said,
        ]
        for one in MEASURED
    ]
    head = ["measured", "restitution", "loss over Housner's", "said by"]
    print(markdown(["parameter of the formula", "value"], formula.rows()))
    print()
    print(markdown(head, measured))
    return 0


def _span(low: float, high: float) -> str:
    return f"{low:.2f} to {high:.2f}" if low < high else f"{low:.2f}"
