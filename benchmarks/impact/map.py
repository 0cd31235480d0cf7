"""A map of what an impact takes: energy over what Housner's block loses, in the limit of step,
mesh and modes, over slenderness, stiffness, section and friction.

    ./containers/run python -m benchmarks.impact map [-o DIR] [-j N] [--report]
        [--ratio H/B ...] [--shape SHAPE ...]

Each cell is a file below DIR/cells (results/impact/map unless given): the same command goes on.
Writes map.csv, a row an impact, and map.png (and .pdf), prints a table of the cells and what finer
meshes, more modes, a shorter step and another tilt of release change. On which groups an impact
depends: `sections`; its cells: `grid`; formula and measured tests: `kept_map`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from benchmarks.impact import grid
from benchmarks.impact.figure import draw_map
from benchmarks.impact.sections import SHAPES
from fecolumn.foundation.atomic import write_csv
from fecolumn.foundation.cores import usable_cores


def main(arguments) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.impact map",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-o", "--out", type=Path, default=Path("results/impact/map"))
    parser.add_argument("-j", "--jobs", type=int, default=usable_cores(), help="cells at once")
    parser.add_argument("--report", action="store_true", help="compute nothing, tell what is done")
    parser.add_argument("--ratio", type=float, nargs="+", default=grid.RATIOS, choices=grid.RATIOS)
    parser.add_argument("--group", type=float, nargs="+", default=grid.GROUPS, choices=grid.GROUPS)
    parser.add_argument("--shape", nargs="+", default=SHAPES, choices=SHAPES)
    options = parser.parse_args(arguments)
    wanted = grid.cells(options.ratio, options.group, options.shape)
    rows = grid.rows_of(options.out, wanted, 0 if options.report else options.jobs)
    if not rows:
        parser.error(f"{options.out}: no cell is done")
    write_csv(
        options.out / "map.csv",
        [grid.COLUMNS, *([row[name] for name in grid.COLUMNS] for row in rows)],
    )
    cells = grid.by_cell(rows)
    print("\n\n".join([_map_table(cells), _check_table(rows, cells)]))
    print("\nwrote", *draw_map(cells, options.out / "map"))
    return 0


def _map_table(cells: list[dict]) -> str:
    groups = sorted({one["group"] for one in cells})
    head = ["body", *(f"E B/(rho g H²) {group:.0e}" for group in groups)]
    lines = []
    for shape in SHAPES:
        for friction, ratio in sorted(
            {(one["friction"], one["ratio"]) for one in cells if one["shape"] == shape}
        ):
            own = {
                one["group"]: one
                for one in cells
                if (one["shape"], one["friction"], one["ratio"]) == (shape, friction, ratio)
            }
            name = f"{shape}, friction {friction:g}, H/B {ratio:g}"
            lines.append([name, *(_cell(own.get(group)) for group in groups)])
    return markdown(head, lines)


def _cell(one: dict | None) -> str:
    """Mean and half width of its interval; in parentheses how many releases have a loss, where some
    have none.
    """
    if one is None or not one["releases"]:
        return "-"
    few = "" if one["releases"] == grid.BESIDE else f" ({one['releases']})"
    return f"{one['loss']:.2f} ± {one['half_width']:.2f}{few}"


def _check_table(rows: list[dict], cells: list[dict]) -> str:
    """What a check changes of the mean of a cell; and the step before the last one."""
    head = ["check", "cells", "mean change", "root mean square", "largest"]
    lines = []
    changes = {f"step {grid.STEPS[-2]:g} to {grid.STEPS[-1]:g} B/c": [c["change"] for c in cells]}
    same = {
        tuple(one[key] for key in ("shape", "ratio", "group", "friction")): one for one in cells
    }
    words = {
        "step": f"step {grid.STEPS[-1]:g} to {grid.STEPS[-1] / 4:g} B/c",
        "elements": "8 to 12 elements over the width",
        "modes": "100 to 300 modes",
        "share": "release from 0.15, not 0.3",
    }
    for check, label in words.items():
        changes[label] = [
            one["loss"] - same[key]["loss"]
            for one in grid.by_cell(rows, check)
            if (key := tuple(one[name] for name in ("shape", "ratio", "group", "friction"))) in same
        ]
    for label, found in changes.items():
        values = np.array(found, float)
        values = values[np.isfinite(values)]
        if len(values):
            lines.append(
                [
                    label,
                    len(values),
                    f"{values.mean():+.3f}",
                    f"{np.sqrt(np.mean(values**2)):.3f}",
                    f"{values[np.abs(values).argmax()]:+.3f}",
                ]
            )
    return markdown(head, lines)
