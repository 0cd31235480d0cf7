"""The map of impacts as benchmarks/tables holds it: cells and formula, without their releases."""

from __future__ import annotations

import re

from benchmarks import tables
from benchmarks.impact.formula import Formula
from benchmarks.impact.grid import BESIDE
from benchmarks.impact.sections import SHAPES

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
    """The formula that was fitted to them."""
    value = {name: float(text) for name, text in tables.read("impact_formula").rows}
    return Formula(
        {shape: value[f"a, {shape}"] for shape in SHAPES if f"a, {shape}" in value},
        *(value[name] for name in ("b", "c", "G_c", "m", "k")),
        value["root mean square error"],
        value["of a slenderness left out"],
    )
